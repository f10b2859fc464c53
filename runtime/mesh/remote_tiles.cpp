#include "mesh/remote_tiles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace fw::mesh {
namespace {

constexpr float kSourceSide = 0.25f;  // m: smaller objects are one source, larger ones a grid of 4

struct TileSum {
    uint64_t position[3] = {};
    int64_t normal[3] = {};
    uint32_t texels = 0, materials[8] = {};
};

TileSum sumTile(const BurnDomain& domain, uint32_t tile) noexcept {
    TileSum sum;
    const uint32_t corner =
        tile / domain.tilesX * kTileSide * domain.width + tile % domain.tilesX * kTileSide;
    for (uint32_t lane = 0; lane < 64; ++lane) {
        const uint32_t texel = corner + (lane >> 3) * domain.width + (lane & 7);
        if (!domain.real(texel)) continue;
        const TexelPosition& p = domain.texels[texel];
        sum.position[0] += p.x;
        sum.position[1] += p.y;
        sum.position[2] += p.z;
        const gpu::ivec3 n = gpu::decodeNormal(domain.normals[texel]);
        for (int i = 0; i < 3; ++i) sum.normal[i] += n[i];
        ++sum.texels;
        ++sum.materials[p.materialFlags & 7];
    }
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

uint32_t cellAt(const uint32_t (&middle)[3], const Grid& grid) noexcept {
    uint32_t cell = 0;
    for (int i = 2; i >= 0; --i)
        cell = cell * grid.sides + std::min(middle[i] / grid.unit, grid.sides - 1);
    return cell;
}

uint32_t packSum(const int64_t (&sum)[3]) noexcept {
    double size = 0;
    for (const int64_t s : sum) size += double(s) * double(s);
    if (!(size > 0)) return 0;
    const double scale = 1 / std::sqrt(size);
    const auto part = [&](int i, double one) {
        return uint32_t(int32_t(std::lround(double(sum[i]) * scale * one)));
    };
    return (part(0, 1023) & 0x7FFu) | (part(1, 1023) & 0x7FFu) << 11 |
           (part(2, 511) & 0x3FFu) << 22;
}

int cellOf(int mm) noexcept {
    constexpr int kSide = int(gpu::kContactGap);
    return mm >= 0 ? mm / kSide : -((kSide - 1 - mm) / kSide);
}

gpu::ivec3 cellAt(const gpu::ivec3& p) noexcept { return {cellOf(p.x), cellOf(p.y), cellOf(p.z)}; }

// mm from a place, `within` its cell along an axis, to the cell beside it; 0: its own.
uint32_t wayTo(int beside, int within) noexcept {
    return uint32_t(beside == 0 ? 0 : beside < 0 ? within + 1 : int(gpu::kContactGap) - within);
}

// The cells of places that one object has near another: numbers of their own, wherever in the world
// that is.
struct ContactCells {
    static constexpr size_t kMostListed = 4096;
    gpu::ivec3 low{0}, high{-1};
    bool listed = false;                           // they are few enough for `starts`
    std::array<uint32_t, kMostListed + 1> starts;  // by cell: its first place

    void add(const gpu::ivec3& cell) noexcept {
        const bool first = high.x < low.x;
        low = first ? cell : glm::min(low, cell);
        high = first ? cell : glm::max(high, cell);
    }
    [[nodiscard]] uint64_t keyOf(int x, int y, int z) const noexcept {
        const auto side = [&](int axis) { return uint64_t(high[axis] - low[axis]) + 1; };
        return (uint64_t(x - low.x) * side(1) + uint64_t(y - low.y)) * side(2) +
               uint64_t(z - low.z);
    }
    // Of places that are in the order of their keys.
    void list(std::span<const ContactPlace> places) noexcept {
        const uint64_t cells = keyOf(high.x, high.y, high.z) + 1;
        listed = cells <= kMostListed;
        if (!listed) return;
        size_t at = 0;
        for (uint64_t key = 0; key <= cells; ++key) {
            while (at < places.size() && places[at].key < key) ++at;
            starts[key] = uint32_t(at);
        }
    }
    // The places in three cells of a row.
    [[nodiscard]] std::span<const ContactPlace> around(std::span<const ContactPlace> places, int x,
                                                       int y, int z) const noexcept {
        const int first = std::max(z - 1, low.z), last = std::min(z + 1, high.z);
        if (x < low.x || x > high.x || y < low.y || y > high.y || first > last) return {};
        const uint64_t from = keyOf(x, y, first), end = keyOf(x, y, last) + 1;
        if (listed) return places.subspan(starts[from], starts[end] - starts[from]);
        const auto before = [](const ContactPlace& a, uint64_t key) { return a.key < key; };
        const auto at = std::lower_bound(places.begin(), places.end(), from, before);
        return {at, std::lower_bound(at, places.end(), end, before)};
    }
};

bool inside(const gpu::ivec3& p, const Box& box, int more) noexcept {
    for (int i = 0; i < 3; ++i)
        if (p[i] < box.low[i] - more || p[i] > box.high[i] + more) return false;
    return true;
}

// Calls each(tile, box) for the tiles that come near `other`.
template <class Each>
void nearTiles(const ContactSide& side, const Box& other, Each&& each) {
    for (uint32_t tile = 0; tile < side.domain->tileCount(); ++tile) {
        const TileBounds& bounds = side.domain->tileBounds[tile];
        if (bounds.low[0] > bounds.high[0]) continue;
        const Box box = placedBox(*side.place, bounds.low, bounds.high);
        if (gapOf(box, other) <= int(gpu::kContactGap)) each(tile, box);
    }
}

Box wholeBox(const ContactSide& side) noexcept {
    Box box;
    const gpu::RemoteObject& o = *side.place;
    const int low[3] = {o.turn0.w, o.turn1.w, o.turn2.w};
    for (int i = 0; i < 3; ++i) {
        box.low[i] = low[i];
        box.high[i] = o.high[i];
    }
    return box;
}

bool burnsAt(const ContactSide& side, uint32_t texel) noexcept {
    return side.domain->real(texel) && side.domain->slowness[texel] != 0 &&
           (side.burns >> (side.domain->texels[texel].materialFlags & 7) & 1) != 0;
}

gpu::ivec3 placeOf(const ContactSide& side, uint32_t texel) noexcept {
    const TexelPosition& p = side.domain->texels[texel];
    return gpu::remotePlace(*side.place, gpu::ivec3(p.x, p.y, p.z));
}

}  // namespace

uint32_t remoteTiles(const BurnDomain& domain, std::pmr::vector<gpu::RemoteTile>& out) {
    out.resize(domain.tileCount());
    const Grid grid = gridOf(domain);
    std::array<uint32_t, gpu::kSourcesPerObject> numbers;
    numbers.fill(kNone);
    uint32_t cells = 0;
    for (uint32_t tile = 0; tile < domain.tileCount(); ++tile) {
        const TileSum sum = sumTile(domain, tile);
        gpu::RemoteTile made{};
        if (sum.texels != 0) {
            uint32_t middle[3];
            for (int i = 0; i < 3; ++i) middle[i] = uint32_t(sum.position[i] / sum.texels);
            uint32_t& number = numbers[cellAt(middle, grid)];
            if (number == kNone) number = cells++;
            const auto most =
                uint32_t(std::max_element(std::begin(sum.materials), std::end(sum.materials)) -
                         std::begin(sum.materials));
            made.xy = middle[0] | middle[1] << 16;
            made.z = middle[2] | number << 16 | most << 24;
            made.normal = packSum(sum.normal);
            made.texels = sum.texels;
        }
        made.parts = gpu::uvec4(kNone);
        for (int block = 0; block < 4 && !domain.partLinks.empty(); ++block)
            made.parts[block] = domain.partLinks[size_t(tile) * 4 + size_t(block)];
        out[tile] = made;
    }
    return std::max(cells, 1u);
}

uint32_t sourceCells(const BurnDomain& domain) noexcept {
    const Grid grid = gridOf(domain);
    uint64_t seen = 0;
    for (uint32_t tile = 0; tile < domain.tileCount(); ++tile) {
        const TileSum sum = sumTile(domain, tile);
        if (sum.texels == 0) continue;
        uint32_t middle[3];
        for (int i = 0; i < 3; ++i) middle[i] = uint32_t(sum.position[i] / sum.texels);
        seen |= uint64_t(1) << cellAt(middle, grid);
    }
    uint32_t cells = 0;
    for (; seen != 0; seen &= seen - 1) ++cells;
    return std::max(cells, 1u);
}

Box placedBox(const gpu::RemoteObject& place, const uint16_t (&low)[3],
              const uint16_t (&high)[3]) noexcept {
    Box box;
    for (int i = 0; i < 3; ++i) {
        box.low[i] = std::numeric_limits<int>::max();
        box.high[i] = std::numeric_limits<int>::min();
    }
    for (uint32_t corner = 0; corner < 8; ++corner) {
        const gpu::ivec3 at = gpu::remotePlace(
            place, gpu::ivec3((corner & 1 ? high : low)[0], (corner & 2 ? high : low)[1],
                              (corner & 4 ? high : low)[2]));
        for (int i = 0; i < 3; ++i) {
            box.low[i] = std::min(box.low[i], at[i]);
            box.high[i] = std::max(box.high[i], at[i] + 1);
        }
    }
    return box;
}

int gapOf(const Box& a, const Box& b) noexcept {
    int64_t gap = std::numeric_limits<int>::min();
    for (int i = 0; i < 3; ++i)
        gap = std::max({gap, int64_t(a.low[i]) - b.high[i], int64_t(b.low[i]) - a.high[i]});
    return int(std::min<int64_t>(gap, std::numeric_limits<int>::max()));
}

void findContacts(const ContactSide& to, const ContactSide& from,
                  std::pmr::vector<ContactPlace>& placed, std::pmr::vector<Contact>& out) {
    constexpr int kGap = int(gpu::kContactGap);
    if (gapOf(wholeBox(to), wholeBox(from)) > kGap) return;
    placed.clear();
    ContactCells cells;
    const Box toBox = wholeBox(to), fromBox = wholeBox(from);
    nearTiles(from, toBox, [&](uint32_t tile, const Box&) {
        const uint32_t corner = tile / from.domain->tilesX * kTileSide * from.domain->width +
                                tile % from.domain->tilesX * kTileSide;
        for (uint32_t lane = 0; lane < 64; ++lane) {
            const uint32_t texel = corner + (lane >> 3) * from.domain->width + (lane & 7);
            if (!burnsAt(from, texel)) continue;
            const gpu::ivec3 p = placeOf(from, texel);
            if (!inside(p, toBox, kGap)) continue;
            cells.add(cellAt(p));
            placed.push_back({0, {p.x, p.y, p.z}, texel});
        }
    });
    if (placed.empty()) return;
    for (ContactPlace& one : placed)
        one.key = cells.keyOf(cellOf(one.place[0]), cellOf(one.place[1]), cellOf(one.place[2]));
    std::sort(placed.begin(), placed.end(), [](const ContactPlace& a, const ContactPlace& b) {
        return a.key != b.key ? a.key < b.key : a.texel < b.texel;
    });
    cells.list(placed);
    const size_t most = out.size() + kMostContacts;
    nearTiles(to, fromBox, [&](uint32_t tile, const Box&) {
        const uint32_t corner = tile / to.domain->tilesX * kTileSide * to.domain->width +
                                tile % to.domain->tilesX * kTileSide;
        for (uint32_t block = 0; block < 4 && out.size() < most; ++block) {
            Contact best;
            uint32_t bestSquare = uint32_t(kGap * kGap) + 1;
            for (uint32_t lane = 0; lane < 16; ++lane) {
                const uint32_t x = (block & 1) * 4 + (lane & 3), y = (block >> 1) * 4 + (lane >> 2);
                const uint32_t texel = corner + y * to.domain->width + x;
                if (!burnsAt(to, texel)) continue;
                const gpu::ivec3 p = placeOf(to, texel);
                if (!inside(p, fromBox, kGap)) continue;
                const gpu::ivec3 cell = cellAt(p);
                for (int around = 0; around < 9; ++around) {
                    const int cx = around / 3 - 1, cy = around % 3 - 1;
                    const uint32_t x1 = wayTo(cx, p.x - cell.x * kGap),
                                   y1 = wayTo(cy, p.y - cell.y * kGap);
                    if (x1 * x1 + y1 * y1 >= bestSquare) continue;  // so is all of the row
                    for (const ContactPlace& entry :
                         cells.around(placed, cell.x + cx, cell.y + cy, cell.z)) {
                        const gpu::ivec3 d(entry.place[0] - p.x, entry.place[1] - p.y,
                                           entry.place[2] - p.z);
                        const uint32_t square = gpu::squareSum(d);
                        if (square >= bestSquare) continue;
                        bestSquare = square;
                        best = {texel, entry.texel, gpu::isqrtNear(square)};
                    }
                }
            }
            if (bestSquare <= uint32_t(kGap * kGap)) out.push_back(best);
        }
    });
}

}  // namespace fw::mesh
