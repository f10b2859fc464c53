#include "mesh/carry.h"

#include "shared/front.h"

#include <algorithm>
#include <cmath>
#include <glm/ext/vector_int3_sized.hpp>
#include <limits>

namespace fw::mesh {
namespace {

constexpr int kFaces = 1 << 27;    // of two unit normals in Q14: within 60 degrees
constexpr double kFarthest = 2e9;  // micrometres, of a reach: squares fit

// Micrometres: whole numbers, so that every machine picks the same texels.
using Place = glm::i64vec3;

Place micrometresOf(const BurnDomain& domain, uint32_t texel) noexcept {
    const glm::dvec3 place = domain.placeOf(texel) * 1e6;
    return {std::llround(place.x), std::llround(place.y), std::llround(place.z)};
}

struct PlacedTile {  // a tile with real texels
    uint32_t tile = 0;
    Place low{}, high{};
};

// `places`: by texel.
std::pmr::vector<PlacedTile> tilesOf(const BurnDomain& domain, std::pmr::vector<Place>& places) {
    places.resize(domain.texelCount());
    std::pmr::vector<PlacedTile> tiles(places.get_allocator().resource());
    for (uint32_t t = 0; t < domain.tileCount(); ++t) {
        constexpr int64_t kFar = std::numeric_limits<int64_t>::max();
        PlacedTile tile{t, Place(kFar), Place(-kFar)};
        eachTexel(domain, tile.tile, [&](uint32_t texel) {
            const Place& place = places[texel] = micrometresOf(domain, texel);
            tile.low = glm::min(tile.low, place);
            tile.high = glm::max(tile.high, place);
        });
        if (tile.low[0] <= tile.high[0]) tiles.push_back(tile);
    }
    return tiles;
}

// Square of the distance between two boxes, or most * most + 1 if it is larger than most * most.
int64_t gapOf(const Place& lowA, const Place& highA, const PlacedTile& b, int64_t most) noexcept {
    int64_t sum = 0;
    for (int i = 0; i < 3; ++i) {
        const int64_t gap = std::max({lowA[i] - b.high[i], b.low[i] - highA[i], int64_t(0)});
        if (gap > most) return most * most + 1;
        sum += gap * gap;
    }
    return sum;
}

struct NearTile {
    int64_t gap = 0;  // square
    uint32_t tile = 0;
    auto operator<=>(const NearTile&) const = default;
};

}  // namespace

uint32_t matchTexels(const BurnDomain& from, const BurnDomain& to, float reach,
                     std::pmr::vector<uint32_t>& out) {
    std::pmr::memory_resource* memory = out.get_allocator().resource();
    std::pmr::vector<Place> fromPlaces(memory), toPlaces(memory);
    const std::pmr::vector<PlacedTile> sources = tilesOf(from, fromPlaces),
                                       tiles = tilesOf(to, toPlaces);
    std::pmr::vector<NearTile> near(memory);
    out.assign(to.texelCount(), kNone);
    const auto farthest = int64_t(std::min(double(reach) * 1e6, kFarthest));
    const int64_t least = farthest * farthest;
    FW_ASSERT(farthest >= 0, "reach %g m", double(reach));
    uint32_t matched = 0;
    for (const PlacedTile& tile : tiles) {
        near.clear();
        for (uint32_t k = 0; k < sources.size(); ++k)
            if (const int64_t gap = gapOf(tile.low, tile.high, sources[k], farthest); gap <= least)
                near.push_back({gap, k});
        std::sort(near.begin(), near.end());
        eachTexel(to, tile.tile, [&](uint32_t texel) {
            const Place& place = toPlaces[texel];
            const gpu::ivec3 normal = gpu::decodeNormal(to.normals[texel]);
            uint32_t& taken = out[texel];
            // A texel that faces another way counts as one reach further off.
            int64_t best = 2 * least + 1;
            for (const NearTile& one : near) {
                if (one.gap > best) break;
                const PlacedTile& source = sources[one.tile];
                if (gapOf(place, place, source, farthest) > std::min(best, least)) continue;
                eachTexel(from, source.tile, [&](uint32_t other) {
                    const Place off = fromPlaces[other] - place;
                    int64_t square = off.x * off.x + off.y * off.y + off.z * off.z;
                    if (square > std::min(best, least)) return;
                    if (gpu::dotInt(gpu::decodeNormal(from.normals[other]), normal) < kFaces)
                        square += least;
                    if (square > best || (square == best && other > taken)) return;
                    best = square;
                    taken = other;
                });
            }
            FW_ASSERT(taken == kNone || from.real(taken), "texel %u", taken);
            matched += taken != kNone ? 1u : 0u;
        });
    }
    return matched;
}

}  // namespace fw::mesh
