// Parts of one mesh that share no edge but lie within kContactGap of each other. Each block of 4 x
// 4 texels stores the nearest place of another part, so that every tile has four links.
#include "mesh/part_links.h"

#include "mesh/hold.h"
#include "mesh/texels.h"
#include "shared/exchange.h"

#include <algorithm>
#include <array>

namespace fw::mesh {
namespace {

constexpr int kFarthest = 32767;   // units: squares of three of these fit in 32 bits
constexpr size_t kCandidates = 4;  // blocks that are compared texel by texel
constexpr uint32_t kBlockTexels = 16;

struct Entry {  // one part's texel in a block
    uint64_t key = 0;
    int place[3] = {};
    uint32_t block = 0;  // tile * 4 + block of it
    uint32_t part = 0;
};

struct Near {
    uint32_t square = 0xFFFFFFFFu;
    uint32_t entry = 0;
};

uint32_t texelOf(const BurnDomain& domain, uint32_t block, uint32_t lane) noexcept {
    const uint32_t tile = block / 4;
    const uint32_t x = tile % domain.tilesX * kTileSide + block % 2 * 4 + lane % 4;
    const uint32_t y = tile / domain.tilesX * kTileSide + block % 4 / 2 * 4 + lane / 4;
    return y * domain.width + x;
}

uint64_t keyOf(int x, int y, int z) noexcept {  // cells from -1 on
    return uint64_t(x + 1) << 42 | uint64_t(y + 1) << 21 | uint64_t(z + 1);
}

uint32_t squareBetween(const TexelPosition& a, const TexelPosition& b) noexcept {
    const int64_t x = int64_t(a.x) - b.x, y = int64_t(a.y) - b.y, z = int64_t(a.z) - b.z;
    return uint32_t(std::min<int64_t>(x * x + y * y + z * z, 0xFFFFFFFFll));
}

struct Blocks {
    const BurnDomain& domain;
    const Pieces& pieces;
    std::pmr::vector<Entry> entries;  // by cell
    int cell = 1;                     // units

    [[nodiscard]] int cellOf(int place) const noexcept { return place / cell; }

    // One for each part in each block: the texel of it that is nearest to the block's middle.
    void gather() {
        static constexpr std::array<uint8_t, kBlockTexels> kFromMiddle = {
            5, 6, 9, 10, 1, 2, 4, 8, 7, 11, 13, 14, 0, 3, 12, 15};
        for (uint32_t block = 0; block < domain.tileCount() * 4; ++block) {
            const size_t first = entries.size();
            for (const uint8_t lane : kFromMiddle) {
                const uint32_t texel = texelOf(domain, block, lane);
                const uint32_t part = pieces.of[texel];
                if (part == kNone ||
                    std::any_of(entries.begin() + std::ptrdiff_t(first), entries.end(),
                                [&](const Entry& entry) { return entry.part == part; }))
                    continue;
                const TexelPosition& p = domain.texels[texel];
                entries.push_back(
                    {keyOf(cellOf(p.x), cellOf(p.y), cellOf(p.z)), {p.x, p.y, p.z}, block, part});
            }
        }
        std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
            return a.key != b.key       ? a.key < b.key
                   : a.block != b.block ? a.block < b.block
                                        : a.part < b.part;
        });
    }

    // The nearest entries of other parts, within a cell's side.
    void nearest(const Entry& of, std::array<Near, kCandidates>& found) const noexcept {
        found = {};
        const int at[3] = {cellOf(of.place[0]), cellOf(of.place[1]), cellOf(of.place[2])};
        for (int column = 0; column < 9; ++column) {
            const int x = at[0] + column / 3 - 1, y = at[1] + column % 3 - 1;
            const uint64_t last = keyOf(x, y, at[2] + 1);
            auto entry = std::lower_bound(entries.begin(), entries.end(), keyOf(x, y, at[2] - 1),
                                          [](const Entry& e, uint64_t key) { return e.key < key; });
            for (; entry != entries.end() && entry->key <= last; ++entry) {
                if (entry->part == of.part) continue;
                int64_t square = 0;
                for (int k = 0; k < 3; ++k) {
                    const int64_t d = int64_t(entry->place[k]) - of.place[k];
                    square += d * d;
                }
                if (square > int64_t(cell) * cell || square >= found.back().square) continue;
                found.back() = {uint32_t(square), uint32_t(entry - entries.begin())};
                for (size_t i = kCandidates - 1; i > 0 && found[i].square < found[i - 1].square;
                     --i)
                    std::swap(found[i], found[i - 1]);
            }
        }
    }
};

}  // namespace

