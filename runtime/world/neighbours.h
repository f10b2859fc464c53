// Objects within reach of each other: for each object the others whose boxes come within the reach
// of one of the two, by slot. Kept object by object: what moves finds its neighbours again, the
// others gain or lose that one. Not where fire goes between them.
#pragma once
#include "world/box_grid.h"
#include "world/list_pool.h"
#include "world/slot_set.h"

namespace fw::world {

class Neighbours {
 public:
    static constexpr uint32_t kSlot = 0xFFFFFFu;  // of an entry; above: what is seen of it, of 255

    explicit Neighbours(std::pmr::memory_resource* memory)
        : grid_(memory), pool_(memory, 0u), marks_(memory), changed_(memory), added_(memory) {}

    // An object that is new or elsewhere. Throws std::bad_alloc; then only `clear` mends it.
    void place(uint32_t slot, const mesh::Box& box, uint32_t reach);
    void remove(uint32_t slot) noexcept;
    void clear() noexcept;

    [[nodiscard]] std::span<const uint32_t> of(uint32_t slot) const noexcept {
        return pool_.of(slot);
    }
    // Sets the part of `slot` that a fire of its neighbour `other` sees, of 255.
    void see(uint32_t slot, uint32_t other, uint32_t part) noexcept;

    // Lists that have changed since `settle`, in no order.
    [[nodiscard]] std::span<const uint32_t> changed() const noexcept { return changed_.slots(); }
    void settle() noexcept;

    [[nodiscard]] const ListPool<uint32_t>& pool() const noexcept { return pool_; }
    // Pairs of boxes that were compared since the world was made.
    [[nodiscard]] uint64_t examined() const noexcept { return grid_.examined(); }
    [[nodiscard]] uint64_t bytes() const noexcept;

 private:
    void add(uint32_t slot, uint32_t other) noexcept;   // other to the list of slot
    void take(uint32_t slot, uint32_t other) noexcept;  // and from it

    BoxGrid grid_;
    ListPool<uint32_t> pool_;
    std::pmr::vector<uint64_t> marks_;  // by slot: of the object that was placed last
    SlotSet changed_;
    std::pmr::vector<uint32_t> added_;  // scratch
    uint64_t mark_ = 0;
};

}  // namespace fw::world
