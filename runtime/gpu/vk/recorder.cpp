#include "gpu/vk/recorder.h"

#include "gpu/passes/frame_graph.h"

#include <array>
#include <cstddef>

namespace fw::gpu::vk {

void FrameRecorder::barrier(std::span<const Use> uses) {
    t_.barriers->use(t_.device->table, t_.commands, uses, t_.view);
}

VkBuffer FrameRecorder::buffer(uint32_t resource) const {
    return t_.planes->buffer(resourceOf(resource, t_.view)).handle;
}

void FrameRecorder::bind(const ComputePass& pass, const void* push) {
    const Table& vk = t_.device->table;
    const size_t number = passNumber(pass);
    const PassObjects& objects = t_.pipelines->compute(number);
    barrier(pass.uses);
    t_.slot->timers.begin(*t_.device, t_.commands, pass.name);
    bool view = false;
    for (const Use& use : pass.uses) view |= use.access == Access::uniformView;
    const VkDescriptorSet set = t_.sets->compute(number, t_.view);
    vk.CmdBindPipeline(t_.commands, VK_PIPELINE_BIND_POINT_COMPUTE, objects.pipeline);
    vk.CmdBindDescriptorSets(t_.commands, VK_PIPELINE_BIND_POINT_COMPUTE, objects.layout, 0, 1,
                             &set, view ? 1 : 0, &t_.viewOffset);
    if (pass.pushBytes)
        vk.CmdPushConstants(t_.commands, objects.layout, VK_SHADER_STAGE_COMPUTE_BIT, 0,
                            pass.pushBytes, push);
}

void FrameRecorder::dispatch(const ComputePass& pass, const void* push, uint32_t groups,
                             uint32_t rows) {
    bind(pass, push);
    t_.device->table.CmdDispatch(t_.commands, groups, rows, 1);
    t_.slot->timers.end(*t_.device, t_.commands);
}

void FrameRecorder::dispatchVolumes(const ComputePass& pass, std::span<const MarchedVolume> volumes,
                                    VolumesOf which) {
    const Table& vk = t_.device->table;
    const size_t number = passNumber(pass);
    const PassObjects& objects = t_.pipelines->compute(number);
    barrier(pass.uses);
    t_.slot->timers.begin(*t_.device, t_.commands, pass.name);
    const VkBuffer work = buffer(FW_BIND_VOLUME_WORK);
    vk.CmdBindPipeline(t_.commands, VK_PIPELINE_BIND_POINT_COMPUTE, objects.pipeline);
    vk.CmdBindDescriptorSets(t_.commands, VK_PIPELINE_BIND_POINT_COMPUTE, objects.layout, 1, 1,
                             &t_.profiles, 0, nullptr);
    const VkDescriptorSet set = t_.sets->compute(number, t_.view);
    const bool listed = which != VolumesOf::all;
    for (const MarchedVolume& one : volumes) {
        if (listed && one.smokes != (which == VolumesOf::smoke)) continue;
        // In the order of their bindings: the view, the flame.
        const std::array<uint32_t, 2> offsets{t_.viewOffset, one.flame * kVolumeFlameBytes};
        vk.CmdBindDescriptorSets(t_.commands, VK_PIPELINE_BIND_POINT_COMPUTE, objects.layout, 0, 1,
                                 &set, uint32_t(offsets.size()), offsets.data());
        vk.CmdPushConstants(t_.commands, objects.layout, VK_SHADER_STAGE_COMPUTE_BIT, 0,
                            sizeof one.march, &one.march);
        if (listed)
            vk.CmdDispatchIndirect(
                t_.commands, work,
                one.march.flame * sizeof(VolumeWork) + offsetof(VolumeWork, groups));
        else
            vk.CmdDispatch(t_.commands,
                           volumeProbeBlocks(one.composite.tilesX, one.march.apart) *
                               volumeProbeBlocks(one.composite.tilesY, one.march.apart),
                           1, 1);
    }
    t_.slot->timers.end(*t_.device, t_.commands);
}

void FrameRecorder::dispatchAt(const ComputePass& pass, const void* push, uint64_t at) {
    bind(pass, push);
    t_.device->table.CmdDispatchIndirect(t_.commands, buffer(FW_BIND_COUNTERS), at);
    t_.slot->timers.end(*t_.device, t_.commands);
}

void FrameRecorder::dispatchIndirect(const ComputePass& pass, const void* push, uint32_t resource,
                                     uint64_t at) {
    bind(pass, push);
    t_.device->table.CmdDispatchIndirect(t_.commands, buffer(resource), at);
    t_.slot->timers.end(*t_.device, t_.commands);
}

void FrameRecorder::dispatchWork(const ComputePass& pass, const void* push, uint32_t row) {
    dispatchAt(pass, push, row * sizeof(IterationCounters) + offsetof(IterationCounters, workX));
}

void FrameRecorder::dispatchRim(const ComputePass& pass, const void* push, uint32_t row) {
    dispatchAt(pass, push, row * sizeof(IterationCounters) + offsetof(IterationCounters, rimX));
}

void FrameRecorder::dispatchRun(const ComputePass& pass, const void* push, uint32_t row) {
    dispatchAt(pass, push, row * sizeof(IterationCounters) + offsetof(IterationCounters, runX));
}

void FrameRecorder::dispatchList(const ComputePass& pass, const void* push, uint32_t row) {
    dispatchAt(pass, push, row * sizeof(IterationCounters) + offsetof(IterationCounters, listX));
}

void FrameRecorder::copyIn(uint64_t uploadAt, uint32_t resource, uint64_t at, uint64_t bytes) {
    const Use uses[] = {{resource, Access::copyWrite}};
    barrier(uses);
    const VkBufferCopy region{uploadAt, at, bytes};
    t_.device->table.CmdCopyBuffer(t_.commands, t_.slot->upload.handle, buffer(resource), 1,
                                   &region);
}

void FrameRecorder::copyWithin(uint32_t resource, uint64_t from, uint64_t at, uint64_t bytes) {
    const Use uses[] = {{resource, Access::copyRead}, {resource, Access::copyWrite}};
    barrier(uses);
    const VkBuffer handle = buffer(resource);
    const VkBufferCopy region{from, at, bytes};
    t_.device->table.CmdCopyBuffer(t_.commands, handle, handle, 1, &region);
}

void FrameRecorder::copyBetween(uint32_t from, uint32_t to, uint64_t at, uint64_t bytes) {
    const Use uses[] = {{from, Access::copyRead}, {to, Access::copyWrite}};
    barrier(uses);
    const VkBufferCopy region{at, at, bytes};
    t_.device->table.CmdCopyBuffer(t_.commands, buffer(from), buffer(to), 1, &region);
}

void FrameRecorder::copyOut(uint32_t resource, uint64_t from, uint64_t readbackAt, uint64_t bytes) {
    const Use uses[] = {{resource, Access::copyRead}};
    barrier(uses);
    const VkBufferCopy region{from, readbackAt, bytes};
    t_.device->table.CmdCopyBuffer(t_.commands, buffer(resource), t_.slot->readback.handle, 1,
                                   &region);
}

void FrameRecorder::fillZero(uint32_t resource, uint64_t at, uint64_t bytes) {
    const Use uses[] = {{resource, Access::copyWrite}};
    barrier(uses);
    t_.device->table.CmdFillBuffer(t_.commands, buffer(resource), at, bytes, 0);
}

}  // namespace fw::gpu::vk
