#include "mesh/exchange_tiles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/ext/vector_int3_sized.hpp>
#include <glm/geometric.hpp>
#include <limits>

namespace fw::mesh {
namespace {

constexpr float kSourceSide = 0.25f;  // m: smaller objects are one source, larger ones a grid of 4

struct TileSum {
    glm::i64vec3 position{0}, normal{0};
    uint32_t texels = 0, materials[8] = {};
};

TileSum sumTile(const BurnDomain& domain, uint32_t tile) noexcept {
    TileSum sum;
    eachTexel(domain, tile, [&](uint32_t texel) {
        sum.position += glm::i64vec3(domain.texels[texel].units());
        sum.normal += glm::i64vec3(gpu::decodeNormal(domain.normals[texel]));
        ++sum.texels;
        ++sum.materials[domain.texels[texel].materialFlags & 7];
    });
    return sum;
}

struct Grid {
    uint32_t sides = 1, unit = 1;  // position units along a cell
};

Grid gridOf(const BurnDomain& domain) noexcept {
    float extent = 0;
    for (int i = 0; i < 3; ++i)
        extent = std::max(extent, domain.boundsHigh[i] - domain.boundsLow[i]);
    Grid grid;
    grid.sides = std::clamp(uint32_t(std::ceil(extent / kSourceSide)), 1u, gpu::kSourceGrid);
    const float units = extent / std::max(domain.quantum, 1e-12f) / float(grid.sides);
    grid.unit = std::clamp(uint32_t(std::ceil(units)), 1u, 65536u);
    return grid;
}

uint32_t cellAt(glm::uvec3 middle, const Grid& grid) noexcept {
    FW_ASSERT(grid.sides >= 1 && grid.unit >= 1, "%u cells of %u units", grid.sides, grid.unit);
    uint32_t cell = 0;
    for (int i = 2; i >= 0; --i)
        cell = cell * grid.sides + std::min(middle[i] / grid.unit, grid.sides - 1);
    return cell;
}

uint32_t packSum(glm::dvec3 sum) noexcept {
    const double size = glm::dot(sum, sum);
    if (!(size > 0)) return 0;
    const glm::dvec3 unit = sum * (1 / std::sqrt(size));
    const auto part = [&](int i, double one) {
        return uint32_t(int32_t(std::lround(unit[i] * one)));
    };
    return (part(0, 1023) & 0x7FFu) | (part(1, 1023) & 0x7FFu) << 11 |
           (part(2, 511) & 0x3FFu) << 22;
}

// Side of the search's cells: at least the gap.
constexpr int kCellShift = 6;  // mm: 64
static_assert(gpu::kContactGap <= 1u << kCellShift);

// One object's places near another object, by cells. Cells are numbered from the lowest of them,
// wherever in the world they are.
struct ContactCells {
    static constexpr size_t kMaxListed = 4096;
    glm::ivec3 low{0}, high{0};
    uint64_t sideY = 0, sideZ = 0;
    bool listed = false;                          // few enough cells for `starts`
    std::array<uint32_t, kMaxListed + 1> starts;  // by cell: its first place
    std::span<const Contacts::Place> places;      // by cell

