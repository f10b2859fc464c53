#include "gpu/passes/frame_graph.h"

#include "gpu/backend.h"
#include "gpu/vk/recorder.h"
#include "shared/grant.h"
#include "shared/spark.h"

#include <algorithm>
#include <array>

namespace fw::gpu {
namespace {

constexpr uint32_t kMaxGroups = 65535;  // of a dispatch at the floor; shaders stride over the rest
constexpr uint64_t kRowBytes = sizeof(IterationCounters);
constexpr uint64_t kListPart = offsetof(IterationCounters, listX);

constexpr const ComputePass* kComputePasses[] = {
    &kResetPass,         &kRestorePass,       &kEventsPass,        &kHeatPass,
    &kWakePass,          &kSchedulePass,      &kGatherPass,        &kArrivalPass,
    &kArrivalRimPass,    &kGrantPass,         &kCommitPass,        &kPublishedPass,
    &kReduceClearPass,   &kReduceFrontPass,   &kReducePass,        &kFireCellsPass,
    &kFireSourcesPass,   &kReceiversPass,     &kExchangePass,      &kExchangeShieldPass,
    &kContactsPass,      &kPartsPass,         &kEmberWaysPass,     &kEmbersPass,
    &kPredictAnewPass,   &kPredictGatherPass, &kPredictPass,       &kPredictRimPass,
    &kSupportPass,       &kProbePass,         &kLightsPass,        &kFlameQuadsPass,
    &kFlameSortPass,     &kRefineHeatPass,    &kRefineLevelsPass,  &kRefineScanPass,
    &kRefineEmitPass,    &kRefinePlacePass,   &kRecedePass,        &kTiesPass,
    &kSoftPass,          &kSpringsPass,       &kDrapePass,         &kInnerPass,
    &kSkinPass,          &kSootPass,          &kRefineCutPass,     &kRefinePublishedPass,
    &kVolumeProbePass,   &kVolumeMarchPass,   &kVolumeSmokePass,   &kParticlesPass,
    &kParticleQuadsPass, &kSparksPass,        &kFieldPass,         &kFieldMaskPass,
    &kFieldShowPass,     &kRoomsPass,         &kPredictStatesPass, &kPredictCommitPass,
    &kEventsAllPass,
};

constexpr const DrawPass* kDrawPasses[] = {
    &kSurfacePasses[0],  &kSurfacePasses[1],    &kSurfacePasses[2],    &kSurfacePasses[3],
    &kSurfacePasses[4],  &kSurfacePasses[5],    &kSurfacePasses[6],    &kSurfacePasses[7],
    &kSurfacePasses[8],  &kSurfacePasses[9],    &kSurfacePasses[10],   &kSurfacePasses[11],
    &kSurfacePasses[12], &kSurfacePasses[13],   &kSurfacePasses[14],   &kSurfacePasses[15],
    &kSurfacePasses[16], &kSurfacePasses[17],   &kSurfacePasses[18],   &kSurfacePasses[19],
    &kSurfacePasses[20], &kSurfacePasses[21],   &kSurfacePasses[22],   &kSurfacePasses[23],
    &kSurfacePasses[24], &kSurfacePasses[25],   &kSurfacePasses[26],   &kSurfacePasses[27],
    &kSurfacePasses[28], &kSurfacePasses[29],   &kSurfacePasses[30],   &kSurfacePasses[31],
    &kSurfacePasses[32], &kSurfacePasses[33],   &kSurfacePasses[34],   &kZPass,
    &kFlamesPass,        &kVolumePass,          &kVolumeCardPass,      &kVolumeCompositePass,
    &kVolumeSlicesPass,  &kFieldDrawPasses[0],  &kFieldDrawPasses[1],  &kFieldDrawPasses[2],
    &kVolumeHazePass,    &kBookFlamesPasses[0], &kBookFlamesPasses[1], &kHalfDepthPass,
    &kHalfTilesPass,     &kHalfCompositePass,   &kHalfSparksPasses[0], &kHalfSparksPasses[1],
    &kTransparencyPass};

constexpr uint32_t kNumberOfZPass = kSurfaceVariants;
constexpr uint32_t kNumberOfVolumes = kNumberOfZPass + 2;
constexpr uint32_t kNumberOfFields = kNumberOfZPass + 6;
constexpr uint32_t kNumberOfHaze = kNumberOfFields + kFieldVariants;
constexpr uint32_t kNumberOfBookFlames = kNumberOfHaze + 1;
constexpr uint32_t kNumberOfHalf = kNumberOfBookFlames + kBookVariants;
constexpr uint32_t kNumberOfHalfComposite = kNumberOfHalf + 2;
constexpr uint32_t kNumberOfHalfSparks = kNumberOfHalf + 3;
constexpr uint32_t kNumberOfTransparency = kNumberOfHalfSparks + 2;
static_assert(std::size(kDrawPasses) == kNumberOfTransparency + 1);

// What was hidden by the Z-pass shows what is behind it, so others come first. The variants of
// fields are one step, in which they are drawn as they lie behind each other, and so are volumetric
// flames of all tiers. Haze bends what is solid alone. Where fields, quads and volumes are drawn at
// half resolution, they come over the picture at the end, and sparks after them.
constexpr auto kDrawSteps = [] {
    std::array<DrawStep, 2 * kSurfaceVariants + 11> steps{};
    for (uint32_t i = 0; i < kSurfaceVariants; ++i) {
        steps[i] = {i, false};
        steps[kSurfaceVariants + 1 + i] = {i, true};
    }
    steps[kSurfaceVariants] = {kNumberOfZPass, true};
    steps[2 * kSurfaceVariants + 1] = {kNumberOfHaze, false};
    steps[2 * kSurfaceVariants + 2] = {kNumberOfFields, false};
    steps[2 * kSurfaceVariants + 3] = {kNumberOfZPass + 1, false};
    steps[2 * kSurfaceVariants + 4] = {kNumberOfBookFlames, false};
    steps[2 * kSurfaceVariants + 5] = {kNumberOfBookFlames + 1, false};
    steps[2 * kSurfaceVariants + 6] = {kNumberOfVolumes, false};
    steps[2 * kSurfaceVariants + 7] = {kNumberOfHalfComposite, false};
    steps[2 * kSurfaceVariants + 8] = {kNumberOfHalfSparks, false};
    steps[2 * kSurfaceVariants + 9] = {kNumberOfHalfSparks + 1, false};
    steps[2 * kSurfaceVariants + 10] = {kNumberOfTransparency, false};
    return steps;
}();

uint32_t groupsOf(uint32_t items) { return std::min((items + 63) / 64, kMaxGroups); }

void zeroRow(vk::FrameRecorder& recorder, uint32_t row) {
    recorder.fillZero(FW_BIND_COUNTERS, row * kRowBytes, kRowBytes);
}

}  // namespace

std::span<const ComputePass* const> computePasses() { return kComputePasses; }
std::span<const DrawPass* const> drawPasses() { return kDrawPasses; }
std::span<const DrawStep> drawSteps() { return kDrawSteps; }

size_t passNumber(const ComputePass& pass) {
    return size_t(std::find(std::begin(kComputePasses), std::end(kComputePasses), &pass) -
                  std::begin(kComputePasses));
}

size_t passNumber(const DrawPass& pass) {
    return size_t(std::find(std::begin(kDrawPasses), std::end(kDrawPasses), &pass) -
                  std::begin(kDrawPasses));
}

void recordCounters(vk::FrameRecorder& recorder, FrameLists& lists, uint32_t iterations) {
    if (lists.row != kRowIteration)
        recorder.copyWithin(FW_BIND_COUNTERS, lists.row * kRowBytes + kListPart,
                            kRowIteration * kRowBytes + kListPart, kRowBytes - kListPart);
    recorder.fillZero(FW_BIND_COUNTERS, kRowIteration * kRowBytes, kListPart);
    if (iterations)
        recorder.fillZero(FW_BIND_COUNTERS, (kRowIteration + 1) * kRowBytes,
                          iterations * kRowBytes);
    lists.row = kRowIteration;
}

void recordReset(vk::FrameRecorder& recorder, uint32_t object, uint32_t tiles) {
    StepPush push{};
    push.object = object;
    recorder.fillZero(FW_BIND_OBJECT_COUNTERS, object * sizeof(ObjectCounters),
                      sizeof(ObjectCounters));
    recorder.dispatch(kResetPass, &push, std::min(tiles, kMaxGroups));
}

namespace {

// `grant`: what asked to burn is let to with it.
void recordExchange(vk::FrameRecorder& recorder, const FrameLists& lists, const StepRecord& step,
                    const StepPush& grant) {
    ExchangePush push = step.rules;
    push.now = step.now + kStepTicks;
    push.burnParity = lists.burnParity;
    push.row = lists.row;
    push.parity = lists.parity;
    push.predictParity = lists.predictParity;
    push.switches = grant.switches;
    push.hotParity = lists.hotParity;
    push.count = step.objectSlots;
    zeroRow(recorder, kRowExchange);
    recorder.dispatchRun(kFireCellsPass, &push, kRowBurn + lists.burnParity);
    recorder.dispatch(kFireSourcesPass, &push, std::max(groupsOf(push.count), 1u));
    if (push.warms != 0) {
        recorder.dispatch(kReceiversPass, &push, std::max(groupsOf(push.count), 1u));
        recorder.dispatchRun(push.shieldCell != 0 ? kExchangeShieldPass : kExchangePass, &push,
                             kRowExchange);
    }
    const bool touches = (push.flags & kRemoteContact) && step.links;
    const bool parts = (push.flags & kRemoteContact) && step.parts;
    const bool throws = (push.flags & kRemoteEmbers) != 0;
    if (throws) recorder.dispatch(kEmberWaysPass, &push, std::max(groupsOf(push.count), 1u));
    const auto light = [&] {
        push.count = step.links;
        if (touches) recorder.dispatch(kContactsPass, &push, (step.links + 63) / 64);
        push.count = step.objectSlots;
        if (parts) recorder.dispatchRun(kPartsPass, &push, kRowBurn + lists.burnParity);
        if (throws) recorder.dispatch(kEmbersPass, &push, std::max(groupsOf(push.count), 1u));
    };
    if (step.capped && (touches || parts || throws)) {
        push.switches |= kSwitchAsks;
        light();
        push.switches &= ~kSwitchAsks;
        recorder.dispatch(kGrantPass, &grant, 1);
    }
    light();
}

// Events that address all texels of an object, with a group for each tile and row of the list: many
// events of single texels between two such rows are left out.
void recordWholeObjects(vk::FrameRecorder& recorder, const StepRecord& step, StepPush& push) {
    constexpr uint32_t kMostBetween = 16;
    const auto count = uint32_t(step.allTiles != 0 ? step.eventList.size() : 0);
    for (uint32_t first = 0, end = 0; first < count; first = end) {
        end = first + 1;
        if (!addressesAll(step.eventList[first])) continue;
        for (uint32_t i = end; i < count && i <= end + kMostBetween && i - first < kMaxGroups; ++i)
            if (addressesAll(step.eventList[i])) end = i + 1;
        push.object = first;
        recorder.dispatch(kEventsAllPass, &push, std::min(step.allTiles, kMaxGroups), end - first);
    }
}

}  // namespace

bool addressesAll(const TexelEvent& event) noexcept {
    const uint32_t kind = eventKind(event.kind);
    return event.texel == kNoneTexel && kind != kEventGate && kind != kEventPlays;
}

void recordStep(vk::FrameRecorder& recorder, FrameLists& lists, const StepRecord& step) {
    const bool dense = (step.switches & kSwitchDense) != 0;
    const auto pushNow = [&] {
        StepPush push{};
        push.now = step.now;
        push.stepShift = step.stepShift;
        push.row = lists.row;
        push.parity = lists.parity;
        push.burnParity = lists.burnParity;
        push.predictParity = lists.predictParity;
        push.hotParity = lists.hotParity;
        push.switches = step.switches | (step.governed ? kSwitchGoverned : 0u) |
                        (step.capped ? kSwitchCapped : 0u) | (step.plays ? kSwitchPlays : 0u);
        push.tilesMost = step.rules.tilesMost;
        return push;
    };
    StepPush push = pushNow();
    // What lights, with `push`; where tiles are limited it asks before.
    const auto askThen = [&](const auto& light) {
        if (step.capped) {
            push.switches |= kSwitchAsks;
            light();
            push.switches &= ~kSwitchAsks;
            recorder.dispatch(kGrantPass, &push, 1);
        }
        light();
    };
    if (step.wakeGroups.count) {
        recorder.copyIn(step.wakeGroups.at, FW_BIND_WAKE_GROUPS, 0,
                        uint64_t(step.wakeGroups.count) * 8);
        push.count = step.wakeGroups.count;
        if (!dense) recorder.dispatch(kWakePass, &push, std::min(push.count, kMaxGroups));
    }
    if (step.events.count) {
        recorder.copyIn(step.events.at, FW_BIND_EVENTS, 0,
                        uint64_t(step.events.count) * sizeof(TexelEvent));
        push.count = step.events.count;
        askThen([&] {
            recorder.dispatch(kEventsPass, &push, (push.count + 63) / 64);
            recordWholeObjects(recorder, step, push);
        });
    }
    if (step.rooms) {
        push = pushNow();
        push.count = step.objectSlots;
        recorder.dispatch(kRoomsPass, &push, 1);
    }
    if (step.heat) {
        push = pushNow();
        zeroRow(recorder, kRowHot + (lists.hotParity ^ 1));
        askThen([&] { recorder.dispatchList(kHeatPass, &push, kRowHot + lists.hotParity); });
        lists.hotParity ^= 1;
    }
    for (uint32_t k = 0; step.iterate && k < 1u << step.stepShift; ++k) {
        push = pushNow();
        push.iteration = k;
        push.count = step.wakeGroups.count;
        if (dense)
            recorder.dispatch(kSchedulePass, &push, std::min(std::max(push.count, 1u), kMaxGroups));
        else
            recorder.dispatchList(kSchedulePass, &push, lists.row);
        recorder.dispatchRun(kGatherPass, &push, lists.row);
        recorder.dispatchWork(kArrivalPass, &push, lists.row);
        recorder.dispatchRim(kArrivalRimPass, &push, lists.row);
        if (step.capped) {
            push.switches |= kSwitchAsks;
            recorder.dispatch(kGrantPass, &push, 1);
            push.switches &= ~kSwitchAsks;
        }
        recorder.dispatchWork(kCommitPass, &push, lists.row);
        lists.row += 1;
        lists.parity ^= 1;
    }
    push = pushNow();
    if (!step.published.empty())
        askThen([&] {
            for (const PublishedStep& object : step.published) {
                push.object = object.object;
                push.publishedParity = object.parity;
                recorder.dispatch(kPublishedPass, &push, std::min(object.groups, kMaxGroups));
            }
        });
    if (!step.reduce) return;
    push = pushNow();
    push.now = step.now + kStepTicks;
    push.count = step.objectSlots;
    zeroRow(recorder, kRowBurn + (lists.burnParity ^ 1));
    recorder.dispatch(kReduceClearPass, &push, std::max(groupsOf(push.count), 1u));
    recorder.dispatchList(kReduceFrontPass, &push, lists.row);
    recorder.dispatchList(kReducePass, &push, kRowBurn + lists.burnParity);
    lists.burnParity ^= 1;
    if (!step.exchange) return;
    push = pushNow();
    push.now = step.now + kStepTicks;
    recordExchange(recorder, lists, step, push);
}

void recordPredictAnew(vk::FrameRecorder& recorder, const FrameLists& lists, uint32_t object,
                       uint32_t tiles) {
    StepPush push{};
    push.object = object;
    push.predictParity = lists.predictParity;
    recorder.dispatch(kPredictAnewPass, &push, std::min(std::max(groupsOf(tiles), 1u), kMaxGroups));
}

void recordPredict(vk::FrameRecorder& recorder, FrameLists& lists, uint32_t endTick, bool seen) {
    StepPush push{};
    push.now = endTick;
    push.predictParity = lists.predictParity;
    zeroRow(recorder, kRowPredict + (lists.predictParity ^ 1));
    const uint32_t row = kRowPredict + lists.predictParity;
    recorder.dispatchList(kPredictStatesPass, &push, row);
    recorder.dispatchList(kPredictGatherPass, &push, row);
    if (seen) {
        recorder.dispatchWork(kPredictPass, &push, row);
        recorder.dispatchRim(kPredictRimPass, &push, row);
        for (push.iteration = 0; push.iteration < 2; ++push.iteration)
            recorder.dispatchWork(kPredictCommitPass, &push, row);
    }
    lists.predictParity ^= 1;
}

void recordSupport(vk::FrameRecorder& recorder, uint32_t endTick, uint32_t ticks, uint32_t first,
                   uint32_t count) {
    StepPush push{};
    push.now = endTick;
    push.count = ticks;
    push.object = first;
    push.iteration = count;
    for (push.row = 0; push.row < 2; ++push.row)
        recorder.dispatch(kSupportPass, &push, groupsOf(count));
}

void recordSoot(vk::FrameRecorder& recorder, uint32_t ticks, uint32_t first, uint32_t count) {
    StepPush push{};
    push.count = ticks;
    push.object = first;
    push.iteration = count;
    recorder.dispatch(kSootPass, &push, std::min((count + 7) / 8, kMaxGroups));
}

void recordSkin(vk::FrameRecorder& recorder, const SkinPush& push) {
    recorder.dispatch(kSkinPass, &push, std::min(groupsOf(push.count), kMaxGroups));
}

void recordDeform(vk::FrameRecorder& recorder, const DeformRecord& deform) {
    if (deform.groups.count == 0) return;
    recorder.copyIn(deform.groups.at, FW_BIND_DEFORM_GROUPS, 0, uint64_t(deform.groups.count) * 8);
    const auto dispatch = [&](const ComputePass& pass, uint32_t first, uint32_t groups,
                              uint32_t parity) {
        DeformPush push = deform.push;
        push.parity = parity;
        for (uint32_t done = 0; done < groups; done += kMaxGroups) {
            push.first = first + done;
            recorder.dispatch(pass, &push, std::min(groups - done, kMaxGroups));
        }
    };
    const uint32_t sheets = deform.nodeGroups, springs = sheets + deform.sheetGroups;
    dispatch(kRecedePass, 0, deform.nodeGroups, deform.steps << 1);
    // Whoever begins knows of no link yet.
    if (deform.begins && !(deform.steps > 0 && tiesAt(deform.way)))
        dispatch(kTiesPass, sheets, deform.sheetGroups, 0);
    for (uint32_t i = 0; i < deform.steps; ++i) {
        const uint32_t way = (deform.way + i) % kArmWays;
        if (tiesAt(way)) dispatch(kTiesPass, sheets, deform.sheetGroups, i & 1);
        dispatch(kSoftPass, sheets, deform.sheetGroups, (i & 1) | way << 1);
        dispatch(kSpringsPass, springs, deform.springGroups, i & 1);
    }
    const uint32_t vertices = springs + deform.springGroups;
    dispatch(kDrapePass, vertices, deform.vertexGroups, 0);
    dispatch(kInnerPass, vertices + deform.vertexGroups, deform.innerGroups, 0);
}

void recordFields(vk::FrameRecorder& recorder, const FieldsRecord& fields) {
    if (fields.runs.count == 0) return;
    recorder.copyIn(fields.runs.at, FW_BIND_FIELD_RUNS, 0,
                    uint64_t(fields.runs.count) * sizeof(FieldRun));
    FieldPush push{};
    if (fields.masked) recorder.dispatch(kFieldMaskPass, &push, fields.masked);
    push.first = fields.masked;
    for (uint32_t i = 0; i < fields.rounds; ++i) {
        if (fields.groups[i] > 0) recorder.dispatch(kFieldPass, &push, fields.groups[i]);
        push.first += fields.groups[i] * kFieldUnits;
    }
}

void recordFieldShow(vk::FrameRecorder& recorder, uint32_t fields) {
    recorder.dispatch(kFieldShowPass, nullptr, fields * kFieldShowGroups);
}

void recordProbes(vk::FrameRecorder& recorder, const Staged& probes) {
    if (probes.count == 0) return;
    StepPush push{};
    push.count = probes.count;
    recorder.copyIn(probes.at, FW_BIND_PROBES, 0, uint64_t(probes.count) * 8);
    recorder.dispatch(kProbePass, &push, groupsOf(probes.count));
}

void recordDrawStep(const DrawStep& step, DrawRecorder& recorder, const DrawList& list) {
    if (step.pass < kSurfaceVariants)
        recordSurface(recorder, step.pass, list.surfaces, step.afterZ, list.turned);
    else if (step.pass == kNumberOfZPass)
        recordZPass(recorder, list.surfaces);
    else if (step.pass >= kNumberOfHalfSparks)
        recordHalfSparks(recorder);
    else if (step.pass != kNumberOfFields && step.pass != kNumberOfVolumes)  // bind by themselves
        recordFlames(recorder);
}

void recordVolumeRun(const VolumeRun& run, DrawRecorder& recorder, const DrawList& list) {
    if (run.pass == &kVolumePass)
        recordVolume(recorder, list.volumes.subspan(run.first, run.count));
    else if (run.pass == &kVolumeCardPass)
        recordVolumeCards(recorder, list.cards.subspan(run.first, run.count));
    else if (run.pass == &kVolumeSlicesPass)
        recordVolumeSlices(recorder, list.sliced.subspan(run.first, run.count));
    else if (run.pass == &kVolumeHazePass)
        recordVolumeHazes(recorder, list.hazes.subspan(run.first, run.count));
    else
        recordVolumeComposite(recorder, list.marched.subspan(run.first, run.count));
}

bool drawStepDraws(const DrawStep& step, const DrawList& list) {
    if (step.pass < kSurfaceVariants) return surfaceDraws(step.pass, list.surfaces, step.afterZ);
    if (step.pass == kNumberOfZPass) return zPassDraws(list.surfaces);
    if (step.pass == kNumberOfFields) return !list.fields.empty();
    if (kDrawPasses[step.pass] == &kFlamesPass) return list.flames && !list.books;
    if (step.pass >= kNumberOfBookFlames && step.pass < kNumberOfBookFlames + kBookVariants)
        return list.flames && list.books && list.pagesAlone == (step.pass > kNumberOfBookFlames);
    if (step.pass == kNumberOfHalfComposite) return list.half;
    if (step.pass == kNumberOfTransparency) return list.transparent;
    if (step.pass >= kNumberOfHalfSparks)
        return list.flames && list.books == (step.pass > kNumberOfHalfSparks);
    if (step.pass == kNumberOfHaze) return !list.hazes.empty();
    return !list.volumeRuns.empty();
}

void recordLights(vk::FrameRecorder& recorder, const FrameLists& lists, uint32_t endTick) {
    StepPush push{};
    push.now = endTick;
    push.burnParity = lists.burnParity;
    recorder.dispatch(kLightsPass, &push, 1);
}

void recordFlameQuads(vk::FrameRecorder& recorder, const FrameLists& lists, uint32_t endTick,
                      uint32_t books) {
    StepPush push{};
    push.count = books;
    push.now = endTick;
    push.burnParity = lists.burnParity;
    recorder.dispatch(kFlameQuadsPass, &push, 16);
}

void recordParticles(vk::FrameRecorder& recorder, const ParticlePush& push, uint32_t groups) {
    recorder.dispatch(kParticlesPass, &push, std::min(groups, kMaxGroups));
}

void recordNoQuads(vk::FrameRecorder& recorder) {
    recorder.fillZero(FW_BIND_DRAW_ARGS, 0, kFlameOrder * 4);
}

void recordParticleQuads(vk::FrameRecorder& recorder, const ParticlePush& push, uint32_t groups) {
    recorder.dispatch(kParticleQuadsPass, &push, std::min(groups, kMaxGroups));
}

void recordSparks(vk::FrameRecorder& recorder, const SparkPush& push, uint32_t sources) {
    recorder.dispatch(kSparksPass, &push, sources * kSparkGroups);
}

void recordFlameSort(vk::FrameRecorder& recorder, const SortPush& push) {
    recorder.dispatch(kFlameSortPass, &push, 1);
}

void recordVolumeMarch(vk::FrameRecorder& recorder, std::span<const MarchedVolume> volumes,
                       uint32_t first, uint32_t end, uint32_t cards) {
    if (volumes.empty()) return;
    if (end > first)
        recorder.fillZero(FW_BIND_VOLUME_RAYS, uint64_t(first) * 4, uint64_t(end - first) * 4);
    // Cells of cards that no tile has are read too.
    for (const MarchedVolume& one : volumes.last(cards))
        recorder.fillZero(FW_BIND_VOLUME_RAYS, uint64_t(one.march.tiles) * 4,
                          uint64_t(kCardWords) * 4);
    uint32_t last = 0;
    for (const MarchedVolume& one : volumes) last = std::max(last, one.march.flame);
    recorder.fillZero(FW_BIND_VOLUME_WORK, 0, (last + 1) * sizeof(VolumeWork));
    recorder.dispatchVolumes(kVolumeProbePass, volumes, vk::VolumesOf::all);
    const auto smokes = [](const MarchedVolume& one) { return one.smokes; };
    if (!std::all_of(volumes.begin(), volumes.end(), smokes))
        recorder.dispatchVolumes(kVolumeMarchPass, volumes, vk::VolumesOf::clear);
    if (std::any_of(volumes.begin(), volumes.end(), smokes))
        recorder.dispatchVolumes(kVolumeSmokePass, volumes, vk::VolumesOf::smoke);
}

namespace {

// Heat to levels, levels to triangles; what moves is listed to be placed.
void recordTurn(vk::FrameRecorder& recorder, const FrameLists& lists, const RefinePush& with,
                bool fresh) {
    RefinePush push = with;
    push.row = lists.row;
    push.parity = lists.parity;
    recorder.dispatchList(kRefineHeatPass, &push, lists.row);
    push.row = kRowBurn + lists.burnParity;
    push.parity = 2 + lists.burnParity;
    recorder.dispatchList(kRefineHeatPass, &push, push.row);
    push.parity = kRefineFreshHeat;
    if (fresh) recorder.dispatch(kRefineHeatPass, &push, std::min(push.objects, kMaxGroups));
    const uint32_t items = std::min(push.edgeGroups + push.triangleGroups, kMaxGroups),
                   triangles = std::min(push.triangleGroups, kMaxGroups);
    const uint32_t groups[5] = {items, push.budget ? triangles : 0, push.budget ? 1u : 0, items,
                                triangles};
    for (push.phase = 0; push.phase < 5; ++push.phase)
        if (groups[push.phase]) recorder.dispatch(kRefineLevelsPass, &push, groups[push.phase]);
    recorder.dispatch(kRefineScanPass, &push, std::min(push.objects, kMaxGroups));
    recorder.dispatchIndirect(kRefineEmitPass, &push, FW_BIND_REFINE_WORK, kRefineWorkEmit * 4);
}

}  // namespace

void recordRefine(vk::FrameRecorder& recorder, const FrameLists& lists, const RefinePush& with,
                  bool turn, bool cuts, bool fresh) {
    if (turn) recordTurn(recorder, lists, with, fresh);
    RefinePush push = with;
    push.phase = 0;
    recorder.dispatch(kRefinePlacePass, &push, std::min(push.cornerGroups, kMaxGroups));
    push.phase = 1;
    recorder.dispatchIndirect(kRefinePlacePass, &push, FW_BIND_REFINE_WORK, kRefineWorkEdges * 4);
    push.phase = 2;
    recorder.dispatchIndirect(kRefinePlacePass, &push, FW_BIND_REFINE_WORK, kRefineWorkPlace * 4);
    push.phase = 3;
    recorder.dispatchIndirect(kRefinePlacePass, &push, FW_BIND_REFINE_WORK, kRefineWorkMorph * 4);
    if (!turn || !cuts) return;
    push.phase = 0;
    recorder.dispatch(kRefineCutPass, &push, std::min(push.triangleGroups, kMaxGroups));
    push.phase = 1;
    recorder.dispatchIndirect(kRefineCutPass, &push, FW_BIND_REFINE_WORK, kRefineWorkCut * 4);
    push.phase = 2;
    recorder.dispatch(kRefineCutPass, &push, groupsOf(push.objects * kMaterialsPerObject));
}

void recordRefinePublished(vk::FrameRecorder& recorder, const ArpPush& with, uint32_t placeGroups,
                           uint32_t nameGroups) {
    ArpPush push = with;
    for (push.phase = 0; push.phase < 2; ++push.phase) {
        const uint32_t first = push.phase ? placeGroups : 0;
        const uint32_t groups = push.phase ? nameGroups : placeGroups;
        for (uint32_t done = 0; done < groups; done += kMaxGroups) {
            push.firstGroup = first + done;
            recorder.dispatch(kRefinePublishedPass, &push, std::min(groups - done, kMaxGroups));
        }
    }
}

}  // namespace fw::gpu
