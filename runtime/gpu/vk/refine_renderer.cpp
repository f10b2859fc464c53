#include "gpu/vk/refine_renderer.h"

#include "gpu/vk/backend_state.h"
#include "gpu/vk/vk_extension.h"
#include "mesh/refine/model.h"
#include "mesh/refine/table.h"
#include "mesh/refine/turns.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace fw::gpu::vk {
namespace {

constexpr uint32_t kTableWords = kRefineTableSize / 2;
constexpr uint32_t kAppearanceSide = 512, kNoiseSide = 64;
// Holes are cut where a mean edge is longer than this, in segments of the finest; what was is until
// it is shorter than the second.
constexpr float kCutFrom = 4, kCutTo = 3;
// Levels short of what its size asks for, with which a triangle still says where its holes are.
constexpr float kFewestLevels = 1.25f, kFewestAgain = 0.9f;
constexpr float kCutNear = 10;          // where only cut holes show their rims
constexpr float kDefaultHeight = 1080;  // px, before anything was drawn
// Of the budget, what levels aim at: they are on their way for a moment, and some objects wait.
constexpr uint32_t kAimed = 15, kAimedOf = 16;

uint32_t drawnMaterialOf(const mesh::BurnDomain& domain, const RefineTriangle& triangle) {
    const uint32_t corner = domain.indices[size_t(triangle.source) * 3];
    return std::min(domain.vertices[corner].material, kMaterialsPerObject - 1);
}

// m, object space, from the camera to the mesh's bounds.
float eyeDistance(const MeshEntry& mesh, const vec4& eye) noexcept {
    float square = 0;
    for (int k = 0; k < 3; ++k) {
        const float out = std::max(
            {mesh.domain->boundsLow[k] - eye[k], eye[k] - mesh.domain->boundsHigh[k], 0.0f});
        square += out * out;
    }
    return std::sqrt(square);
}

// How many of the finest segments its mean edge would be where it is nearest to the camera: holes
// of far objects are small, and discarded.
float cutSegments(const SceneTables& scene, const ObjectEntry& object,
                  const RefineObject& record) noexcept {
    if ((object.record.flags & kObjectNoHoles) != 0 && !object.refine.border) return 0;
    if (record.eye.w == 0) return kCutNear;
    const float pixels = scene.refineOf(object).edgeLength * record.eye.w;
    const float away = eyeDistance(scene.meshOf(object), record.eye);
    return pixels / std::max(record.pixelsPerEdge * away, 1e-6f);
}

}  // namespace

// Once more after it is quiet: pictures may be seconds apart. An object with a border is drawn
// refined from the first picture on.
bool refines(const ObjectEntry& object) noexcept {
    return object.live && object.refine.on && !object.refine.extendedPlus1 &&
           (object.refine.border || double(object.refine.quietTick) > object.refine.turnTick);
}

// The table is the first thing in the buffer of words. Of the appearance textures the noise of
// holes is kept: a mip of the first layer, its first channel.
void RefineRenderer::uploadTable(BackendState& s) {
    const size_t texels = size_t(kNoiseSide) * kNoiseSide;
    size_t first = 0;
    for (uint32_t side = kAppearanceSide; side > kNoiseSide; side /= 2)
        first += size_t(side) * side * 4;
    if (s.limits.appearances.textures.size() >= first + texels * 4)
        for (size_t i = 0; i < texels; ++i)
            noise.push_back(uint8_t(s.limits.appearances.textures[first + i * 4]));
    table = s.buffers.allocate(kPoolRefineWords, kTableWords, 0);
    FW_ASSERT(table.first() == 0, "word %u", table.first());
    s.scene.uploads.stage(kTableWords * 4, "refinement table")
        .add(FW_BIND_REFINE_WORDS, 0, std::span<const uint16_t>(mesh::kRefineTable));
}

