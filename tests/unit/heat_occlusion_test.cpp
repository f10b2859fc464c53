// Cells of the heat-occlusion grid: a segment meets exactly the cells it crosses, and objects fill
// the right cells.
#include "components/heat_occlusion.h"

#include "components/exchange_object.h"
#include "mesh/bake.h"
#include "support/meshes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

namespace fw::test {
namespace {

using components::OcclusionGridShape;
using gpu::ivec3;

OcclusionGridShape shapeOf(uint32_t x, uint32_t y, uint32_t z, uint32_t cell) {
    OcclusionGridShape shape;
    shape.counts = {x, y, z};
    shape.origin = {-700, 300, 1000};
    shape.cell = cell;
    return shape;
}

gpu::ExchangePush rulesOf(const OcclusionGridShape& shape) {
    gpu::ExchangePush rules{};
    rules.occlusionX = shape.origin[0];
    rules.occlusionY = shape.origin[1];
    rules.occlusionZ = shape.origin[2];
    rules.occlusionCell = shape.cell;
    rules.occlusionCounts = components::countsOf(shape);
    return rules;
}

std::vector<uint32_t> walked(const OcclusionGridShape& shape, ivec3 a, ivec3 b) {
    std::vector<uint32_t> cells;
    for (gpu::OcclusionWalk w = gpu::beginOcclusionWalk(rulesOf(shape), a, b); w.within;
         gpu::stepOcclusionWalk(w, shape.cell)) {
        cells.push_back(w.cell);
        if (cells.size() > 3 * gpu::kMaxOcclusionSide) break;
    }
    return cells;
}

// Points well inside a cell (3 mm, the precision of the grid entry) say which cells a segment must
// meet.
TEST(HeatOcclusion, SegmentsMeetTheCellsTheyCross) {
    std::mt19937 random(7);
    const auto below = [&](int most) { return int(random() % uint32_t(most)); };
    uint32_t met = 0, missed = 0;
    for (int i = 0; i < 2000; ++i) {
        const OcclusionGridShape shape =
            shapeOf(1 + uint32_t(below(30)), 1 + uint32_t(below(12)), 1 + uint32_t(below(30)),
                    50 + uint32_t(below(300)));
        ivec3 ends[2];
        for (ivec3& end : ends)
            for (int k = 0; k < 3; ++k) {
                const int size = int(shape.counts[size_t(k)] * shape.cell);
                end[k] = shape.origin[size_t(k)] - size / 2 + below(2 * size + 2);
            }
        if (i % 5 == 0) ends[1][i % 3] = ends[0][i % 3];  // in a plane of faces
        const std::vector<uint32_t> cells = walked(shape, ends[0], ends[1]);
        const std::set<uint32_t> all(cells.begin(), cells.end());
        ASSERT_EQ(all.size(), cells.size()) << "a cell is met twice, segment " << i;
        for (const uint32_t cell : cells) ASSERT_LT(cell, shape.cells());
        std::set<uint32_t> sure;  // cells that hold a point well inside
        for (int s = 0; s <= 4000; ++s) {
            uint32_t cell = 0;
            bool well = true;
            for (int k = 2; k >= 0; --k) {
                const double at = ends[0][k] + double(ends[1][k] - ends[0][k]) * s / 4000 -
                                  shape.origin[size_t(k)];
                const double c = std::floor(at / shape.cell);
                well = well && c >= 0 && c < shape.counts[size_t(k)] && at - c * shape.cell > 3 &&
                       (c + 1) * shape.cell - at > 3;
                if (!well) break;
                cell = cell * shape.counts[size_t(k)] + uint32_t(c);
            }
            if (well) sure.insert(cell);
        }
        for (const uint32_t cell : sure) {
            ASSERT_TRUE(all.count(cell)) << "segment " << i << ", cell " << cell;
            ++met;
        }
        // The other cells met are corners that it cuts.
        missed += uint32_t(all.size() - sure.size());
        for (size_t k = 1; k < cells.size(); ++k) {
            const uint32_t d =
                cells[k] > cells[k - 1] ? cells[k] - cells[k - 1] : cells[k - 1] - cells[k];
            ASSERT_TRUE(d == 1 || d == shape.counts[0] || d == shape.counts[0] * shape.counts[1]);
        }
    }
    EXPECT_GT(met, 10000u);
    EXPECT_LT(missed, met / 5);
}

// Far away and at the ends of the world nothing overflows; sanitizers check this.
TEST(HeatOcclusion, DistantSegmentsMeetNothing) {
    OcclusionGridShape shape = shapeOf(256, 32, 256, 10000);
    shape.origin = {1000000000, -1000000000, 0};
    for (const int at : {-2000000000, -40000, 0, 40000, 2000000000})
        EXPECT_TRUE(walked(shape, {at, at, -at / 2}, {at + 30000, at, -at / 2}).empty());
    EXPECT_TRUE(walked(shapeOf(4, 4, 4, 100), {-600, 400, 1100}, {-600, 400, 1100}).size() <= 1);
    EXPECT_TRUE(walked(OcclusionGridShape{}, {0, 0, 0}, {100, 0, 0}).empty());
}

// A slanted plane has no gap from either side: each segment through it meets one of its cells.
TEST(HeatOcclusion, ObjectsFillTheCellsOfTheirTexels) {
    const Mesh plane = makePlane(2, 2, 0, 1, 90);  // along x and z
    const mesh::BurnDomain domain = mesh::bake(plane.input(48), std::pmr::get_default_resource());
    for (const float turn : {0.0f, 0.3f, 0.78f}) {
        float transform[16] = {std::cos(turn),
                               std::sin(turn),
                               0,
                               0,
                               -std::sin(turn),
                               std::cos(turn),
                               0,
                               0,
                               0,
                               0,
                               1,
                               0,
                               0,
                               0,
                               0,
                               1};
        const components::Pose pose = components::makePose(transform, "transform");
        components::OcclusionObject object;
        object.slot = 5;
        object.domain = &domain;
        components::placeExchangeObject(pose, domain, object.place);
        object.texelSide = uint32_t(domain.texelSide * 1000);
        OcclusionGridShape shape;
        shape.counts = {60, 60, 60};
        shape.origin = {-500, -500, -500};
        shape.cell = 60;
        components::HeatOcclusion shield(std::pmr::get_default_resource());
        shield.shape = shape;
        shield.solid.assign(shape.words(), 0);
        components::bakeOcclusion(shape, {&object, 1}, shield.baked);
        std::pmr::vector<uint32_t> words;
        components::packOcclusion(shield, words);
        ASSERT_EQ(3 * shape.words() + 2 * shield.baked.size(), words.size());
        for (size_t i = 0; i < shield.baked.size(); ++i) {
            const uint32_t cell = shield.baked[i].cell;
            ASSERT_TRUE(words[cell / 32] >> cell % 32 & 1);
            ASSERT_EQ(5u, shield.baked[i].what & gpu::kOcclusionSlotMask);
            ASSERT_TRUE(domain.real(shield.baked[i].texel));
        }
        // About its area in cells, half as much more if slanted.
        EXPECT_LT(shield.baked.size(), size_t(2.2 * (2000.0 / 60) * (2000.0 / 60)));
        components::OcclusionView view{shape, words, {}};
        std::mt19937 random(3);
        for (int i = 0; i < 500; ++i) {
            const auto within = [&] { return 0.2f + 1.4f * float(random() % 1000) / 1000; };
            const float x = within(), z = within(), up = 0.3f;
            const float on[3] = {x * std::cos(turn), x * std::sin(turn), z};
            const float a[3] = {on[0] - up * std::sin(turn), on[1] + up * std::cos(turn), on[2]};
            const float b[3] = {on[0] + up * std::sin(turn), on[1] - up * std::cos(turn), on[2]};
            ASSERT_TRUE(components::isShadedByOcclusion(view, a, b, 0)) << turn << ", " << i;
        }
        const uint8_t fallen[] = {0, 0, 0, 0, 0, 1};
        view.fallen = fallen;
        const float a[3] = {0.5f, 1.5f, 0.5f}, b[3] = {0.5f, -0.4f, 0.5f};
        EXPECT_FALSE(components::isShadedByOcclusion(view, a, b, 0));
    }
}

}  // namespace
}  // namespace fw::test
