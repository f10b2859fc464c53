// Bytes on their way to buffers and images of the device: each upload waits in a staging buffer of
// its own until the next frame copies it.
#pragma once
#include "core/assert.h"
#include "gpu/vk/barriers.h"
#include "gpu/vk/world_buffers.h"

#include <cstring>
#include <span>

namespace fw::gpu::vk {

struct PendingUpload {
    struct Region {  // of a buffer
        uint32_t resource = 0;
        uint64_t from = 0, at = 0, bytes = 0;
    };
    static constexpr uint32_t kMaxRegions = 10;
    Buffer staging;
    uint64_t used = 0;  // bytes of it that regions have
    Region regions[kMaxRegions];
    uint32_t regionCount = 0;
    VkImage image = VK_NULL_HANDLE;  // instead of regions
    uint32_t width = 0, height = 0, mips = 1, layers = 1;
    uint32_t firstLayer = 0;

    // Where to write `bytes` that go to byte `at` of `resource`.
    std::byte* region(uint32_t resource, uint64_t at, uint64_t bytes) noexcept {
        FW_ASSERT(used + bytes <= staging.size, "%llu of %llu bytes",
                  (unsigned long long)(used + bytes), (unsigned long long)staging.size);
        std::byte* const to = staging.mapped + used;
        if (bytes == 0) return to;
        FW_ASSERT(regionCount < kMaxRegions, "%u regions", regionCount);
        regions[regionCount++] = {resource, used, at, bytes};
        used += bytes;
        return to;
    }
    // From element `first` of `resource` on.
    template <class T>
    void add(uint32_t resource, uint64_t first, std::span<const T> data) noexcept {
        std::byte* const to = region(resource, first * sizeof(T), data.size_bytes());
        if (!data.empty()) std::memcpy(to, data.data(), data.size_bytes());
    }
};

class UploadQueue {
 public:
    UploadQueue(DeviceMemory& deviceMemory, RetireQueue& retired, std::pmr::memory_resource* memory)
        : deviceMemory_(deviceMemory), retired_(retired), uploads_(memory) {}
    ~UploadQueue() { drop(0); }
    UploadQueue(const UploadQueue&) = delete;
    UploadQueue& operator=(const UploadQueue&) = delete;

    // Valid until the next call. Throws where memory is refused.
    PendingUpload& stage(uint64_t bytes, const char* name);
    void drop(size_t kept) noexcept;  // all but the first `kept`
    void dropFirst(size_t count) noexcept;
    void dropFor(VkImage image) noexcept;
    [[nodiscard]] size_t size() const noexcept { return uploads_.size(); }
    // Copies all, whose staging buffers go once frame `frameIndex` is done.
    void record(const Device& device, VkCommandBuffer commands, BarrierTracker& barriers,
                const WorldBuffers& buffers, uint64_t frameIndex) noexcept;

 private:
    DeviceMemory& deviceMemory_;
    RetireQueue& retired_;
    std::pmr::vector<PendingUpload> uploads_;
};

// Drops what was staged since it began, unless `keep` is called.
class UploadGuard {
 public:
    explicit UploadGuard(UploadQueue& queue) : queue_(queue), kept_(queue.size()) {}
    ~UploadGuard() { queue_.drop(kept_); }
    UploadGuard(const UploadGuard&) = delete;
    UploadGuard& operator=(const UploadGuard&) = delete;
    void keep() noexcept { kept_ = queue_.size(); }

 private:
    UploadQueue& queue_;
    size_t kept_;
};

}  // namespace fw::gpu::vk
