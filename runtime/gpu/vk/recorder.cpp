#include "gpu/vk/backend_state.h"

#include <algorithm>
#include <array>

namespace fw::gpu::vk {

void FrameRecorder::barrier(std::span<const Use> uses) {
    s_.barriers.use(s_.device.table, s_.open.commands, uses, view_);
}

VkBuffer FrameRecorder::buffer(uint32_t resource) const {
    return s_.buffers.buffer(resourceOf(resource, view_)).handle;
}

const PassObjects& FrameRecorder::begin(uint32_t pass, uint32_t arguments) {
    const PassObjects& objects = s_.context.pipelines.compute(pass);
    const std::span<const Use> bound = objects.declared.uses();
    std::array<Use, ShaderInterface::kMost + 1> uses;
    size_t count = size_t(std::copy(bound.begin(), bound.end(), uses.begin()) - uses.begin());
    if (arguments != kNoResource) uses[count++] = {arguments, Access::indirect};
    barrier({uses.data(), count});
    slot_.timers.begin(s_.device, s_.open.commands, computePasses()[pass].name);
    s_.device.table.CmdBindPipeline(s_.open.commands, VK_PIPELINE_BIND_POINT_COMPUTE,
                                    objects.pipeline);
    return objects;
}

void FrameRecorder::bind(uint32_t pass, const void* push, uint32_t arguments) {
    const Table& vk = s_.device.table;
    const PassObjects& objects = begin(pass, arguments);
    const VkDescriptorSet set = s_.sets.compute(pass, view_);
    vk.CmdBindDescriptorSets(s_.open.commands, VK_PIPELINE_BIND_POINT_COMPUTE, objects.layout, 0, 1,
                             &set, objects.declared.usesView() ? 1 : 0, &viewOffset_);
    if (const uint32_t bytes = computePasses()[pass].pushBytes)
        vk.CmdPushConstants(s_.open.commands, objects.layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, bytes,
                            push);
}

void FrameRecorder::end() { slot_.timers.end(s_.device, s_.open.commands); }

void FrameRecorder::dispatchGroups(uint32_t pass, const void* push, uint32_t groups,
                                   uint32_t rows) {
    FW_ASSERT(rows > 0 && rows <= kMaxGroups, "%u rows of pass %s", rows,
              computePasses()[pass].name);
    bind(pass, push, kNoResource);
    s_.device.table.CmdDispatch(s_.open.commands, std::min(groups, kMaxGroups), rows, 1);
    end();
}

void FrameRecorder::dispatchAt(uint32_t pass, const void* push, uint32_t resource, uint64_t at) {
    bind(pass, push, resource);
    s_.device.table.CmdDispatchIndirect(s_.open.commands, buffer(resource), at);
    end();
}

void FrameRecorder::dispatchVolumes(ComputePassOf<MarchPush> pass,
                                    std::span<const MarchedVolume> volumes, VolumesOf which) {
    const Table& vk = s_.device.table;
    const bool ofBodies = which >= VolumesOf::bodyFlames;
    const bool listed =
        which == VolumesOf::clear || which == VolumesOf::smoke || which == VolumesOf::bodies;
    const auto taken = [&](const MarchedVolume& one) {
        return one.body == ofBodies &&
               (!listed || ofBodies || one.smokes == (which == VolumesOf::smoke));
    };
    if (std::none_of(volumes.begin(), volumes.end(), taken)) return;
    const PassObjects& objects =
        begin(pass.number, listed ? uint32_t(FW_BIND_VOLUME_WORK) : kNoResource);
    const VkBuffer work = buffer(FW_BIND_VOLUME_WORK);
    if (objects.declared.sets() > 1)
        vk.CmdBindDescriptorSets(s_.open.commands, VK_PIPELINE_BIND_POINT_COMPUTE, objects.layout,
                                 1, 1, &s_.scene.profiles.set.set, 0, nullptr);
    const VkDescriptorSet set = s_.sets.compute(pass.number, view_);
    const bool usesView = objects.declared.usesView();
    const bool usesFlame = std::ranges::any_of(
        objects.declared.uses(), [](const Use& use) { return use.resource == FW_BIND_VOLUMES; });
    for (const MarchedVolume& one : volumes) {
        if (!taken(one)) continue;
        // In the order of their bindings: the view, the flame.
        std::array<uint32_t, 2> offsets{};
        uint32_t count = 0;
        if (usesView) offsets[count++] = viewOffset_;
        if (usesFlame) offsets[count++] = one.flame * kVolumeFlameBytes;
        vk.CmdBindDescriptorSets(s_.open.commands, VK_PIPELINE_BIND_POINT_COMPUTE, objects.layout,
                                 0, 1, &set, count, offsets.data());
        vk.CmdPushConstants(s_.open.commands, objects.layout, VK_SHADER_STAGE_COMPUTE_BIT, 0,
                            sizeof one.march, &one.march);
        if (listed)
            vk.CmdDispatchIndirect(
                s_.open.commands, work,
                one.march.flame * sizeof(VolumeWork) + offsetof(VolumeWork, groups));
        else if (ofBodies)
            vk.CmdDispatch(s_.open.commands,
                           groupsOf(which == VolumesOf::bodyFlames
                                        ? kBodyCells
                                        : one.composite.tilesX * one.composite.tilesY),
                           1, 1);
        else
            vk.CmdDispatch(s_.open.commands,
                           probeBlockCount(one.composite.tilesX, one.march.apart) *
                               probeBlockCount(one.composite.tilesY, one.march.apart),
                           1, 1);
    }
    end();
}

void FrameRecorder::copyIn(const Staged& staged, uint32_t resource, uint64_t at) {
    const Use uses[] = {{resource, Access::copyWrite}};
    copy(uses, slot_.upload.handle, buffer(resource), {staged.at, at, staged.bytes});
}

void FrameRecorder::copyBetween(const Place& from, const Place& to, uint64_t bytes) {
    const Use uses[] = {{from.resource, Access::copyRead}, {to.resource, Access::copyWrite}};
    copy(uses, buffer(from.resource), buffer(to.resource), {from.at, to.at, bytes});
}

void FrameRecorder::copyOut(uint32_t resource, uint64_t from, uint64_t readbackAt, uint64_t bytes) {
    FW_ASSERT(readbackAt + bytes <= slot_.readback.size, "%llu of %llu bytes of a readback",
              (unsigned long long)(readbackAt + bytes), (unsigned long long)slot_.readback.size);
    const Use uses[] = {{resource, Access::copyRead}};
    copy(uses, buffer(resource), slot_.readback.handle, {from, readbackAt, bytes});
}

void FrameRecorder::copy(std::span<const Use> uses, VkBuffer from, VkBuffer to,
                         const VkBufferCopy& region) {
    barrier(uses);
    s_.device.table.CmdCopyBuffer(s_.open.commands, from, to, 1, &region);
}

void FrameRecorder::fillZero(uint32_t resource, uint64_t at, uint64_t bytes) {
    const Use uses[] = {{resource, Access::copyWrite}};
    barrier(uses);
    s_.device.table.CmdFillBuffer(s_.open.commands, buffer(resource), at, bytes, 0);
}

}  // namespace fw::gpu::vk
