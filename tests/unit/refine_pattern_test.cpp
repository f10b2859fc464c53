// Patterns: the triangulation of every combination of three edge levels and an interior level.
#include "mesh/refine/table.h"

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <vector>

namespace fw::mesh {
namespace {

using Point = std::pair<int, int>;  // barycentrics 1 and 2 in 1/32

Point placeOf(uint32_t levels, uint32_t code) {
    const glm::uvec3 w = gpu::refineWeights(levels, code);
    EXPECT_EQ(32u, w.x + w.y + w.z);
    return {int(w.y), int(w.z)};
}

struct Triple {
    Point p[3];
    [[nodiscard]] int area() const {
        return (p[1].first - p[0].first) * (p[2].second - p[0].second) -
               (p[1].second - p[0].second) * (p[2].first - p[0].first);
    }
};

std::vector<Triple> patternOf(uint32_t levels) {
    std::vector<Triple> triples;
    for (uint32_t k = 0; k < gpu::refineCount(levels); ++k) {
        const glm::uvec3 codes = refineTriangle(levels, k);
        triples.push_back(
            {{placeOf(levels, codes.x), placeOf(levels, codes.y), placeOf(levels, codes.z)}});
    }
    return triples;
}

// The number of faults of a pattern.
uint32_t faults(uint32_t levels, const std::vector<Triple>& triples) {
    uint32_t wrong = 0;
    int area = 0;
    std::map<std::pair<Point, Point>, int> edges;
    for (const Triple& t : triples) {
        wrong += t.area() <= 0;
        area += t.area();
        for (int k = 0; k < 3; ++k) ++edges[{t.p[k], t.p[(k + 1) % 3]}];
    }
    wrong += area != 32 * 32;
    std::set<std::pair<Point, Point>> border;
    for (uint32_t e = 0; e < 3; ++e)
        for (uint32_t i = 0; i < 1u << gpu::refineSide(levels, e); ++i)
            border.insert({placeOf(levels, gpu::refineOnSide(e, i)),
                           placeOf(levels, gpu::refineOnSide(e, i + 1))});
    size_t outer = 0;
    for (const auto& [edge, uses] : edges) {
        wrong += uses != 1;
        if (edges.count({edge.second, edge.first}) != 0) continue;
        ++outer;
        wrong += border.count(edge) == 0;
    }
    return wrong + uint32_t(outer != border.size());
}

// The strip walked triangle by triangle; random access must give the same.
std::vector<glm::uvec3> walkedInOrder(uint32_t levels) {
    std::vector<glm::uvec3> out;
    const uint32_t m = gpu::refineInterior(levels), n = 1u << m, s = n - 3;
    for (uint32_t b = 0; b < s; ++b)
        for (uint32_t a = 0; a + b < s; ++a) {
            const auto in = [](uint32_t x, uint32_t y) { return gpu::refineInside(x, y); };
            out.push_back({in(a + 1, b + 1), in(a + 2, b + 1), in(a + 1, b + 2)});
            if (a + b + 1 < s)
                out.push_back({in(a + 2, b + 1), in(a + 2, b + 2), in(a + 1, b + 2)});
        }
    for (uint32_t e = 0; e < 3; ++e) {
        const uint32_t f = (e + 1) % 3, p = (e + 2) % 3, l = gpu::refineSide(levels, e);
        const uint32_t steps = 1u << l;
        const auto row = [&](uint32_t j) { return gpu::refineRowPoint(e, j, n); };
        const auto on = [](uint32_t side, uint32_t i) { return gpu::refineOnSide(side, i); };
        std::vector<glm::uvec3> strip;
        uint32_t i = 0, j = 1;
        while (i < steps || j < n - 2) {
            // Edge vertex i + 1 at (i + 1) * n / steps against row vertex j + 1 at j + 1.5.
            const bool edge =
                j == n - 2 || (i < steps && double(i + 1) * n / steps <= double(j) + 1.5);
            if (edge) {
                strip.push_back({on(e, i), on(e, i + 1), row(j)});
                ++i;
            } else {
                strip.push_back({on(e, i), row(j + 1), row(j)});
                ++j;
            }
        }
        if (l == m && gpu::refineSide(levels, p) == m)
            strip.front() = {on(e, 1), row(1), on(p, (1u << m) - 1)};
        if (l == m && gpu::refineSide(levels, f) == m)
            strip.back() = {on(e, steps - 1), on(f, 0), on(f, 1)};
        out.insert(out.end(), strip.begin(), strip.end());
    }
    return out;
}

template <typename Visit>
uint32_t everyPattern(Visit visit) {
    uint32_t count = 0;
    for (uint32_t a = 0; a <= 5; ++a)
        for (uint32_t b = 0; b <= 5; ++b)
            for (uint32_t c = 0; c <= 5; ++c)
                for (uint32_t m = 0; m <= 5; ++m)
                    if (gpu::fitInterior(a, b, c, m) == m) {
                        ++count;
                        visit(gpu::refinePack(a, b, c, m));
                    }
    return count;
}

TEST(RefinePattern, All872AreValid) {
    uint32_t wrong = 0;
    const uint32_t patterns = everyPattern([&](uint32_t levels) {
        const uint32_t f = faults(levels, patternOf(levels));
        if (f != 0 && wrong < 5) ADD_FAILURE() << "levels " << std::hex << levels;
        wrong += f != 0;
    });
    EXPECT_EQ(872u, patterns);
    EXPECT_EQ(0u, wrong);
}

TEST(RefinePattern, FaultCounterCatchesMutants) {
    const uint32_t levels = gpu::refinePack(3, 2, 5, 4);
    std::vector<Triple> triples = patternOf(levels);
    ASSERT_EQ(0u, faults(levels, triples));
    // Side 0 with another level: its segments differ from the requested ones.
    EXPECT_NE(0u, faults(gpu::refinePack(2, 2, 5, 4), triples));
    std::vector<Triple> fewer(triples.begin() + 1, triples.end());
    EXPECT_NE(0u, faults(levels, fewer));
    std::swap(triples[0].p[0], triples[0].p[1]);
    EXPECT_NE(0u, faults(levels, triples));
}

TEST(RefinePattern, RandomAccessEqualsTheWalk) {
    uint32_t compared = 0, differ = 0;
    everyPattern([&](uint32_t levels) {
        if (gpu::refineInterior(levels) < 2) return;
        const std::vector<glm::uvec3> walk = walkedInOrder(levels);
        ASSERT_EQ(walk.size(), gpu::refineCount(levels));
        for (uint32_t k = 0; k < walk.size(); ++k) differ += refineTriangle(levels, k) != walk[k];
        ++compared;
    });
    EXPECT_EQ(864u, compared);
    EXPECT_EQ(0u, differ);
}

// With equal levels the pattern is the regular lattice, so levels nest.
TEST(RefinePattern, EqualLevelsAreTheRegularLattice) {
    for (uint32_t m = 1; m <= 5; ++m) {
        const uint32_t levels = gpu::refinePack(m, m, m, m);
        const std::vector<Triple> triples = patternOf(levels);
        EXPECT_EQ(1u << (2 * m), triples.size());
        const int step = 32 >> m;
        int odd = 0;
        for (const Triple& t : triples)
            for (int k = 0; k < 3; ++k) {
                const int x = t.p[(k + 1) % 3].first - t.p[k].first;
                const int y = t.p[(k + 1) % 3].second - t.p[k].second;
                odd += std::abs(x) > step || std::abs(y) > step || std::abs(x + y) > step;
            }
        EXPECT_EQ(0, odd) << "m = " << m;
    }
}

TEST(RefinePattern, HaveTheirTriangleCounts) {
    const auto count = [](uint32_t a, uint32_t b, uint32_t c, uint32_t m) {
        return gpu::refineCount(gpu::refinePack(a, b, c, gpu::fitInterior(a, b, c, m)));
    };
    EXPECT_EQ(1024u, count(5, 5, 5, 5));
    EXPECT_EQ(38u, count(5, 0, 0, 0)) << "a cold neighbour of one hot edge";
    EXPECT_EQ(962u, count(5, 0, 0, 5)) << "if the interior had the edges' level";
    EXPECT_EQ(931u, count(0, 0, 0, 5)) << "hot inside, cold edges";
    EXPECT_EQ(1u, count(0, 0, 0, 0));
    EXPECT_EQ(4u, count(1, 1, 1, 1));
}

TEST(RefinePattern, TheTableIsFullyUsed) {
    std::set<uint32_t> entries;
    everyPattern([&](uint32_t levels) {
        for (uint32_t k = 0; k < gpu::refineCount(levels); ++k)
            entries.insert(gpu::refineLocate(levels, k).entry);
    });
    EXPECT_EQ(540u + 1036u + 20u, entries.size());  // 20 of the 32 for m < 2
    EXPECT_LT(*entries.rbegin(), gpu::kRefineTableSize);
    EXPECT_EQ(3216u, sizeof kRefineTable);
}

}  // namespace
}  // namespace fw::mesh
