// The outside part of a frame: what waits is uploaded, the plan's steps are recorded, and the
// readback is copied. Everything that can fail comes before the first command.
#include "core/error.h"
#include "gpu/vk/world_state.h"

#include <algorithm>
#include <cstring>

namespace fw::gpu::vk {
namespace {

constexpr uint32_t kMaxGroups = 65535;

uint64_t alignUp(uint64_t value, uint64_t alignment) noexcept {
    return (value + alignment - 1) / alignment * alignment;
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

// Linear writes into the frame's upload buffer.
class UploadWriter {
 public:
    explicit UploadWriter(FrameInFlight& slot) : slot_(slot) {}
    template <class T>
    Staged write(std::span<const T> data) {
        const Staged staged{slot_.uploadUsed, uint32_t(data.size())};
        if (!data.empty())
            std::memcpy(slot_.upload.mapped + slot_.uploadUsed, data.data(), data.size_bytes());
        slot_.uploadUsed = alignUp(slot_.uploadUsed + data.size_bytes(), 16);
        return staged;
    }

 private:
    FrameInFlight& slot_;
};

struct WakeGroup {
    uint32_t object, firstTile;
};

uint32_t wakeGroupsOf(const ObjectEntry& object) noexcept {
    return (object.record.tileCount + 63) / 64;
}

Staged writeWakeGroups(FrameInFlight& slot, std::span<const ObjectEntry> objects,
                       std::span<const uint32_t> slots) {
    Staged staged{slot.uploadUsed, 0};
    for (const uint32_t object : slots) {
        const uint32_t groups = wakeGroupsOf(objects[object]);
        for (uint32_t g = 0; g < groups; ++g) {
            const WakeGroup group{object, g * 64};
            std::memcpy(slot.upload.mapped + slot.uploadUsed, &group, sizeof group);
            slot.uploadUsed += sizeof group;
            ++staged.count;
        }
    }
    slot.uploadUsed = alignUp(slot.uploadUsed, 16);
    return staged;
}

void recordImageUpload(const Table& vk, VkCommandBuffer commands, const PendingUpload& upload) {
    auto barrier = typed<VkImageMemoryBarrier>(VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER);
    barrier.dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
    barrier.oldLayout = VK_IMAGE_LAYOUT_UNDEFINED;
    barrier.newLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = upload.image;
    barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, upload.mips, 0, upload.layers};
    vk.CmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT,
                          VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, nullptr, 0, nullptr, 1, &barrier);
    uint64_t at = 0;
    for (uint32_t layer = 0; layer < upload.layers; ++layer) {
        for (uint32_t mip = 0; mip < upload.mips; ++mip) {
            VkBufferImageCopy region{};
            region.bufferOffset = at;
            region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, mip, layer, 1};
            region.imageExtent = {std::max(upload.width >> mip, 1u),
                                  std::max(upload.height >> mip, 1u), 1};
            vk.CmdCopyBufferToImage(commands, upload.staging.handle, upload.image,
                                    VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
            at += uint64_t(region.imageExtent.width) * region.imageExtent.height * 4;
        }
    }
    barrier.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
    barrier.dstAccessMask = VK_ACCESS_SHADER_READ_BIT;
    barrier.oldLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    barrier.newLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    vk.CmdPipelineBarrier(
        commands, VK_PIPELINE_STAGE_TRANSFER_BIT,
        VK_PIPELINE_STAGE_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, 0, 0, nullptr,
        0, nullptr, 1, &barrier);
}

}  // namespace

void VkBackend::State::openFrame(VkCommandBuffer commands, uint64_t ringFrame) {
    open = {};
    open.open = true;
    open.commands = commands;
    open.ringFrame = ringFrame;
}

