// One command buffer being recorded: dispatches, copies and draws by resource and pass, with their
// barriers, timers and labels. Knows no order: that is the frame graph's.
#pragma once
#include "gpu/passes/draw.h"
#include "gpu/vk/barriers.h"
#include "gpu/vk/descriptors.h"
#include "gpu/vk/frame_ring.h"

namespace fw::gpu::vk {

struct RecordTarget {  // what a recorder works on; all of it outlives the recorder
    const Device* device = nullptr;
    const Pipelines* pipelines = nullptr;
    const PassSets* sets = nullptr;
    const Planes* planes = nullptr;
    BarrierTracker* barriers = nullptr;
    FrameInFlight* slot = nullptr;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    uint32_t viewOffset = 0;                    // of the passes that use the view
    uint32_t view = 0;                          // whose resources they use
    VkDescriptorSet profiles = VK_NULL_HANDLE;  // of those that use the fire profiles
};

// Of volumetric flames: all, with the groups of the probe; or those with and without smoke, with
// the groups that the probe listed.
enum class VolumesOf : uint8_t { all, clear, smoke };

class FrameRecorder {
 public:
    explicit FrameRecorder(const RecordTarget& target) : t_(target) {}

    void dispatch(const ComputePass& pass, const void* push, uint32_t groups, uint32_t rows = 1);
    // Groups from a row of the counters: its work, rim, run or list part.
    void dispatchWork(const ComputePass& pass, const void* push, uint32_t row);
    void dispatchRim(const ComputePass& pass, const void* push, uint32_t row);
    void dispatchRun(const ComputePass& pass, const void* push, uint32_t row);
    void dispatchList(const ComputePass& pass, const void* push, uint32_t row);

    // Groups from four words of a resource.
    void dispatchIndirect(const ComputePass& pass, const void* push, uint32_t resource,
                          uint64_t at);

    // Those of them at once: none sees what another writes.
    void dispatchVolumes(const ComputePass& pass, std::span<const MarchedVolume> volumes,
                         VolumesOf which);

    void copyIn(uint64_t uploadAt, uint32_t resource, uint64_t at, uint64_t bytes);
    void copyWithin(uint32_t resource, uint64_t from, uint64_t at, uint64_t bytes);
    // The same range of another resource.
    void copyBetween(uint32_t from, uint32_t to, uint64_t at, uint64_t bytes);
    void copyOut(uint32_t resource, uint64_t from, uint64_t readbackAt, uint64_t bytes);
    void fillZero(uint32_t resource, uint64_t at, uint64_t bytes);

 private:
    void barrier(std::span<const Use> uses);
    [[nodiscard]] VkBuffer buffer(uint32_t resource) const;
    void bind(const ComputePass& pass, const void* push);
    void dispatchAt(const ComputePass& pass, const void* push, uint64_t at);

    RecordTarget t_;
};

}  // namespace fw::gpu::vk
