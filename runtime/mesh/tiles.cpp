// Tiles: their texels with link records, their texels that other tiles read, and those tiles.
// Also the bounds that make queries fast.
#include "mesh/texels.h"
#include "shared/body.h"
#include "shared/front.h"

#include <cmath>
#include <tuple>

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

// The smallest cells that are few enough, and no smaller than a tile.
void buildFlameCells(BurnDomain& domain) {
    struct Key {
        int x = 0, y = 0, z = 0, facing = 0;  // facing: axis and sign
        uint32_t tile = 0;
    };
    const auto place = [](const Key& key) { return std::tie(key.x, key.y, key.z, key.facing); };
    std::pmr::vector<Key> keys(domain.memory);
    std::pmr::vector<glm::dvec3> middles(domain.tileCount(), glm::dvec3(0), domain.memory);
    std::pmr::vector<int> facings(domain.tileCount(), -1, domain.memory);
    double all = 0;  // texels
    for (uint32_t tile = 0; tile < domain.tileCount(); ++tile) {
        glm::ivec3 normal(0);
        double count = 0;
        eachTexel(domain, tile, [&](uint32_t texel) {
            middles[tile] += domain.placeOf(texel);
            normal += gpu::decodeNormal(domain.normals[texel]);
            count += 1;
        });
        if (count == 0) continue;
        middles[tile] /= count;
        all += count;
        const glm::ivec3 size = glm::abs(normal);
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        facings[tile] = 2 * axis + (normal[axis] < 0 ? 1 : 0);
    }
    const double each = 0.6 * std::sqrt(all / double(gpu::kBodyCells));  // texels a side
    float side = std::max(float(kTileSide), float(each)) * domain.texelSide;
    for (;; side *= 1.1f) {
        keys.clear();
        for (uint32_t tile = 0; tile < domain.tileCount(); ++tile) {
            if (facings[tile] < 0) continue;
            const auto cell = [&](int i) {
                return int(
                    std::floor((middles[tile][i] - double(domain.boundsLow[i])) / double(side)));
            };
            keys.push_back({cell(0), cell(1), cell(2), facings[tile], tile});
        }
        std::ranges::sort(keys, {}, [&](const Key& key) {
            return std::tuple_cat(place(key), std::tie(key.tile));
        });
        uint32_t count = 0;
        domain.flameCells.assign(domain.tileCount(), kNone);
        for (size_t i = 0; i < keys.size(); ++i) {
            if (i == 0 || place(keys[i]) != place(keys[i - 1])) ++count;
            domain.flameCells[keys[i].tile] = count - 1;
        }
        domain.flameCellCount = count;
        if (count <= gpu::kBodyCells) break;
    }
    domain.flameCellSide = side;
}

}  // namespace fw::mesh
