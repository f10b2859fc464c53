// A set of slots of a table, in order: a bit each, so that a walk skips 64 slots at once.
#pragma once
#include "core/assert.h"

#include <bit>
#include <cstdint>
#include <memory_resource>
#include <vector>

namespace fw::core {

class SlotSet {
 public:
    explicit SlotSet(std::pmr::memory_resource* memory) : words_(memory) {}

    // Makes space for slots below `end`. Only this function throws.
    void atLeast(uint32_t end) {
        if (words_.size() < (end + 63) / 64) words_.resize((end + 63) / 64);
    }
    void insert(uint32_t slot) noexcept {
        FW_ASSERT(slot / 64 < words_.size(), "slot %u of %zu", slot, words_.size() * 64);
        words_[slot / 64] |= bit(slot);
    }
    void erase(uint32_t slot) noexcept {
        FW_ASSERT(slot / 64 < words_.size(), "slot %u of %zu", slot, words_.size() * 64);
        words_[slot / 64] &= ~bit(slot);
    }
    [[nodiscard]] bool contains(uint32_t slot) const noexcept {
        return slot / 64 < words_.size() && (words_[slot / 64] & bit(slot)) != 0;
    }

    // Lowest first. A walk may erase its current slot; it may miss slots inserted meanwhile.
    struct End {};
    class Walk {
     public:
        explicit Walk(const std::pmr::vector<uint64_t>& words) noexcept : words_(words) {
            rest_ = words.empty() ? 0 : words[0];
            skip();
        }
        uint32_t operator*() const noexcept {
            FW_ASSERT(rest_ != 0, "the walk has ended");
            return at_ * 64 + uint32_t(std::countr_zero(rest_));
        }
        Walk& operator++() noexcept {
            rest_ &= rest_ - 1;
            skip();
            return *this;
        }
        bool operator!=(End) const noexcept { return rest_ != 0; }

     private:
        void skip() noexcept {
            while (rest_ == 0 && at_ + 1 < words_.size()) rest_ = words_[++at_];
        }
        const std::pmr::vector<uint64_t>& words_;
        uint32_t at_ = 0;
        uint64_t rest_ = 0;
    };
    [[nodiscard]] Walk begin() const noexcept { return Walk(words_); }
    [[nodiscard]] End end() const noexcept { return {}; }

 private:
    static constexpr uint64_t bit(uint32_t slot) noexcept { return uint64_t(1) << slot % 64; }
    std::pmr::vector<uint64_t> words_;
};

}  // namespace fw::core
