// What a plan asks of its frame, and room for it: everything that can fail, before the first
// command.
#include "core/error.h"
#include "flamewright/flamewright_debug.h"
#include "gpu/vk/frame_needs.h"
#include "shared/published.h"
#include "shared/spark.h"

#include <algorithm>

namespace fw::gpu::vk {
namespace {

uint32_t publishedGroups(const BurnObject& object) {
    const uint32_t blocks = object.width / kPublishedBlockX *
                            ((object.height + kPublishedBlockY - 1) / kPublishedBlockY);
    return groupsOf(blocks);
}

// A host-visible buffer of at least `bytes`; never shrinks. Throws and then left the old one.
void ensure(VkBackend::State& s, Buffer& buffer, uint64_t bytes, VkBufferUsageFlags usage,
            MemoryKind kind, Component component, const char* name) {
    if (buffer.size >= bytes) return;
    Buffer fresh = s.deviceMemory.createBuffer(std::max<uint64_t>(bytes + bytes / 2, 65536), usage,
                                               kind, component, name);
    s.deviceMemory.destroy(buffer);  // its frame is done: the slot was free
    buffer = fresh;
}

// Where the pieces of the frame's readback will lie; `bytes`: all of it.
ReadbackLayout layoutOf(VkBackend::State& s, const FramePlan& plan, const FrameNeeds& needs,
                        uint64_t& bytes) {
    ReadbackLayout layout;
    layout.frameIndex = plan.frameIndex;
    layout.endTick = plan.endTick;
    layout.objects = uint32_t(s.scene.objects.size());
    layout.answers = uint32_t(plan.probes.size());
    layout.lights = s.limits.maxLights;
    bytes = 0;
    const auto place = [&](uint64_t size) {
        const uint64_t at = bytes;
        bytes = alignUp(bytes + size, 16);
        return at;
    };
    const uint64_t lastRow =
        needs.iterations ? kRowIteration + needs.iterations : s.simulation.lists.row;
    layout.countersAt = place((lastRow + 1) * sizeof(IterationCounters));
    layout.objectsAt = place(layout.objects * sizeof(ObjectCounters));
    layout.answersAt = place(uint64_t(layout.answers) * sizeof(ProbeAnswer));
    layout.lightsAt = place(uint64_t(layout.lights) * sizeof(BurnLight));
    layout.flamesAt = place(16);
    layout.biasAt = place(4);
    layout.fields = uint32_t(s.particleFields.fields.size());
    layout.fieldsAt = place(layout.fields * sizeof(FieldCounters));
    layout.rooms = s.scene.airs || needs.airs;
    if (layout.rooms) layout.roomsAt = place(kMaxRooms * sizeof(RoomAir));
    for (const uint32_t object : plan.burnMaps) {
        ReadbackLayout::MapAt& map = layout.maps[layout.mapCount++];
        map.object = object;
        map.texels = s.scene.objects[object].record.width * s.scene.objects[object].record.height;
        map.at = place(uint64_t(map.texels) * 4);
        map.heat = (s.scene.objects[object].record.flags & kObjectHeat) != 0;
        if (map.heat) map.heatAt = place(uint64_t(map.texels) * sizeof(uvec2));
    }
    allocateImages(s, plan.images, layout, place);
    return layout;
}

}  // namespace

FrameNeeds needsOf(VkBackend::State& s, const FramePlan& plan) {
    FrameNeeds needs;
    needs.stimulus = s.scene.restoreDue;
    needs.dense = (plan.switches & kSwitchDense) != 0;
    needs.never = (plan.switches & FW_DEBUG_NEVER_IDLE) != 0;
    uint64_t denseGroups = 0;
    if (needs.dense)
        for (const ObjectEntry& object : s.scene.objects)
            denseGroups += object.live ? appendWakeGroups(object) : 0;
    s.simulation.published.clear();
    for (const uint32_t i : s.scene.awake) {
        ObjectEntry& object = s.scene.objects[i];
        if (object.recordDirty) needs.uploadBytes += uploaded(sizeof(BurnObject));
        if (object.materialsDirty)
            needs.uploadBytes += uploaded(sizeof object.materials) + uploaded(sizeof object.heat);
        if (object.deforms.recordDirty) needs.uploadBytes += uploaded(sizeof object.deform);
        addDeformNeeds(s, i, plan.endTick, needs);
        if (object.live && (object.record.flags & kObjectPublished) != 0)
            s.simulation.published.push_back({i, publishedGroups(object.record), 0});
    }
    if (s.scene.roomsDirty) needs.uploadBytes += uploaded(sizeof s.scene.rooms);
    const bool anyStep = !plan.steps.empty();
    // A burning object may light another after its last front tile went.
    bool iterates = !s.simulation.frontEmpty || needs.dense || needs.never;
    for (const StepPlan& step : plan.steps) {
        iterates |= step.exchange && !s.simulation.burnEmpty;
        if (step.events.size() > size_t(kMaxGroups) * 64)
            core::fail(FW_ERROR_INVALID_ARGUMENT, "One step has %zu texel events; the limit is %u.",
                       step.events.size(), kMaxGroups * 64);
        uint64_t wake = needs.dense ? denseGroups : 0;
        for (const MaterialUpdate& update : step.materials) {
            needs.uploadBytes += uploaded(sizeof update.materials) + kUploadAlignment;
            if (!needs.dense) wake += appendWakeGroups(s.scene.objects[update.object]);
        }
        if (step.remote) {
            const ExchangeUpdate& update = *step.remote;
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
        if (step.shield) {
            needs.placing = true;
            needs.occlusionWords =
                std::max(needs.occlusionWords, uint32_t(step.shield->words.size()));
            needs.uploadBytes += uploaded(step.shield->words.size_bytes());
        }
        needs.exchanges |= step.exchange;
        needs.airs |= step.rooms;
        needs.events = std::max(needs.events, uint32_t(step.events.size()));
        needs.wakeGroups = std::max(needs.wakeGroups, uint32_t(wake));
        needs.uploadBytes +=
            uploaded(step.events.size_bytes()) + uploaded(wake * sizeof(WakeGroup));
        for (const TexelEvent& event : step.events) {
            s.recordFire(event.object, plan.endTick);
            if (event.kind != kEventWet && event.kind != kEventExtinguish) continue;
            ObjectEntry& object = s.scene.objects[event.object];
            object.burn.lastDouse = s.open.ringFrame;
            object.burn.douseEnds = step.now;  // water takes some heat steps
            if (object.record.flags & kObjectHeat)
                object.burn.douseEnds += (kSoakSteps + 2) * kHeatSteps * kStepTicks;
        }
        needs.stimulus |= changesState(step);
        iterates |= changesState(step);
        if (iterates) needs.iterations += uint64_t(1) << step.substepShift;
    }
    // Once a dousing is over, what its object sees coming is forgotten and found again: predictions
    // that lost their fire would keep each other alive.
    bool forgets = false;
    uint64_t forgetGroups = 0;
    for (const uint32_t i : s.scene.awake) {
        ObjectEntry& object = s.scene.objects[i];
        object.burn.forget = object.live && object.burn.lastDouse != 0 &&
                             object.burn.lastDouse < s.open.ringFrame &&
                             (anyStep || s.simulation.frontEmpty) &&
                             (plan.endTick > object.burn.douseEnds || s.simulation.frontEmpty);
        if (!object.burn.forget) continue;
        forgets = true;
        forgetGroups += appendWakeGroups(object);
    }
    needs.rebuildsPrediction = forgets && anyStep && !s.simulation.frontEmpty && !needs.dense;
    if (needs.rebuildsPrediction) {
        needs.wakeGroups += uint32_t(forgetGroups);
        needs.uploadBytes += uploaded(forgetGroups * sizeof(WakeGroup));
    }
    needs.uploadBytes += uploaded(uint64_t(needs.deform.all()) * 8);
    needs.uploadBytes += uploaded(plan.probes.size_bytes());
    if (plan.burnMaps.size() > ReadbackLayout::kMaxMaps)
        core::fail(FW_ERROR_INVALID_ARGUMENT, "%zu burn maps are asked for; the limit is %u.",
                   plan.burnMaps.size(), ReadbackLayout::kMaxMaps);
    const auto maxIterations = uint64_t(s.buffers.capacity(kPoolIterations)) - kRowIteration - 1;
    if (needs.iterations > maxIterations)
        core::fail(FW_ERROR_INVALID_ARGUMENT, "A frame has %llu iterations; the limit is %llu.",
                   (unsigned long long)needs.iterations, (unsigned long long)maxIterations);
    needs.publishedRuns =
        anyStep && std::any_of(s.simulation.published.begin(), s.simulation.published.end(),
                               [&](const PublishedStep& one) {
                                   return needs.stimulus || needs.exchanges ||
                                          s.scene.objects[one.object].publishedTouched;
                               });
    needs.burning = !s.simulation.burnEmpty || needs.stimulus || needs.never;
    needs.heating = !s.simulation.hotEmpty || (needs.exchanges && needs.burning) ||
                    needs.stimulus || needs.never;
    addSeenNeeds(s, needs);
    needs.predicting = !s.simulation.predictEmpty || (needs.exchanges && needs.burning) ||
                       needs.stimulus || needs.never || needs.appears;
    needs.falling = anyStep && s.limits.looks.viewParams &&
                    (needs.burning || plan.endTick < s.simulation.supportUntil);
    needs.readback = needs.burning || needs.predicting || needs.heating || needs.iterations > 0 ||
                     needs.publishedRuns || needs.airs || !plan.probes.empty() ||
                     !plan.burnMaps.empty() || !plan.images.empty();
    if (plan.volumes) {
        if (plan.volumes->count > kMaxVolumeFlames)
            core::fail(FW_ERROR_INVALID_ARGUMENT,
                       "%u volumetric flames are in a frame; the limit is %u.", plan.volumes->count,
                       kMaxVolumeFlames);
        needs.uploadBytes += uploaded(uint64_t(plan.volumes->count) * kVolumeFlameBytes);
    }
    if (plan.emitters)
        needs.uploadBytes += uploaded(plan.emitters->count * sizeof(ParticleEmitter)) +
                             uploaded(plan.emitters->groups.size_bytes()) +
                             uploaded(plan.emitters->sparkCount * sizeof(SparkSource));
    addFieldNeeds(s, plan, needs);
    const uint64_t refineBytes = s.planRefine(plan) + s.planPatterns();
    needs.uploadBytes += refineBytes;
    needs.work = needs.readback || needs.falling || needs.deform.vertices > 0 || needs.skins ||
                 refineBytes > 0 || forgets || plan.volumes || plan.emitters ||
                 (s.showsEmitters() && !s.open.unseen) ||
                 (!s.flames.volumes.empty() && !s.open.unseen) || needs.placing ||
                 s.scene.recordsDirty || s.scene.roomsDirty || s.particleFields.fieldsDirty ||
                 needs.fieldsShow || !s.scene.uploads.empty() || s.buffers.movesPending();
    return needs;
}

FrameInFlight& makeRoom(VkBackend::State& s, const FramePlan& plan, const FrameNeeds& needs) {
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
        s.flames.volumes.reserve(plan.volumes->count);
    }
    if (plan.emitters) s.makeEmitterRoom(*plan.emitters, last);
    const uint32_t volumes = plan.volumes ? plan.volumes->count : uint32_t(s.flames.volumes.size());
    const bool follows = !s.open.unseen || s.detail.memory < 1;  // a limit holds unseen, too
    s.makeViewRoom(volumes, follows, last);
    FrameInFlight& slot = s.ring.slotFor(s.open.ringFrame);
    uint64_t readbackBytes = 0;
    const ReadbackLayout layout = layoutOf(s, plan, needs, readbackBytes);
    const bool reads = needs.readback || plan.frameIndex == 0;  // a picture tells what it shows
    if (slot.upload.size < needs.uploadBytes || (reads && slot.readback.size < readbackBytes))
        slot.readbackPending = false;
    ensure(s, slot.upload, needs.uploadBytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, MemoryKind::upload,
           kComponentStaging, "frame upload");
    if (reads)
        ensure(s, slot.readback, readbackBytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
               MemoryKind::readback, kComponentReadback, "frame readback");
    s.sets.update(s.buffers, s.views.handle, sizeof(ViewParams), last);
    for (const OutsideView* of : s.seenFrom())
        s.sets.update(s.buffers, s.views.handle, sizeof(ViewParams), last, of->number);
    slot.layout = layout;
    return slot;
}

}  // namespace fw::gpu::vk
