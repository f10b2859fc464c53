#include "world/neighbours.h"

#include <algorithm>

namespace fw::world {
namespace {

constexpr uint32_t kAllSeen = 255u << 24;

constexpr auto slotOf = [](uint32_t entry) noexcept { return entry & Neighbours::kSlot; };

}  // namespace

void Neighbours::add(uint32_t slot, uint32_t other) noexcept {
    FW_ASSERT(slot != other && other <= kSlot, "%u next to %u", slot, other);
    pool_.insert(slot, pool_.indexOf(slot, other, slotOf), other | kAllSeen);
    changed_.add(slot);
}

void Neighbours::take(uint32_t slot, uint32_t other) noexcept {
    pool_.erase(slot, pool_.indexOf(slot, other, slotOf));
    changed_.add(slot);
}

void Neighbours::place(uint32_t slot, const mesh::Box& box, uint32_t reach) {
    pool_.addLists(slot + 1);
    changed_.reserve(slot + 1);
    if (slot >= marks_.size()) {
        core::growTo(marks_, slot + 1);
        marks_.resize(slot + 1);
    }
    grid_.place(slot, box, reach);
    const uint64_t had = ++mark_, stays = ++mark_;
    for (const uint32_t entry : of(slot)) marks_[slotOf(entry)] = had;
    added_.clear();
    grid_.each(box, reach, [&](uint32_t other) {
        if (other == slot) return;
        if (marks_[other] == had)
            marks_[other] = stays;
        else
            added_.push_back(other);
    });
    std::sort(added_.begin(), added_.end());
    pool_.reserve(slot, uint32_t(of(slot).size() + added_.size()));
    for (const uint32_t other : added_) pool_.reserve(other, uint32_t(of(other).size()) + 1);
    const auto left = [&](uint32_t entry) { return marks_[slotOf(entry)] == had; };
    for (const uint32_t entry : of(slot))
        if (left(entry)) take(slotOf(entry), slot), changed_.add(slot);
    pool_.eraseIf(slot, left);
    for (const uint32_t other : added_) {
        add(other, slot);
        add(slot, other);
    }
}

void Neighbours::remove(uint32_t slot) noexcept {
    grid_.remove(slot);
    for (const uint32_t entry : of(slot)) take(slotOf(entry), slot);
    pool_.drop(slot);
}

void Neighbours::see(uint32_t slot, uint32_t other, uint32_t part) noexcept {
    const uint32_t at = pool_.indexOf(slot, other, slotOf), entry = other | part << 24;
    FW_ASSERT(part <= 255, "part %u", part);
    if (of(slot)[at] != entry) pool_.set(slot, at, entry);
}

void Neighbours::settle() noexcept {
    changed_.clear();
    pool_.settle();
}

void Neighbours::clear() noexcept {
    grid_.clear();
    pool_.clear();
    changed_.clear();
}

uint64_t Neighbours::bytes() const noexcept {
    return grid_.bytes() + pool_.bytes() + changed_.bytes() + marks_.capacity() * sizeof(uint64_t) +
           added_.capacity() * sizeof(uint32_t);
}

}  // namespace fw::world
