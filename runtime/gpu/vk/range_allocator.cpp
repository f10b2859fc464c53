#include "gpu/vk/range_allocator.h"

#include "core/assert.h"
#include "core/growth.h"

#include <algorithm>

namespace fw::gpu::vk {

void RangeAllocator::addCapacity(uint64_t units) {
    core::growTo(free_, pieces_ + 3);
    if (freeAtEnd() > 0)
        free_.back().units += units;
    else if (units > 0)
        free_.push_back({capacity_, units});
    capacity_ += units;
}

void RangeAllocator::dropCapacity(uint64_t units) noexcept {
    FW_ASSERT(units <= freeAtEnd(), "%llu units of %llu free ones at the end",
              (unsigned long long)units, (unsigned long long)freeAtEnd());
    if (units == 0) return;
    free_.back().units -= units;
    if (free_.back().units == 0) free_.pop_back();
    capacity_ -= units;
}

uint64_t RangeAllocator::allocate(uint64_t units, uint64_t alignment) {
    FW_ASSERT(alignment > 0);
    for (size_t i = 0; i < free_.size(); ++i) {
        const Range range = free_[i];
        const uint64_t first = (range.first + alignment - 1) / alignment * alignment;
        if (first + units > range.end()) continue;
        core::growTo(free_, pieces_ + 3);
        const Range after{first + units, range.end() - first - units};
        auto at = free_.erase(free_.begin() + std::ptrdiff_t(i));
        if (after.units > 0) at = free_.insert(at, after);
        if (first > range.first) free_.insert(at, {range.first, first - range.first});
        used_ += units;
        ++pieces_;
        return first;
    }
    return kNoRange;
}

void RangeAllocator::release(uint64_t first, uint64_t units) noexcept {
    FW_ASSERT(pieces_ > 0 && units <= used_ && first + units <= capacity_,
              "%llu units from %llu on of %llu used ones", (unsigned long long)units,
              (unsigned long long)first, (unsigned long long)used_);
    FW_ASSERT(free_.size() < free_.capacity(), "allocate reserves what release needs");
    auto at =
        std::lower_bound(free_.begin(), free_.end(), first,
                         [](const Range& range, uint64_t wanted) { return range.first < wanted; });
    FW_ASSERT(at == free_.end() || first + units <= at->first, "a free range is released again");
    at = free_.insert(at, {first, units});
    if (at + 1 != free_.end() && at->end() == (at + 1)->first) {
        at->units += (at + 1)->units;
        free_.erase(at + 1);
    }
    if (at != free_.begin() && (at - 1)->end() == at->first) {
        (at - 1)->units += at->units;
        free_.erase(at);
    }
    used_ -= units;
    --pieces_;
}

}  // namespace fw::gpu::vk