RecordTarget VkBackend::State::recordTarget(FrameInFlight& slot,
                                            VkCommandBuffer commands) noexcept {
    RecordTarget target;
    target.device = &device;
    target.pipelines = &context.pipelines;
    target.sets = &sets;
    target.planes = &planes;
    target.barriers = &barriers;
    target.slot = &slot;
    target.commands = commands;
    return target;
}

uint32_t VkBackend::State::pushView(FrameInFlight& slot, const FwView& view,
                                    const VkViewport& viewport) {
    if (slot.views == FrameRing::kMaxViews)
        core::fail(FW_ERROR_INVALID_ARGUMENT,
                   "A frame is drawn with more than %u views; that is the limit.",
                   FrameRing::kMaxViews);
    ViewInput input;
    input.view = &view;
    input.viewport[0] = viewport.x;
    input.viewport[1] = viewport.y;
    input.viewport[2] = viewport.width;
    input.viewport[3] = viewport.height;
    input.now = shownTick;
    input.tickFraction = tickFraction;
    for (int i = 0; i < 3; ++i) {
        input.wind[i] = wind[i];
        input.up[i] = limits.up[i];
    }
    input.paceFactor = limits.paceFactor;
    input.lightCount = limits.maxLights;
    input.flameCapacity = std::min(limits.maxFlames, kFlameCapacity);
    input.seed = limits.seed;
    ViewParams params{};
    if (limits.looks.viewParams) limits.looks.viewParams(input, params);
    const uint32_t offset = (ring.indexOf(slot) * FrameRing::kMaxViews + slot.views) * viewStride;
    std::memcpy(views.mapped + offset, &params, sizeof params);
    ++slot.views;
    return offset;
}