    [[nodiscard]] uint64_t keyOf(glm::ivec3 cell) const noexcept {
        const glm::ivec3 at = cell - low;
        FW_ASSERT(at == glm::max(at, 0) && cell == glm::min(cell, high), "cell (%d, %d, %d)",
                  cell.x, cell.y, cell.z);
        return (uint64_t(at.x) * sideY + uint64_t(at.y)) * sideZ + uint64_t(at.z);
    }
    [[nodiscard]] uint64_t keyOf(const Contacts::Place& place) const noexcept {
        return keyOf(place.at >> kCellShift);
    }
    void list(std::span<Contacts::Place> given, std::pmr::vector<Contacts::Place>& sorted) {
        FW_ASSERT(!given.empty());
        low = high = given[0].at >> kCellShift;
        for (const Contacts::Place& place : given) {
            low = glm::min(low, place.at >> kCellShift);
            high = glm::max(high, place.at >> kCellShift);
        }
        sideY = uint64_t(high.y - low.y) + 1;
        sideZ = uint64_t(high.z - low.z) + 1;
        const uint64_t cells = keyOf(high) + 1;
        listed = cells <= kMaxListed;
        if (!listed) {
            sorted.assign(given.begin(), given.end());
            std::sort(sorted.begin(), sorted.end(),
                      [&](const auto& a, const auto& b) { return keyOf(a) < keyOf(b); });
            places = sorted;
            return;
        }
        sorted.resize(given.size());
        places = sorted;
        std::fill_n(starts.begin(), cells + 1, 0);
        for (Contacts::Place& place : given) ++starts[place.cell = uint32_t(keyOf(place))];
        uint32_t end = 0;
        for (uint64_t cell = 0; cell <= cells; ++cell) end = starts[cell] += end;
        FW_ASSERT(end == given.size(), "%u of %zu places", end, given.size());
        for (const Contacts::Place& place : given) sorted[--starts[place.cell]] = place;
    }
    // The places in cells `first` to `last` of a row along z.
    [[nodiscard]] std::span<const Contacts::Place> row(int x, int y, int first,
                                                       int last) const noexcept {
        first = std::max(first, low.z);
        last = std::min(last, high.z);
        if (x < low.x || x > high.x || y < low.y || y > high.y || first > last) return {};
        const uint64_t from = keyOf({x, y, first}), end = keyOf({x, y, last}) + 1;
        if (listed) return {&places[0] + starts[from], starts[end] - starts[from]};
        const auto before = [&](const Contacts::Place& a, uint64_t key) { return keyOf(a) < key; };
        const auto at = std::lower_bound(places.begin(), places.end(), from, before);
        return {at, std::lower_bound(at, places.end(), end, before)};
    }
};

bool inside(const gpu::ivec3& p, const Box& box, int more) noexcept {
    return glm::all(glm::greaterThanEqual(p, box.low - more)) &&
           glm::all(glm::lessThanEqual(p, box.high + more));
}

Box wholeBox(const ContactSide& side) noexcept {
    const gpu::ExchangeObject& o = *side.place;
    return {{o.rotation0.w, o.rotation1.w, o.rotation2.w}, glm::ivec3(o.high)};
}

bool burnsAt(const ContactSide& side, uint32_t texel) noexcept {
    return side.domain->real(texel) && side.domain->slowness[texel] != 0 &&
           (side.burns >> (side.domain->texels[texel].materialFlags & 7) & 1) != 0;
}

gpu::ivec3 placeOf(const ContactSide& side, uint32_t texel) noexcept {
    return gpu::toWorldMm(*side.place, side.domain->texels[texel].units());
}

// The burnable texels of `side` that are near `other`, block by block.
void placeNear(const ContactSide& side, const Box& other, std::pmr::vector<Contacts::Place>& out) {
    const BurnDomain& domain = *side.domain;
    FW_ASSERT(domain.tileBounds.size() == domain.tileCount(), "%zu of %u tiles",
              domain.tileBounds.size(), domain.tileCount());
    for (uint32_t tile = 0; tile < domain.tileCount(); ++tile) {
        const TileBounds& bounds = domain.tileBounds[tile];
        if (bounds.low[0] > bounds.high[0]) continue;
        if (gapOf(placedBox(*side.place, bounds.low, bounds.high), other) > int(gpu::kContactGap))
            continue;
        const TileTexels texels = domain.texelsOf(tile);
        for (uint32_t i = 0; i < kTileLanes; ++i) {
            const uint32_t block = i >> 4;
            const uint32_t x = (block & 1) * 4 + (i & 3), y = (block >> 1) * 4 + (i >> 2 & 3);
            const uint32_t texel = texels[y * kTileSide + x];
            if (!burnsAt(side, texel)) continue;
            const gpu::ivec3 p = placeOf(side, texel);
            if (!inside(p, other, int(gpu::kContactGap))) continue;
            Contacts::Place& place = out.emplace_back();  // in place: a copy waits for its parts
            place.at = p;
            place.texel = texel;
            place.block = tile * 4 + block;
        }
    }
}

// Cubes of kContactGap; their order decides between equally near places.
int cubeOf(int mm) noexcept {
    constexpr int kSide = int(gpu::kContactGap);
    return mm >= 0 ? mm / kSide : -((kSide - 1 - mm) / kSide);
}

// The nearest pair of a block's texel and a texel in `cells`. Equally near pairs: the first texel
// of the block wins, then the first cube, then the first texel in it.
struct NearestPair {
    const ContactCells& cells;
    const Contacts::Place *to = nullptr, *from = nullptr;
    int limit =
        int(gpu::kContactGap * gpu::kContactGap);  // squared mm: of the pair, if there is one

