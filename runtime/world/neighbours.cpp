#include "world/neighbours.h"

#include <algorithm>

namespace fw::world {
namespace {

constexpr uint32_t kAllSeen = 255u << 24;

// Where `other` is in a list, or belongs.
uint32_t indexOf(std::span<const uint32_t> list, uint32_t other) noexcept {
    const auto at = std::lower_bound(
        list.begin(), list.end(), other,
        [](uint32_t entry, uint32_t wanted) { return (entry & Neighbours::kSlot) < wanted; });
    return uint32_t(at - list.begin());
}

}  // namespace

void Neighbours::note(uint32_t slot) noexcept {
    FW_ASSERT(slot < isChanged_.size(), "%u of %zu lists", slot, isChanged_.size());
    if (isChanged_[slot]) return;
    FW_ASSERT(changed_.size() < changed_.capacity(), "%zu lists", changed_.size());
    isChanged_[slot] = 1;
    changed_.push_back(slot);
}

void Neighbours::add(uint32_t slot, uint32_t other) noexcept {
    ListPlace& list = lists_[slot];
    FW_ASSERT(slot != other && other <= kSlot, "%u next to %u", slot, other);
    pool_.insert(list, indexOf(pool_.of(list), other), other | kAllSeen);
    note(slot);
}

void Neighbours::take(uint32_t slot, uint32_t other) noexcept {
    ListPlace& list = lists_[slot];
    pool_.erase(list, indexOf(pool_.of(list), other));
    note(slot);
}

void Neighbours::place(uint32_t slot, const mesh::Box& box, uint32_t reach) {
    if (slot >= lists_.size()) {
        core::growTo(lists_, slot + 1);
        core::growTo(marks_, slot + 1);
        core::growTo(isChanged_, slot + 1);
        core::growTo(changed_, slot + 1);
        lists_.resize(slot + 1);
        marks_.resize(slot + 1);
        isChanged_.resize(slot + 1);
    }
    grid_.place(slot, box, reach);
    const uint64_t had = ++mark_, stays = ++mark_;
    for (const uint32_t entry : pool_.of(lists_[slot])) marks_[entry & kSlot] = had;
    added_.clear();
    grid_.each(box, reach, [&](uint32_t other) {
        if (other == slot) return;
        if (marks_[other] == had)
            marks_[other] = stays;
        else
            added_.push_back(other);
    });
    std::sort(added_.begin(), added_.end());
    pool_.reserve(lists_[slot], lists_[slot].count + uint32_t(added_.size()));
    for (const uint32_t other : added_) pool_.reserve(lists_[other], lists_[other].count + 1);
    for (uint32_t i = lists_[slot].count; i-- > 0;) {
        const uint32_t other = pool_.of(lists_[slot])[i] & kSlot;
        if (marks_[other] != had) continue;
        take(other, slot);
        pool_.erase(lists_[slot], i);
        note(slot);
    }
    for (const uint32_t other : added_) {
        add(other, slot);
        add(slot, other);
    }
}

void Neighbours::remove(uint32_t slot) noexcept {
    grid_.remove(slot);
    if (slot >= lists_.size()) return;
    for (const uint32_t entry : pool_.of(lists_[slot])) take(entry & kSlot, slot);
    pool_.drop(lists_[slot]);
}

void Neighbours::see(uint32_t slot, uint32_t other, uint32_t part) noexcept {
    const ListPlace& list = lists_[slot];
    const uint32_t at = indexOf(pool_.of(list), other), entry = other | part << 24;
    FW_ASSERT(at < list.count && part <= 255, "neighbour %u of %u, part %u", at, list.count, part);
    if (pool_.of(list)[at] == entry) return;
    pool_.of(list)[at] = entry;
    pool_.mark(list.first + at, 1);
}

void Neighbours::settle() noexcept {
    for (const uint32_t slot : changed_) isChanged_[slot] = 0;
    changed_.clear();
    pool_.settle();
}

void Neighbours::clear() noexcept {
    grid_.clear();
    pool_.clear();
    std::fill(lists_.begin(), lists_.end(), ListPlace{});
    std::fill(isChanged_.begin(), isChanged_.end(), uint8_t(0));
    changed_.clear();
}

uint64_t Neighbours::bytes() const noexcept {
    return grid_.bytes() + pool_.bytes() + lists_.capacity() * sizeof(ListPlace) +
           marks_.capacity() * sizeof(uint64_t) + changed_.capacity() * sizeof(uint32_t) +
           isChanged_.capacity() + added_.capacity() * sizeof(uint32_t);
}

}  // namespace fw::world
