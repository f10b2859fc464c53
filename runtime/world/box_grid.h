// Axis-aligned boxes in space, found by where they are: a hash grid with a level of cells for each
// power of two of their sizes. A box is in one cell, that of its middle, so a move costs the same
// however many boxes there are. Not who they belong to.
#pragma once
#include "core/assert.h"
#include "mesh/exchange_tiles.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory_resource>
#include <vector>

namespace fw::world {

class BoxGrid {
 public:
    explicit BoxGrid(std::pmr::memory_resource* memory)
        : entries_(memory), cells_(memory), spare_(memory) {}

    // The box of `slot` from here on, in mm. margin: mm around it within which it wants to be
    // found. Throws std::bad_alloc; then nothing has changed.
    void place(uint32_t slot, const mesh::Box& box, uint32_t margin);
    // So that `count` boxes that have a place may go to others without memory; throws.
    void reserveMoves(uint32_t count) {
        if (2 * (used_ + size_t{count} + 1) > cells_.size()) grow(count);
    }
    void remove(uint32_t slot) noexcept;
    void clear() noexcept;
    [[nodiscard]] bool has(uint32_t slot) const noexcept {
        return slot < entries_.size() && entries_[slot].cell != kNoCell;
    }
    [[nodiscard]] const mesh::Box& boxOf(uint32_t slot) const noexcept {
        FW_ASSERT(has(slot), "box %u", slot);
        return entries_[slot].box;
    }
    // Calls visit(slot) for every box whose gap to `box` is at most the larger of `margin` and its
    // own margin, in no particular order.
    template <class Visit>
    void each(const mesh::Box& box, uint32_t margin, Visit&& visit) const;
    // Boxes that `each` has looked at since the grid was made.
    [[nodiscard]] uint64_t examined() const noexcept { return examined_; }
    [[nodiscard]] uint64_t bytes() const noexcept {
        return entries_.capacity() * sizeof(Entry) +
               (cells_.capacity() + spare_.capacity()) * sizeof(Cell);
    }

 private:
    static constexpr uint32_t kNone = 0xFFFFFFFFu, kNoCell = 0xFFFFFFFFu;
    static constexpr uint32_t kFinest = 6, kLevels = 32;  // cells of 2^6 mm and larger

    struct Entry {
        mesh::Box box;
        uint32_t margin = 0;
        uint32_t cell = kNoCell;  // of cells_
        uint32_t next = kNone, previous = kNone;
    };
    struct Cell {
        int at[3] = {};
        uint32_t level = kNone;  // kNone: this place of the table is free
        uint32_t first = kNone;  // entry
    };
    struct Level {
        uint32_t count = 0;
        int64_t half = 0, margin = 0;   // of the largest box
        int low[3] = {}, high[3] = {};  // cells that its boxes are in
    };

    static uint32_t levelOf(const mesh::Box& box, uint32_t margin) noexcept;
    static size_t hashOf(const int (&at)[3], uint32_t level) noexcept;
    // Place in the table of that cell, or of the free one where it belongs.
    [[nodiscard]] uint32_t findCell(const int (&at)[3], uint32_t level) const noexcept;
    void grow(size_t more);  // for so many cells; throws; drops empty ones
    void link(uint32_t slot, uint32_t cell) noexcept;
    void unlink(uint32_t slot) noexcept;
    void count(uint32_t slot) noexcept;  // in its level
    template <class Visit>
    void visitCell(uint32_t first, const mesh::Box& box, uint32_t margin, Visit&& visit) const;

    std::pmr::vector<Entry> entries_;  // by slot
    std::pmr::vector<Cell> cells_;     // an open hash table
    std::pmr::vector<Cell> spare_;     // the one before it: boxes that wander take no more memory
    uint32_t used_ = 0;                // places of it
    std::array<Level, kLevels> levels_{};
    mutable uint64_t examined_ = 0;
};

template <class Visit>
void BoxGrid::visitCell(uint32_t first, const mesh::Box& box, uint32_t margin,
                        Visit&& visit) const {
    for (uint32_t slot = first; slot != kNone; slot = entries_[slot].next) {
        const Entry& entry = entries_[slot];
        ++examined_;
        if (mesh::gapOf(box, entry.box) <= int64_t(std::max(margin, entry.margin))) visit(slot);
    }
}

template <class Visit>
void BoxGrid::each(const mesh::Box& box, uint32_t margin, Visit&& visit) const {
    for (uint32_t level = 0; level < kLevels; ++level) {
        const Level& of = levels_[level];
        if (of.count == 0) continue;
        const int64_t around = std::max<int64_t>(margin, of.margin) + of.half;
        int low[3], high[3];
        double volume = 1;
        for (int i = 0; i < 3; ++i) {
            low[i] = int(std::max<int64_t>((box.low[i] - around) >> level, of.low[i]));
            high[i] = int(std::min<int64_t>((box.high[i] + around) >> level, of.high[i]));
            volume *= std::max(0.0, double(high[i]) - double(low[i]) + 1);
        }
        if (volume == 0) continue;
        if (volume > double(cells_.size())) {  // a walk through all cells is shorter
            for (const Cell& cell : cells_)
                if (cell.level == level) visitCell(cell.first, box, margin, visit);
            continue;
        }
        int at[3];
        for (at[2] = low[2]; at[2] <= high[2]; ++at[2])
            for (at[1] = low[1]; at[1] <= high[1]; ++at[1])
                for (at[0] = low[0]; at[0] <= high[0]; ++at[0])
                    if (const Cell& cell = cells_[findCell(at, level)]; cell.level == level)
                        visitCell(cell.first, box, margin, visit);
    }
}

}  // namespace fw::world