    void offer(const Contacts::Place& a, std::span<const Contacts::Place> row) noexcept {
        for (const Contacts::Place& b : row) {
            const glm::ivec3 d = b.at - a.at;
            const int square = d.x * d.x + d.y * d.y + d.z * d.z;
            if (square > limit || (square == limit && from && !comesBefore(a, b))) continue;
            limit = square;
            to = &a;
            from = &b;
        }
    }
    [[nodiscard]] bool comesBefore(const Contacts::Place& a,
                                   const Contacts::Place& b) const noexcept {
        if (&a != to) return &a < to;
        for (int i = 0; i < 3; ++i)
            if (const int mine = cubeOf(b.at[i]), theirs = cubeOf(from->at[i]); mine != theirs)
                return mine < theirs;
        return b.texel < from->texel;
    }
    void offerOwnCell(const Contacts::Place& a) noexcept {
        const glm::ivec3 cell = a.at >> kCellShift;
        offer(a, cells.row(cell.x, cell.y, cell.z, cell.z));
    }
    // Cells around that may hold a nearer one.
    void offerAround(const Contacts::Place& a) noexcept {
        constexpr int kSide = 1 << kCellShift;
        // Squared mm along each axis to the next cell.
        const glm::ivec3 within = a.at & (kSide - 1);
        const glm::ivec3 before = (within + 1) * (within + 1);
        const glm::ivec3 after = (kSide - within) * (kSide - within);
        const int x = a.at.x >> kCellShift, y = a.at.y >> kCellShift, z = a.at.z >> kCellShift;
        for (int dx = before[0] <= limit ? -1 : 0; dx <= (after[0] <= limit ? 1 : 0); ++dx) {
            const int squareX = dx == 0 ? 0 : dx < 0 ? before[0] : after[0];
            for (int dy = squareX + before[1] <= limit ? -1 : 0;
                 dy <= (squareX + after[1] <= limit ? 1 : 0); ++dy) {
                const int square = squareX + (dy == 0 ? 0 : dy < 0 ? before[1] : after[1]);
                if (square > limit) continue;
                const bool below = square + before[2] <= limit, above = square + after[2] <= limit;
                if (square != 0) {
                    offer(a, cells.row(x + dx, y + dy, z - below, z + above));
                    continue;
                }
                if (below) offer(a, cells.row(x, y, z - 1, z - 1));
                if (above) offer(a, cells.row(x, y, z + 1, z + 1));
            }
        }
    }
};

void findNearest(std::span<const Contacts::Place> places, const ContactCells& cells,
                 std::pmr::vector<Contact>& out) {
    for (size_t first = 0; first < places.size() && out.size() < kMaxContacts;) {
        size_t end = first + 1;
        while (end < places.size() && places[end].block == places[first].block) ++end;
        NearestPair nearest{cells};
        // Own cells first: their nearest pair rules out most of the cells around.
        for (size_t i = first; i < end; ++i) nearest.offerOwnCell(places[i]);
        for (size_t i = first; i < end; ++i) nearest.offerAround(places[i]);
        FW_ASSERT(nearest.limit >= 0 && (nearest.from != nullptr) == (nearest.to != nullptr),
                  "squared gap %d", nearest.limit);
        if (nearest.from)
            out.push_back(
                {nearest.to->texel, nearest.from->texel, gpu::isqrtNear(uint32_t(nearest.limit))});
        first = end;
    }
}

}  // namespace

uint32_t exchangeTiles(const BurnDomain& domain, std::pmr::vector<gpu::ExchangeTile>& out) {
    out.resize(domain.tileCount());
    const Grid grid = gridOf(domain);
    std::array<uint32_t, gpu::kSourcesPerObject> numbers;
    numbers.fill(kNone);
    uint32_t cells = 0;
    for (uint32_t tile = 0; tile < domain.tileCount(); ++tile) {
        const TileSum sum = sumTile(domain, tile);
        gpu::ExchangeTile made{};
        if (sum.texels != 0) {
            const glm::uvec3 middle(sum.position / int64_t(sum.texels));
            uint32_t& number = numbers[cellAt(middle, grid)];
            if (number == kNone) number = cells++;
            const auto most = uint32_t(std::ranges::max_element(sum.materials) - sum.materials);
            FW_ASSERT(number < gpu::kSourcesPerObject, "%u of %u sources", number,
                      gpu::kSourcesPerObject);
            made.xy = middle[0] | middle[1] << 16;
            made.z = middle[2] | number << 16 | most << 24;
            made.normal = packSum(glm::dvec3(sum.normal));
            made.texels = sum.texels;
        }
        made.parts = gpu::uvec4(kNone);
        for (int block = 0; block < 4 && !domain.partLinks.empty(); ++block)
            made.parts[block] = domain.partLinks[size_t(tile) * 4 + size_t(block)];
        out[tile] = made;
    }
    return std::max(cells, 1u);
}

uint32_t sourceCells(std::span<const gpu::ExchangeTile> tiles) noexcept {
    uint32_t cells = 1;  // an empty tile is in the first one
    for (const gpu::ExchangeTile& tile : tiles) cells = std::max(cells, gpu::tileCluster(tile) + 1);
    return cells;
}

Box placedBox(const gpu::ExchangeObject& place, const uint16_t (&low)[3],
              const uint16_t (&high)[3]) noexcept {
    FW_ASSERT(place.shift < 32, "shift %u", place.shift);
    const gpu::ivec4* const rows[3] = {&place.row0, &place.row1, &place.row2};
    Box box;
    for (int i = 0; i < 3; ++i) {  // as toWorldMm of the corners
        int least = 0, most = 0;
        for (int k = 0; k < 3; ++k) {
            const int a = (*rows[i])[k] * int(low[k]), b = (*rows[i])[k] * int(high[k]);
            least += std::min(a, b);
            most += std::max(a, b);
        }
        box.low[i] = (*rows[i]).w + (least >> int(place.shift));
        box.high[i] = (*rows[i]).w + (most >> int(place.shift)) + 1;
    }
    return box;
}

int gapOf(const Box& a, const Box& b) noexcept {
    int64_t gap = std::numeric_limits<int>::min();
    for (int i = 0; i < 3; ++i)
        gap = std::max({gap, int64_t(a.low[i]) - b.high[i], int64_t(b.low[i]) - a.high[i]});
    return int(std::min<int64_t>(gap, std::numeric_limits<int>::max()));
}

void findContacts(const ContactSide (&sides)[2], Contacts& contacts) {
    for (int k = 0; k < 2; ++k) {
        contacts.found[k].clear();
        contacts.places[k].clear();
    }
    if (gapOf(wholeBox(sides[0]), wholeBox(sides[1])) > int(gpu::kContactGap)) return;
    for (int k = 0; k < 2; ++k) {
        placeNear(sides[k], wholeBox(sides[1 - k]), contacts.places[k]);
        if (contacts.places[k].empty()) return;
    }
    for (int k = 0; k < 2; ++k) {
        ContactCells cells;
        cells.list(contacts.places[1 - k], contacts.byCell);
        findNearest(contacts.places[k], cells, contacts.found[k]);
    }
}

}  // namespace fw::mesh
