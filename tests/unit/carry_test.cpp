// Matching of texels between two meshes for a transferred burn: the matches and the search time.
#include "mesh/bake.h"
#include "mesh_checks.h"

#include <chrono>

namespace fw::test {
namespace {

double placeOf(const BurnDomain& d, uint32_t texel, int axis) {
    const mesh::TexelPosition& p = d.texels[texel];
    const uint16_t units[3] = {p.x, p.y, p.z};
    return double(d.origin[axis]) + double(d.quantum) * double(units[axis]);
}

// Brute force: for every texel of the other mesh the nearest texel that faces the same way.
TEST(MatchTexels, FindsTheNearestTexelOfTheSameFacing) {
    const BurnDomain from = bakeOf(makeCube(1.0, 32, true).input(24));
    const BurnDomain to = bakeOf(makeCube(1.0, 12, true).input(14));
    std::pmr::vector<uint32_t> match;
    const uint32_t matched = mesh::matchTexels(from, to, 0.1f, match);
    EXPECT_EQ(to.report.realTexels, matched);
    for (uint32_t i = 0; i < to.texelCount(); ++i) {
        if (!to.real(i)) continue;
        ASSERT_LT(match[i], from.texelCount());
        double least = 1e9, taken = 0;
        for (uint32_t k = 0; k < from.texelCount(); ++k) {
            if (!from.real(k)) continue;
            double square = 0;
            for (int axis = 0; axis < 3; ++axis)
                square += std::pow(placeOf(from, k, axis) - placeOf(to, i, axis), 2);
            least = std::min(least, square);
            if (k == match[i]) taken = square;
        }
        ASSERT_NEAR(std::sqrt(least), std::sqrt(taken), 1e-5) << i;
    }
}

// Distant parts of a differently shaped mesh end the search as early as near ones.
TEST(MatchTexels, EndsEarlyWithoutANearTexel) {
    const BurnDomain from = bakeOf(makeCube(1.0, 32, true).input(150));
    const BurnDomain to = bakeOf(makeCube(1.5, 32, true).input(100));
    std::pmr::vector<uint32_t> match;
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_EQ(0u, mesh::matchTexels(from, to, 0.15f, match));
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    EXPECT_LT(seconds, 5);
}

}  // namespace
}  // namespace fw::test