void VkBackend::State::run(const FramePlan& plan) {
    if (!open.open || open.ran)
        core::fail(FW_ERROR_INTERNAL, "A frame's plan is run once, after the frame is begun.");
    open.planFrame = plan.frameIndex;
    open.endTick = plan.endTick;
    const bool dense = (plan.switches & kSwitchDense) != 0;
    const bool never = (plan.switches & 32u) != 0;  // FW_DEBUG_NEVER_IDLE

    // What the frame is made of.
    uint64_t uploadBytes = 0, denseGroups = 0, iterations = 0;
    uint32_t mostEvents = 0, mostWake = 0;
    bool stimulus = false, anyStep = false;
    if (recordsDirty) {
        for (const ObjectEntry& object : objects) {
            if (object.recordDirty) uploadBytes += alignUp(sizeof(BurnObject), 16);
            if (object.materialsDirty) uploadBytes += alignUp(sizeof object.materials, 16);
        }
    }
    if (dense) {
        for (const ObjectEntry& object : objects)
            denseGroups += object.live ? wakeGroupsOf(object) : 0;
    }
    published.clear();
    for (uint32_t i = 0; i < objects.size(); ++i) {
        const ObjectEntry& object = objects[i];
        if (!object.live || !(object.record.flags & kObjectPublished)) continue;
        published.push_back(
            {i, ((object.record.width + 15) / 16) * ((object.record.height + 15) / 16), 0});
    }
    bool emptySoFar = frontEmpty;
    for (const StepPlan& step : plan.steps) {
        if (step.events.size() > size_t(kMaxGroups) * 64)
            core::fail(FW_ERROR_INVALID_ARGUMENT, "One step has %zu texel events; the limit is %u.",
                       step.events.size(), kMaxGroups * 64);
        mostEvents = std::max(mostEvents, uint32_t(step.events.size()));
        uploadBytes += alignUp(step.events.size_bytes(), 16);
        uint64_t wake = 0;
        for (const MaterialUpdate& update : step.materials) {
            uploadBytes += alignUp(sizeof update.materials, 16) + 16;
            wake += wakeGroupsOf(objects[update.object]);
        }
        if (dense) wake = denseGroups;
        mostWake = std::max(mostWake, uint32_t(wake));
        uploadBytes += alignUp(wake * sizeof(WakeGroup), 16);
        for (const TexelEvent& event : step.events) {
            if (event.kind == kEventWet || event.kind == kEventExtinguish)
                objects[event.object].lastDouse = open.ringFrame;
        }
        const bool fresh = !step.events.empty() || !step.materials.empty();
        stimulus |= fresh;
        emptySoFar &= !fresh;
        if (!emptySoFar || dense || never) iterations += uint64_t(1) << step.substepShift;
        anyStep = true;
    }
    // Once a dousing is over, what its object sees coming is forgotten and found anew: predictions
    // that lost their fire would keep each other alive.
    bool forgets = false;
    uint64_t forgetGroups = 0;
    for (ObjectEntry& object : objects) {
        object.forget = object.live && object.lastDouse != 0 && object.lastDouse < open.ringFrame &&
                        (anyStep || frontEmpty);
        if (!object.forget) continue;
        forgets = true;
        forgetGroups += wakeGroupsOf(object);
    }
    const bool findsAnew = forgets && anyStep && !frontEmpty && !dense;
    if (findsAnew) {
        mostWake += uint32_t(forgetGroups);
        uploadBytes += alignUp(forgetGroups * sizeof(WakeGroup), 16);
    }
    uploadBytes += alignUp(plan.probes.size_bytes(), 16);
    if (plan.burnMaps.size() > ReadbackLayout::kMaxMaps)
        core::fail(FW_ERROR_INVALID_ARGUMENT, "%zu burn maps are asked for; the limit is %u.",
                   plan.burnMaps.size(), ReadbackLayout::kMaxMaps);
    const auto mostIterations = uint64_t(planes.capacity(kSpaceIterations)) - kRowIteration - 1;
    if (iterations > mostIterations)
        core::fail(FW_ERROR_INVALID_ARGUMENT, "A frame has %llu iterations; the limit is %llu.",
                   (unsigned long long)iterations, (unsigned long long)mostIterations);
    const bool publishedRuns =
        anyStep &&
        (stimulus || std::any_of(published.begin(), published.end(), [&](const PublishedStep& one) {
             return objects[one.object].publishedTouched;
         }));
    const bool burning = !burnEmpty || stimulus || never;
    const bool predicting = !predictEmpty || stimulus || never;
    const bool stepping = anyStep && (iterations > 0 || burning || publishedRuns);
    const bool asked = !plan.probes.empty() || !plan.burnMaps.empty();
    open.readback = stepping || predicting || asked || burning;
    const bool work =
        open.readback || forgets || recordsDirty || !uploads.empty() || planes.movesPending();
    wind[0] = plan.wind[0];
    wind[1] = plan.wind[1];
    wind[2] = plan.wind[2];
    tickFraction = plan.tickFraction;

    // All that may fail.
    const uint64_t last = ring.newest();
    planes.atLeast(kSpaceEvents, mostEvents, last);
    planes.atLeast(kSpaceWakeGroups, mostWake, last);
    planes.atLeast(kSpaceProbes, uint32_t(plan.probes.size()), last);
    steps.clear();
    steps.reserve(plan.steps.size());
    open.ran = true;
    if (!work) {
        shownTick = plan.endTick;
        if (plan.frameIndex == 0) return;
        PendingReadback same;
        same.ringFrame = open.ringFrame;
        same.frameIndex = plan.frameIndex;
        same.endTick = plan.endTick;
        pushPending(same);
        return;
    }
    FrameInFlight& slot = ring.slotFor(open.ringFrame);
    ReadbackLayout layout;
    layout.frameIndex = plan.frameIndex;
    layout.endTick = plan.endTick;
    layout.objects = uint32_t(objects.size());
    layout.answers = uint32_t(plan.probes.size());
    layout.lights = limits.maxLights;
    uint64_t readbackBytes = 0;
    const auto place = [&](uint64_t bytes) {
        const uint64_t at = readbackBytes;
        readbackBytes = alignUp(readbackBytes + bytes, 16);
        return at;
    };
    const uint64_t lastRow = iterations ? kRowIteration + iterations : lists.row;
    layout.countersAt = place((lastRow + 1) * sizeof(IterationCounters));
    layout.objectsAt = place(layout.objects * sizeof(ObjectCounters));
    layout.answersAt = place(uint64_t(layout.answers) * 4);
    layout.lightsAt = place(uint64_t(layout.lights) * sizeof(BurnLight));
    layout.flamesAt = place(16);
    for (const uint32_t object : plan.burnMaps) {
        ReadbackLayout::MapAt& map = layout.maps[layout.mapCount++];
        map.object = object;
        map.texels = objects[object].record.width * objects[object].record.height;
        map.at = place(uint64_t(map.texels) * 4);
    }
    try {
        if (slot.upload.size < uploadBytes || (open.readback && slot.readback.size < readbackBytes))
            slot.readbackPending = false;
        ensure(*this, slot.upload, uploadBytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
               MemoryKind::upload, kComponentStaging, "frame upload");
        if (open.readback)
            ensure(*this, slot.readback, readbackBytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                   MemoryKind::readback, kComponentReadback, "frame readback");
        sets.update(planes, views.handle, sizeof(ViewParams), last);
    } catch (...) {
        open.ran = false;
        throw;
    }

    // From here on nothing fails.
    const Table& vk = device.table;
    open.slot = &slot;
    open.recording = true;
    slot.layout = layout;
    barriers.begin(vk, open.commands);
    slot.timers.reset(device, open.commands);
    RecordTarget target = recordTarget(slot, open.commands);
    FrameRecorder recorder(target);
    if (planes.recordMoves(vk, open.commands, open.ringFrame)) {
        barriers.begin(vk, open.commands);  // rare: waits for all of the moves
    }
    if (!initialized) {
        for (const uint32_t resource : {FW_BIND_COUNTERS, FW_BIND_OBJECT_COUNTERS, FW_BIND_LIGHTS,
                                        FW_BIND_LIGHT_CELLS, FW_BIND_DRAW_ARGS, FW_BIND_OBJECTS})
            recorder.fillZero(resource, 0, VK_WHOLE_SIZE);
        initialized = true;
    }
    bool reset = false;
    for (PendingUpload& upload : uploads) {
        if (upload.image) recordImageUpload(vk, open.commands, upload);
        for (uint32_t i = 0; i < upload.regionCount; ++i) {
            const PendingUpload::Region& region = upload.regions[i];
            const Use uses[] = {{region.resource, Access::copyWrite}};
            barriers.use(vk, open.commands, uses);
            const VkBufferCopy copy{region.from, region.at, region.bytes};
            vk.CmdCopyBuffer(open.commands, upload.staging.handle,
                             planes.buffer(region.resource).handle, 1, &copy);
        }
        retired.push(open.ringFrame, upload.staging);
    }
    uploads.clear();
    UploadWriter writer(slot);
    if (recordsDirty) {
        for (uint32_t i = 0; i < objects.size(); ++i) {
            ObjectEntry& object = objects[i];
            if (object.recordDirty) {
                const Staged staged = writer.write(std::span<const BurnObject>(&object.record, 1));
                recorder.copyIn(staged.at, FW_BIND_OBJECTS, uint64_t(i) * sizeof(BurnObject),
                                sizeof(BurnObject));
            }
            if (object.materialsDirty) {
                const Staged staged = writer.write(std::span<const BurnMaterial>(object.materials));
                recorder.copyIn(staged.at, FW_BIND_MATERIALS, i * sizeof object.materials,
                                sizeof object.materials);
            }
            object.recordDirty = object.materialsDirty = false;
            reset |= object.resetDue;
        }
        for (uint32_t i = 0; reset && i < objects.size(); ++i) {
            ObjectEntry& object = objects[i];
            if (!object.resetDue) continue;
            recordReset(recorder, i, object.record.tileCount);
            object.resetDue = false;
        }
        recordsDirty = false;
        drawItems.clear();
        for (uint32_t i = 0; i < objects.size(); ++i) {
            const ObjectEntry& object = objects[i];
            if (!object.live || (object.record.flags & kObjectHidden)) continue;
            const MeshEntry& mesh = meshes[object.mesh];
            drawItems.push_back({i, mesh.indexRange.first, mesh.indices,
                                 int32_t(mesh.vertexRange.first), object.record.image,
                                 surfaceVariant(object.materials, object.touched)});
        }
    }
    for (ObjectEntry& object : objects) {
        if (!object.forget) continue;
        recorder.copyBetween(FW_BIND_STATE, FW_BIND_PREDICT, uint64_t(object.record.stateBase) * 4,
                             uint64_t(object.record.width) * object.record.height * 4);
        object.lastDouse = 0;
    }
    drawVertices = planes.buffer(kResourceVertices).handle;
    drawIndices = planes.buffer(kResourceIndices).handle;

    if (iterations) recordCounters(recorder, lists, uint32_t(iterations));
    slot.layout.firstRow = lists.row;
    emptySoFar = frontEmpty;
    for (const StepPlan& plannedStep : plan.steps) {
        StepRecord step;
        step.now = plannedStep.now;
        step.stepShift = plannedStep.substepShift;
        step.switches = plan.switches;
        step.objectSlots = uint32_t(objects.size());
        const bool fresh = !plannedStep.events.empty() || !plannedStep.materials.empty();
        emptySoFar &= !fresh;
        step.iterate = !emptySoFar || dense || never;
        step.reduce = plannedStep.reduce && burning;
        for (const MaterialUpdate& update : plannedStep.materials) {
            ObjectEntry& object = objects[update.object];
            std::copy(std::begin(update.materials), std::end(update.materials),
                      std::begin(object.materials));
            object.record.window = update.window;
            object.record.substepShift = update.substepShift;
            const Staged staged = writer.write(std::span<const BurnMaterial>(object.materials));
            recorder.copyIn(staged.at, FW_BIND_MATERIALS,
                            uint64_t(update.object) * sizeof object.materials,
                            sizeof object.materials);
            const uint32_t words[2] = {update.window, update.substepShift};
            static_assert(offsetof(BurnObject, substepShift) == offsetof(BurnObject, window) + 4);
            const Staged words2 = writer.write(std::span<const uint32_t>(words));
            recorder.copyIn(
                words2.at, FW_BIND_OBJECTS,
                uint64_t(update.object) * sizeof(BurnObject) + offsetof(BurnObject, window),
                sizeof words);
        }
        if (dense) {
            step.wakeGroups = {slot.uploadUsed, 0};
            for (uint32_t i = 0; i < objects.size(); ++i) {
                if (!objects[i].live) continue;
                const uint32_t one[] = {i};
                const uint64_t at = slot.uploadUsed;
                step.wakeGroups.count += writeWakeGroups(slot, objects, one).count;
                slot.uploadUsed = at + uint64_t(wakeGroupsOf(objects[i])) * sizeof(WakeGroup);
            }
            slot.uploadUsed = alignUp(slot.uploadUsed, 16);
        } else {
            step.wakeGroups = {slot.uploadUsed, 0};
            for (const MaterialUpdate& update : plannedStep.materials) {
                const uint32_t one[] = {update.object};
                const uint64_t at = slot.uploadUsed;
                step.wakeGroups.count += writeWakeGroups(slot, objects, one).count;
                slot.uploadUsed =
                    at + uint64_t(wakeGroupsOf(objects[update.object])) * sizeof(WakeGroup);
            }
            for (uint32_t i = 0; findsAnew && &plannedStep == &plan.steps[0] && i < objects.size();
                 ++i) {
                if (!objects[i].forget) continue;
                const uint32_t one[] = {i};
                const uint64_t at = slot.uploadUsed;
                step.wakeGroups.count += writeWakeGroups(slot, objects, one).count;
                slot.uploadUsed = at + uint64_t(wakeGroupsOf(objects[i])) * sizeof(WakeGroup);
            }
            slot.uploadUsed = alignUp(slot.uploadUsed, 16);
        }
        step.events = writer.write(plannedStep.events);
        for (const TexelEvent& event : plannedStep.events) {
            ObjectEntry& object = objects[event.object];
            object.publishedTouched |= (object.record.flags & kObjectPublished) != 0;
            if (object.touched) continue;
            object.touched = true;
            for (DrawItem& item : drawItems) {
                if (item.object == event.object)
                    item.variant = surfaceVariant(object.materials, true);
            }
        }
        if (publishedRuns) {
            for (PublishedStep& one : published) {
                one.parity = objects[one.object].publishedParity;
                objects[one.object].publishedParity ^= 1;
            }
            step.published = published;
        }
        recordStep(recorder, lists, step);
        frontWalks += step.iterate ? 1 : 0;
        burnWalks += step.reduce ? 1 : 0;
    }
    slot.layout.rows = lists.row;
    slot.layout.burnParity = lists.burnParity;
    if (stimulus) {
        lastStimulus = open.ringFrame;
        frontEmpty = burnEmpty = predictEmpty = false;
    }
    shownTick = plan.endTick;
    if (predicting) {
        recordPredict(recorder, lists, plan.endTick);
        ++predictWalks;
    }
    slot.layout.predictParity = lists.predictParity;
    if (!plan.probes.empty()) recordProbes(recorder, writer.write(plan.probes));
}

