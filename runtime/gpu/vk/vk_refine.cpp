// Adaptive refinement's side of the backend: what a mesh and an object bring to the buffers, and
// which objects a frame refines. What their passes do is in shaders/refine.
#include "core/error.h"
#include "gpu/vk/world_state.h"
#include "mesh/refine/model.h"
#include "mesh/refine/table.h"
#include "mesh/refine/turns.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace fw::gpu::vk {
namespace {

constexpr uint32_t kTableWords = kRefineTableSize / 2;
// Ticks that an object is refined beyond the last sign of fire: levels outlive their heat by a
// second, take five quarters more to fall, and readbacks come late.
constexpr uint32_t kQuietTicks = 4 * kTicksPerSecond;
constexpr uint32_t kLookSide = 512, kNoiseSide = 64;
// Holes are cut where a mean edge is longer than this, in segments of the finest; what was is until
// it is shorter than the second.
constexpr float kCutFrom = 4, kCutTo = 3;
// Levels short of what its size asks for, with which a triangle still says where its holes are.
constexpr float kFewestLevels = 1.25f, kFewestAgain = 0.9f;
constexpr float kCutNear = 10;          // where rims show what only cut ones can
constexpr float kDefaultHeight = 1080;  // px, before anything was drawn
// Of the budget, what levels aim at: they are on their way for a moment, and some objects wait.
constexpr uint32_t kAimed = 15, kAimedOf = 16;

uint32_t drawnMaterialOf(const mesh::BurnDomain& domain, const RefineTriangle& triangle) {
    const uint32_t corner = domain.indices[size_t(triangle.source) * 3];
    return std::min(domain.vertices[corner].material, kMaterialsPerObject - 1);
}

template <class T>
void append(PendingUpload& upload, uint64_t& from, uint32_t resource, uint64_t first,
            std::span<const T> data) {
    if (data.empty()) return;
    std::memcpy(upload.staging.mapped + from, data.data(), data.size_bytes());
    upload.regions[upload.regionCount++] = {resource, from, first * sizeof(T), data.size_bytes()};
    from += data.size_bytes();
}

void releaseAll(WorldBuffers& buffers, std::span<const PoolRange> ranges) noexcept {
    for (const PoolRange& one : ranges)
        if (one.range->units) buffers.release(one.pool, one.range->first, one.range->units);
}

}  // namespace

// The pattern table is the first thing in the buffer of words. Of the look textures the noise of
// holes is kept: a mip of the first layer, its first channel.
void VkBackend::State::uploadRefineTable() {
    const size_t texels = size_t(kNoiseSide) * kNoiseSide;
    size_t first = 0;
    for (uint32_t side = kLookSide; side > kNoiseSide; side /= 2) first += size_t(side) * side * 4;
    if (limits.looks.textures.size() >= first + texels * 4)
        for (size_t i = 0; i < texels; ++i)
            refine.noise.push_back(uint8_t(limits.looks.textures[first + i * 4]));
    const uint32_t table = buffers.allocate(kPoolRefineWords, kTableWords, 0);
    PendingUpload& upload = stage(kTableWords * 4, "refinement table");
    uint64_t from = 0;
    append(upload, from, FW_BIND_REFINE_WORDS, uint64_t(table) * 2,
           std::span<const uint16_t>(mesh::kRefineTable));
}

