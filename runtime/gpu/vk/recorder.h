// One command buffer being recorded: dispatches, copies and draws by resource and pass, with their
// barriers, timers and labels. Knows no order: that is frame.cpp's.
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
    const WorldBuffers* buffers = nullptr;
    BarrierTracker* barriers = nullptr;
    FrameInFlight* slot = nullptr;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    uint32_t viewOffset = 0;                    // of the passes that use the view
    uint32_t view = 0;                          // whose resources they use
    VkDescriptorSet profiles = VK_NULL_HANDLE;  // of those that use the fire profiles
};

constexpr uint32_t kMaxGroups = 65535;  // of a dispatch at the floor; shaders stride over the rest
// Groups of 64 that hold so many.
constexpr uint32_t groupsOf(uint32_t items) noexcept { return (items + 63) / 64; }

// Volumetric flames: all, with the groups of the probe; or those with and without smoke, with the
// groups that the probe listed.
enum class VolumesOf : uint8_t { all, clear, smoke };

class FrameRecorder {
 public:
    explicit FrameRecorder(const RecordTarget& target) : t_(target) {}

    // At most kMaxGroups in a row.
    template <class Push>
    void dispatch(ComputePassOf<Push> pass, const Push& push, uint32_t groups, uint32_t rows = 1) {
        dispatchGroups(pass.number, &push, groups, rows);
    }
    // A group for each 64 items, at least one.
    template <class Push>
    void dispatchItems(ComputePassOf<Push> pass, const Push& push, uint32_t items) {
        dispatchGroups(pass.number, &push, std::max(groupsOf(items), 1u), 1);
    }
    // Groups from the work, rim, run or list part of a row of the counters.
    template <class Push>
    void dispatchWork(ComputePassOf<Push> pass, const Push& push, uint32_t row) {
        dispatchAt(pass.number, &push, FW_BIND_COUNTERS,
                   rowAt(row) + offsetof(IterationCounters, workX));
    }
    template <class Push>
    void dispatchRim(ComputePassOf<Push> pass, const Push& push, uint32_t row) {
        dispatchAt(pass.number, &push, FW_BIND_COUNTERS,
                   rowAt(row) + offsetof(IterationCounters, rimX));
    }
    template <class Push>
    void dispatchRun(ComputePassOf<Push> pass, const Push& push, uint32_t row) {
        dispatchAt(pass.number, &push, FW_BIND_COUNTERS,
                   rowAt(row) + offsetof(IterationCounters, runX));
    }
    template <class Push>
    void dispatchList(ComputePassOf<Push> pass, const Push& push, uint32_t row) {
        dispatchAt(pass.number, &push, FW_BIND_COUNTERS,
                   rowAt(row) + offsetof(IterationCounters, listX));
    }
    // Groups from three words of a resource, at `at` bytes.
    template <class Push>
    void dispatchIndirect(ComputePassOf<Push> pass, const Push& push, uint32_t resource,
                          uint64_t at) {
        dispatchAt(pass.number, &push, resource, at);
    }
    // Flames at once: none sees what another writes.
    void dispatchVolumes(ComputePassOf<MarchPush> pass, std::span<const MarchedVolume> volumes,
                         VolumesOf which);

    void copyIn(uint64_t uploadAt, uint32_t resource, uint64_t at, uint64_t bytes);
    void copyWithin(uint32_t resource, uint64_t from, uint64_t at, uint64_t bytes);
    // The same range of another resource.
    void copyBetween(uint32_t from, uint32_t to, uint64_t at, uint64_t bytes);
    void copyOut(uint32_t resource, uint64_t from, uint64_t readbackAt, uint64_t bytes);
    void fillZero(uint32_t resource, uint64_t at, uint64_t bytes);

 private:
    static constexpr uint64_t rowAt(uint32_t row) { return row * sizeof(IterationCounters); }
    void barrier(std::span<const Use> uses);
    [[nodiscard]] VkBuffer buffer(uint32_t resource) const;
    // Barrier, timer, pipeline. `arguments`: the resource that a dispatch takes its groups from, or
    // kNoResource.
    static constexpr uint32_t kNoResource = ~0u;
    const PassObjects& begin(uint32_t pass, uint32_t arguments);
    void bind(uint32_t pass, const void* push, uint32_t arguments);
    void end();
    void dispatchGroups(uint32_t pass, const void* push, uint32_t groups, uint32_t rows);
    void dispatchAt(uint32_t pass, const void* push, uint32_t resource, uint64_t at);

    RecordTarget t_;
};

}  // namespace fw::gpu::vk
