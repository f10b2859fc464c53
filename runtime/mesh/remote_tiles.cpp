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

uint64_t keyOf(int x, int y, int z) noexcept {
    const auto part = [](int v) { return uint64_t(uint32_t(v + (1 << 20)) & 0x1FFFFFu); };
    return part(x) << 42 | part(y) << 21 | part(z);
}
int cellOf(int mm) noexcept {
    constexpr int kSide = int(gpu::kContactGap);
    return mm >= 0 ? mm / kSide : -((kSide - 1 - mm) / kSide);
}

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
    const Box toBox = wholeBox(to);
    nearTiles(from, toBox, [&](uint32_t tile, const Box&) {
        const uint32_t corner = tile / from.domain->tilesX * kTileSide * from.domain->width +
                                tile % from.domain->tilesX * kTileSide;
        for (uint32_t lane = 0; lane < 64; ++lane) {
            const uint32_t texel = corner + (lane >> 3) * from.domain->width + (lane & 7);
            if (!burnsAt(from, texel)) continue;
            const gpu::ivec3 p = placeOf(from, texel);
            if (!inside(p, toBox, kGap)) continue;
            placed.push_back(
                {keyOf(cellOf(p.x), cellOf(p.y), cellOf(p.z)), {p.x, p.y, p.z}, texel});
        }
    });
    if (placed.empty()) return;
    std::sort(placed.begin(), placed.end(), [](const ContactPlace& a, const ContactPlace& b) {
        return a.key != b.key ? a.key < b.key : a.texel < b.texel;
    });
    const size_t most = out.size() + kMostContacts;
    nearTiles(to, wholeBox(from), [&](uint32_t tile, const Box&) {
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
                const int cell[3] = {cellOf(p.x), cellOf(p.y), cellOf(p.z)};
                for (int around = 0; around < 9; ++around) {
                    const int cx = cell[0] + around / 3 - 1, cy = cell[1] + around % 3 - 1;
                    const uint64_t last = keyOf(cx, cy, cell[2] + 1);
                    auto entry = std::lower_bound(
                        placed.begin(), placed.end(), keyOf(cx, cy, cell[2] - 1),
                        [](const ContactPlace& a, uint64_t key) { return a.key < key; });
                    for (; entry != placed.end() && entry->key <= last; ++entry) {
                        const gpu::ivec3 d(entry->place[0] - p.x, entry->place[1] - p.y,
                                           entry->place[2] - p.z);
                        const uint32_t square = gpu::squareSum(d);
                        if (square >= bestSquare) continue;
                        bestSquare = square;
                        best = {texel, entry->texel, gpu::isqrtNear(square)};
                    }
                }
            }
            if (bestSquare <= uint32_t(kGap * kGap)) out.push_back(best);
        }
    });
}

}  // namespace fw::mesh
