// A list for each slot, all in one array that a backend keeps a copy of. A list that outgrows its
// place moves to a larger one; places that are left are given out again.
#pragma once
#include "core/growth.h"
#include "gpu/backend.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <memory_resource>
#include <span>
#include <vector>

namespace fw::world {

struct ListPlace {
    uint32_t first = 0, count = 0;
    uint32_t room = 0;  // entries from first on; 0: it has no place
};

template <class T>
class ListPool {
 public:
    // none: what the entries are that belong to no list.
    ListPool(std::pmr::memory_resource* memory, const T& none)
        : all_(memory), lists_(memory), sizes_(memory), changed_(memory), none_(none) {}

    // Empty lists for all slots up to a number; throws std::bad_alloc.
    void addLists(size_t slots) {
        if (slots <= lists_.size()) return;
        core::growTo(lists_, slots);
        lists_.resize(slots);
    }
    [[nodiscard]] size_t lists() const noexcept { return lists_.size(); }
    [[nodiscard]] ListPlace placeOf(uint32_t slot) const noexcept {
        return slot < lists_.size() ? lists_[slot] : ListPlace{};
    }
    [[nodiscard]] std::span<const T> of(uint32_t slot) const noexcept {
        const ListPlace list = placeOf(slot);
        return std::span(all_).subspan(list.first, list.count);
    }
    [[nodiscard]] std::span<const T> all() const noexcept { return all_; }
    // Where an entry is in a sorted list, or belongs.
    template <class Key>
    [[nodiscard]] uint32_t indexOf(uint32_t slot, uint32_t key, const Key& keyOf) const noexcept {
        const std::span<const T> list = of(slot);
        return uint32_t(std::ranges::lower_bound(list, key, {}, keyOf) - list.begin());
    }

    // Room for `count` entries; throws std::bad_alloc, and then nothing has changed.
    void reserve(uint32_t slot, uint32_t count) {
        FW_ASSERT(slot < lists_.size(), "%u of %zu lists", slot, lists_.size());
        if (count > lists_[slot].room) move(lists_[slot], sizeOf(count));
    }
    // A list that has shrunk moves to a smaller place, so that the pool holds what lists have and
    // not the most that each had. Throws std::bad_alloc, and then nothing has changed.
    void fit(uint32_t slot) {
        FW_ASSERT(slot < lists_.size(), "%u of %zu lists", slot, lists_.size());
        ListPlace& list = lists_[slot];
        if (list.count == 0)
            drop(slot);
        else if (sizeOf(list.count) < sizeOf(list.room))
            move(list, sizeOf(list.count));
    }
    // The place goes, and the entries with it.
    void drop(uint32_t slot) noexcept {
        if (slot >= lists_.size()) return;
        release(lists_[slot]);
        lists_[slot] = {};
    }
    // Before entry `at`, where reserve has found room.
    void insert(uint32_t slot, uint32_t at, const T& value) noexcept {
        FW_ASSERT(slot < lists_.size(), "%u of %zu lists", slot, lists_.size());
        ListPlace& list = lists_[slot];
        FW_ASSERT(list.count < list.room && at <= list.count, "entry %u of %u", at, list.count);
        T* data = all_.data() + list.first;
        std::memmove(data + at + 1, data + at, (list.count - at) * sizeof(T));
        data[at] = value;
        ++list.count;
        mark(list.first + at, list.count - at);
    }
    void set(uint32_t slot, uint32_t at, const T& value) noexcept {
        FW_ASSERT(at < lists_[slot].count, "entry %u of %u", at, lists_[slot].count);
        all_[lists_[slot].first + at] = value;
        mark(lists_[slot].first + at, 1);
    }
    void erase(uint32_t slot, uint32_t at) noexcept {
        ListPlace& list = lists_[slot];
        FW_ASSERT(at < list.count, "entry %u of %u", at, list.count);
        T* data = all_.data() + list.first;
        std::memmove(data + at, data + at + 1, (list.count - at - 1) * sizeof(T));
        mark(list.first + at, list.count - at);
        data[--list.count] = none_;
    }
    template <class Goes>
    void eraseIf(uint32_t slot, const Goes& goes) noexcept {
        ListPlace& list = lists_[slot];
        const auto begin = all_.begin() + list.first, end = begin + list.count;
        const auto kept = std::remove_if(begin, end, goes);
        if (kept == end) return;
        std::fill(kept, end, none_);
        mark(list.first, list.count);
        list.count = uint32_t(kept - begin);
    }
    // Throws std::bad_alloc, and then nothing has changed.
    void assign(uint32_t slot, std::span<const T> values) {
        reserve(slot, uint32_t(values.size()));
        ListPlace& list = lists_[slot];
        T* data = all_.data() + list.first;
        mark(list.first, std::max(list.count, uint32_t(values.size())));
        std::fill_n(data, list.count, none_);
        std::copy(values.begin(), values.end(), data);
        list.count = uint32_t(values.size());
    }
    void clear() noexcept {
        all_.clear();
        changed_.clear();
        std::fill(lists_.begin(), lists_.end(), ListPlace{});
        for (Size& size : sizes_) {
            size.free.clear();
            size.made = 0;
        }
    }

