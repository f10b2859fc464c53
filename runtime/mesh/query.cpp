// Texels near a point, and near those of another mesh. The point is rounded to position units
// first, so that every machine picks the same texels. Tiles are skipped by their bounds.
#include "mesh/texels.h"
#include "shared/front.h"

#include <algorithm>
#include <cmath>
#include <glm/ext/vector_int3_sized.hpp>
#include <glm/geometric.hpp>
#include <limits>

namespace fw::mesh {
namespace {

// A point in units of 2^shift position units. Points near the mesh have a shift of 0. Points whose
// square would not fit into 64 bits have a larger one, still finer than the host's float.
struct Units {
    glm::i64vec3 at;  // position units
    uint32_t shift;
};

constexpr double kMaxDistance = 2305843009213693952.0;  // 2^61
constexpr int64_t kMaxUnits = int64_t(1) << 30;         // three squares of these fit into 63 bits

int64_t toUnits(double metres, double quantum) {
    FW_ASSERT(quantum > 0, "%g m", quantum);
    const double units = metres / quantum;
    if (std::isnan(units)) return 0;
    return int64_t(std::floor(std::clamp(units, -kMaxDistance, kMaxDistance) + 0.5));
}
Units unitsOf(const BurnDomain& domain, const float point[3]) {
    Units units{};
    int64_t most = 0;
    for (int k = 0; k < 3; ++k) {
        const double d = double(point[k]) - double(domain.origin[k]);
        units.at[k] = toUnits(d, double(domain.quantum));
        most = std::max(most, std::abs(units.at[k]));
    }
    while (most >> units.shift > kMaxUnits) ++units.shift;
    return units;
}
int64_t squareOf(glm::i64vec3 v) { return v.x * v.x + v.y * v.y + v.z * v.z; }
// By component: vectors of 64 bits are slower here.
int64_t squareTo(const TexelPosition& p, const Units& u) {
    return squareOf(
        {(p.x - u.at.x) >> u.shift, (p.y - u.at.y) >> u.shift, (p.z - u.at.z) >> u.shift});
}
int64_t squareTo(const TileBounds& b, const Units& u) {
    int64_t sum = 0;
    for (int k = 0; k < 3; ++k) {
        const int64_t d =
            std::max({b.low[k] - u.at[k], u.at[k] - b.high[k], int64_t(0)}) >> u.shift;
        sum += d * d;
    }
    return sum;
}

// Calls visit(texel, square) for the real texels within a square distance that may shrink.
template <typename Visit>
void visitWithin(const BurnDomain& domain, const Units& point, const int64_t& limit, Visit visit) {
    FW_ASSERT(domain.tileBounds.size() == domain.tileCount(), "%zu of %u tiles",
              domain.tileBounds.size(), domain.tileCount());
    for (uint32_t t = 0; t < domain.tileCount(); ++t) {
        const TileBounds& bounds = domain.tileBounds[t];
        if (bounds.low[0] > bounds.high[0] || squareTo(bounds, point) > limit) continue;
        eachTexel(domain, t, [&](uint32_t texel) {
            const int64_t square = squareTo(domain.texels[texel], point);
            if (square <= limit) visit(texel, square);
        });
    }
}

uint32_t nearestWithin(const BurnDomain& domain, const Units& point, int64_t limit) {
    uint32_t best = kNone;
    visitWithin(domain, point, limit, [&](uint32_t texel, int64_t square) {
        if (best != kNone && square == limit && texel > best) return;
        best = texel;
        limit = square;
    });
    return best;
}

int64_t unitsOf(const BurnDomain& domain, float metres) {
    return metres >= 0 ? toUnits(double(metres), double(domain.quantum)) : 0;  // also of NaN
}

constexpr int kFaces = 1 << 27;         // of two unit normals in Q14: within 60 degrees
constexpr double kFarthestReach = 2e9;  // micrometres, of a reach: squares fit

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

uint32_t nearestTexel(const BurnDomain& domain, const float point[3], float maxDistance) {
    const Units units = unitsOf(domain, point);
    // No texel is farther away than twice kMaxUnits.
    const int64_t reach = unitsOf(domain, maxDistance) >> units.shift;
    const int64_t coarse = std::min(reach + (units.shift > 0 ? 1 : 0), 2 * kMaxUnits);
    // The 2: half a unit of rounding on each side must not lose a texel at the very reach.
    return nearestWithin(domain, units, coarse * coarse + 2);
}

void texelsNear(const BurnDomain& domain, const float point[3], float radius,
                std::pmr::vector<uint32_t>& out) {
    out.clear();
    const uint32_t centre =
        nearestWithin(domain, unitsOf(domain, point), std::numeric_limits<int64_t>::max());
    if (centre == kNone) return;
    const TexelPosition& p = domain.texels[centre];
    const int64_t reach = std::min(unitsOf(domain, radius), kMaxUnits);  // the mesh ends before
    FW_ASSERT(domain.real(centre), "texel %u", centre);
    visitWithin(domain, {{p.x, p.y, p.z}, 0}, reach * reach,
                [&](uint32_t texel, int64_t) { out.push_back(texel); });
    std::sort(out.begin(), out.end());
}

void texelWeights(const BurnDomain& domain, uint32_t texel, float (&weights)[3]) noexcept {
    FW_ASSERT(domain.real(texel) && domain.triangleOf[texel] < domain.indices.size() / 3,
              "texel %u has no triangle", texel);
    const uint32_t triangle = domain.triangleOf[texel];
    const glm::dvec3 last(domain.cornerOf(triangle, 2).place());
    const glm::dvec3 a = glm::dvec3(domain.cornerOf(triangle, 0).place()) - last,
                     b = glm::dvec3(domain.cornerOf(triangle, 1).place()) - last,
                     p = domain.placeOf(texel) - last;
    // Least squares in the triangle's plane.
    const double aa = glm::dot(a, a), ab = glm::dot(a, b), bb = glm::dot(b, b);
    const double ap = glm::dot(a, p), bp = glm::dot(b, p);
    const double determinant = aa * bb - ab * ab;
    double u = 1.0 / 3, v = 1.0 / 3;
    if (determinant > 1e-12 * aa * bb) {
        u = (ap * bb - bp * ab) / determinant;
        v = (bp * aa - ap * ab) / determinant;
    }
    u = std::clamp(u, 0.0, 1.0);
    v = std::clamp(v, 0.0, 1.0 - u);
    weights[0] = float(u);
    weights[1] = float(v);
    weights[2] = float(1 - u - v);
}

uint32_t matchTexels(const BurnDomain& from, const BurnDomain& to, float reach,
                     std::pmr::vector<uint32_t>& out) {
    std::pmr::memory_resource* memory = out.get_allocator().resource();
    std::pmr::vector<Place> fromPlaces(memory), toPlaces(memory);
    const std::pmr::vector<PlacedTile> sources = tilesOf(from, fromPlaces),
                                       tiles = tilesOf(to, toPlaces);
    std::pmr::vector<NearTile> near(memory);
    out.assign(to.texelCount(), kNone);
    const auto farthest = int64_t(std::min(double(reach) * 1e6, kFarthestReach));
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
                    int64_t square = squareOf(fromPlaces[other] - place);
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
