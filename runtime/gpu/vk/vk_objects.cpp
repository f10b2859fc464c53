// Objects as they come and go, and where hosts move them. What becomes of them within a frame is
// vk_record.cpp's.
#include "core/growth.h"
#include "gpu/vk/drawn_order.h"
#include "gpu/vk/world_state.h"

#include <algorithm>
#include <cstring>

namespace fw::gpu::vk {
namespace {

// Records of a mesh that deforms, with vertices as the device numbers them.
void stageDeformModel(VkBackend::State& s, const mesh::BurnDomain& domain,
                      const mesh::DeformModel& model, uint32_t firstNode, uint32_t firstEmbedding) {
    const DrawnOrder order(domain, s.memory);
    const uint64_t nodeBytes = model.nodes.size() * sizeof(DeviceParticle);
    const uint64_t embeddingBytes = model.embeddings.size() * sizeof(DeformEmbedding);
    PendingUpload& upload = s.stage(nodeBytes + embeddingBytes, "deformation staging");
    const auto number = [&](uint32_t& vertex) {
        if (vertex != kNoneTexel) vertex = order.numbers[vertex];
    };
    for (uint32_t i = 0; i < model.nodes.size(); ++i) {
        DeviceParticle node = mesh::deviceNode(model, i);
        number(node.vertex);
        mesh::putQuads(node, i, model.nodes.size(), upload.staging.mapped);
    }
    for (size_t i = 0; i < order.vertices.size(); ++i) {
        DeformEmbedding coat = model.embeddings[order.vertices[i]];
        number(coat.node);
        for (uint32_t& vertex : coat.ring) number(vertex);
        mesh::putQuads(coat, i, order.vertices.size(), upload.staging.mapped + nodeBytes);
    }
    upload.regions[0] = {FW_BIND_DEFORM_PARTICLES, 0, uint64_t(firstNode) * sizeof(DeviceParticle),
                         nodeBytes};
    upload.regions[1] = {FW_BIND_DEFORM_EMBEDDINGS, nodeBytes,
                         uint64_t(firstEmbedding) * sizeof(DeformEmbedding), embeddingBytes};
    upload.regionCount = 2;
}

// Where each texel is on its triangle.
void stageSkinTexels(VkBackend::State& s, const mesh::BurnDomain& domain, const DrawnOrder& order,
                     uint32_t firstTile, uint32_t firstSource) {
    const uint64_t bytes = uint64_t(domain.texelCount()) * sizeof(uvec4);
    const uint64_t sourceBytes = order.vertices.size() * 4;
    PendingUpload& upload = s.stage(bytes + sourceBytes, "skin staging");
    for (size_t i = 0; i < order.vertices.size(); ++i)
        std::memcpy(upload.staging.mapped + bytes + i * 4, &domain.sources[order.vertices[i]], 4);
    upload.regions[upload.regionCount++] = {FW_BIND_SKIN_SOURCES, bytes, uint64_t(firstSource) * 4,
                                            sourceBytes};
    for (uint32_t i = 0; i < domain.texelCount(); ++i) {
        uvec4 record{0, 0, 0, 0};
        if (domain.triangleOf[i] != mesh::kNone) {
            uint32_t number[3];
            for (uint32_t k = 0; k < 3; ++k)
                number[k] = order.numbers[domain.indices[size_t(domain.triangleOf[i]) * 3 + k]];
            float weights[3];
            mesh::texelWeights(domain, i, weights);
            const auto unorm = [](float w) { return uint32_t(w * 65535.0f + 0.5f); };
            record = {number[0], number[1], number[2], unorm(weights[0]) | unorm(weights[1]) << 16};
        }
        std::memcpy(upload.staging.mapped + size_t(i) * sizeof record, &record, sizeof record);
    }
    upload.regions[upload.regionCount++] = {
        FW_BIND_SKIN_TEXELS, 0, uint64_t(firstTile) * kTileTexels * sizeof(uvec4), bytes};
}

// A skinned object's vertices at rest: kept here, and on their way to the device.
void stageSkin(VkBackend::State& s, const mesh::BurnDomain& domain, const DrawnOrder& order,
               Skin& skin, uint32_t firstShown) {
    skin.shown.assign(domain.vertices.size(), ShownVertex{});
    skin.sources.resize(domain.vertices.size());
    for (size_t i = 0; i < order.vertices.size(); ++i) {
        const mesh::RenderVertex& v = domain.vertices[order.vertices[i]];
        skin.shown[i].x = v.position[0];
        skin.shown[i].y = v.position[1];
        skin.shown[i].z = v.position[2];
        skin.shown[i].normal = v.normal;
        skin.sources[i] = domain.sources[order.vertices[i]];
    }
    const uint64_t bytes = skin.shown.size() * sizeof(ShownVertex);
    PendingUpload& upload = s.stage(bytes, "skin staging");
    std::memcpy(upload.staging.mapped, skin.shown.data(), bytes);
    upload.regions[upload.regionCount++] = {FW_BIND_SHOWN, 0,
                                            uint64_t(firstShown) * sizeof(ShownVertex), bytes};
}

// All of an object's but its tiles, which lists may still name.
void releaseRanges(VkBackend::State& s, const ObjectEntry& entry) noexcept {
    if (entry.slowness.units)
        s.buffers.release(kPoolSlowness, entry.slowness.first, entry.slowness.units);
    if (entry.published.units)
        s.buffers.release(kPoolPublished, entry.published.first, entry.published.units);
    if (entry.heatTiles.units)
        s.buffers.release(kPoolHeat, entry.heatTiles.first, entry.heatTiles.units);
    if (entry.sources.units)
        s.buffers.release(kPoolSources, entry.sources.first, entry.sources.units);
    if (entry.deforms.range.units)
        s.buffers.release(kPoolDeformers, entry.deforms.range.first, entry.deforms.range.units);
    if (entry.soft.units) s.buffers.release(kPoolSoft, entry.soft.first, entry.soft.units);
    if (entry.shown.units) s.buffers.release(kPoolShown, entry.shown.first, entry.shown.units);
    if (entry.deforms.skinPlus1) {
        s.deforming.skins[entry.deforms.skinPlus1 - 1].shown.clear();
        Skin& skin = s.deforming.skins[entry.deforms.skinPlus1 - 1];
        skin.dirty = skin.givenDue = false;
        if (skin.words.units) s.buffers.release(kPoolSkinGiven, skin.words.first, skin.words.units);
        skin.words = {};
    }
}

// Has no frame anything to do for it, until somebody changes it or something reaches it?
bool rests(const VkBackend::State& s, const ObjectEntry& object) noexcept {
    if (object.recordDirty || object.materialsDirty || object.resetDue) return false;
    if (!object.live) return true;
    const bool reached = object.burn.touched || object.burn.warmed || object.burn.charred;
    const bool moves = object.deforms.recordDirty || object.deforms.reset || object.deforms.now ||
                       object.soft.units != 0 || object.deforms.skinPlus1 != 0;
    const bool refined = object.refine.patternPlus1 != 0 || object.refine.due || s.refines(object);
    return !reached && !moves && !refined && (object.record.flags & kObjectPublished) == 0;
}

}  // namespace

void VkBackend::State::changed(uint32_t slot) noexcept {
    scene.objects[slot].recordDirty = scene.recordsDirty = true;
    scene.awake.insert(slot);
}

void VkBackend::State::settle() noexcept {
    for (const uint32_t slot : scene.awake)
        if (rests(*this, scene.objects[slot])) scene.awake.erase(slot);
}

void VkBackend::createObject(uint32_t slot, const ObjectInit& init) {
    State& s = *state_;
    const uint64_t last = s.ring.newest();
    MeshEntry& mesh = s.scene.meshes[init.mesh];
    RangeOf nodes = mesh.nodes, embeddings = mesh.embeddings, skin = mesh.skin,
            sources = mesh.skinSources;
    const size_t uploadsBefore = s.scene.uploads.size();
    ObjectEntry fresh;
    fresh.live = true;
    fresh.mesh = init.mesh;
    fresh.record = init.record;
    fresh.seenFrame = last;
    DrawPassSet passes = 0;
    for (uint32_t m = 0, first = 0; m < kMaterialsPerObject; first = mesh.materialEnd[m++]) {
        if (mesh.materialEnd[m] == first) continue;
        const BurnMaterial material =
            m < init.materials.size() ? init.materials[m] : BurnMaterial{};
        passes |= surfacePasses(material, init.images[m] != 0);
    }
    s.context.pipelines.need(passes);
    try {
        core::growTo(s.scene.quarantine, s.scene.quarantine.size() + s.scene.liveObjects + 1);
        core::growTo(s.surfaces.drawItems, (s.scene.liveObjects + 1) * kMaterialsPerObject);
        core::growTo(s.surfaces.surfaceSteps,
                     (s.scene.liveObjects + 1) * kMaterialsPerObject * kMostSurfaceSteps);
        core::growTo(s.simulation.published, s.scene.liveObjects + 1);
        core::growTo(s.results.givenObjects, std::max<size_t>(slot + 1, s.scene.objects.size()));
        (void)slotOf(s.scene.objects, slot);
        s.scene.awake.atLeast(slot + 1);
        s.buffers.atLeast(kPoolObjects, slot + 1, last);
        s.freeQuarantine();
        fresh.tiles = {s.buffers.allocate(kPoolObjectTiles, mesh.tiles, last), mesh.tiles};
        fresh.inner = init.inner;
        if (init.refine) {
            fresh.refine.on = true;
            fresh.refine.key = refineKey(init.patternModel != nullptr, init.refineDepth);
            fresh.refine.pixelsPerEdge = init.refinePixelsPerEdge;
            fresh.refine.epochTick = s.simulation.shownTick;
            const RefineMesh& refined = mesh.refine[fresh.refine.key];
            if (init.patternModel)
                s.adoptPattern(fresh.refine, init, refined, last);
            else
                fresh.refine.allocate(s.buffers, refined,
                                      (init.record.flags & kObjectTwoSided) == 0, last);
        }
        if (!init.slowness.empty()) {
            fresh.slowness = {s.buffers.allocate(kPoolSlowness, mesh.tiles, last), mesh.tiles};
            PendingUpload& upload = s.stage(init.slowness.size_bytes(), "slowness staging");
            std::memcpy(upload.staging.mapped, init.slowness.data(), init.slowness.size_bytes());
            upload.regions[upload.regionCount++] = {
                FW_BIND_SLOWNESS, 0, uint64_t(fresh.slowness.first) * kTileTexels * 2,
                init.slowness.size_bytes()};
        }
        if (init.record.flags & kObjectPublished)
            fresh.published = {s.buffers.allocate(kPoolPublished, mesh.tiles, last), mesh.tiles};
        fresh.sources = {s.buffers.allocate(kPoolSources, mesh.sourceCells, last),
                         mesh.sourceCells};
        if (!init.heat.empty())
            fresh.heatTiles = {s.buffers.allocate(kPoolHeat, mesh.tiles, last), mesh.tiles};
        if (init.deform) {
            const mesh::DeformModel& model = *init.deformModel;
            fresh.deforms.range = {s.buffers.allocate(kPoolDeformers, 1, last), 1};
            const auto count = uint32_t(model.nodes.size());
            if (init.deform->flags & (kDeformShell | kDeformSprings))
                fresh.soft = {s.buffers.allocate(kPoolSoft, count, last), count};
            // And once more for the inner skin.
            const uint32_t shown = mesh.vertices * (init.inner ? 2 : 1);
            fresh.shown = {s.buffers.allocate(kPoolShown, shown, last), shown};
            if (nodes.units == 0) {
                nodes = {s.buffers.allocate(kPoolSheetParticles, count, last), count};
                embeddings = {s.buffers.allocate(kPoolEmbeddings, mesh.vertices, last),
                              mesh.vertices};
                stageDeformModel(s, *mesh.domain, model, nodes.first, embeddings.first);
            }
        }
        if (init.record.flags & kObjectSkinned) {
            const DrawnOrder order(*mesh.domain, s.memory);
            if (skin.units == 0) {
                skin = {s.buffers.allocate(kPoolSkin, mesh.tiles, last), mesh.tiles};
                sources = {s.buffers.allocate(kPoolSkinSources, mesh.vertices, last),
                           mesh.vertices};
                stageSkinTexels(s, *mesh.domain, order, skin.first, sources.first);
            }
            if (!(init.deform->flags & (kDeformShell | kDeformSprings))) {  // the host moves it
                uint32_t free = 0;
                while (free < s.deforming.skins.size() && !s.deforming.skins[free].shown.empty())
                    ++free;
                if (free == s.deforming.skins.size()) s.deforming.skins.emplace_back();
                fresh.deforms.skinPlus1 = free + 1;
                stageSkin(s, *mesh.domain, order, s.deforming.skins[free], fresh.shown.first);
            }
        }
    } catch (...) {
        s.dropPattern(fresh.refine);
        fresh.refine.release(s.buffers);
        if (mesh.nodes.units == 0) {
            if (nodes.units) s.buffers.release(kPoolSheetParticles, nodes.first, nodes.units);
            if (embeddings.units)
                s.buffers.release(kPoolEmbeddings, embeddings.first, embeddings.units);
        }
        if (mesh.skin.units == 0) {
            if (skin.units) s.buffers.release(kPoolSkin, skin.first, skin.units);
            if (sources.units) s.buffers.release(kPoolSkinSources, sources.first, sources.units);
        }
        releaseRanges(s, fresh);
        if (fresh.tiles.units)
            s.buffers.release(kPoolObjectTiles, fresh.tiles.first, fresh.tiles.units);
        s.dropUploads(uploadsBefore);
        throw;
    }
    BurnObject& r = fresh.record;
    r.texelBase = mesh.meshTiles.first * kTileTexels;
    r.stateBase = fresh.tiles.first * kTileTexels;
    r.slowBase =
        (fresh.slowness.units ? fresh.slowness.first : mesh.slowness.first) * (kTileTexels / 2);
    r.tileBase = mesh.meshTiles.first;
    r.worldTileBase = fresh.tiles.first;
    r.linkBase = mesh.links.first;
    r.dependentBase = mesh.readers.first;
    r.publishedBase = fresh.published.first * kTileTexels * 3;
    r.heatBase = fresh.heatTiles.first * kTileTexels;
    r.width = mesh.width;
    r.height = mesh.height;
    r.tilesX = mesh.tilesX;
    r.tileCount = mesh.tiles;
    r.flags = (r.flags & ~kObjectHeat) | kObjectLive | (init.heat.empty() ? 0 : kObjectHeat);
    for (size_t i = 0; i < kMaterialsPerObject && i < init.heat.size(); ++i)
        fresh.heat[i] = init.heat[i];
    for (size_t i = 0; i < kMaterialsPerObject && i < init.materials.size(); ++i)
        fresh.materials[i] = init.materials[i];
    std::copy(std::begin(init.images), std::end(init.images), std::begin(fresh.images));
    fresh.materialsDirty = fresh.resetDue = true;
    if (init.deform) {
        mesh.nodes = nodes;
        mesh.embeddings = embeddings;
        fresh.deform = *init.deform;
        fresh.deform.nodeBase = nodes.first;
        fresh.deform.nodeCount = nodes.units;
        fresh.deform.embeddingBase = embeddings.first;
        fresh.deform.vertexCount = mesh.vertices;
        fresh.deform.shownBase = fresh.shown.first;
        fresh.deform.softBase = fresh.soft.first;
        fresh.deform.innerFirst = mesh.innerVertices.first;
        fresh.deform.stateBase = r.stateBase;
        fresh.deform.slot = slot;
        fresh.deform.scale = length(vec3(r.worldRow0));
        for (const DeformMaterial& m : fresh.deform.materials)
            for (const uint32_t ticks : {m.charTicks, m.holeTicks})
                if (ticks != kNoneTexel) fresh.deforms.ticks = std::max(fresh.deforms.ticks, ticks);
        fresh.deforms.ticks += kTicksPerSecond;  // readbacks come late
        fresh.deforms.recordDirty = fresh.deforms.reset = true;
    }
    if (init.record.flags & kObjectSkinned) {
        mesh.skin = skin;
        mesh.skinSources = sources;
        r.skinBase = skin.first * kTileTexels;
        r.shownBase = fresh.shown.first;
    }
    if (fresh.deforms.skinPlus1) {
        std::copy_n(init.shape, 3, fresh.shape);
        fresh.deforms.reset = false;  // at rest already
    }
    s.scene.objects[slot] = fresh;
    s.changed(slot);
    s.simulation.seenFrame = std::max(s.simulation.seenFrame, last);
    (fresh.refine.patternPlus1 ? s.pattern.users : s.refine.users) += fresh.refine.on ? 1 : 0;
    ++s.scene.liveObjects;
}

void VkBackend::destroyObject(uint32_t slot) noexcept {
    State& s = *state_;
    ObjectEntry& entry = s.scene.objects[slot];
    if (!entry.live) return;
    const bool met = !entry.resetDue;  // by a recorded frame, so lists may name its tiles
    if (met)
        s.scene.quarantine.push_back({entry.tiles, s.simulation.frontWalks, s.simulation.burnWalks,
                                      s.simulation.predictWalks, s.simulation.hotWalks});
    else
        s.buffers.release(kPoolObjectTiles, entry.tiles.first, entry.tiles.units);
    (entry.refine.patternPlus1 ? s.pattern.users : s.refine.users) -= entry.refine.on ? 1 : 0;
    s.dropPattern(entry.refine);
    entry.refine.release(s.buffers);
    releaseRanges(s, entry);
    entry = {};
    s.changed(slot);  // a record without kObjectLive: list entries fall out
    --s.scene.liveObjects;
    s.surfaces.surfacesDirty = true;
    std::erase_if(s.surfaces.drawItems,
                  [slot](const DrawItem& item) { return item.object == slot; });
}

void VkBackend::setObjectPose(uint32_t slot, const vec4 rows[3], const vec4& tint, uint32_t flags) {
    State& s = *state_;
    ObjectEntry& entry = s.scene.objects[slot];
    entry.record.worldRow0 = rows[0];
    entry.record.worldRow1 = rows[1];
    entry.record.worldRow2 = rows[2];
    entry.record.tint = tint;
    if (entry.shown.units) {
        entry.deform.scale = length(vec3(rows[0]));
        entry.deforms.recordDirty = true;
        entry.deforms.softUntil = 0;  // it swings again
    }
    constexpr uint32_t kFixed = kObjectPublished | kObjectHeat | kObjectUnseen;
    entry.record.flags = (flags & ~kFixed) | (entry.record.flags & kFixed) | kObjectLive;
    s.changed(slot);
}

void VkBackend::setObjectWind(uint32_t slot, uint32_t wind) {
    State& s = *state_;
    s.scene.objects[slot].record.zoneWind = wind;
    s.changed(slot);
}

void VkBackend::setRoom(uint32_t slot, const Room& room) noexcept {
    state_->scene.rooms[slot] = room;
    state_->scene.roomsDirty = true;
}

void VkBackend::setVertices(uint32_t slot, std::span<const float> positions,
                            std::span<const float> normals) noexcept {
    State& s = *state_;
    Skin& skin = s.deforming.skins[s.scene.objects[slot].deforms.skinPlus1 - 1];
    for (size_t i = 0; i < skin.shown.size(); ++i) {
        ShownVertex& v = skin.shown[i];
        const size_t from = size_t(skin.sources[i]) * 3;
        v.x = positions[from];
        v.y = positions[from + 1];
        v.z = positions[from + 2];
        if (!normals.empty())
            v.normal = packDirection({normals[from], normals[from + 1], normals[from + 2]});
    }
    skin.dirty = true;
    skin.givenDue = false;
    skin.normals = !normals.empty();
}

void VkBackend::setVertexBuffer(uint32_t slot, const FwVulkanVertices& vertices,
                                float metersPerUnit) {
    State& s = *state_;
    Skin& skin = s.deforming.skins[s.scene.objects[slot].deforms.skinPlus1 - 1];
    const uint64_t last = vertices.normalOffset ? uint64_t(vertices.normalOffset) + 12 : 12;
    const uint64_t words = (uint64_t(vertices.vertexCount - 1) * vertices.stride + last) / 4;
    if (skin.words.units < words) {
        const RangeOf fresh{s.buffers.allocate(kPoolSkinGiven, uint32_t(words), s.ring.newest()),
                            uint32_t(words)};
        if (skin.words.units) s.buffers.release(kPoolSkinGiven, skin.words.first, skin.words.units);
        skin.words = fresh;
    }
    skin.given = vertices;
    skin.metersPerUnit = metersPerUnit;
    skin.givenDue = true;
    skin.dirty = false;
    skin.normals = vertices.normalOffset != 0;
}

}  // namespace fw::gpu::vk