void VkBackend::createRefinement(uint32_t slot, uint32_t depth, bool published,
                                 const mesh::BurnDomain& domain, const mesh::RefineModel& model,
                                 std::span<const mesh::RefineHoles> materials) {
    State& s = *state_;
    const uint64_t last = s.ring.newest();
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
    for (uint32_t m = 1; m < kMaterialsPerObject; ++m)
        fresh.materialEnd[m] += fresh.materialEnd[m - 1];

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
    const size_t uploadsBefore = s.scene.uploads.size();
    const auto units = [](size_t count) { return std::max(1u, uint32_t(count)); };
    const size_t words = model.tileStart.size() + model.tileItems.size();
    const struct {
        PoolRange place;
        uint32_t units;
    } wanted[] = {
        {{&fresh.triangles, kPoolRefineMeshTriangles}, units(fresh.triangleCount)},
        {{&fresh.edges, kPoolRefineMeshEdges}, units(fresh.edgeCount)},
        {{&fresh.slots, kPoolRefineMeshSlots}, units(fresh.slotCount)},
        {{&fresh.words, kPoolRefineWords}, units(words)},
        {{&fresh.draws, kPoolVertices}, units(vertices.size())},
    };
    try {
        for (const auto& one : wanted)
            *one.place.range = {s.buffers.allocate(one.place.pool, one.units, last), one.units};
        PendingUpload& upload = s.stage(model.triangles.size() * sizeof(RefineTriangle) +
                                            model.edges.size() * sizeof(RefineEdge) +
                                            model.slots.size() * sizeof(RefineSlot) + words * 4 +
                                            vertices.size() * sizeof(mesh::RenderVertex),
                                        "refinement staging");
        uint64_t from = 0;
        append(upload, from, FW_BIND_REFINE_TRIANGLES, fresh.triangles.first,
               std::span<const RefineTriangle>(model.triangles));
        append(upload, from, FW_BIND_REFINE_EDGES, fresh.edges.first,
               std::span<const RefineEdge>(model.edges));
        append(upload, from, FW_BIND_REFINE_SLOTS, fresh.slots.first,
               std::span<const RefineSlot>(slots));
        append(upload, from, FW_BIND_REFINE_WORDS, fresh.words.first,
               std::span<const uint32_t>(model.tileStart));
        append(upload, from, FW_BIND_REFINE_WORDS, fresh.words.first + model.tileStart.size(),
               std::span<const uint32_t>(model.tileItems));
        append(upload, from, kResourceVertices, fresh.draws.first,
               std::span<const mesh::RenderVertex>(vertices));
    } catch (...) {
        fresh.release(s.buffers);
        s.dropUploads(uploadsBefore);
        throw;
    }
    s.scene.meshes[slot].refine[refineKey(published, depth)] = fresh;
}

void RefineMesh::release(WorldBuffers& buffers) noexcept {
    const PoolRange all[] = {{&triangles, kPoolRefineMeshTriangles},
                             {&edges, kPoolRefineMeshEdges},
                             {&slots, kPoolRefineMeshSlots},
                             {&words, kPoolRefineWords},
                             {&draws, kPoolVertices}};
    releaseAll(buffers, all);
    *this = {};
}

void RefineUse::allocate(WorldBuffers& buffers, const RefineMesh& mesh, bool thick, uint64_t last) {
    inner = thick && mesh.solid ? mesh.slotCount : 0;
    border = inner != 0 && mesh.openEdges > 0;
    const auto take = [&](RangeOf& range, BufferPool pool, uint32_t units) {
        units = std::max(1u, units);
        range = {buffers.allocate(pool, units, last), units};
    };
    take(items, kPoolRefineItems, mesh.edgeCount + mesh.triangleCount);
    take(triangles, kPoolRefineTriangles, mesh.triangleCount + kRefineSums);
    take(slots, kPoolRefineSlots, mesh.slotCount + inner);
    take(indices, kPoolRefineIndices, mesh.fullCount * 3);
    // Along rims, of up to four for a small triangle; with an inner skin and along borders more.
    const uint32_t rims = mesh.fullCount / (inner ? 3 : 4) + 64;
    const uint32_t walls = border ? mesh.openEdges << (kRefineDepth + 1) : 0;
    take(cuts, kPoolRefineCuts, 3 * std::min(rims + walls, kMaxRefineCut));
}

void RefineUse::allocatePattern(WorldBuffers& buffers, const RefineMesh& mesh, uint64_t last) {
    slots = {buffers.allocate(kPoolRefineSlots, mesh.slotCount, last), mesh.slotCount};
    const uint32_t listed = groupsOf(mesh.fullCount) * 64;
    patternList = {buffers.allocate(kPoolPatternList, listed, last), listed};
    indices = {buffers.allocate(kPoolRefineIndices, listed * 3, last), listed * 3};
}

