// Texels near a point. The point is rounded to position units first, so that every machine picks
// the same texels. Tiles are skipped by their bounds.
#include "mesh/texels.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace fw::mesh {
namespace {

// A point in units of 2^shift position units. Points near the mesh have a shift of 0. Points whose
// square would not fit into 64 bits have a larger one, still finer than the host's float.
struct Units {
    int64_t at[3];  // position units
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
int64_t squareTo(const TexelPosition& p, const Units& u) {
    const int64_t x = (p.x - u.at[0]) >> u.shift, y = (p.y - u.at[1]) >> u.shift,
                  z = (p.z - u.at[2]) >> u.shift;
    return x * x + y * y + z * z;
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

}  // namespace fw::mesh