void VkBackend::createRefinement(uint32_t slot, uint32_t depth, bool extended,
                                 const mesh::BurnDomain& domain, const mesh::RefineModel& model,
                                 std::span<const mesh::RefineHoles> materials) {
    BackendState& s = *state_;
    FW_ASSERT(depth <= kRefineDepth, "depth %u", depth);
    RefineMesh fresh;
    fresh.live = true;
    fresh.edgeCount = uint32_t(model.edges.size());
    fresh.triangleCount = uint32_t(model.triangles.size());
    fresh.cornerCount = model.cornerCount;
    fresh.slotCount = uint32_t(model.slots.size());
    fresh.fullCount = uint32_t(model.fullCount());
    for (const RefineEdge& e : model.edges) {
        const RefineSlot &a = model.slots[e.low], &b = model.slots[e.high];
        fresh.edgeLength += std::hypot(a.x - b.x, a.y - b.y, a.z - b.z) / float(fresh.edgeCount);
    }
    fresh.openEdges = model.openEdges;
    fresh.solid = mesh::hasInside(domain, model);
    for (const RefineTriangle& t : model.triangles) ++fresh.materialEnd[drawnMaterialOf(domain, t)];
    std::partial_sum(std::begin(fresh.materialEnd), std::end(fresh.materialEnd),
                     std::begin(fresh.materialEnd));

    std::pmr::vector<mesh::RenderVertex> vertices(s.memory);
    vertices.reserve(model.draws.size());
    for (uint32_t d = 0; d < model.draws.size(); ++d) {
        // The place of a slot that no triangle draws is never asked for.
        vertices.push_back(model.draws[d].triangle == mesh::kNone
                               ? mesh::RenderVertex{}
                               : mesh::refineRenderVertex(domain, model, d));
        vertices.back().material = model.draws[d].slot;
    }
    std::pmr::vector<RefineSlot> slots(model.slots, s.memory);
    if (!s.refine.noise.empty())
        mesh::refineRoughen(domain, model, materials, s.refine.noise, kNoiseSide, slots);
    const auto allocate = [&](BufferPool pool, size_t count) {
        return s.buffers.allocate(pool, std::max(1u, uint32_t(count)), s.ring.newest());
    };
    const size_t words = model.tileStart.size() + model.tileItems.size();
    fresh.triangles = allocate(kPoolRefineMeshTriangles, fresh.triangleCount);
    fresh.edges = allocate(kPoolRefineMeshEdges, fresh.edgeCount);
    fresh.slots = allocate(kPoolRefineMeshSlots, fresh.slotCount);
    fresh.words = allocate(kPoolRefineWords, words);
    fresh.draws = allocate(kPoolVertices, vertices.size());
    if (extended) extension()->vulkan->createRefinement(s, slot, depth, domain, model);
    PendingUpload& upload = s.scene.uploads.stage(
        model.triangles.size() * sizeof(RefineTriangle) + model.edges.size() * sizeof(RefineEdge) +
            slots.size() * sizeof(RefineSlot) + words * 4 +
            vertices.size() * sizeof(mesh::RenderVertex),
        "refinement staging");
    const auto add = [&](uint32_t resource, uint64_t first, const auto& data) {
        upload.add(resource, first, std::span(data));
    };
    add(FW_BIND_REFINE_TRIANGLES, fresh.triangles.first(), model.triangles);
    add(FW_BIND_REFINE_EDGES, fresh.edges.first(), model.edges);
    add(FW_BIND_REFINE_SLOTS, fresh.slots.first(), slots);
    add(FW_BIND_REFINE_WORDS, fresh.words.first(), model.tileStart);
    add(FW_BIND_REFINE_WORDS, fresh.words.first() + model.tileStart.size(), model.tileItems);
    add(kResourceVertices, fresh.draws.first(), vertices);
    s.scene.meshes[slot].refine[refineKey(extended, depth)] = std::move(fresh);
}

void RefineUse::allocate(WorldBuffers& buffers, const RefineMesh& mesh, bool thick, uint64_t last) {
    inner = thick && mesh.solid ? mesh.slotCount : 0;
    border = inner != 0 && mesh.openEdges > 0;
    const auto take = [&](BufferPool pool, uint32_t units) {
        return buffers.allocate(pool, std::max(1u, units), last);
    };
    items = take(kPoolRefineItems, mesh.edgeCount + mesh.triangleCount);
    triangles = take(kPoolRefineTriangles, mesh.triangleCount + kRefineSums);
    slots = take(kPoolRefineSlots, mesh.slotCount + inner);
    indices = take(kPoolRefineIndices, mesh.fullCount * 3);
    // Along rims, of up to four for a small triangle; with an inner skin and along borders more.
    const uint32_t rims = mesh.fullCount / (inner ? 3 : 4) + 64;
    const uint32_t walls = border ? mesh.openEdges << (kRefineDepth + 1) : 0;
    cuts = take(kPoolRefineCuts, 3 * std::min(rims + walls, kMaxRefineCut));
}

mesh::RefineOptions VkBackend::extendedRefineOptions(uint32_t depth) const {
    return extension()->vulkan->refineOptions(depth);
}