void RefineUse::release(WorldBuffers& buffers) noexcept {
    const PoolRange all[] = {{&items, kPoolRefineItems}, {&triangles, kPoolRefineTriangles},
                             {&slots, kPoolRefineSlots}, {&indices, kPoolRefineIndices},
                             {&cuts, kPoolRefineCuts},   {&patternList, kPoolPatternList}};
    releaseAll(buffers, all);
    *this = {};
}

void VkBackend::State::recordFire(uint32_t object, uint32_t tick) noexcept {
    scene.awake.insert(object);
    RefineUse& use = scene.objects[object].refine;
    if (!use.on) return;
    uint32_t opens = 0;  // what burns may open later than it goes out
    if ((scene.objects[object].record.flags & kObjectNoHoles) == 0)
        for (const BurnMaterial& m : scene.objects[object].materials)
            opens = std::max(opens, m.holeTicks);
    const uint64_t quiet = uint64_t(tick) + kQuietTicks + opens;
    use.quietTick = std::max(use.quietTick, uint32_t(std::min<uint64_t>(quiet, kLiveEnd)));
}

// Once more after it is quiet: pictures may be seconds apart. What has a border is drawn refined
// from the first picture on.
bool VkBackend::State::refines(const ObjectEntry& object) const noexcept {
    return object.live && object.refine.on && !object.refine.patternPlus1 &&
           (object.refine.border || double(object.refine.quietTick) > object.refine.turnTick);
}

// Which objects the frame may refine, and the bytes that it uploads for all of them. May throw.
uint64_t VkBackend::State::planRefine(const FramePlan& plan) {
    refine.push = {};
    refine.full = (plan.switches & kSwitchRefineFull) != 0;
    if (refine.users == 0 || open.unseen) return 0;
    listRefined(true);
    const RefinePush& push = refine.push;
    if (push.objects == 0) return 0;
    const uint32_t jobs = (push.cutJobs - push.placeJobs) / 2;
    buffers.atLeast(kPoolRefineWork, push.cutJobs + jobs + 2 * 64 * push.edgeGroups, ring.newest());
    return refine.lists.size() * 4 + uint64_t(push.objectEnd) * sizeof(RefineObject) + 64;
}

// The work buffer of the objects that are due, or of all that refine. Throws only where it has more
// to list than ever.
void VkBackend::State::listRefined(bool all) {
    refine.lists.clear();
    refine.push = {};
    uint64_t emitJobs = 0, placeJobs = 0;
    const auto each = [&](auto&& use) {
        for (const uint32_t i : scene.awake) {
            const ObjectEntry& object = scene.objects[i];
            if (all ? refines(object) : object.refine.due)
                use(i, scene.meshes[object.mesh].refine[object.refine.key]);
        }
    };
    const auto list = [&](uint32_t object, uint32_t count) {
        for (uint32_t k = 0; k < count; k += 64) {
            refine.lists.push_back(object);
            refine.lists.push_back(k);
        }
        return groupsOf(count);
    };
    refine.lists.resize(kRefineWorkLists, 0);
    for (const uint32_t at :
         {kRefineWorkEmit, kRefineWorkPlace, kRefineWorkCut, kRefineWorkEdges, kRefineWorkMorph})
        refine.lists[at + 1] = refine.lists[at + 2] = 1;
    RefinePush& push = refine.push;
    each([&](uint32_t i, const RefineMesh& m) { push.edgeGroups += list(i, m.edgeCount); });
    each([&](uint32_t i, const RefineMesh& m) { push.triangleGroups += list(i, m.triangleCount); });
    each([&](uint32_t i, const RefineMesh& m) { push.cornerGroups += list(i, m.cornerCount); });
    each([&](uint32_t i, const RefineMesh& m) {
        refine.lists.push_back(i);
        refine.lists.push_back(0);
        ++push.objects;
        emitJobs += groupsOf(m.fullCount);
        placeJobs += m.triangleCount;
    });
    for (uint32_t o = 0; o < push.objects; ++o) {  // counts, ends
        refine.lists.insert(refine.lists.end(), kMaterialsPerObject, 0);
        refine.lists.insert(refine.lists.end(), kMaterialsPerObject, kNoneTexel);
    }
    // The budget is shared with those whose turn it is not.
    uint64_t full = 0;
    for (const uint32_t i : scene.awake) {
        if (!refines(scene.objects[i])) continue;
        full += scene.meshes[scene.objects[i].mesh].refine[scene.objects[i].refine.key].fullCount;
        push.objectEnd = i + 1;
    }
    const auto most = uint32_t(detail.triangles * float(limits.maxRefinedTriangles));
    if (full > most) push.budget = std::max(1u, most / kAimedOf * kAimed);
    push.full = refine.full ? 1 : 0;
    push.recede = kRefineRecede;
    push.emitJobs = uint32_t(refine.lists.size());
    push.placeJobs = push.emitJobs + uint32_t(2 * emitJobs);
    push.cutJobs = push.placeJobs + uint32_t(4 * placeJobs);
}

