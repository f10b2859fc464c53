// Lists of a save: an entry for each thing in a pool, with its slot.
#pragma once
#include "core/error.h"

#include <cstdint>
#include <memory_resource>
#include <vector>

namespace fw::world {

template <class T>
struct Slotted : T {
    uint32_t slot = 0;

    template <class A>
    void serialize(A& a) {
        a(slot);
        T::serialize(a);
    }
};
template <class T>
using SlottedList = std::pmr::vector<Slotted<T>>;

// fill(thing, entry) for all that are there.
template <class Pool, class T, class Fill>
void captureSlots(const Pool& pool, SlottedList<T>& to, const Fill& fill) {
    to.clear();
    for (auto [slot, thing] : pool.entries()) {
        Slotted<T>& made = to.emplace_back();
        made.slot = slot;
        fill(thing, static_cast<T&>(made));
    }
}
template <class Pool, class T>
void captureSlots(const Pool& pool, SlottedList<T>& to) {
    captureSlots(pool, to, [](const auto& thing, T& made) { made = thing; });
}

// Throws unless the world has the same things in the same slots.
template <class List, class Pool>
void checkSlots(const List& saved, const Pool& pool, const char* name, const char* names) {
    if (saved.size() != pool.live())
        core::failData("The save has %zu %s; this world has %u.", saved.size(), names, pool.live());
    uint32_t next = 0;
    for (const auto& one : saved) {
        if (one.slot < next || !pool.findSlot(one.slot))
            core::failData(
                "The save has %s %u, which this world does not. Create the same things in "
                "the same order.",
                name, one.slot + 1);
        next = one.slot + 1;
    }
}
// Throws where the world has one with another def.
inline void checkSame(bool same, const char* name, uint32_t slot) {
    if (!same)
        core::failData("The save's %s %u has another def here, or a time after the save's.", name,
                       slot + 1);
}
inline void checkCount(size_t count, size_t limit, const char* names) {
    if (count > limit)
        core::failData("The save has %zu %s; the limit is %zu.", count, names, limit);
}

}  // namespace fw::world
