// The published refinement scheme's side of the backend: its statuses advance on the CPU, what they
// draw is uploaded when it changes, and a pass places its vertices. Needs no readback.
#include "gpu/vk/frame_needs.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace fw::gpu::vk {
namespace {

// Groups of its list, at most.
uint32_t maxGroups(const ObjectEntry& object) { return object.refine.patternList.units() / 64; }

}  // namespace

void adoptPattern(BackendState& s, RefineUse& use, const ObjectInit& init, const RefineMesh& mesh,
                  uint64_t last) {
    uint32_t free = 0;
    while (free < s.pattern.patternUses.size() && s.pattern.patternUses[free]->model) ++free;
    if (free == s.pattern.patternUses.size())
        s.pattern.patternUses.push_back(core::Owned<PatternUse>::make(s.memory, s.memory));
    PatternUse& taken = *s.pattern.patternUses[free];
    taken.state.reset(*init.patternModel);
    use.allocatePattern(s.buffers, mesh, last);
    taken.model = init.patternModel;
    taken.settings = init.pattern;
    use.patternPlus1 = free + 1;
}

void dropPattern(BackendState& s, RefineUse& use) noexcept {
    if (use.patternPlus1) s.pattern.patternUses[use.patternPlus1 - 1]->model = nullptr;
    use.patternPlus1 = 0;
}

void VkBackend::startBoundary(uint32_t slot, const float point[3], uint32_t tick) noexcept {
    BackendState& s = *state_;
    const uint32_t plus1 = s.scene.objects[slot].refine.patternPlus1;
    if (plus1 == 0) return;
    PatternUse& use = *s.pattern.patternUses[plus1 - 1];
    mesh::ignitePattern(*use.model, use.settings, {point[0], point[1], point[2]}, tick, use.state);
}

// Where no host lit it there is no boundary: such an object is drawn as its mesh.
bool refinesAsPublished(const BackendState& s, const ObjectEntry& object) noexcept {
    return object.live && object.refine.patternPlus1 &&
           s.pattern.patternUses[object.refine.patternPlus1 - 1]->state.lit &&
           double(object.refine.quietTick) > s.pattern.lastTick;
}

// The bytes that the frame may upload for it. May throw.
uint64_t planPatterns(BackendState& s) {
    s.pattern.placeGroups = s.pattern.nameGroups = 0;
    if (s.pattern.users == 0 || s.open.unseen) return 0;
    uint64_t bytes = 0;
    for (const uint32_t i : s.scene.awake) {
        const ObjectEntry& object = s.scene.objects[i];
        if (!refinesAsPublished(s, object)) continue;
        s.pattern.placeGroups +=
            groupsOf(s.scene.meshes[object.mesh].refine[object.refine.key].slotCount);
        s.pattern.nameGroups += maxGroups(object);
        bytes += uploaded(sizeof(RefineObject)) + uploaded(maxGroups(object) * 256ull) +
                 uploaded(kMaterialsPerObject * sizeof(VkDrawIndexedIndirectCommand));
    }
    if (bytes == 0) return 0;
    s.buffers.atLeast(kPoolPatternGroups, s.pattern.placeGroups + s.pattern.nameGroups,
                      s.ring.newest());
    return bytes + uploaded((s.pattern.placeGroups + s.pattern.nameGroups) * sizeof(WakeGroup));
}

namespace {

// The list, filled up to whole groups, and a draw for each material.
void writeList(const ObjectEntry& object, uint32_t slot, const RefineMesh& mesh,
               const mesh::PatternState& state, FrameRecorder& recorder) {
    Staged staged = recorder.beginStaged();
    recorder.append(staged, std::span<const uint32_t>(state.list));
    const uint32_t nothing = kPatternEmpty;
    while (staged.count % 64 != 0) recorder.append(staged, std::span<const uint32_t>(&nothing, 1));
    recorder.endStaged();
    recorder.copyIn(staged.at, FW_BIND_PATTERN_LIST,
                    uint64_t(object.refine.patternList.first()) * 4, uint64_t(staged.count) * 4);
    VkDrawIndexedIndirectCommand draws[kMaterialsPerObject]{};
    uint32_t first = object.refine.indices.first();
    for (uint32_t m = 0; m < kMaterialsPerObject; ++m) {
        draws[m] = {state.listed[m] * 3, 1, first, int32_t(mesh.draws.first()), 0};
        first += state.listed[m] * 3;
    }
    const Staged args = recorder.stage(std::span<const VkDrawIndexedIndirectCommand>(draws));
    recorder.copyIn(args.at, FW_BIND_REFINE_DRAWS, uint64_t(slot) * sizeof draws, sizeof draws);
}

}  // namespace

void refineAsPublished(BackendState& s, FrameInFlight& slot) {
    if (s.pattern.placeGroups == 0) return;
    s.refine.takeEyes(s);
    FrameRecorder recorder(s.recordTarget(slot, s.open.commands));
    const double now =
        double(s.simulation.shownTick) + double(s.simulation.tickFraction) * kStepTicks;
    for (const uint32_t i : s.scene.awake) {
        ObjectEntry& object = s.scene.objects[i];
        if (!refinesAsPublished(s, object)) continue;
        const RefineMesh& refined = s.scene.meshes[object.mesh].refine[object.refine.key];
        PatternUse& use = *s.pattern.patternUses[object.refine.patternPlus1 - 1];
        RefineObject record = s.refine.recordOf(s, object, s.refine.full);
        record.items = object.refine.patternList.first();
        record.cornerCount = refined.slotCount;
        const Staged staged = recorder.stage(std::span<const RefineObject>(&record, 1));
        recorder.copyIn(staged.at, FW_BIND_REFINE_OBJECTS, uint64_t(i) * sizeof record,
                        sizeof record);
        use.settings.pixelsPerEdge = object.refine.pixelsPerEdge;
        const mesh::PatternView from{{record.eye.x, record.eye.y, record.eye.z}, record.eye.w};
        if (mesh::advancePattern(*use.model, use.settings, now, from, s.refine.full, use.state))
            writeList(object, i, refined, use.state, recorder);
        object.refine.started = true;
        object.refine.now = record.now;
    }
    Staged groups = recorder.beginStaged();
    uint32_t places = 0;
    for (const bool naming : {false, true})
        for (const uint32_t i : s.scene.awake) {
            const ObjectEntry& object = s.scene.objects[i];
            if (!refinesAsPublished(s, object)) continue;
            const auto count =
                naming
                    ? uint32_t(
                          s.pattern.patternUses[object.refine.patternPlus1 - 1]->state.list.size())
                    : s.scene.meshes[object.mesh].refine[object.refine.key].slotCount;
            for (uint32_t first = 0; first < count; first += 64) {
                const WakeGroup group{i, first};
                recorder.append(groups, std::span<const WakeGroup>(&group, 1));
            }
            if (!naming) places = groups.count;
        }
    recorder.endStaged();
    recorder.copyIn(groups.at, FW_BIND_PATTERN_GROUPS, 0, groups.count * sizeof(WakeGroup));
    s.pattern.lastTick = now;
    recordRefinementAsPublished(recorder, {0, s.simulation.shownTick, 0, kRefineRecede}, places,
                                groups.count - places);
}

}  // namespace fw::gpu::vk
