// Tiles: their texels with link records, their texels that other tiles read, and those tiles.
// Also the bounds that make queries fast.
#include "mesh/texels.h"

namespace fw::mesh {
namespace {

struct Read {  // tile `to` has a record that names a texel of tile `of`
    uint32_t of, to;
    auto operator<=>(const Read&) const = default;
};

}  // namespace

void buildTiles(const TexelGrid& grid, BurnDomain& domain) {
    FW_ASSERT(grid.count() == domain.texelCount(), "%u and %u texels", grid.count(),
              domain.texelCount());
    FW_ASSERT(domain.links.empty() && domain.dependents.empty());
    domain.tiles.assign(domain.tileCount(), TileStatic{});
    std::pmr::vector<Read> reads(grid.memory);
    for (uint32_t t = 0; t < domain.tileCount(); ++t) {
        TileStatic& tile = domain.tiles[t];
        tile.rimBase = uint32_t(domain.links.size() / 8);
        const TileTexels texels = domain.texelsOf(t);
        for (uint32_t lane = 0; lane < kTileLanes; ++lane) {
            const uint32_t texel = texels[lane];
            if (!grid.real(texel) || grid.linkRecord[texel] == kNone) continue;
            tile.rimMask |= uint64_t(1) << lane;
            for (int k = 0; k < 8; ++k) {
                const uint32_t link = grid.ring(texel, k);
                domain.links.push_back(link);
                const uint32_t of = link == kNone ? t : domain.tileOf(link);
                if (of == t) continue;
                reads.push_back({of, t});
                domain.tiles[of].seamMask |= uint64_t(1) << domain.laneOf(link);
            }
        }
    }
    std::sort(reads.begin(), reads.end());
    reads.erase(std::unique(reads.begin(), reads.end()), reads.end());
    domain.dependents.reserve(reads.size());
    size_t next = 0;
    FW_ASSERT(domain.links.size() % 8 == 0, "%zu links", domain.links.size());
    for (uint32_t t = 0; t < domain.tileCount(); ++t) {
        domain.tiles[t].dependentStart = uint32_t(next);
        for (; next < reads.size() && reads[next].of == t; ++next)
            domain.dependents.push_back(reads[next].to);
        domain.tiles[t].dependentCount = uint32_t(next) - domain.tiles[t].dependentStart;
    }
}

void buildTileBounds(BurnDomain& domain) {
    domain.tileBounds.assign(domain.tileCount(), TileBounds{});
    for (uint32_t tile = 0; tile < domain.tileCount(); ++tile) {
        TileBounds& bounds = domain.tileBounds[tile];
        eachTexel(domain, tile, [&](uint32_t texel) {
            const glm::ivec3 at = domain.texels[texel].units();
            for (int k = 0; k < 3; ++k) {
                bounds.low[k] = std::min(bounds.low[k], uint16_t(at[k]));
                bounds.high[k] = std::max(bounds.high[k], uint16_t(at[k]));
            }
        });
    }
}

}  // namespace fw::mesh