// Marks the objects that the frame refines; whether there are any.
bool VkBackend::State::chooseDue(double now) noexcept {
    bool any = false;
    const auto due = [&](const ObjectEntry& object) {
        return refines(object) && isDue(object, refineRecord(object, refine.full), now);
    };
    for (const uint32_t i : scene.awake) any = any || due(scene.objects[i]);
    if (!any) return false;
    // Full ones are compared with what has no turns.
    for (const uint32_t i : scene.awake)
        scene.objects[i].refine.due =
            refines(scene.objects[i]) && (refine.full || due(scene.objects[i]));
    return true;
}

// The views' eyes and the heights of their last pictures limit levels.
void VkBackend::State::refineObjects(FrameInFlight& slot) {
    RefinePush& push = refine.push;
    if (push.objects == 0) return;
    visibilityFromViews();
    const double now = double(simulation.shownTick) + double(simulation.tickFraction);
    const bool turn = chooseDue(now);
    if (!turn && !refine.full) return;
    FrameRecorder recorder(recordTarget(slot, open.commands));
    uint64_t at = (slot.uploadUsed + 15) / 16 * 16;
    if (turn) {
        listRefined(false);
        refine.last = push;
        open.refined = true;
        std::memcpy(slot.upload.mapped + at, refine.lists.data(), refine.lists.size() * 4);
        recorder.copyIn(at, FW_BIND_REFINE_WORK, 0, refine.lists.size() * 4);
        at += (refine.lists.size() * 4 + 15) / 16 * 16;
    }
    push = refine.last;
    push.nowTick = simulation.shownTick;
    const uint64_t recordsAt = at;
    uint32_t ordinal = 0;
    bool cuts = false, fresh = false;
    for (uint32_t i = 0; i < push.objectEnd; ++i, at += sizeof(RefineObject)) {
        RefineObject record{};
        ObjectEntry& object = scene.objects[i];
        if (object.refine.due) {
            record = refineRecord(object, refine.full);
            record.flags |= kRefineIsActive | kRefineIsCounted;
            record.ordinal = ordinal++;
            record.dt =
                float(std::clamp((now - object.refine.turnTick) / kTicksPerSecond, 0.0, 2.0));
        }
        if (!object.refine.due && object.refine.started && refines(object)) {
            record.flags = kRefineIsCounted;
            record.triangles = object.refine.triangles.first;
            record.triangleCount =
                scene.meshes[object.mesh].refine[object.refine.key].triangleCount;
        }
        if (object.refine.due && turn) {
            object.refine.turnTick = now;
            object.refine.turnEye = record.eye;
            const float segments = cutSegments(object, record);
            const bool cut = segments > (object.refine.cut ? kCutTo : kCutFrom);
            const bool perPixelHoles = cut && hasPerPixelHoles(object);
            // What was cut is emitted again.
            const bool was =
                object.refine.cut && (!cut || (perPixelHoles && !object.refine.perPixelHoles));
            record.flags |= (was ? kRefineIsWhole : 0) | (cut ? kRefineIsCut : 0) |
                            (perPixelHoles ? kRefineHasPerPixelHoles : 0);
            object.refine.cut = cut;
            object.refine.perPixelHoles = perPixelHoles;
            object.refine.nearness =
                std::clamp((segments - kCutFrom) / (kCutNear - kCutFrom), 0.0f, 1.0f);
            object.refine.now = record.now;
            cuts |= cut;
            if (!object.refine.started) {
                record.flags |= kRefineIsFresh;
                fresh = true;
                const RangeOf& items = object.refine.items;
                recorder.fillZero(FW_BIND_REFINE_HEAT, uint64_t(items.first) * 4,
                                  uint64_t(items.units) * 4);
                object.refine.started = true;
            }
        }
        std::memcpy(slot.upload.mapped + at, &record, sizeof record);
    }
    slot.uploadUsed = at;
    recorder.copyIn(recordsAt, FW_BIND_REFINE_OBJECTS, 0,
                    uint64_t(push.objectEnd) * sizeof(RefineObject));
    recordRefinement(recorder, simulation.lists, {push, turn, cuts, fresh});
}

