// Cells of tiles that each show a flame: mesh::BurnDomain::flameCells.
#include "mesh/bake.h"
#include "shared/body.h"
#include "support/meshes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace fw::test::flame_cells_test {
namespace {

void expectCells(const mesh::BurnDomain& domain) {
    ASSERT_EQ(domain.flameCells.size(), domain.tileCount());
    ASSERT_GT(domain.flameCellCount, 0u);
    EXPECT_LE(domain.flameCellCount, gpu::kBodyCells);
    EXPECT_GE(domain.flameCellSide, float(mesh::kTileSide) * domain.texelSide);
    std::vector<std::array<double, 6>> spans(domain.flameCellCount,
                                             {1e9, 1e9, 1e9, -1e9, -1e9, -1e9});
    std::set<uint32_t> used;
    for (uint32_t tile = 0; tile < domain.tileCount(); ++tile) {
        const mesh::TileBounds& bounds = domain.tileBounds[tile];
        const uint32_t cell = domain.flameCells[tile];
        const bool real = bounds.low[0] <= bounds.high[0];
        EXPECT_EQ(real, cell != mesh::kNone) << "tile " << tile;
        if (!real) continue;
        ASSERT_LT(cell, domain.flameCellCount);
        used.insert(cell);
        for (size_t k = 0; k < 3; ++k) {
            spans[cell][k] = std::min(spans[cell][k], double(bounds.low[k]));
            spans[cell][3 + k] = std::max(spans[cell][3 + k], double(bounds.high[k]));
        }
    }
    EXPECT_EQ(used.size(), domain.flameCellCount) << "none is empty";
    // Middles of tiles lie in a cell; tiles may be half as long again as eight texels.
    const double most =
        double(domain.flameCellSide) + 1.5 * mesh::kTileSide * double(domain.texelSide);
    for (const std::array<double, 6>& span : spans)
        for (size_t k = 0; k < 3; ++k)
            EXPECT_LT((span[3 + k] - span[k]) * double(domain.quantum), most);
}

TEST(FlameCells, AreFewAndTogether) {
    std::pmr::memory_resource* memory = std::pmr::get_default_resource();
    for (const double texels : {4.0, 64.0, 300.0}) {
        SCOPED_TRACE(texels);
        expectCells(mesh::bake(makeCube(1, 4).input(texels), memory));
        expectCells(mesh::bake(makeSheet(1, 4).input(texels), memory));
        expectCells(mesh::bake(makeCylinder(0.2, 1, 16, 4, 2, true).input(texels), memory));
    }
}

// A flame stands on one side.
TEST(FlameCells, SidesOfACubeAreApart) {
    const mesh::BurnDomain domain =
        mesh::bake(makeCube(1, 4, false, false).input(64), std::pmr::get_default_resource());
    EXPECT_GE(domain.flameCellCount, 6u);
}

}  // namespace
}  // namespace fw::test::flame_cells_test
