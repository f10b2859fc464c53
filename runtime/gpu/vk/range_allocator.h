// First-fit ranges of whole units, as device memory and pools of buffers are cut into. Not the
// memory itself.
#pragma once
#include <cstdint>
#include <memory_resource>
#include <vector>

namespace fw::gpu::vk {

class RangeAllocator {
 public:
    explicit RangeAllocator(std::pmr::memory_resource* memory) : free_(memory) {}
    static constexpr uint64_t kNoRange = ~0ull;
    void addCapacity(uint64_t units);            // at the end; may throw
    void dropCapacity(uint64_t units) noexcept;  // likewise, of what is free there
    // The first unit, a multiple of `alignment`; kNoRange: no free range is long enough.
    uint64_t allocate(uint64_t units, uint64_t alignment = 1);
    void release(uint64_t first, uint64_t units) noexcept;
    [[nodiscard]] uint64_t capacity() const noexcept { return capacity_; }
    [[nodiscard]] uint64_t used() const noexcept { return used_; }
    [[nodiscard]] uint64_t freeAtEnd() const noexcept {
        return !free_.empty() && free_.back().end() == capacity_ ? free_.back().units : 0;
    }

 private:
    struct Range {
        uint64_t first, units;
        [[nodiscard]] uint64_t end() const noexcept { return first + units; }
    };
    std::pmr::vector<Range>
        free_;  // by first; capacity for pieces_ + 3, so release never allocates
    uint64_t capacity_ = 0, used_ = 0;
    uint32_t pieces_ = 0;
};

}  // namespace fw::gpu::vk
