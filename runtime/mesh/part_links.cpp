// Parts of one mesh that share no edge but lie within kContactGap of each other. Each block of 4 x
// 4 texels stores the nearest place of another part, so that every tile has four links.
#include "mesh/part_links.h"

#include "mesh/hold.h"
#include "mesh/texels.h"
#include "shared/exchange.h"

#include <algorithm>
#include <array>
#include <tuple>

namespace fw::mesh {
namespace {

constexpr int kFarthest = 32767;   // units: squares of three of these fit in 32 bits
constexpr size_t kCandidates = 4;  // blocks that are compared texel by texel
constexpr uint32_t kBlockTexels = 16;

struct Entry {  // one part's texel in a block
    uint64_t key = 0;
    uint32_t block = 0;  // tile * 4 + block of it
    uint32_t part = 0;
    glm::ivec3 place{0};
    bool operator<(const Entry& other) const noexcept {
        return std::tie(key, block, part) < std::tie(other.key, other.block, other.part);
    }
};

struct Near {
    uint32_t square = kNone;
    uint32_t entry = 0;
};

uint32_t texelOf(const BurnDomain& domain, uint32_t block, uint32_t lane) noexcept {
    const uint32_t tile = block / 4;
    const uint32_t x = tile % domain.tilesX * kTileSide + block % 2 * 4 + lane % 4;
    const uint32_t y = tile / domain.tilesX * kTileSide + block % 4 / 2 * 4 + lane / 4;
    return y * domain.width + x;
}

uint64_t keyOf(glm::ivec3 cell) noexcept {  // cells from -1 on
    return uint64_t(cell.x + 1) << 42 | uint64_t(cell.y + 1) << 21 | uint64_t(cell.z + 1);
}

int64_t squareBetween(glm::ivec3 a, glm::ivec3 b) noexcept {
    const int64_t x = a.x - b.x, y = a.y - b.y, z = a.z - b.z;
    return x * x + y * y + z * z;
}

struct Blocks {
    const BurnDomain& domain;
    const Pieces& pieces;
    std::pmr::vector<Entry> entries;  // by cell
    int cell = 1;                     // units

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
                const glm::ivec3 place = domain.texels[texel].units();
                entries.push_back({keyOf(place / cell), block, part, place});
            }
        }
        std::sort(entries.begin(), entries.end());
    }

    // The nearest entries of other parts, within a cell's side.
    void nearest(const Entry& of, std::array<Near, kCandidates>& found) const noexcept {
        found = {};
        const glm::ivec3 at = of.place / cell;
        for (int column = 0; column < 9; ++column) {
            const glm::ivec3 first = at + glm::ivec3(column / 3 - 1, column % 3 - 1, -1);
            const uint64_t last = keyOf(first + glm::ivec3(0, 0, 2));
            auto entry = std::lower_bound(entries.begin(), entries.end(), keyOf(first),
                                          [](const Entry& e, uint64_t key) { return e.key < key; });
            for (; entry != entries.end() && entry->key <= last; ++entry) {
                if (entry->part == of.part) continue;
                const int64_t square = squareBetween(entry->place, of.place);
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
    PartPath path{materialOf(p), materialOf(q)};
    if ((path.reached->flags & 1) != 0)
        path.delay = gpu::partDelay(*path.reached, q.units() - p.units());
    return path;
}

void linkParts(BurnDomain& domain) {
    domain.partLinks.clear();
    Pieces pieces(domain.memory);
    findPieces(domain, {}, pieces);
    if (pieces.count < 2) return;
    const double units = 1 / std::max(double(domain.quantum), 1e-12);
    const int gap = int(std::min(gpu::kContactGap / 1000.0 * units, double(kFarthest)));
    const double block = 6 * double(domain.texelSide) * units;  // from one's middle to another's
    Blocks blocks{domain, pieces, std::pmr::vector<Entry>(domain.memory),
                  int(std::clamp(gap + block, 1.0, 1e6))};
    blocks.gather();
    std::pmr::vector<int64_t> squares(size_t(domain.tileCount()) * 4, int64_t(gap) * gap + 1,
                                      domain.memory);
    std::pmr::vector<uint32_t> links(squares.size(), kNone, domain.memory);
    std::array<Near, kCandidates> near;
    for (const Entry& of : blocks.entries) {
        blocks.nearest(of, near);
        for (const Near& candidate : near) {
            if (candidate.square == kNone) break;
            const Entry& other = blocks.entries[candidate.entry];
            for (uint32_t lane = 0; lane < kBlockTexels; ++lane) {
                const uint32_t from = texelOf(domain, of.block, lane);
                if (pieces.of[from] != of.part) continue;
                for (uint32_t there = 0; there < kBlockTexels; ++there) {
                    const uint32_t to = texelOf(domain, other.block, there);
                    if (pieces.of[to] != other.part) continue;
                    const int64_t square =
                        squareBetween(domain.texels[from].units(), domain.texels[to].units());
                    if (square >= squares[of.block]) continue;
                    squares[of.block] = square;
                    links[of.block] = lane << 28 | to;
                }
            }
        }
    }
    if (std::any_of(links.begin(), links.end(), [](uint32_t link) { return link != kNone; }))
        domain.partLinks.assign(links.begin(), links.end());
}

}  // namespace fw::mesh
