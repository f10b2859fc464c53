// Tiles: which texels have link records, which are read from other tiles, and by whom.
// Also the bounds that make queries fast.
#include "mesh/texels.h"

namespace fw::mesh {
namespace {

struct Read {  // tile `to` has a record that names a texel of tile `of`
    uint32_t of, to;
    bool operator<(const Read& o) const { return of != o.of ? of < o.of : to < o.to; }
    bool operator==(const Read& o) const { return of == o.of && to == o.to; }
};

void setBit(uint32_t& low, uint32_t& high, uint32_t lane) {
    (lane < 32 ? low : high) |= 1u << (lane & 31);
}

}  // namespace

void buildTiles(const TexelGrid& grid, BurnDomain& domain, std::pmr::memory_resource* memory) {
    const uint32_t width = grid.width;
    const auto tileOf = [&](uint32_t texel) {
        return texel / width / kTileSide * domain.tilesX + texel % width / kTileSide;
    };
    const auto laneOf = [&](uint32_t texel) {
        return texel / width % kTileSide * kTileSide + texel % width % kTileSide;
    };
    domain.tiles.assign(domain.tileCount(), TileStatic{});
    std::pmr::vector<Read> reads(memory);
    for (uint32_t t = 0; t < domain.tileCount(); ++t) {
        TileStatic& tile = domain.tiles[t];
        tile.rimBase = uint32_t(domain.links.size() / 8);
        const uint32_t corner =
            t / domain.tilesX * kTileSide * width + t % domain.tilesX * kTileSide;
        for (uint32_t lane = 0; lane < kTileSide * kTileSide; ++lane) {
            const uint32_t texel = corner + lane / kTileSide * width + lane % kTileSide;
            if (!grid.real(texel) || grid.linkRecord[texel] == kNone) continue;
            setBit(tile.rimMaskLow, tile.rimMaskHigh, lane);
            for (int k = 0; k < 8; ++k) {
                const uint32_t link = grid.ring(texel, k);
                domain.links.push_back(link);
                if (link == kNone || tileOf(link) == t) continue;
                reads.push_back({tileOf(link), t});
                TileStatic& source = domain.tiles[tileOf(link)];
                setBit(source.seamMaskLow, source.seamMaskHigh, laneOf(link));
            }
        }
    }
    std::sort(reads.begin(), reads.end());
    reads.erase(std::unique(reads.begin(), reads.end()), reads.end());
    domain.readers.reserve(reads.size());
    size_t next = 0;
    for (uint32_t t = 0; t < domain.tileCount(); ++t) {
        domain.tiles[t].readerStart = uint32_t(next);
        for (; next < reads.size() && reads[next].of == t; ++next)
            domain.readers.push_back(reads[next].to);
        domain.tiles[t].readerCount = uint32_t(next) - domain.tiles[t].readerStart;
    }
}

void buildTileBounds(BurnDomain& domain) {
    domain.tileBounds.assign(domain.tileCount(), TileBounds{});
    for (uint32_t texel = 0; texel < domain.texelCount(); ++texel) {
        if (!domain.real(texel)) continue;
        const uint32_t tile =
            texel / domain.width / kTileSide * domain.tilesX + texel % domain.width / kTileSide;
        TileBounds& bounds = domain.tileBounds[tile];
        const TexelPosition& p = domain.texels[texel];
        const uint16_t at[3] = {p.x, p.y, p.z};
        for (int k = 0; k < 3; ++k) {
            bounds.low[k] = std::min(bounds.low[k], at[k]);
            bounds.high[k] = std::max(bounds.high[k], at[k]);
        }
    }
}

}  // namespace fw::mesh