PartLink readPartLink(const BurnDomain& domain, uint32_t tile, uint32_t block,
                      uint32_t link) noexcept {
    FW_ASSERT(link != kNone && block < 4, "word %u of block %u", link, block);
    const uint32_t lane = gpu::partFrom(link, block);
    return {lane, domain.texelsOf(tile)[lane], link % gpu::kPartTexels};
}

PartPath partPath(const BurnDomain& domain, std::span<const gpu::BurnMaterial> materials,
                  const PartLink& link) noexcept {
    FW_ASSERT(domain.real(link.from) && domain.real(link.to), "from texel %u to %u", link.from,
              link.to);
    FW_ASSERT(materials.size() >= gpu::kMaterialsPerObject, "%zu materials", materials.size());
    const TexelPosition &p = domain.texels[link.from], &q = domain.texels[link.to];
    const auto materialOf = [&](const TexelPosition& at) {
        return &materials[at.materialFlags & (gpu::kMaterialsPerObject - 1)];
    };
    PartPath way{materialOf(p), materialOf(q)};
    const gpu::ivec3 gap(int(q.x) - p.x, int(q.y) - p.y, int(q.z) - p.z);
    way.delay = (way.reached->flags & 1) != 0 ? gpu::partDelay(*way.reached, gap) : gpu::kNever;
    return way;
}

void linkParts(BurnDomain& domain, std::pmr::memory_resource* memory) {
    domain.partLinks.clear();
    Pieces pieces(memory);
    findPieces(domain, {}, pieces);
    if (pieces.count < 2) return;
    const double units = 1 / std::max(double(domain.quantum), 1e-12);
    const int gap = int(std::min(gpu::kContactGap / 1000.0 * units, double(kFarthest)));
    const double block = 6 * double(domain.texelSide) * units;  // from one's middle to another's
    Blocks blocks{domain, pieces, std::pmr::vector<Entry>(memory),
                  int(std::clamp(gap + block, 1.0, 1e6))};
    blocks.gather();
    std::pmr::vector<uint32_t> squares(size_t(domain.tileCount()) * 4,
                                       uint32_t(gap) * uint32_t(gap) + 1, memory);
    std::pmr::vector<uint32_t> links(squares.size(), kNone, memory);
    bool any = false;
    std::array<Near, kCandidates> near;
    for (const Entry& of : blocks.entries) {
        blocks.nearest(of, near);
        for (const Near& candidate : near) {
            if (candidate.square == 0xFFFFFFFFu) break;
            const Entry& other = blocks.entries[candidate.entry];
            for (uint32_t lane = 0; lane < kBlockTexels; ++lane) {
                const uint32_t from = texelOf(domain, of.block, lane);
                if (pieces.of[from] != of.part) continue;
                for (uint32_t there = 0; there < kBlockTexels; ++there) {
                    const uint32_t to = texelOf(domain, other.block, there);
                    if (pieces.of[to] != other.part) continue;
                    const uint32_t square = squareBetween(domain.texels[from], domain.texels[to]);
                    if (square >= squares[of.block]) continue;
                    squares[of.block] = square;
                    links[of.block] = lane << 28 | to;
                    any = true;
                }
            }
        }
    }
    if (any) domain.partLinks.assign(links.begin(), links.end());
}

}  // namespace fw::mesh