void VkBackend::State::closeFrame(const FwView* view) {
    if (!open.recording) {
        open = {};
        return;
    }
    const Table& vk = device.table;
    FrameInFlight& slot = *open.slot;
    RecordTarget target = recordTarget(slot, open.commands);
    if (view && !burnEmpty && limits.looks.viewParams) {
        const VkViewport whole{0, 0, 1, 1, 0, 1};
        target.viewOffset = pushView(slot, *view, whole);
        FrameRecorder looks(target);
        recordLooks(looks, lists, open.endTick);
    }
    FrameRecorder recorder(target);
    if (open.readback && open.planFrame) {
        const ReadbackLayout& layout = slot.layout;
        // Counters before the lists: rows that this frame used, and the one its list ended in.
        recorder.copyOut(FW_BIND_COUNTERS, 0, layout.countersAt,
                         uint64_t(layout.rows + 1) * sizeof(IterationCounters));
        if (layout.objects)
            recorder.copyOut(FW_BIND_OBJECT_COUNTERS, 0, layout.objectsAt,
                             layout.objects * sizeof(ObjectCounters));
        if (layout.answers)
            recorder.copyOut(FW_BIND_ANSWERS, 0, layout.answersAt, uint64_t(layout.answers) * 4);
        if (layout.lights)
            recorder.copyOut(FW_BIND_LIGHTS, 0, layout.lightsAt,
                             uint64_t(layout.lights) * sizeof(BurnLight));
        recorder.copyOut(FW_BIND_DRAW_ARGS, 0, layout.flamesAt, 16);
        for (uint32_t i = 0; i < layout.mapCount; ++i)
            recorder.copyOut(FW_BIND_STATE,
                             uint64_t(objects[layout.maps[i].object].record.stateBase) * 4,
                             layout.maps[i].at, uint64_t(layout.maps[i].texels) * 4);
        slot.readbackPending = true;
        PendingReadback one;
        one.ringFrame = open.ringFrame;
        one.slot = int32_t(ring.indexOf(slot));
        one.frameIndex = open.planFrame;
        one.endTick = open.endTick;
        pushPending(one);
    }
    barriers.end(vk, open.commands);
    open = {};
}

}  // namespace fw::gpu::vk