    void listChanges(std::pmr::vector<gpu::ExchangeUpdate::Range>& out) const {
        out.clear();
        for (uint32_t word = 0; word < changed_.size(); ++word)
            for (uint64_t bits = changed_[word]; bits != 0; bits &= bits - 1) {
                const uint32_t first = (word * 64 + uint32_t(std::countr_zero(bits))) * kBlock;
                const uint32_t count = std::min(kBlock, uint32_t(all_.size()) - first);
                if (!out.empty() && out.back().first + out.back().count + kBlock >= first)
                    out.back().count = first + count - out.back().first;
                else
                    out.push_back({first, count});
            }
    }
    void settle() noexcept { std::fill(changed_.begin(), changed_.end(), 0); }

    [[nodiscard]] uint64_t bytes() const noexcept {
        uint64_t sum = all_.capacity() * sizeof(T) + lists_.capacity() * sizeof(ListPlace);
        for (const Size& size : sizes_) sum += size.free.capacity() * sizeof(uint32_t);
        return sum;
    }

 private:
    static constexpr uint32_t kBlock = 64;  // entries that count as changed together

    struct Size {
        std::pmr::vector<uint32_t> free;  // first entries of places
        uint32_t made = 0;                // places of this size in all
        using allocator_type = std::pmr::polymorphic_allocator<>;
        explicit Size(const allocator_type& a) : free(a) {}
        Size(Size&& other, const allocator_type& a)
            : free(std::move(other.free), a), made(other.made) {}
        Size(Size&&) = default;
    };

    // Rooms of 4, 6, 8, 12, 16, 24 ...: at most a third of one is empty.
    static uint32_t roomOf(uint32_t size) noexcept { return (size % 2 == 0 ? 4u : 6u) << size / 2; }
    static uint32_t sizeOf(uint32_t count) noexcept {
        uint32_t size = 0;
        while (roomOf(size) < count) ++size;
        return size;
    }
    // Marks entries as changed since `settle`.
    void mark(uint32_t first, uint32_t count) noexcept {
        if (count == 0) return;
        FW_ASSERT(uint64_t(first) + count <= all_.size(), "%u and %u more of %zu", first, count,
                  all_.size());
        for (uint32_t block = first / kBlock; block <= (first + count - 1) / kBlock; ++block)
            changed_[block / 64] |= uint64_t(1) << block % 64;
    }
    void move(ListPlace& list, uint32_t size) {
        const uint32_t room = roomOf(size);
        while (sizes_.size() <= size) sizes_.emplace_back();
        Size& of = sizes_[size];
        uint32_t first = 0;
        if (of.free.empty()) {
            core::growTo(of.free, of.made + 1);  // giving the place back needs no memory
            first = uint32_t(all_.size());
            changed_.resize(((all_.size() + room) / kBlock + 64) / 64);
            all_.resize(all_.size() + room, none_);
            ++of.made;
        } else {
            first = of.free.back();
            of.free.pop_back();
        }
        std::copy_n(all_.begin() + list.first, list.count, all_.begin() + first);
        mark(first, room);
        release(list);
        list.first = first;
        list.room = room;
    }
    void release(const ListPlace& list) noexcept {
        if (list.room == 0) return;
        FW_ASSERT(sizeOf(list.room) < sizes_.size(), "a place of %u", list.room);
        std::fill_n(all_.begin() + list.first, list.room, none_);
        mark(list.first, list.count);
        sizes_[sizeOf(list.room)].free.push_back(list.first);
    }

    std::pmr::vector<T> all_;
    std::pmr::vector<ListPlace> lists_;  // by slot
    std::pmr::vector<Size> sizes_;
    std::pmr::vector<uint64_t> changed_;  // a bit a block
    T none_;
};

}  // namespace fw::world
