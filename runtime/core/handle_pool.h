// Slots with generations: maps a public id {index1, generation} to a value, and distinguishes stale
// ids from wrong ones. Indices are reused lowest first, so runs repeat slot for slot.
#pragma once
#include "core/assert.h"
#include "core/error.h"
#include "core/growth.h"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory_resource>
#include <optional>
#include <utility>
#include <vector>

namespace fw::core {

// Id is a public struct {uint32_t index1, generation}; zero is null.
template <class Id, class Value>
class HandlePool {
 public:
    HandlePool(const char* noun, std::pmr::memory_resource* memory)
        : noun_(noun), slots_(memory), free_(memory) {}

    template <class... Arguments>
    Id create(Arguments&&... arguments) {
        const bool grows = free_.empty();
        if (grows) {
            growTo(free_, slots_.size() + 1);  // so that destroy never allocates
            slots_.emplace_back();
        }
        // The free slots are sorted descending: the lowest index is last.
        const uint32_t index = grows ? uint32_t(slots_.size() - 1) : free_.back();
        FW_ASSERT(index < slots_.size() && !slots_[index].value, "slot %u of %zu", index,
                  slots_.size());
        try {
            slots_[index].value.emplace(std::forward<Arguments>(arguments)...);
        } catch (...) {
            if (grows) slots_.pop_back();
            throw;
        }
        if (!grows) free_.pop_back();
        ++live_;
        return Id{index + 1, slots_[index].generation};
    }

    // Null if the id is null, stale or unknown.
    Value* find(Id id) noexcept {
        if (id.index1 == 0 || id.index1 > slots_.size()) return nullptr;
        Slot& slot = slots_[id.index1 - 1];
        return slot.value && slot.generation == id.generation ? &*slot.value : nullptr;
    }
    const Value* find(Id id) const noexcept { return const_cast<HandlePool*>(this)->find(id); }

    // As find, but throws Error.
    Value& get(Id id) {
        if (Value* value = find(id)) return *value;
        if (id.index1 == 0) fail(FW_ERROR_STALE_ID, "%s id is null.", noun_);
        if (id.index1 > slots_.size())
            fail(FW_ERROR_STALE_ID, "%s %u does not exist; there are %zu slots.", noun_, id.index1,
                 slots_.size());
        fail(FW_ERROR_STALE_ID,
             "%s %u (generation %u) is already destroyed; the slot is at generation %u.", noun_,
             id.index1, id.generation, slots_[id.index1 - 1].generation);
    }

    void destroy(Id id) {
        (void)get(id);
        Slot& slot = slots_[id.index1 - 1];
        slot.value.reset();
        ++slot.generation;
        const uint32_t index = id.index1 - 1;
        FW_ASSERT(free_.size() < free_.capacity() && live_ > 0, "%zu free slots, %u live",
                  free_.size(), live_);
        free_.insert(std::lower_bound(free_.begin(), free_.end(), index, std::greater<>()), index);
        --live_;
    }

    [[nodiscard]] uint32_t live() const noexcept { return live_; }
    [[nodiscard]] uint32_t slotCount() const noexcept { return uint32_t(slots_.size()); }
    // Null for an empty slot. For loops in slot order.
    Value* at(uint32_t index) noexcept {
        FW_ASSERT(index < slots_.size(), "slot %u of %zu", index, slots_.size());
        return slots_[index].value ? &*slots_[index].value : nullptr;
    }
    const Value* at(uint32_t index) const noexcept {
        return const_cast<HandlePool*>(this)->at(index);
    }
    Id idOf(uint32_t index) const noexcept {
        FW_ASSERT(index < slots_.size(), "slot %u of %zu", index, slots_.size());
        return Id{index + 1, slots_[index].generation};
    }
    // Of any number: null, or an id that every call refuses, where no value has that slot.
    Value* findSlot(uint32_t index) noexcept { return index < slots_.size() ? at(index) : nullptr; }
    const Value* findSlot(uint32_t index) const noexcept {
        return const_cast<HandlePool*>(this)->findSlot(index);
    }
    Id findId(uint32_t index) const noexcept {
        return index < slots_.size() ? idOf(index) : Id{index + 1, 0};
    }
    // Live values with their slots, in order: for (auto [slot, value] : pool.entries()). A loop may
    // destroy the value that it is at. Values that own what they point to are given as that.
    [[nodiscard]] auto entries() noexcept { return Entries<HandlePool>{*this}; }
    [[nodiscard]] auto entries() const noexcept { return Entries<const HandlePool>{*this}; }

 private:
    template <class Pool>
    struct Entries {
        struct End {};
        struct Iterator {
            Pool& pool;
            uint32_t slot;
            [[nodiscard]] bool operator!=(End) const noexcept { return slot < pool.slotCount(); }
            auto operator*() const noexcept {
                auto& value = *pool.at(slot);
                if constexpr (requires { *value; })
                    return std::pair<uint32_t, decltype(*value)>(slot, *value);
                else
                    return std::pair<uint32_t, decltype(value)>(slot, value);
            }
            Iterator& operator++() noexcept {
                do ++slot;
                while (slot < pool.slotCount() && !pool.at(slot));
                return *this;
            }
        };
        Pool& pool;
        [[nodiscard]] Iterator begin() const noexcept {
            Iterator first{pool, ~uint32_t(0)};
            return ++first;
        }
        [[nodiscard]] End end() const noexcept { return {}; }
    };
    struct Slot {
        uint32_t generation = 1;
        std::optional<Value> value;
    };
    const char* noun_;
    std::pmr::vector<Slot> slots_;
    std::pmr::vector<uint32_t> free_;
    uint32_t live_ = 0;
};

}  // namespace fw::core