void VkBackend::startBoundary(uint32_t slot, const float point[3], uint32_t tick) noexcept {
    ObjectEntry& object = state_->scene.objects[slot];
    if (object.refine.extendedPlus1)
        extension()->vulkan->startBoundary(*state_, object, point, tick);
}

void RefineUse::show(DrawItem& item) const noexcept {
    item.refined = started;
    item.cut = cut;
    item.perPixelHoles = perPixelHoles;
    item.consumed = extendedPlus1 != 0;
    item.draw.now = now;
    item.draw.nearness = nearness;
}

uint64_t RefineRenderer::plan(BackendState& s, const FramePlan& plan) {
    push = {};
    full = (plan.switches & kSwitchRefineFull) != 0;
    if (users == 0 || s.open.unseen) return 0;
    listRefined(s, true);
    if (push.objects == 0) return 0;
    const uint32_t jobs = (push.cutJobs - push.placeJobs) / 2;
    s.buffers.atLeast(kPoolRefineWork, push.cutJobs + jobs + 2 * 64 * push.edgeGroups,
                      s.ring.newest());
    return uploaded(lists.size() * 4) + uploaded(uint64_t(push.objectEnd) * sizeof(RefineObject)) +
           kUploadAlignment;
}

// The work buffer of the objects that are due, or of all that refine. Throws only where it has more
// to list than ever.
void RefineRenderer::listRefined(const BackendState& s, bool all) {
    lists.clear();
    push = {};
    uint64_t emitJobs = 0, placeJobs = 0;
    const auto each = [&](auto&& use) {
        for (const uint32_t i : s.scene.awake)
            if (const ObjectEntry& object = s.scene.objects[i];
                all ? refines(object) : object.refine.due)
                use(i, s.scene.refineOf(object));
    };
    const auto list = [&](uint32_t object, uint32_t count) {
        for (uint32_t k = 0; k < count; k += 64) {
            lists.push_back(object);
            lists.push_back(k);
        }
        return groupsOf(count);
    };
    lists.resize(kRefineWorkLists, 0);
    for (const uint32_t at :
         {kRefineWorkEmit, kRefineWorkPlace, kRefineWorkCut, kRefineWorkEdges, kRefineWorkMorph})
        lists[at + 1] = lists[at + 2] = 1;
    each([&](uint32_t i, const RefineMesh& m) { push.edgeGroups += list(i, m.edgeCount); });
    each([&](uint32_t i, const RefineMesh& m) { push.triangleGroups += list(i, m.triangleCount); });
    each([&](uint32_t i, const RefineMesh& m) { push.cornerGroups += list(i, m.cornerCount); });
    each([&](uint32_t i, const RefineMesh& m) {
        lists.push_back(i);
        lists.push_back(0);
        ++push.objects;
        emitJobs += groupsOf(m.fullCount);
        placeJobs += m.triangleCount;
    });
    for (uint32_t o = 0; o < push.objects; ++o) {  // counts, ends
        lists.insert(lists.end(), kMaterialsPerObject, 0);
        lists.insert(lists.end(), kMaterialsPerObject, kNoneTexel);
    }
    // The budget is shared with those whose turn it is not.
    uint64_t fullCount = 0;
    for (const uint32_t i : s.scene.awake) {
        if (!refines(s.scene.objects[i])) continue;
        fullCount += s.scene.refineOf(s.scene.objects[i]).fullCount;
        push.objectEnd = i + 1;
    }
    const auto most = uint32_t(s.detail.triangles * float(s.limits.maxRefinedTriangles));
    if (fullCount > most) push.budget = std::max(1u, most / kAimedOf * kAimed);
    push.full = full ? 1 : 0;
    push.recede = kRefineRecede;
    push.emitJobs = uint32_t(lists.size());
    push.placeJobs = push.emitJobs + uint32_t(2 * emitJobs);
    push.cutJobs = push.placeJobs + uint32_t(4 * placeJobs);
}

// Marks the objects that the frame refines; whether there are any.
bool RefineRenderer::chooseDue(BackendState& s, double now) noexcept {
    bool any = false;
    const auto due = [&](const ObjectEntry& object) {
        return refines(object) && isDue(s, object, recordOf(s, object, full), now);
    };
    for (const uint32_t i : s.scene.awake) any = any || due(s.scene.objects[i]);
    if (!any) return false;
    // At full detail all are refined, for comparisons with methods that refine in each frame.
    for (const uint32_t i : s.scene.awake)
        s.scene.objects[i].refine.due =
            refines(s.scene.objects[i]) && (full || due(s.scene.objects[i]));
    return true;
}

