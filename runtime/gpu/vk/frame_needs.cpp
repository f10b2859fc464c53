#include "gpu/vk/frame_needs.h"

#include "core/error.h"
#include "flamewright/flamewright_debug.h"
#include "gpu/vk/vk_extension.h"
#include "shared/spark.h"

#include <algorithm>

namespace fw::gpu::vk {
namespace {

// A frame's own buffer of at least `bytes`; never shrinks. Throws and then left the old one.
void ensure(DeviceMemory& memory, Buffer& buffer, uint64_t bytes, MemoryKind kind) {
    if (buffer.size >= bytes) return;
    const bool reads = kind == MemoryKind::readback;
    Buffer fresh = memory.createBuffer(
        std::max<uint64_t>(bytes + bytes / 2, 65536),
        reads ? VK_BUFFER_USAGE_TRANSFER_DST_BIT : VK_BUFFER_USAGE_TRANSFER_SRC_BIT, kind,
        reads ? kComponentReadback : kComponentStaging, reads ? "frame readback" : "frame upload");
    memory.destroy(buffer);  // its frame is done: the slot was free
    buffer = fresh;
}

void addObjectNeeds(BackendState& s, uint64_t endTick, FrameNeeds& needs) {
    s.simulation.extended.clear();
    for (const uint32_t i : s.scene.awake) {
        ObjectEntry& object = s.scene.objects[i];
        if (object.recordDirty) needs.uploadBytes += uploaded(sizeof(BurnObject));
        if (object.materialsDirty)
            needs.uploadBytes += uploaded(sizeof object.materials) + uploaded(sizeof object.heat);
        if (object.deforms.recordDirty) needs.uploadBytes += uploaded(sizeof object.deform);
        s.deforming.addNeeds(s, i, endTick, needs);
        if (object.live && (object.record.flags & kObjectExtended) != 0)
            s.simulation.extended.push_back({i, extension()->vulkan->stepGroups(object.record), 0});
    }
    if (s.scene.roomsDirty) needs.uploadBytes += uploaded(sizeof s.scene.rooms);
}

void addExchangeNeeds(const ExchangeUpdate& update, FrameNeeds& needs) {
    needs.placing = true;
    needs.neighbours = std::max(needs.neighbours, uint32_t(update.neighbours.size()));
    needs.links = std::max(needs.links, uint32_t(update.links.size()));
    needs.uploadBytes += update.objects.size() * uploaded(sizeof(ExchangeObject)) +
                         uploaded(update.occluders.size_bytes());
    for (const ExchangeUpdate::Range& range : update.neighbourRanges)
        needs.uploadBytes += uploaded(range.count * sizeof(uint32_t));
    for (const ExchangeUpdate::Range& range : update.linkRanges)
        needs.uploadBytes += uploaded(range.count * sizeof(ContactLink));
}

// An event lights its object, or wets it or puts it out for some heat steps.
void markEvent(BackendState& s, const TexelEvent& event, uint32_t now, uint32_t endTick) {
    s.scene.noteFire(event.object, endTick);
    if (event.kind != kEventWet && event.kind != kEventExtinguish) return;
    ObjectEntry& object = s.scene.objects[event.object];
    object.burn.lastDouse = s.open.ringFrame;
    object.burn.douseEnds = now;
    if (object.record.flags & kObjectHeat)
        object.burn.douseEnds += (kSoakSteps + 2) * kHeatSteps * kStepTicks;
}

void addStepNeeds(BackendState& s, const FramePlan& plan, FrameNeeds& needs) {
    uint64_t denseGroups = 0;
    if (needs.dense)
        for (const ObjectEntry& object : s.scene.objects)
            denseGroups += object.live ? wakeGroupsOf(object) : 0;
    // A burning object may light another after its last front tile went.
    bool iterates = !s.simulation.frontEmpty || needs.dense || needs.never;
    for (const StepPlan& step : plan.steps) {
        iterates |= step.exchange && !s.simulation.burnEmpty;
        if (step.events.size() > size_t(kMaxGroups) * 64)
            core::refuse("One step has %zu texel events; the limit is %u.", step.events.size(),
                         kMaxGroups * 64);
        uint64_t wake = needs.dense ? denseGroups : 0;
        for (const MaterialUpdate& update : step.materials) {
            needs.uploadBytes += uploaded(sizeof update.materials) + kUploadAlignment;
            if (!needs.dense) wake += wakeGroupsOf(s.scene.objects[update.object]);
        }
        if (step.exchangeUpdate) addExchangeNeeds(*step.exchangeUpdate, needs);
        if (step.occlusionUpdate) {
            needs.placing = true;
            needs.occlusionWords =
                std::max(needs.occlusionWords, uint32_t(step.occlusionUpdate->words.size()));
            needs.uploadBytes += uploaded(step.occlusionUpdate->words.size_bytes());
        }
        needs.exchanges |= step.exchange;
        needs.airs |= step.rooms;
        needs.events = std::max(needs.events, uint32_t(step.events.size()));
        needs.wakeGroups = std::max(needs.wakeGroups, uint32_t(wake));
        needs.uploadBytes +=
            uploaded(step.events.size_bytes()) + uploaded(wake * sizeof(WakeGroup));
        for (const TexelEvent& event : step.events) markEvent(s, event, step.now, plan.endTick);
        needs.stimulus |= changesState(step);
        iterates |= changesState(step);
        if (iterates) needs.iterations += uint64_t(1) << step.substepShift;
    }
}

// Once a dousing is over, its object's predictions are forgotten and found again: predictions that
// lost their fire would keep each other alive. Whether there is such an object.
bool addForgetNeeds(BackendState& s, const FramePlan& plan, FrameNeeds& needs) {
    const bool anyStep = !plan.steps.empty();
    bool forgets = false;
    uint64_t groups = 0;
    for (const uint32_t i : s.scene.awake) {
        ObjectEntry& object = s.scene.objects[i];
        object.burn.forget = object.live && object.burn.lastDouse != 0 &&
                             object.burn.lastDouse < s.open.ringFrame &&
                             (anyStep || s.simulation.frontEmpty) &&
                             (plan.endTick > object.burn.douseEnds || s.simulation.frontEmpty);
        if (!object.burn.forget) continue;
        forgets = true;
        groups += wakeGroupsOf(object);
    }
    needs.rebuildsPrediction = forgets && anyStep && !s.simulation.frontEmpty && !needs.dense;
    if (needs.rebuildsPrediction) {
        needs.wakeGroups += uint32_t(groups);
        needs.uploadBytes += uploaded(groups * sizeof(WakeGroup));
    }
    return forgets;
}

void checkLimits(const BackendState& s, const FramePlan& plan, const FrameNeeds& needs) {
    if (plan.burnMaps.size() > ReadbackLayout::kMaxMaps)
        core::refuse("%zu burn maps are requested; the limit is %u.", plan.burnMaps.size(),
                     ReadbackLayout::kMaxMaps);
    const auto maxIterations = uint64_t(s.buffers.capacity(kPoolIterations)) - kRowIteration - 1;
    if (needs.iterations > maxIterations)
        core::refuse("A frame has %llu iterations; the limit is %llu.",
                     (unsigned long long)needs.iterations, (unsigned long long)maxIterations);
    if (plan.volumes && plan.volumes->count > kMaxVolumeFlames)
        core::refuse("%u volumetric flames are in a frame; the limit is %u.", plan.volumes->count,
                     kMaxVolumeFlames);
}

// Which passes have anything to do.
void choosePasses(BackendState& s, const FramePlan& plan, FrameNeeds& needs) {
    const bool anyStep = !plan.steps.empty();
    const bool wakes = needs.stimulus || needs.never;
    needs.extensionRuns =
        anyStep && std::any_of(s.simulation.extended.begin(), s.simulation.extended.end(),
                               [&](const ExtendedStep& one) {
                                   return needs.stimulus || needs.exchanges ||
                                          s.scene.objects[one.object].extensionTouched;
                               });
    needs.burning = !s.simulation.burnEmpty || wakes;
    needs.heating = !s.simulation.hotEmpty || (needs.exchanges && needs.burning) || wakes;
    addSeenNeeds(s, needs);
    needs.predicting =
        !s.simulation.predictEmpty || (needs.exchanges && needs.burning) || wakes || needs.appears;
    needs.falling = anyStep && s.scene.appearanceTextures.live &&
                    (needs.burning || plan.endTick < s.simulation.supportUntil);
    needs.readback = needs.burning || needs.predicting || needs.heating || needs.iterations > 0 ||
                     needs.extensionRuns || needs.airs || !plan.probes.empty() ||
                     !plan.burnMaps.empty() || !plan.images.empty();
}

}  // namespace

FrameNeeds needsOf(BackendState& s, const FramePlan& plan) {
    FrameNeeds needs;
    needs.stimulus = s.scene.restoreDue;
    needs.dense = (plan.switches & kSwitchDense) != 0;
    needs.never = (plan.switches & FW_DEBUG_NEVER_IDLE) != 0;
    addObjectNeeds(s, plan.endTick, needs);
    addStepNeeds(s, plan, needs);
    const bool forgets = addForgetNeeds(s, plan, needs);
    needs.uploadBytes += uploaded(uint64_t(needs.deform.all()) * sizeof(WakeGroup));
    needs.uploadBytes += uploaded(plan.probes.size_bytes());
    checkLimits(s, plan, needs);
    choosePasses(s, plan, needs);
    if (plan.volumes)
        needs.uploadBytes += uploaded(uint64_t(plan.volumes->count) * kVolumeFlameBytes) +
                             uploaded(uint64_t(plan.volumes->bodyCount) * sizeof(FlameBody));
    if (plan.emitters)
        needs.uploadBytes += uploaded(plan.emitters->count * sizeof(ParticleEmitter)) +
                             uploaded(plan.emitters->groups.size_bytes()) +
                             uploaded(plan.emitters->sparkCount * sizeof(SparkSource));
    s.particleFields.addNeeds(plan, needs);
    const uint64_t refineBytes =
        s.refine.plan(s, plan) + (extension() ? extension()->vulkan->planRefinement(s) : 0);
    needs.uploadBytes += refineBytes;
    needs.work = needs.readback || needs.falling || needs.deform.vertices > 0 || needs.skins ||
                 refineBytes > 0 || forgets || plan.volumes || plan.emitters ||
                 (s.particles.shows() && !s.open.unseen) ||
                 (!s.flames.volumes.empty() && !s.open.unseen) || needs.placing ||
                 s.scene.recordsDirty || s.scene.roomsDirty || s.particleFields.fieldsDirty ||
                 needs.fieldsShow || s.scene.uploads.size() > 0 || s.buffers.movesPending();
    return needs;
}

FrameInFlight& makeRoom(BackendState& s, const FramePlan& plan, const FrameNeeds& needs) {
    const uint64_t last = s.ring.newest();
    s.buffers.atLeast(kPoolEvents, needs.events, last);
    s.buffers.atLeast(kPoolWakeGroups, needs.wakeGroups, last);
    s.buffers.atLeast(kPoolProbes, uint32_t(plan.probes.size()), last);
    s.buffers.atLeast(kPoolDeformGroups, needs.deform.all(), last);
    s.buffers.atLeast(kPoolNeighbours, needs.neighbours, last);
    s.buffers.atLeast(kPoolContacts, needs.links, last);
    s.buffers.atLeast(kPoolOcclusion, needs.occlusionWords, last);
    s.buffers.atLeast(kPoolFieldRuns, needs.fieldRuns, last);
    if (plan.fields) {
        s.buffers.atLeast(kPoolFieldDraws, uint32_t(plan.fields->drawn.size()), last);
        s.particleFields.fieldDraws.reserve(plan.fields->drawn.size());
    }
    if (plan.volumes) {
        s.buffers.atLeast(kPoolVolumes, kVolumeWorks * plan.volumes->count, last);
        s.buffers.atLeast(kPoolBodies, plan.volumes->bodyCount, last);
        s.flames.volumes.reserve(plan.volumes->count);
    }
    if (plan.emitters) s.particles.makeRoom(s, *plan.emitters, last);
    const uint32_t volumes = plan.volumes ? plan.volumes->count : uint32_t(s.flames.volumes.size());
    const bool follows = !s.open.unseen || s.detail.memory < 1;  // a limit holds unseen, too
    s.outsideViews.makeRoom(s, volumes, follows, last);
    FrameInFlight& slot = s.ring.slotFor(s.open.ringFrame);
    uint64_t readbackBytes = 0;
    const ReadbackLayout layout =
        layoutReadback(s, plan, needs.iterations, needs.airs, readbackBytes);
    const bool reads = needs.readback || plan.frameIndex == 0;  // a picture counts its quads
    if (slot.upload.size < needs.uploadBytes || (reads && slot.readback.size < readbackBytes))
        slot.readbackPending = false;
    ensure(s.deviceMemory, slot.upload, needs.uploadBytes, MemoryKind::upload);
    if (reads) ensure(s.deviceMemory, slot.readback, readbackBytes, MemoryKind::readback);
    s.sets.update(s.buffers, s.views.handle, sizeof(ViewParams), last);
    for (const OutsideView* of : s.seenFrom())
        s.sets.update(s.buffers, s.views.handle, sizeof(ViewParams), last, of->number);
    slot.layout = layout;
    return slot;
}

}  // namespace fw::gpu::vk
