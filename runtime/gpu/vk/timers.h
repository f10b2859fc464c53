// Time per pass by timestamp queries, read when the host says that the frame is done; debug labels.
// Never waits. Nothing where the queue family has no timestamps.
#pragma once
#include "gpu/backend.h"
#include "gpu/vk/device.h"

#include <array>

namespace fw::gpu::vk {

// Queries of one frame in flight.
class FrameTimers {
 public:
    static constexpr uint32_t kMaxSpans = 512;  // of a frame; further ones go untimed

    void create(Device& device);
    void destroy(Device& device) noexcept;
    // Outside of a pass.
    void reset(const Device& device, VkCommandBuffer commands);
    // Both no-ops before the first reset. Names are static strings.
    void begin(const Device& device, VkCommandBuffer commands, const char* name);
    void end(const Device& device, VkCommandBuffer commands);
    // Sums by name into out, which keeps its room. The frame is done.
    void read(Device& device, uint64_t frameIndex, std::pmr::vector<PassTime>& out);
    // Of another frame now: until reset() is recorded its pool holds the old frame's stamps, and a
    // frame that has nothing to do but draw records none.
    void forget() noexcept {
        spans_ = 0;
        armed_ = false;
    }

 private:
    VkQueryPool pool_ = VK_NULL_HANDLE;
    std::array<const char*, kMaxSpans> names_{};
    uint32_t spans_ = 0;
    bool open_ = false, armed_ = false;
};

// ms of the frame's passes in `times`; < 0: they are of another frame.
[[nodiscard]] float sumOf(std::span<const PassTime> times, uint64_t frameIndex) noexcept;

}  // namespace fw::gpu::vk
