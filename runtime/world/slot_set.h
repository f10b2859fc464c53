// Slots, each at most once, in the order in which they came.
#pragma once
#include "core/assert.h"
#include "core/growth.h"

#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

namespace fw::world {

class SlotSet {
 public:
    explicit SlotSet(std::pmr::memory_resource* memory) : slots_(memory), has_(memory) {}

    // For all slots up to a number; throws std::bad_alloc.
    void reserve(size_t slots) {
        core::growTo(slots_, slots);
        core::growTo(has_, slots);
        if (has_.size() < slots) has_.resize(slots);
    }
    void add(uint32_t slot) noexcept {
        FW_ASSERT(slot < has_.size(), "slot %u of %zu", slot, has_.size());
        if (has_[slot]) return;
        has_[slot] = 1;
        slots_.push_back(slot);
    }
    [[nodiscard]] bool has(uint32_t slot) const noexcept {
        return slot < has_.size() && has_[slot] != 0;
    }
    template <class Goes>
    void eraseIf(const Goes& goes) noexcept {
        std::erase_if(slots_, [&](uint32_t slot) {
            if (goes(slot)) has_[slot] = 0;
            return has_[slot] == 0;
        });
    }
    void erase(uint32_t slot) noexcept {
        if (has(slot)) eraseIf([&](uint32_t one) { return one == slot; });
    }
    void clear() noexcept {
        for (const uint32_t slot : slots_) has_[slot] = 0;
        slots_.clear();
    }
    [[nodiscard]] std::span<const uint32_t> slots() const noexcept { return slots_; }
    [[nodiscard]] uint64_t bytes() const noexcept {
        return slots_.capacity() * sizeof(uint32_t) + has_.capacity();
    }

 private:
    std::pmr::vector<uint32_t> slots_;
    std::pmr::vector<uint8_t> has_;  // by slot
};

}  // namespace fw::world