void VkBackend::State::visibilityFromViews() noexcept {
    if (!limits.looks.viewParams) return;
    refine.eyeCount = 0;
    refine.pixels = 0;
    for (const OutsideView* const of : seenFrom()) {
        ViewInput input;
        input.view = &of->view;
        input.viewport[2] = input.viewport[3] = of->height > 0 ? of->height : kDefaultHeight;
        ViewParams params{};
        limits.looks.viewParams(input, params);
        const float pixels = 1 / params.eye.w;
        refine.pixels = std::max(refine.pixels, pixels);
        vec4& eye = refine.eyes[refine.eyeCount++];
        eye = params.eye;
        eye.w = params.forward.w > 0.5f ? pixels : 0;
    }
}

void showRefined(const RefineUse& use, DrawItem& item) noexcept {
    item.refined = use.started;
    item.cut = use.cut;
    item.perPixelHoles = use.perPixelHoles;
    item.consumed = use.patternPlus1 != 0;
    item.draw.now = use.now;
    item.draw.nearness = use.nearness;
}

// How many of the finest segments its mean edge would be where it is nearest to the eye: holes of
// far objects are small, and discarded.
float VkBackend::State::cutSegments(const ObjectEntry& object,
                                    const RefineObject& record) const noexcept {
    if ((object.record.flags & kObjectNoHoles) != 0 && !object.refine.border) return 0;
    if (record.eye.w == 0) return kCutNear;
    const float pixels =
        scene.meshes[object.mesh].refine[object.refine.key].edgeLength * record.eye.w;
    return pixels / std::max(record.pixelsPerEdge * eyeDistance(object, record.eye), 1e-6f);
}

// Whether the budget leaves it so few levels that corners do not know its holes; while that is not
// known, whether it may.
bool VkBackend::State::hasPerPixelHoles(const ObjectEntry& object) const noexcept {
    if (refine.full || refine.push.budget == 0) return false;
    if (refine.bias < 0) return true;
    return refine.bias > (object.refine.perPixelHoles ? kFewestAgain : kFewestLevels);
}

// m, object space, from the eye to the mesh's bounds.
float VkBackend::State::eyeDistance(const ObjectEntry& object, const vec4& eye) const noexcept {
    const MeshEntry& entry = scene.meshes[object.mesh];
    float square = 0;
    for (int k = 0; k < 3; ++k) {
        const float out = std::max(
            {entry.domain->boundsLow[k] - eye[k], eye[k] - entry.domain->boundsHigh[k], 0.0f});
        square += out * out;
    }
    return std::sqrt(square);
}

// m, object space; w: as refine.eyes. Of the views' eyes that to which it is largest.
vec4 VkBackend::State::eyeFor(const ObjectEntry& object) const noexcept {
    // Rows are s * R: the eye in object space is (R^T / s) (eye - t).
    const vec4 &x = object.record.worldRow0, &y = object.record.worldRow1,
               &z = object.record.worldRow2;
    const float square = std::max(x.x * x.x + x.y * x.y + x.z * x.z, 1e-12f);
    vec4 best(0.0f);
    float most = -1;
    for (uint32_t i = 0; i < refine.eyeCount; ++i) {
        const vec4& eye = refine.eyes[i];
        const float d[3] = {eye.x - x.w, eye.y - y.w, eye.z - z.w};
        const vec4 at{(x.x * d[0] + y.x * d[1] + z.x * d[2]) / square,
                      (x.y * d[0] + y.y * d[1] + z.y * d[2]) / square,
                      (x.z * d[0] + y.z * d[1] + z.z * d[2]) / square, eye.w};
        if (at.w == 0) return at;
        const float pixels = at.w / std::max(eyeDistance(object, at), 1e-6f);
        if (pixels <= most) continue;
        most = pixels;
        best = at;
    }
    return best;
}

