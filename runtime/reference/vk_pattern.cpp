// The refinement pattern on the Vulkan backend: its statuses advance on the CPU, their triangles
// are uploaded when they change, and a pass places the vertices. Needs no readback.
#include "gpu/vk/frame_needs.h"
#include "reference/methods.h"
#include "reference/pattern_frame.h"

#include <algorithm>
#include <cmath>

namespace fw::reference {
namespace {

using namespace gpu::vk;
using State = BackendState;

struct MeshPattern {
    explicit MeshPattern(std::pmr::memory_resource* memory) : model(memory) {}
    uint32_t mesh = 0, depth = 0;
    PatternModel model;
};

struct ObjectPattern {
    explicit ObjectPattern(std::pmr::memory_resource* memory) : state(memory) {}
    const PatternModel* model = nullptr;  // null: free
    PatternSettings settings;
    PatternState state;
};

struct Patterns {  // of a world
    explicit Patterns(std::pmr::memory_resource* memory) : meshes(memory), objects(memory) {}
    std::pmr::vector<core::Owned<MeshPattern>> meshes;
    std::pmr::vector<core::Owned<ObjectPattern>> objects;
    uint32_t users = 0;
    uint32_t placeGroups = 0, nameGroups = 0;  // of the frame
    double lastTick = 0;                       // of the last frame with any
};

Patterns& patternsOf(const State& s) noexcept {
    FW_ASSERT(s.extended);
    return *static_cast<Patterns*>(s.extended.get());
}

ObjectPattern& patternOf(const State& s, const ObjectEntry& object) noexcept {
    return *patternsOf(s).objects[object.refine.extendedPlus1 - 1];
}

const RefineMesh& refinedMesh(const State& s, const ObjectEntry& object) noexcept {
    return s.scene.meshes[object.mesh].refine[object.refine.key];
}

// Groups of its list, at most.
uint32_t maxGroups(const ObjectEntry& object) noexcept {
    return object.extensionWords.units() / 16;
}

// An object that no host lit has no boundary: it is drawn as its mesh.
bool refines(const State& s, const ObjectEntry& object) noexcept {
    return object.live && object.refine.extendedPlus1 && patternOf(s, object).state.lit &&
           double(object.refine.quietTick) > patternsOf(s).lastTick;
}

// The list, filled up to whole groups, and a draw for each material.
void writeList(const ObjectEntry& object, uint32_t slot, const RefineMesh& mesh,
               const PatternState& state, FrameRecorder& recorder) {
    Staged staged = recorder.beginStaged();
    recorder.append(staged, std::span<const uint32_t>(state.list));
    const uint32_t nothing = gpu::kPatternEmpty;
    while (staged.count % 64 != 0) recorder.append(staged, std::span<const uint32_t>(&nothing, 1));
    recorder.endStaged();
    recorder.copyIn(staged, FW_BIND_EXTENSION_WORDS, uint64_t(object.extensionWords.first()) * 16);
    VkDrawIndexedIndirectCommand draws[gpu::kMaterialsPerObject]{};
    uint32_t first = object.refine.indices.first();
    for (uint32_t m = 0; m < gpu::kMaterialsPerObject; ++m) {
        draws[m] = {state.listed[m] * 3, 1, first, int32_t(mesh.draws.first()), 0};
        first += state.listed[m] * 3;
    }
    const Staged args = recorder.stage(std::span<const VkDrawIndexedIndirectCommand>(draws));
    recorder.copyIn(args, FW_BIND_REFINE_DRAWS, uint64_t(slot) * sizeof draws);
}

}  // namespace

void createPatternModel(State& s, uint32_t mesh, uint32_t depth, const BurnDomain& domain,
                        const RefineModel& model) {
    if (!s.extended)
        s.extended = std::allocate_shared<Patterns>(
            std::pmr::polymorphic_allocator<Patterns>(s.memory), s.memory);
    auto made = core::Owned<MeshPattern>::make(s.memory, s.memory);
    made->mesh = mesh;
    made->depth = depth;
    made->model = makePatternModel(domain, model, depth, s.memory);
    patternsOf(s).meshes.push_back(std::move(made));
}

void dropPatternModels(State& s, uint32_t mesh) noexcept {
    if (!s.extended) return;
    std::erase_if(patternsOf(s).meshes,
                  [mesh](const core::Owned<MeshPattern>& one) { return one->mesh == mesh; });
}

void createPattern(State& s, ObjectEntry& fresh, const gpu::ObjectInit& init, uint64_t last) {
    Patterns& patterns = patternsOf(s);
    const auto of = std::find_if(
        patterns.meshes.begin(), patterns.meshes.end(),
        [&](const auto& one) { return one->mesh == init.mesh && one->depth == init.refineDepth; });
    FW_ASSERT(of != patterns.meshes.end(), "mesh %u, depth %u", init.mesh, init.refineDepth);
    const PatternModel& model = (*of)->model;
    const auto free = std::find_if(patterns.objects.begin(), patterns.objects.end(),
                                   [](const auto& one) { return !one->model; });
    const auto number = uint32_t(free - patterns.objects.begin());
    if (free == patterns.objects.end())
        patterns.objects.push_back(core::Owned<ObjectPattern>::make(s.memory, s.memory));
    ObjectPattern& taken = *patterns.objects[number];
    taken.state.reset(model);
    const RefineMesh& mesh = refinedMesh(s, fresh);
    fresh.refine.slots = s.buffers.allocate(kPoolRefineSlots, mesh.slotCount, last);
    const uint32_t listed = groupsOf(mesh.fullCount) * 64;
    fresh.extensionWords = s.buffers.allocate(kPoolExtensionWords, listed / 4, last);
    fresh.refine.indices = s.buffers.allocate(kPoolRefineIndices, listed * 3, last);
    taken.model = &model;
    taken.settings =
        patternSettings(model, init.boundary.psi, init.boundary.step, init.boundary.speed);
    fresh.refine.extendedPlus1 = number + 1;
    ++patterns.users;
}

void dropPattern(State& s, ObjectEntry& object) noexcept {
    patternOf(s, object).model = nullptr;
    object.refine.extendedPlus1 = 0;
    --patternsOf(s).users;
}

void startPatternBoundary(State& s, ObjectEntry& object, const float point[3],
                          uint32_t tick) noexcept {
    ObjectPattern& use = patternOf(s, object);
    ignitePattern(*use.model, use.settings, {point[0], point[1], point[2]}, tick, use.state);
}

uint32_t listedCount(const State& s, const ObjectEntry& object) noexcept {
    return uint32_t(patternOf(s, object).state.list.size());
}

uint64_t planPatterns(State& s) {
    if (!s.extended) return 0;
    Patterns& patterns = patternsOf(s);
    patterns.placeGroups = patterns.nameGroups = 0;
    if (patterns.users == 0 || s.open.unseen) return 0;
    uint64_t bytes = 0;
    for (const uint32_t i : s.scene.awake) {
        const ObjectEntry& object = s.scene.objects[i];
        if (!refines(s, object)) continue;
        patterns.placeGroups += groupsOf(refinedMesh(s, object).slotCount);
        patterns.nameGroups += maxGroups(object);
        bytes += uploaded(sizeof(gpu::RefineObject)) + uploaded(maxGroups(object) * 256ull) +
                 uploaded(gpu::kMaterialsPerObject * sizeof(VkDrawIndexedIndirectCommand));
    }
    if (bytes == 0) return 0;
    const uint32_t groups = patterns.placeGroups + patterns.nameGroups;
    s.buffers.atLeast(kPoolExtensionGroups, groups, s.ring.newest());
    return bytes + uploaded(groups * sizeof(WakeGroup));
}

void recordPatterns(State& s, FrameInFlight& slot) {
    if (!s.extended || patternsOf(s).placeGroups == 0) return;
    s.refine.takeEyes(s);
    FrameRecorder recorder(s, slot);
    const double now =
        double(s.simulation.shownTick) + double(s.simulation.tickFraction) * gpu::kStepTicks;
    for (const uint32_t i : s.scene.awake) {
        ObjectEntry& object = s.scene.objects[i];
        if (!refines(s, object)) continue;
        const RefineMesh& refined = refinedMesh(s, object);
        ObjectPattern& use = patternOf(s, object);
        gpu::RefineObject record = s.refine.recordOf(s, object, s.refine.full);
        record.items = object.extensionWords.first() * 4;
        record.cornerCount = refined.slotCount;
        const Staged staged = recorder.stage(std::span<const gpu::RefineObject>(&record, 1));
        recorder.copyIn(staged, FW_BIND_REFINE_OBJECTS, uint64_t(i) * sizeof record);
        use.settings.pixelsPerEdge = object.refine.pixelsPerEdge;
        const PatternView from{{record.eye.x, record.eye.y, record.eye.z}, record.eye.w};
        if (advancePattern(*use.model, use.settings, now, from, s.refine.full, use.state))
            writeList(object, i, refined, use.state, recorder);
        object.refine.started = true;
        object.refine.now = record.now;
    }
    Staged groups = recorder.beginStaged();
    uint32_t places = 0;
    for (const bool naming : {false, true})
        for (const uint32_t i : s.scene.awake) {
            const ObjectEntry& object = s.scene.objects[i];
            if (!refines(s, object)) continue;
            const uint32_t count =
                naming ? listedCount(s, object) : refinedMesh(s, object).slotCount;
            for (uint32_t first = 0; first < count; first += 64) {
                const WakeGroup group{i, first};
                recorder.append(groups, std::span<const WakeGroup>(&group, 1));
            }
            if (!naming) places = groups.count;
        }
    recorder.endStaged();
    recorder.copyIn(groups, FW_BIND_EXTENSION_GROUPS);
    patternsOf(s).lastTick = now;
    // Vertices, then listed triangles.
    gpu::PatternPush push{0, s.simulation.shownTick, 0, gpu::kRefineRecede};
    for (push.phase = 0; push.phase < 2; ++push.phase) {
        const uint32_t first = push.phase ? places : 0;
        const uint32_t count = push.phase ? groups.count - places : places;
        for (uint32_t done = 0; done < count; done += kMaxGroups) {
            push.firstGroup = first + done;
            recorder.dispatch(passOf<gpu::PatternPush>(kRefinePattern), push, count - done);
        }
    }
}

}  // namespace fw::reference
