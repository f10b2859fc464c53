#include "gpu/vk/simulation.h"

#include "core/assert.h"
#include "gpu/vk/frame_needs.h"

#include <algorithm>
#include <cmath>

namespace fw::gpu::vk {
namespace {

// More rings of a frame in which an object comes into view or catches fire, which would end in
// steps of whole texels: the next ones add to them. A picture by itself has no next frame, and
// takes what there is to see, up to so many.
constexpr uint32_t kRingsOfFrame = 8, kRingsOfPicture = 96;
// How long predictions may wait where detail is short: ticks, with no triangles left, and texels
// that fire crosses meanwhile, as a round brings a ring. Known predictions stay, and age.
constexpr double kLongestPause = kTicksPerSecond / 10.0, kCrossedInPause = 0.6;

// Texels that fire may cross in a tick.
double paceOf(const ObjectEntry& object) noexcept {
    return metresPerTick(object) / std::sqrt(std::max(double(object.record.tint.w), 1e-12));
}

// Texels that fire may cross in the time that is looked ahead.
uint32_t ringsOf(const ObjectEntry& object) noexcept {
    const double rings = double(object.record.horizon) * paceOf(object);
    return uint32_t(std::clamp(rings, 1.0, double(kRingsOfPicture)));
}

// New records of a step's latches.
void recordMaterials(BackendState& s, std::span<const MaterialUpdate> updates,
                     FrameRecorder& recorder) {
    for (const MaterialUpdate& update : updates) {
        ObjectEntry& object = s.scene.objects[update.object];
        std::copy(std::begin(update.materials), std::end(update.materials),
                  std::begin(object.materials));
        object.record.window = update.window;
        object.record.substepShift = update.substepShift;
        s.surfaces.update(s, update.object, false);
        recorder.uploadOne(FW_BIND_MATERIALS, uint64_t(update.object) * sizeof object.materials,
                           object.materials);
        const uint32_t timing[2] = {update.window, update.substepShift};
        static_assert(offsetof(BurnObject, substepShift) == offsetof(BurnObject, window) + 4);
        recorder.uploadOne(
            FW_BIND_OBJECTS,
            uint64_t(update.object) * sizeof(BurnObject) + offsetof(BurnObject, window), timing);
    }
}

// Where objects are from this step on. A record is known without sources: those are ours.
void recordExchangeUpdate(BackendState& s, const ExchangeUpdate& update, FrameRecorder& recorder) {
    for (const ExchangeUpdate::Placed& placed : update.objects) {
        const BufferRange& sources = s.scene.objects[placed.object].sources;
        ExchangeObject record = placed.record;
        record.sourceBase = sources.first();
        record.sourceCount = sources.units();
        recorder.uploadOne(FW_BIND_EXCHANGE_OBJECTS, uint64_t(placed.object) * sizeof record,
                           record);
    }
    for (const ExchangeUpdate::Range& range : update.neighbourRanges)
        recorder.upload(FW_BIND_NEIGHBOURS, uint64_t(range.first) * sizeof(uint32_t),
                        update.neighbours.subspan(range.first, range.count));
    for (const ExchangeUpdate::Range& range : update.linkRanges)
        recorder.upload(FW_BIND_CONTACTS, uint64_t(range.first) * sizeof(ContactLink),
                        update.links.subspan(range.first, range.count));
    FW_ASSERT(update.occluders.size() <= kMaxHeatOccluders, "%zu occluders",
              update.occluders.size());
    recorder.upload(FW_BIND_HEAT_OCCLUDERS, 0, update.occluders);
    s.simulation.links = uint32_t(update.links.size());
    s.simulation.occluders = uint32_t(update.occluders.size());
}

void uploadOcclusion(SimulationState& simulation, const OcclusionUpdate& update,
                     FrameRecorder& recorder) {
    simulation.occlusion = update;
    simulation.occlusion.words = {};
    recorder.upload(FW_BIND_HEAT_OCCLUSION, 0, update.words);
}

// The tiles that a step looks at again: those of latched objects and of objects that restart their
// prediction, or all.
Staged stageWakeGroups(const BackendState& s, std::span<const MaterialUpdate> updates, bool dense,
                       bool rebuildsPrediction, FrameRecorder& recorder) {
    Staged staged = recorder.beginStaged();
    const auto append = [&](uint32_t object) {
        const uint32_t groups = wakeGroupsOf(s.scene.objects[object]);
        for (uint32_t g = 0; g < groups; ++g) recorder.appendOne(staged, WakeGroup{object, g * 64});
    };
    for (uint32_t i = 0; dense && i < s.scene.objects.size(); ++i)
        if (s.scene.objects[i].live) append(i);
    if (!dense)
        for (const MaterialUpdate& update : updates) append(update.object);
    for (const uint32_t i : s.scene.awake)
        if (rebuildsPrediction && s.scene.objects[i].burn.forget) append(i);
    recorder.endStaged();
    return staged;
}

// An object that an event reaches is drawn as one that may burn from now on.
void markObjectOfEvent(BackendState& s, const TexelEvent& event, uint32_t now) {
    ObjectEntry& object = s.scene.objects[event.object];
    object.extensionTouched |= (object.record.flags & kObjectExtended) != 0;
    object.burn.lastEvent = std::max<uint64_t>(object.burn.lastEvent, now + kStepTicks);
    const uint32_t kind = eventKind(event.kind);
    const bool douses = (kind == kEventWet || kind == kEventDry || kind == kEventExtinguish ||
                         kind == kEventCarry) &&
                        !object.burn.doused;
    const bool lights = kind == kEventIgnite || kind == kEventCarry;
    object.burn.catches |= lights && !object.burn.lit;
    object.burn.lit |= lights;
    if (object.burn.touched && !douses) return;
    object.burn.touched = true;
    object.burn.doused = object.burn.doused || douses;
    s.surfaces.update(s, event.object, true);
}

// The objects that an extension works on, each with the parity of this step.
std::span<const ExtendedStep> beginExtendedStep(BackendState& s) {
    for (ExtendedStep& one : s.simulation.extended) {
        one.parity = s.scene.objects[one.object].extensionParity;
        s.scene.objects[one.object].extensionParity ^= 1;
    }
    return s.simulation.extended;
}

}  // namespace

void recordSteps(BackendState& s, const FramePlan& plan, const FrameNeeds& needs,
                 FrameRecorder& recorder) {
    ReadbackLayout& layout = s.open.slot->layout;
    if (needs.iterations) recordCounters(recorder, s.simulation.lists, uint32_t(needs.iterations));
    layout.firstRow = s.simulation.lists.row;
    bool iterates = !s.simulation.frontEmpty || needs.dense || needs.never;
    for (const StepPlan& planned : plan.steps) {
        iterates |= changesState(planned) || (planned.exchange && !s.simulation.burnEmpty);
        const bool first = &planned == plan.steps.data();
        StepRecord step;
        static_cast<StepPlan&>(step) = planned;
        step.switches = plan.switches;
        step.objectSlots = uint32_t(s.scene.objects.size());
        step.iterate = iterates;
        step.reduce = planned.reduce && needs.burning;
        step.heat = planned.heat && needs.heating;
        s.scene.airs = s.scene.airs || planned.rooms;
        step.exchange = step.reduce && planned.exchange;
        if (planned.exchangeUpdate) recordExchangeUpdate(s, *planned.exchangeUpdate, recorder);
        step.links = s.simulation.links;
        step.parts = s.scene.partMeshes != 0;
        if (planned.occlusionUpdate)
            uploadOcclusion(s.simulation, *planned.occlusionUpdate, recorder);
        step.rules.occluders = s.simulation.occluders;
        setOcclusionPush(s.simulation.occlusion, step.rules);
        recordMaterials(s, planned.materials, recorder);
        step.wakeGroups = stageWakeGroups(s, planned.materials, needs.dense,
                                          needs.rebuildsPrediction && first, recorder);
        step.staged = recorder.stage(planned.events);
        for (const TexelEvent& event : planned.events) {
            markObjectOfEvent(s, event, planned.now);
            if (addressesAll(event))
                step.allTiles =
                    std::max(step.allTiles, s.scene.objects[event.object].record.tileCount);
        }
        if (needs.extensionRuns) step.extended = beginExtendedStep(s);
        recordSimulation(recorder, s.simulation.lists, step);
        s.simulation.walks.front += step.iterate ? 1 : 0;
        s.simulation.walks.burn += step.reduce ? 1 : 0;
        s.simulation.walks.hot += step.heat ? 1 : 0;
    }
    FW_ASSERT(s.simulation.lists.row < s.buffers.capacity(kPoolIterations), "row %u",
              s.simulation.lists.row);
    layout.rows = s.simulation.lists.row;
    layout.burnParity = s.simulation.lists.burnParity;
    layout.hotParity = s.simulation.lists.hotParity;
    if (!needs.stimulus) return;
    s.simulation.lastStimulus = s.open.ringFrame;
    s.simulation.setAllEmpty(false);
}

void recordForgetting(BackendState& s, FrameRecorder& recorder) {
    for (const uint32_t i : s.scene.awake) {
        ObjectEntry& object = s.scene.objects[i];
        if (!object.burn.forget) continue;
        const uint64_t at = uint64_t(object.record.stateBase) * 4;
        recorder.copyBetween({FW_BIND_STATE, at}, {FW_BIND_PREDICT, at},
                             uint64_t(object.texelCount()) * 4);
        object.burn.lastDouse = 0;
    }
}

bool predictsNow(const BackendState& s, const FrameNeeds& needs, uint32_t endTick) noexcept {
    const double shortOf = 1.0 - double(s.detail.triangles);
    if (shortOf <= 0 || needs.stimulus || needs.appears) return true;
    double pause = kLongestPause * shortOf;
    for (const uint32_t i : s.scene.awake)
        if (const ObjectEntry& object = s.scene.objects[i];
            object.live && object.burn.touched && (object.record.flags & kObjectUnseen) == 0)
            pause = std::min(pause, kCrossedInPause / std::max(paceOf(object), 1e-9));
    return double(endTick - s.simulation.predictTick) >=
           pause;  // of a save that was loaded: long ago
}

void recordPredictions(BackendState& s, const FramePlan& plan, FrameRecorder& recorder) {
    const auto uploadFlags = [&](uint32_t slot, uint32_t flags) {
        recorder.uploadOne(FW_BIND_OBJECTS,
                           uint64_t(slot) * sizeof(BurnObject) + offsetof(BurnObject, flags),
                           flags);
    };
    s.simulation.predictTick = plan.endTick;
    const uint32_t most = plan.frameIndex == 0 ? kRingsOfPicture : kRingsOfFrame;
    uint32_t rings = 0;
    // Objects that others lit are known only later.
    bool seen = shownLately(s.simulation.seenFrame, s.open.ringFrame);
    for (const uint32_t i : s.scene.awake) {
        ObjectEntry& object = s.scene.objects[i];
        uint32_t& flags = object.record.flags;
        if (object.turns) {
            flags ^= kObjectUnseen;
            const bool comes = (flags & kObjectUnseen) == 0;
            uploadFlags(i, comes ? flags | kObjectShownAgain : flags);
            if (comes) {
                recordPredictRestart(recorder, s.simulation.lists, i, object.record.tileCount);
                rings = std::max(rings, std::min(ringsOf(object), most));
            }
        }
        if (object.burn.catches && (flags & kObjectUnseen) == 0)
            rings = std::max(rings, std::min(ringsOf(object), kRingsOfFrame));
        object.burn.catches = false;
        seen |= object.live && object.burn.touched && (flags & kObjectUnseen) == 0;
    }
    // A ring a round: long frames need more to stay ahead of a fast front.
    auto rounds = uint32_t(std::clamp<size_t>(plan.steps.size() * 2, 2, 9) - 1);
    recordPrediction(recorder, s.simulation.lists, plan.endTick, seen);
    if (rings > 0) {
        rounds += rings;
        for (const uint32_t i : s.scene.awake)
            if (s.scene.objects[i].turns && (s.scene.objects[i].record.flags & kObjectUnseen) == 0)
                uploadFlags(i, s.scene.objects[i].record.flags);
    }
    for (uint32_t i = 1; seen && i < rounds; ++i)
        recordPrediction(recorder, s.simulation.lists, plan.endTick, seen);
    s.simulation.walks.predict += seen ? rounds : 1;
}

// Burnt pieces that lost their hold: a part of the tiles each frame, round-robin, from the first
// object that fire came to up to the last one.
void recordFalling(BackendState& s, const FramePlan& plan, bool burning, FrameRecorder& recorder) {
    constexpr uint32_t kMaxTiles = 16384;
    uint32_t begin = kNoneTexel, end = 0;
    float latest = 0;
    for (const uint32_t i : s.scene.awake) {
        const ObjectEntry& object = s.scene.objects[i];
        if (!object.live || !object.burn.touched) continue;
        begin = std::min(begin, object.record.worldTileBase);
        end = std::max(end, object.record.worldTileBase + object.record.tileCount);
        for (const BurnMaterial& material : object.materials)
            if (material.holeTicks) latest = std::max(latest, material.baseColor.w);
    }
    if (burning) {
        // After the last flame: until all holes are open, and until readbacks say so.
        s.simulation.supportUntil = plan.endTick + uint32_t(1.2f * latest) + 16 * kTicksPerSecond;
        if (latest == 0) return;
    }
    if (end <= begin) return;
    const uint32_t parts = (end - begin + kMaxTiles - 1) / kMaxTiles;
    const bool goesOn = s.simulation.supportFirst > begin && s.simulation.supportFirst < end;
    const uint32_t first = goesOn ? s.simulation.supportFirst : begin;
    const uint32_t count = std::min(end - first, kMaxTiles);
    s.simulation.supportFirst = first + count;
    const auto ticks = uint32_t(plan.steps.size()) * kStepTicks * parts;
    recordSupport(recorder, plan.endTick, {first, count, ticks});
}

// Soot above this frame's flames: a part of the tiles each frame, round-robin, with so little soot
// that the border of a part does not show. Without a view the pass runs a few times a second.
TileShare SimulationState::sootShare(uint32_t tiles, uint32_t endTick, bool looked) noexcept {
    constexpr uint32_t kMaxTiles = 4096, kUnseenTicks = kTicksPerSecond / 4;
    const uint32_t mostTicksOfAPart = looked ? kTicksPerSecond / 64 : kTicksPerSecond;
    if (!looked && endTick - sootTick < kUnseenTicks) return {};
    const uint32_t parts = std::max((tiles + kMaxTiles - 1) / kMaxTiles, 1u);
    TileShare share;
    share.first = sootFirst < tiles ? sootFirst : 0;
    share.count = std::min(tiles - share.first, kMaxTiles);
    share.ticks = std::min(endTick - sootTick, kTicksPerSecond);
    sootTick = endTick;
    if (share.count == 0 || share.ticks == 0) return {};
    sootFirst = share.first + share.count;
    if (parts > 1) share.ticks = std::min(share.ticks * parts, mostTicksOfAPart);
    return share;
}

}  // namespace fw::gpu::vk