// An object's turn: whether its holes are cut, and its record of the frame.
void RefineRenderer::turn(const BackendState& s, ObjectEntry& object, double now,
                          RefineObject& record, FrameRecorder& recorder,
                          RefineRecord& frame) const noexcept {
    RefineUse& use = object.refine;
    use.turnTick = now;
    use.turnEye = record.eye;
    const float segments = cutSegments(s.scene, object, record);
    const bool cut = segments > (use.cut ? kCutTo : kCutFrom);
    const bool perPixelHoles = cut && hasPerPixelHoles(object);
    // Triangles that were cut are emitted again.
    const bool was = use.cut && (!cut || (perPixelHoles && !use.perPixelHoles));
    record.flags |= (was ? kRefineIsWhole : 0) | (cut ? kRefineIsCut : 0) |
                    (perPixelHoles ? kRefineHasPerPixelHoles : 0);
    use.cut = cut;
    use.perPixelHoles = perPixelHoles;
    use.nearness = std::clamp((segments - kCutFrom) / (kCutNear - kCutFrom), 0.0f, 1.0f);
    use.now = record.now;
    frame.cuts |= cut;
    if (use.started) return;
    record.flags |= kRefineIsFresh;
    frame.fresh = true;
    recorder.fillZero(FW_BIND_REFINE_HEAT, uint64_t(use.items.first()) * 4,
                      uint64_t(use.items.units()) * 4);
    use.started = true;
}

// The views' cameras and the heights of their last pictures limit levels.
void RefineRenderer::record(BackendState& s, FrameInFlight& slot) {
    if (push.objects == 0) return;
    takeEyes(s);
    const double now = double(s.simulation.shownTick) + double(s.simulation.tickFraction);
    RefineRecord frame;
    frame.turn = chooseDue(s, now);
    if (!frame.turn && !full) return;
    FrameRecorder recorder(s, slot);
    if (frame.turn) {
        listRefined(s, false);
        last = push;
        s.open.refined = true;
        recorder.upload(FW_BIND_REFINE_WORK, 0, std::span<const uint32_t>(lists));
    }
    push = last;
    push.nowTick = s.simulation.shownTick;
    Staged records = recorder.beginStaged();
    uint32_t ordinal = 0;
    for (uint32_t i = 0; i < push.objectEnd; ++i) {
        RefineObject record{};
        ObjectEntry& object = s.scene.objects[i];
        if (object.refine.due) {
            record = recordOf(s, object, full);
            record.flags |= kRefineIsActive | kRefineIsCounted;
            record.ordinal = ordinal++;
            record.dt =
                float(std::clamp((now - object.refine.turnTick) / kTicksPerSecond, 0.0, 2.0));
            if (frame.turn) turn(s, object, now, record, recorder, frame);
        } else if (object.refine.started && refines(object)) {
            record.flags = kRefineIsCounted;
            record.triangles = object.refine.triangles.first();
            record.triangleCount = s.scene.refineOf(object).triangleCount;
        }
        recorder.appendOne(records, record);
    }
    recorder.endStaged();
    recorder.copyIn(records, FW_BIND_REFINE_OBJECTS);
    frame.push = push;
    recordRefinement(recorder, s.simulation.lists, frame);
}

void RefineRenderer::takeEyes(const BackendState& s) noexcept {
    if (!s.scene.appearanceTextures.live) return;
    eyeCount = 0;
    pixels = 0;
    for (const OutsideView* const of : s.seenFrom()) {
        const ViewParams params = s.paramsOf(of->view, of->height, kDefaultHeight);
        const float ofView = 1 / params.eye.w;
        pixels = std::max(pixels, ofView);
        vec4& eye = eyes[eyeCount++];
        eye = params.eye;
        eye.w = params.forward.w > 0.5f ? ofView : 0;
    }
}

// Whether the budget leaves it so few levels that corners do not know its holes; while that is not
// known, whether it may.
bool RefineRenderer::hasPerPixelHoles(const ObjectEntry& object) const noexcept {
    if (full || push.budget == 0) return false;
    if (bias < 0) return true;
    return bias > (object.refine.perPixelHoles ? kFewestAgain : kFewestLevels);
}

