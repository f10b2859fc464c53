#include "world/box_grid.h"

#include "core/growth.h"

#include <algorithm>
#include <bit>

namespace fw::world {
namespace {

void cellAt(const mesh::Box& box, uint32_t level, int (&at)[3]) noexcept {
    for (int i = 0; i < 3; ++i) at[i] = int(((int64_t(box.low[i]) + box.high[i]) >> 1) >> level);
}

int64_t sideOf(const mesh::Box& box) noexcept {
    int64_t side = 0;
    for (int i = 0; i < 3; ++i) side = std::max(side, int64_t(box.high[i]) - box.low[i]);
    return side;
}

}  // namespace

// Cells half as large as what is looked for around a box: then few cells are visited in vain, and
// few boxes in them.
uint32_t BoxGrid::levelOf(const mesh::Box& box, uint32_t margin) noexcept {
    const auto size = uint64_t(std::max(sideOf(box), int64_t(margin))) / 2;
    return std::clamp(uint32_t(std::bit_width(size)), kFinest, kLevels - 1);
}

size_t BoxGrid::hashOf(const int (&at)[3], uint32_t level) noexcept {
    uint64_t hash = level;
    for (const int part : at)
        hash = (hash ^ uint32_t(part)) * 0x9E3779B97F4A7C15ull, hash ^= hash >> 29;
    return size_t(hash);
}

uint32_t BoxGrid::findCell(const int (&at)[3], uint32_t level) const noexcept {
    FW_ASSERT(std::has_single_bit(cells_.size()) && used_ < cells_.size(), "%u of %zu cells", used_,
              cells_.size());
    const size_t mask = cells_.size() - 1;
    for (size_t i = hashOf(at, level) & mask;; i = (i + 1) & mask) {
        const Cell& cell = cells_[i];
        if (cell.level == kNone || (cell.level == level && cell.at[0] == at[0] &&
                                    cell.at[1] == at[1] && cell.at[2] == at[2]))
            return uint32_t(i);
    }
}

void BoxGrid::link(uint32_t slot, uint32_t cell) noexcept {
    FW_ASSERT(cell < cells_.size() && cells_[cell].level < kLevels, "cell %u", cell);
    Entry& entry = entries_[slot];
    entry.cell = cell;
    entry.previous = kNone;
    entry.next = cells_[cell].first;
    if (entry.next != kNone) entries_[entry.next].previous = slot;
    cells_[cell].first = slot;
}

void BoxGrid::unlink(uint32_t slot) noexcept {
    const Entry& entry = entries_[slot];
    if (entry.previous != kNone)
        entries_[entry.previous].next = entry.next;
    else
        cells_[entry.cell].first = entry.next;
    if (entry.next != kNone) entries_[entry.next].previous = entry.previous;
}

void BoxGrid::count(uint32_t slot) noexcept {
    const Entry& entry = entries_[slot];
    const Cell& cell = cells_[entry.cell];
    Level& level = levels_[cell.level];
    for (int i = 0; i < 3; ++i) {
        level.low[i] = level.count ? std::min(level.low[i], cell.at[i]) : cell.at[i];
        level.high[i] = level.count ? std::max(level.high[i], cell.at[i]) : cell.at[i];
    }
    level.half = std::max(level.count ? level.half : 0, sideOf(entry.box) / 2 + 1);
    level.margin = std::max(level.count ? level.margin : 0, int64_t(entry.margin));
    ++level.count;
}

// The levels' bounds are found again, too: boxes that left them no longer count.
void BoxGrid::grow(size_t more) {
    size_t filled = 0;
    for (const Cell& cell : cells_) filled += cell.first != kNone ? 1 : 0;
    spare_.assign(std::max<size_t>(64, std::bit_ceil(4 * (filled + more))), Cell{});
    cells_.swap(spare_);
    used_ = 0;
    levels_ = {};
    for (const Cell& old : spare_) {
        if (old.first == kNone) continue;
        const uint32_t at = findCell(old.at, old.level);
        cells_[at] = old;
        ++used_;
        for (uint32_t slot = old.first; slot != kNone; slot = entries_[slot].next) {
            entries_[slot].cell = at;
            count(slot);
        }
    }
}

void BoxGrid::place(uint32_t slot, const mesh::Box& box, uint32_t margin) {
    if (slot >= entries_.size()) {
        core::growTo(entries_, slot + 1);
        entries_.resize(slot + 1);
    }
    if (2 * (used_ + 1) > cells_.size()) grow(1);
    const uint32_t level = levelOf(box, margin);
    int at[3];
    cellAt(box, level, at);
    Entry& entry = entries_[slot];
    if (entry.cell != kNoCell) {
        unlink(slot);
        --levels_[cells_[entry.cell].level].count;
    }
    const uint32_t cell = findCell(at, level);
    if (cells_[cell].level == kNone) {
        std::copy_n(at, 3, cells_[cell].at);
        cells_[cell].level = level;
        ++used_;
    }
    entry.box = box;
    entry.margin = margin;
    link(slot, cell);
    count(slot);
}

void BoxGrid::remove(uint32_t slot) noexcept {
    if (!has(slot)) return;
    FW_ASSERT(levels_[cells_[entries_[slot].cell].level].count > 0, "box %u", slot);
    unlink(slot);
    --levels_[cells_[entries_[slot].cell].level].count;
    entries_[slot].cell = kNoCell;
}

void BoxGrid::clear() noexcept {
    for (Entry& entry : entries_) entry.cell = kNoCell;
    for (Cell& cell : cells_) cell = {};
    used_ = 0;
    levels_ = {};
}

}  // namespace fw::world
