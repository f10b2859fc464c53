// The published refinement scheme's side of the backend: its statuses advance on the CPU, what they
// draw is uploaded when it changes, and a pass places its vertices. Needs no readback.
#include "gpu/vk/frame_needs.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace fw::gpu::vk {
namespace {

// Groups of its list, at most.
uint32_t maxGroups(const ObjectEntry& object) { return object.refine.patternList.units / 64; }

}  // namespace

void VkBackend::State::adoptPattern(RefineUse& use, const ObjectInit& init, const RefineMesh& mesh,
                                    uint64_t last) {
    uint32_t free = 0;
    while (free < pattern.patternUses.size() && pattern.patternUses[free]->model) ++free;
    if (free == pattern.patternUses.size())
        pattern.patternUses.push_back(core::Owned<PatternUse>::make(memory, memory));
    PatternUse& taken = *pattern.patternUses[free];
    taken.state.reset(*init.patternModel);
    use.allocatePattern(buffers, mesh, last);
    taken.model = init.patternModel;
    taken.settings = init.pattern;
    use.patternPlus1 = free + 1;
}

void VkBackend::State::dropPattern(RefineUse& use) noexcept {
    if (use.patternPlus1) pattern.patternUses[use.patternPlus1 - 1]->model = nullptr;
    use.patternPlus1 = 0;
}

void VkBackend::startBoundary(uint32_t slot, const float point[3], uint32_t tick) noexcept {
    State& s = *state_;
    const uint32_t plus1 = s.scene.objects[slot].refine.patternPlus1;
    if (plus1 == 0) return;
    PatternUse& use = *s.pattern.patternUses[plus1 - 1];
    mesh::ignitePattern(*use.model, use.settings, {point[0], point[1], point[2]}, tick, use.state);
}

// Where no host lit it there is no boundary: such an object is drawn as its mesh.
bool VkBackend::State::refinesAsPublished(const ObjectEntry& object) const noexcept {
    return object.live && object.refine.patternPlus1 &&
           pattern.patternUses[object.refine.patternPlus1 - 1]->state.lit &&
           double(object.refine.quietTick) > pattern.lastTick;
}

// The bytes that the frame may upload for it. May throw.
uint64_t VkBackend::State::planPatterns() {
    pattern.placeGroups = pattern.nameGroups = 0;
    if (pattern.users == 0 || open.unseen) return 0;
    uint64_t bytes = 0;
    for (const uint32_t i : scene.awake) {
        const ObjectEntry& object = scene.objects[i];
        if (!refinesAsPublished(object)) continue;
        pattern.placeGroups +=
            groupsOf(scene.meshes[object.mesh].refine[object.refine.key].slotCount);
        pattern.nameGroups += maxGroups(object);
        bytes += uploaded(sizeof(RefineObject)) + uploaded(maxGroups(object) * 256ull) +
                 uploaded(kMaterialsPerObject * sizeof(VkDrawIndexedIndirectCommand));
    }
    if (bytes == 0) return 0;
    buffers.atLeast(kPoolPatternGroups, pattern.placeGroups + pattern.nameGroups, ring.newest());
    return bytes + uploaded((pattern.placeGroups + pattern.nameGroups) * sizeof(WakeGroup));
}

namespace {

// The list, filled up to whole groups, and a draw for each material.
void writeList(const ObjectEntry& object, uint32_t slot, const RefineMesh& mesh,
               const mesh::PatternState& state, FrameRecorder& recorder, UploadWriter& writer) {
    Staged staged = writer.begin();
    writer.append(staged, std::span<const uint32_t>(state.list));
    const uint32_t nothing = kPatternEmpty;
    while (staged.count % 64 != 0) writer.append(staged, std::span<const uint32_t>(&nothing, 1));
    writer.end();
    recorder.copyIn(staged.at, FW_BIND_PATTERN_LIST, uint64_t(object.refine.patternList.first) * 4,
                    uint64_t(staged.count) * 4);
    VkDrawIndexedIndirectCommand draws[kMaterialsPerObject]{};
    uint32_t first = object.refine.indices.first;
    for (uint32_t m = 0; m < kMaterialsPerObject; ++m) {
        draws[m] = {state.listed[m] * 3, 1, first, int32_t(mesh.draws.first), 0};
        first += state.listed[m] * 3;
    }
    const Staged args = writer.write(std::span<const VkDrawIndexedIndirectCommand>(draws));
    recorder.copyIn(args.at, FW_BIND_REFINE_DRAWS, uint64_t(slot) * sizeof draws, sizeof draws);
}

}  // namespace

void VkBackend::State::refineAsPublished(FrameInFlight& slot) {
    if (pattern.placeGroups == 0) return;
    visibilityFromViews();
    FrameRecorder recorder(recordTarget(slot, open.commands));
    UploadWriter writer(slot);
    const double now = double(simulation.shownTick) + double(simulation.tickFraction) * kStepTicks;
    for (const uint32_t i : scene.awake) {
        ObjectEntry& object = scene.objects[i];
        if (!refinesAsPublished(object)) continue;
        const RefineMesh& refined = scene.meshes[object.mesh].refine[object.refine.key];
        PatternUse& use = *pattern.patternUses[object.refine.patternPlus1 - 1];
        RefineObject record = refineRecord(object, refine.full);
        record.items = object.refine.patternList.first;
        record.cornerCount = refined.slotCount;
        const Staged staged = writer.write(std::span<const RefineObject>(&record, 1));
        recorder.copyIn(staged.at, FW_BIND_REFINE_OBJECTS, uint64_t(i) * sizeof record,
                        sizeof record);
        use.settings.pixelsPerEdge = object.refine.pixelsPerEdge;
        const mesh::PatternView from{{record.eye.x, record.eye.y, record.eye.z}, record.eye.w};
        if (mesh::advancePattern(*use.model, use.settings, now, from, refine.full, use.state))
            writeList(object, i, refined, use.state, recorder, writer);
        object.refine.started = true;
        object.refine.now = record.now;
    }
    Staged groups = writer.begin();
    uint32_t places = 0;
    for (const bool naming : {false, true})
        for (const uint32_t i : scene.awake) {
            const ObjectEntry& object = scene.objects[i];
            if (!refinesAsPublished(object)) continue;
            const auto count =
                naming ? uint32_t(
                             pattern.patternUses[object.refine.patternPlus1 - 1]->state.list.size())
                       : scene.meshes[object.mesh].refine[object.refine.key].slotCount;
            for (uint32_t first = 0; first < count; first += 64) {
                const WakeGroup group{i, first};
                writer.append(groups, std::span<const WakeGroup>(&group, 1));
            }
            if (!naming) places = groups.count;
        }
    writer.end();
    recorder.copyIn(groups.at, FW_BIND_PATTERN_GROUPS, 0, groups.count * sizeof(WakeGroup));
    pattern.lastTick = now;
    recordRefinementAsPublished(recorder, {0, simulation.shownTick, 0, kRefineRecede}, places,
                                groups.count - places);
}

}  // namespace fw::gpu::vk