// Whether what it shows may have changed by so much that it shows, since it was last refined.
bool VkBackend::State::isDue(const ObjectEntry& object, const RefineObject& record,
                             double now) const noexcept {
    const RefineUse& use = object.refine;
    if (!use.started || record.eye.w != use.turnEye.w) return true;
    mesh::RefineTurn turn;
    turn.since = std::abs(now - use.turnTick);
    turn.away = eyeDistance(object, record.eye);
    turn.moved = std::hypot(record.eye.x - use.turnEye.x, record.eye.y - use.turnEye.y,
                            record.eye.z - use.turnEye.z);
    turn.perspective = record.eye.w > 0;
    if (double(use.quietTick) <= use.turnTick) turn.since = 0;  // only its border is drawn again
    turn.pixels = refine.pixels;
    // How fast fire runs: ticks are 2^-22 of sigma0 for 1/8 of a quantum.
    uint32_t least = ~0u;
    for (const BurnMaterial& m : object.materials)
        if ((m.flags & 1) != 0) least = std::min(least, m.sigma0);
    turn.speed = double(object.record.originQuantum.w) / 8 * 4194304.0 / double(least);
    return mesh::refineDue(turn);
}

RefineObject VkBackend::State::refineRecord(const ObjectEntry& object, bool full) const noexcept {
    const MeshEntry& entry = scene.meshes[object.mesh];
    const RefineMesh& mesh = entry.refine[object.refine.key];
    const RefineUse& use = object.refine;
    RefineObject r{};
    r.items = use.items.first;
    r.triangles = use.triangles.first;
    r.vertices = use.slots.first;
    r.indices = use.indices.first;
    r.meshTriangles = mesh.triangles.first;
    r.meshEdges = mesh.edges.first;
    r.meshSlots = mesh.slots.first;
    r.meshWords = mesh.words.first;
    r.meshDraws = mesh.draws.first;
    r.edgeCount = mesh.edgeCount;
    r.triangleCount = mesh.triangleCount;
    r.cornerCount = mesh.cornerCount;
    r.textureWidth = entry.width;
    r.tileCount = entry.tiles;
    r.stateBase = object.record.stateBase;
    r.epochTick = use.epochTick;
    r.pixelsPerEdge = use.pixelsPerEdge;
    r.now = float(
        (double(simulation.shownTick) - double(use.epochTick) + double(simulation.tickFraction)) /
        kTicksPerSecond);
    r.eye = eyeFor(object);
    if (full) r.eye.w = 0;
    r.inner = use.inner;
    r.cuts = use.cuts.first;
    r.cutTriangles = use.cuts.units / 3;
    // A wall is gone when it looks gone.
    const auto seconds = [&](uint32_t m) {
        const BurnMaterial& material = object.materials[m];
        const bool opens = material.holeTicks != 0 && !(object.record.flags & kObjectNoHoles);
        const uint32_t ticks = opens ? material.holeTicks : material.flameTicks;
        const float s =
            ticks == kNoneTexel ? 1e6f : std::max(float(ticks) / float(kTicksPerSecond), 1e-3f);
        return opens ? s : -s;
    };
    r.burnSeconds0 = {seconds(0), seconds(1), seconds(2), seconds(3)};
    r.burnSeconds1 = {seconds(4), seconds(5), seconds(6), seconds(7)};
    const auto* end = mesh.materialEnd;
    r.materialEnd0 = {end[0], end[1], end[2], end[3]};
    r.materialEnd1 = {end[4], end[5], end[6], end[7]};
    return r;
}

}  // namespace fw::gpu::vk