// m, object space; w: as `eyes`. Of the views' cameras that to which it is largest.
vec4 RefineRenderer::eyeFor(const BackendState& s, const ObjectEntry& object) const noexcept {
    // Rows are s * R: the eye in object space is (R^T / s) (eye - t).
    const vec4 &x = object.record.worldRow0, &y = object.record.worldRow1,
               &z = object.record.worldRow2;
    const float square = std::max(x.x * x.x + x.y * x.y + x.z * x.z, 1e-12f);
    vec4 best(0.0f);
    float most = -1;
    for (uint32_t i = 0; i < eyeCount; ++i) {
        const vec4& eye = eyes[i];
        const float d[3] = {eye.x - x.w, eye.y - y.w, eye.z - z.w};
        const vec4 at{(x.x * d[0] + y.x * d[1] + z.x * d[2]) / square,
                      (x.y * d[0] + y.y * d[1] + z.y * d[2]) / square,
                      (x.z * d[0] + y.z * d[1] + z.z * d[2]) / square, eye.w};
        if (at.w == 0) return at;
        const float across = at.w / std::max(eyeDistance(s.scene.meshOf(object), at), 1e-6f);
        if (across <= most) continue;
        most = across;
        best = at;
    }
    return best;
}

// Whether it may have changed visibly since it was last refined.
bool RefineRenderer::isDue(const BackendState& s, const ObjectEntry& object,
                           const RefineObject& record, double now) const noexcept {
    const RefineUse& use = object.refine;
    if (!use.started || record.eye.w != use.turnEye.w) return true;
    mesh::RefineTurn turn;
    turn.since = std::abs(now - use.turnTick);
    turn.away = eyeDistance(s.scene.meshOf(object), record.eye);
    turn.moved = std::hypot(record.eye.x - use.turnEye.x, record.eye.y - use.turnEye.y,
                            record.eye.z - use.turnEye.z);
    turn.perspective = record.eye.w > 0;
    if (double(use.quietTick) <= use.turnTick) turn.since = 0;  // only its border is drawn again
    turn.pixels = pixels;
    turn.speed = metresPerTick(object);
    return mesh::refineDue(turn);
}

RefineObject RefineRenderer::recordOf(const BackendState& s, const ObjectEntry& object,
                                      bool atFull) const noexcept {
    const MeshEntry& entry = s.scene.meshOf(object);
    const RefineMesh& mesh = s.scene.refineOf(object);
    const RefineUse& use = object.refine;
    RefineObject r{};
    r.items = use.items.first();
    r.triangles = use.triangles.first();
    r.vertices = use.slots.first();
    r.indices = use.indices.first();
    r.meshTriangles = mesh.triangles.first();
    r.meshEdges = mesh.edges.first();
    r.meshSlots = mesh.slots.first();
    r.meshWords = mesh.words.first();
    r.meshDraws = mesh.draws.first();
    r.edgeCount = mesh.edgeCount;
    r.triangleCount = mesh.triangleCount;
    r.cornerCount = mesh.cornerCount;
    r.textureWidth = entry.width;
    r.tileCount = entry.tiles;
    r.stateBase = object.record.stateBase;
    r.epochTick = use.epochTick;
    r.pixelsPerEdge = use.pixelsPerEdge;
    r.now = float((double(s.simulation.shownTick) - double(use.epochTick) +
                   double(s.simulation.tickFraction)) /
                  kTicksPerSecond);
    r.eye = eyeFor(s, object);
    if (atFull) r.eye.w = 0;
    r.inner = use.inner;
    r.cuts = use.cuts.first();
    r.cutTriangles = use.cuts.units() / 3;
    // A wall disappears when it looks burnt through.
    const auto seconds = [&](uint32_t m) {
        const BurnMaterial& material = object.materials[m];
        const bool opens = material.holeTicks != 0 && !(object.record.flags & kObjectNoHoles);
        const uint32_t ticks = opens ? material.holeTicks : material.flameTicks;
        const float after =
            ticks == kNoneTexel ? 1e6f : std::max(float(ticks) / float(kTicksPerSecond), 1e-3f);
        return opens ? after : -after;
    };
    r.burnSeconds0 = {seconds(0), seconds(1), seconds(2), seconds(3)};
    r.burnSeconds1 = {seconds(4), seconds(5), seconds(6), seconds(7)};
    const auto* end = mesh.materialEnd;
    r.materialEnd0 = {end[0], end[1], end[2], end[3]};
    r.materialEnd1 = {end[4], end[5], end[6], end[7]};
    return r;
}

}  // namespace fw::gpu::vk
