// Creation and destruction of objects, and the changes that hosts make to them. simulation.cpp
// records what a frame does to them.
#include "core/growth.h"
#include "gpu/vk/backend_state.h"
#include "gpu/vk/drawn_order.h"
#include "gpu/vk/vk_extension.h"

#include <algorithm>
#include <cstring>

namespace fw::gpu::vk {
namespace {

// Ranges that an object's mesh holds from the first object on that needs them.
struct MeshAdditions {
    BufferRange particles, embeddings, skin, skinSources;
};

// Records of a mesh that deforms, with vertices as the device numbers them.
void stageDeformModel(BackendState& s, const mesh::BurnDomain& domain,
                      const mesh::DeformModel& model, const MeshAdditions& added) {
    const DrawnOrder order(domain, s.memory);
    const uint64_t particleBytes = model.particles.size() * sizeof(DeviceParticle);
    const uint64_t embeddingBytes = model.embeddings.size() * sizeof(DeformEmbedding);
    PendingUpload& upload =
        s.scene.uploads.stage(particleBytes + embeddingBytes, "deformation staging");
    const auto number = [&](uint32_t& vertex) {
        if (vertex != kNoneTexel) vertex = order.numbers[vertex];
    };
    std::byte* to =
        upload.region(FW_BIND_DEFORM_PARTICLES,
                      uint64_t(added.particles.first()) * sizeof(DeviceParticle), particleBytes);
    for (uint32_t i = 0; i < model.particles.size(); ++i) {
        DeviceParticle particle = mesh::deviceParticle(model, i);
        number(particle.vertex);
        mesh::putQuads(particle, i, model.particles.size(), to);
    }
    to =
        upload.region(FW_BIND_DEFORM_EMBEDDINGS,
                      uint64_t(added.embeddings.first()) * sizeof(DeformEmbedding), embeddingBytes);
    for (size_t i = 0; i < order.vertices.size(); ++i) {
        DeformEmbedding embedding = model.embeddings[order.vertices[i]];
        number(embedding.particle);
        for (uint32_t& vertex : embedding.ring) number(vertex);
        mesh::putQuads(embedding, i, order.vertices.size(), to);
    }
}

// Where each texel is on its triangle.
void stageSkinTexels(BackendState& s, const mesh::BurnDomain& domain, const DrawnOrder& order,
                     const MeshAdditions& added) {
    const uint64_t bytes = uint64_t(domain.texelCount()) * sizeof(uvec4);
    const uint64_t sourceBytes = order.vertices.size() * 4;
    PendingUpload& upload = s.scene.uploads.stage(bytes + sourceBytes, "skin staging");
    std::byte* to = upload.region(
        FW_BIND_SKIN_TEXELS, uint64_t(added.skin.first()) * kTileTexels * sizeof(uvec4), bytes);
    for (uint32_t i = 0; i < domain.texelCount(); ++i, to += sizeof(uvec4)) {
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
        std::memcpy(to, &record, sizeof record);
    }
    to = upload.region(FW_BIND_SKIN_SOURCES, uint64_t(added.skinSources.first()) * 4, sourceBytes);
    for (const uint32_t vertex : order.vertices) {
        std::memcpy(to, &domain.sources[vertex], 4);
        to += 4;
    }
}

// A skinned object's vertices at rest: kept here, and on their way to the device.
void stageSkin(BackendState& s, const mesh::BurnDomain& domain, const DrawnOrder& order, Skin& skin,
               uint32_t firstShown) {
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
    const std::span<const ShownVertex> shown(skin.shown);
    s.scene.uploads.stage(shown.size_bytes(), "skin staging").add(FW_BIND_SHOWN, firstShown, shown);
}

bool isSheet(const ObjectInit& init) noexcept {
    return init.deform && (init.deform->flags & (kDeformShell | kDeformExtended)) != 0;
}

// Reserves space in all tables for a new object in `slot`.
void reserveForObject(BackendState& s, uint32_t slot, uint64_t last) {
    const size_t live = s.scene.liveObjects + 1;
    core::growTo(s.scene.quarantine, s.scene.quarantine.size() + live);
    core::growTo(s.surfaces.drawItems, live * kMaterialsPerObject);
    core::growTo(s.surfaces.surfaceSteps, live * kMaterialsPerObject * kMostSurfaceSteps);
    core::growTo(s.simulation.extended, live);
    core::growTo(s.results.givenObjects, std::max<size_t>(slot + 1, s.scene.objects.size()));
    (void)slotOf(s.scene.objects, slot);
    s.scene.awake.atLeast(slot + 1);
    s.buffers.atLeast(kPoolObjects, slot + 1, last);
    s.scene.freeQuarantine(s.simulation);
}

void allocateRefinement(BackendState& s, const ObjectInit& init, const MeshEntry& mesh,
                        RefineUse& use, uint64_t last) {
    use.on = true;
    use.key = refineKey(init.refineExtended, init.refineDepth);
    use.pixelsPerEdge = init.refinePixelsPerEdge;
    use.epochTick = s.simulation.shownTick;
    const RefineMesh& refined = mesh.refine[use.key];
    FW_ASSERT(refined.live, "createRefinement comes before objects of depth %u", init.refineDepth);
    if (!init.refineExtended)
        use.allocate(s.buffers, refined, (init.record.flags & kObjectTwoSided) == 0, last);
}

void allocateDeformation(BackendState& s, const ObjectInit& init, const MeshEntry& mesh,
                         ObjectEntry& fresh, MeshAdditions& added, uint64_t last) {
    const mesh::DeformModel& model = *init.deformModel;
    const auto count = uint32_t(model.particles.size());
    fresh.deforms.range = s.buffers.allocate(kPoolDeformers, 1, last);
    if (isSheet(init)) fresh.soft = s.buffers.allocate(kPoolSoft, count, last);
    // And once more for the inner skin.
    fresh.shown = s.buffers.allocate(kPoolShown, mesh.vertices * (init.inner ? 2 : 1), last);
    if (mesh.particles) return;
    added.particles = s.buffers.allocate(kPoolSheetParticles, count, last);
    added.embeddings = s.buffers.allocate(kPoolEmbeddings, mesh.vertices, last);
    stageDeformModel(s, *mesh.domain, model, added);
}

void allocateSkin(BackendState& s, const ObjectInit& init, const MeshEntry& mesh,
                  ObjectEntry& fresh, MeshAdditions& added, uint64_t last) {
    FW_ASSERT(init.deform, "skinned objects have shown vertices");
    const DrawnOrder order(*mesh.domain, s.memory);
    if (!mesh.skin) {
        added.skin = s.buffers.allocate(kPoolSkin, mesh.tiles, last);
        added.skinSources = s.buffers.allocate(kPoolSkinSources, mesh.vertices, last);
        stageSkinTexels(s, *mesh.domain, order, added);
    }
    if (isSheet(init)) return;  // else the host moves it
    std::pmr::vector<Skin>& skins = s.deforming.skins;
    auto free = std::find_if(skins.begin(), skins.end(),
                             [](const Skin& skin) { return skin.shown.empty(); });
    if (free == skins.end()) free = skins.insert(skins.end(), Skin(s.memory));
    fresh.deforms.skinPlus1 = uint32_t(free - skins.begin()) + 1;
    stageSkin(s, *mesh.domain, order, *free, fresh.shown.first());
}

void fillRecord(const ObjectInit& init, const MeshEntry& mesh, ObjectEntry& fresh) noexcept {
    BurnObject& r = fresh.record;
    r.texelBase = mesh.meshTiles.first() * kTileTexels;
    r.stateBase = fresh.tiles.first() * kTileTexels;
    r.slowBase = (fresh.slowness ? fresh.slowness : mesh.slowness).first() * (kTileTexels / 2);
    r.tileBase = mesh.meshTiles.first();
    r.worldTileBase = fresh.tiles.first();
    r.linkBase = mesh.links.first();
    r.dependentBase = mesh.dependents.first();
    r.extensionBase = fresh.extensionTiles.first() * kTileTexels * 3;
    r.heatBase = fresh.heatTiles.first() * kTileTexels;
    r.width = mesh.width;
    r.height = mesh.height;
    r.tilesX = mesh.tilesX;
    r.tileCount = mesh.tiles;
    r.flags = (r.flags & ~kObjectHeat) | kObjectLive | (init.heat.empty() ? 0 : kObjectHeat);
    if (r.flags & kObjectSkinned) {
        r.skinBase = mesh.skin.first() * kTileTexels;
        r.shownBase = fresh.shown.first();
    }
    std::copy_n(init.heat.begin(), std::min<size_t>(init.heat.size(), kMaterialsPerObject),
                fresh.heat);
    std::copy_n(init.materials.begin(),
                std::min<size_t>(init.materials.size(), kMaterialsPerObject), fresh.materials);
    std::copy(std::begin(init.images), std::end(init.images), std::begin(fresh.images));
    fresh.materialsDirty = fresh.resetDue = true;
}

void fillDeformation(const ObjectInit& init, const MeshEntry& mesh, uint32_t slot,
                     ObjectEntry& fresh) noexcept {
    DeformObject& deform = fresh.deform = *init.deform;
    deform.nodeBase = mesh.particles.first();
    deform.particleCount = mesh.particles.units();
    deform.embeddingBase = mesh.embeddings.first();
    deform.vertexCount = mesh.vertices;
    deform.shownBase = fresh.shown.first();
    deform.softBase = fresh.soft.first();
    deform.extensionBase = fresh.extensionWords.first();
    deform.innerFirst = mesh.innerVertices.first();
    deform.stateBase = fresh.record.stateBase;
    deform.slot = slot;
    deform.scale = length(vec3(fresh.record.worldRow0));
    for (const DeformMaterial& m : deform.materials)
        for (const uint32_t ticks : {m.charTicks, m.holeTicks})
            if (ticks != kNoneTexel) fresh.deforms.ticks = std::max(fresh.deforms.ticks, ticks);
    fresh.deforms.ticks += kTicksPerSecond;  // readbacks come late
    fresh.deforms.recordDirty = true;
    fresh.deforms.reset = fresh.deforms.skinPlus1 == 0;  // else it is at rest already
    if (fresh.deforms.skinPlus1) std::copy_n(init.shape, 3, fresh.shape);
}

// Whether frames have nothing to do for it until a change or an event.
bool isSleeping(const ObjectEntry& object) noexcept {
    if (object.recordDirty || object.materialsDirty || object.resetDue) return false;
    if (!object.live) return true;
    const bool reached = object.burn.touched || object.burn.warmed || object.burn.charred;
    const bool moves = object.deforms.recordDirty || object.deforms.reset || object.deforms.now ||
                       object.soft || object.deforms.skinPlus1 != 0;
    const bool refined = object.refine.extendedPlus1 != 0 || object.refine.due || refines(object);
    return !reached && !moves && !refined && (object.record.flags & kObjectExtended) == 0;
}

}  // namespace

void SceneTables::changed(uint32_t slot) noexcept {
    objects[slot].recordDirty = recordsDirty = true;
    awake.insert(slot);
}

void SceneTables::noteFire(uint32_t slot, uint32_t tick) noexcept {
    // Ticks that an object is refined beyond the last sign of fire: levels outlive their heat by a
    // second, take five quarters more to fall, and readbacks come late.
    constexpr uint32_t kQuietTicks = 4 * kTicksPerSecond;
    awake.insert(slot);
    ObjectEntry& object = objects[slot];
    if (!object.refine.on) return;
    uint32_t opens = 0;  // a hole may open after its fire is out
    if ((object.record.flags & kObjectNoHoles) == 0)
        for (const BurnMaterial& m : object.materials) opens = std::max(opens, m.holeTicks);
    const uint64_t quiet = uint64_t(tick) + kQuietTicks + opens;
    object.refine.quietTick =
        std::max(object.refine.quietTick, uint32_t(std::min<uint64_t>(quiet, kLiveEnd)));
}

void SceneTables::freeQuarantine(const SimulationState& now) noexcept {
    std::erase_if(quarantine, [&](const Quarantined& one) {
        return (now.walks.front > one.walks.front || now.frontEmpty) &&
               (now.walks.burn > one.walks.burn || now.burnEmpty) &&
               (now.walks.predict > one.walks.predict || now.predictEmpty) &&
               (now.walks.hot > one.walks.hot || now.hotEmpty);
    });
}

double metresPerTick(const ObjectEntry& object) noexcept {
    uint32_t least = ~0u;
    for (const BurnMaterial& m : object.materials)
        if ((m.flags & 1) != 0) least = std::min(least, m.sigma0);
    // Ticks are 2^-22 of sigma0 for 1/8 of a quantum.
    return double(object.record.originQuantum.w) / 8 * 4194304.0 / double(least);
}

void settle(BackendState& s) noexcept {
    for (const uint32_t slot : s.scene.awake)
        if (isSleeping(s.scene.objects[slot])) s.scene.awake.erase(slot);
}

void VkBackend::createObject(uint32_t slot, const ObjectInit& init) {
    BackendState& s = *state_;
    const uint64_t last = s.ring.newest();
    FW_ASSERT(init.mesh < s.scene.meshes.size() && s.scene.meshes[init.mesh].live, "mesh %u",
              init.mesh);
    MeshEntry& mesh = s.scene.meshes[init.mesh];
    DrawPassSet passes = 0;
    for (uint32_t m = 0, first = 0; m < kMaterialsPerObject; first = mesh.materialEnd[m++])
        if (mesh.materialEnd[m] != first)
            passes |=
                surfacePasses(s.limits.appearances.familyOf(
                                  m < init.materials.size() ? init.materials[m] : BurnMaterial{}),
                              init.images[m] != 0);
    s.context.pipelines.need(passes);
    UploadGuard staged(s.scene.uploads);
    MeshAdditions added;
    ObjectEntry fresh;
    fresh.live = true;
    fresh.mesh = init.mesh;
    fresh.record = init.record;
    fresh.seenFrame = last;
    fresh.inner = init.inner;
    reserveForObject(s, slot, last);
    try {
        fresh.tiles = s.buffers.allocate(kPoolObjectTiles, mesh.tiles, last);
        if (init.refine) allocateRefinement(s, init, mesh, fresh.refine, last);
        if (!init.slowness.empty()) {
            fresh.slowness = s.buffers.allocate(kPoolSlowness, mesh.tiles, last);
            s.scene.uploads.stage(init.slowness.size_bytes(), "slowness staging")
                .add(FW_BIND_SLOWNESS, uint64_t(fresh.slowness.first()) * kTileTexels,
                     init.slowness);
        }
        fresh.sources = s.buffers.allocate(kPoolSources, mesh.sourceCells, last);
        if (!init.heat.empty()) fresh.heatTiles = s.buffers.allocate(kPoolHeat, mesh.tiles, last);
        if (init.deform) allocateDeformation(s, init, mesh, fresh, added, last);
        if (init.record.flags & kObjectSkinned) allocateSkin(s, init, mesh, fresh, added, last);
        if (extension()) extension()->vulkan->createObject(s, fresh, init, last);
    } catch (...) {
        if (fresh.refine.extendedPlus1) extension()->vulkan->destroyObject(s, fresh);
        if (fresh.deforms.skinPlus1) s.deforming.skinOf(fresh).free();
        throw;
    }
    staged.keep();
    if (added.particles) {
        mesh.particles = std::move(added.particles);
        mesh.embeddings = std::move(added.embeddings);
    }
    if (added.skin) {
        mesh.skin = std::move(added.skin);
        mesh.skinSources = std::move(added.skinSources);
    }
    fillRecord(init, mesh, fresh);
    if (init.deform) fillDeformation(init, mesh, slot, fresh);
    if (fresh.refine.on && !fresh.refine.extendedPlus1) ++s.refine.users;
    FW_ASSERT(!s.scene.objects[slot].live, "object %u is there", slot);
    s.scene.objects[slot] = std::move(fresh);
    s.scene.changed(slot);
    s.simulation.seenFrame = std::max(s.simulation.seenFrame, last);
    ++s.scene.liveObjects;
}

void VkBackend::destroyObject(uint32_t slot) noexcept {
    BackendState& s = *state_;
    ObjectEntry& entry = s.scene.objects[slot];
    if (!entry.live) return;
    if (!entry.resetDue) {  // a recorded frame met it, so lists may name its tiles
        FW_ASSERT(s.scene.quarantine.size() < s.scene.quarantine.capacity());
        s.scene.quarantine.push_back({std::move(entry.tiles), s.simulation.walks});
    }
    if (entry.refine.extendedPlus1) {
        extension()->vulkan->destroyObject(s, entry);
    } else if (entry.refine.on) {
        FW_ASSERT(s.refine.users > 0, "object %u refines and no user is counted", slot);
        --s.refine.users;
    }
    if (entry.deforms.skinPlus1) s.deforming.skinOf(entry).free();
    entry = {};
    s.scene.changed(slot);  // a record without kObjectLive: list entries fall out
    FW_ASSERT(s.scene.liveObjects > 0);
    --s.scene.liveObjects;
    s.surfaces.drop(slot);
}

void VkBackend::setObjectPose(uint32_t slot, const vec4 rows[3], const vec4& tint, uint32_t flags) {
    BackendState& s = *state_;
    ObjectEntry& entry = s.scene.objects[slot];
    FW_ASSERT(entry.live, "object %u", slot);
    entry.record.worldRow0 = rows[0];
    entry.record.worldRow1 = rows[1];
    entry.record.worldRow2 = rows[2];
    entry.record.tint = tint;
    if (entry.shown) {
        entry.deform.scale = length(vec3(rows[0]));
        entry.deforms.recordDirty = true;
        entry.deforms.softUntil = 0;  // it swings again
    }
    constexpr uint32_t kFixed = kObjectExtended | kObjectHeat | kObjectUnseen;
    entry.record.flags = (flags & ~kFixed) | (entry.record.flags & kFixed) | kObjectLive;
    s.scene.changed(slot);
}

void VkBackend::setObjectWind(uint32_t slot, uint32_t wind) {
    state_->scene.objects[slot].record.zoneWind = wind;
    state_->scene.changed(slot);
}

void VkBackend::setRoom(uint32_t slot, const Room& room) noexcept {
    FW_ASSERT(slot < kMaxRooms, "room %u of %u", slot, kMaxRooms);
    state_->scene.rooms[slot] = room;
    state_->scene.roomsDirty = true;
}

void VkBackend::setVertices(uint32_t slot, std::span<const float> positions,
                            std::span<const float> normals) noexcept {
    Skin& skin = state_->deforming.skinOf(state_->scene.objects[slot]);
    for (size_t i = 0; i < skin.shown.size(); ++i) {
        ShownVertex& v = skin.shown[i];
        const size_t from = size_t(skin.sources[i]) * 3;
        FW_ASSERT(from + 2 < positions.size(), "vertex %u of %zu", skin.sources[i],
                  positions.size() / 3);
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
    BackendState& s = *state_;
    Skin& skin = s.deforming.skinOf(s.scene.objects[slot]);
    const uint64_t last = vertices.normalOffset ? uint64_t(vertices.normalOffset) + 12 : 12;
    const uint64_t words = (uint64_t(vertices.vertexCount - 1) * vertices.stride + last) / 4;
    if (skin.words.units() < words)
        skin.words = s.buffers.allocate(kPoolSkinGiven, uint32_t(words), s.ring.newest());
    skin.given = vertices;
    skin.metersPerUnit = metersPerUnit;
    skin.givenDue = true;
    skin.dirty = false;
    skin.normals = vertices.normalOffset != 0;
}

}  // namespace fw::gpu::vk
