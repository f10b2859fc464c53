// The published scheme: what its rules do as printed, and that the repaired ones come to rest.
#include "mesh/refine/published.h"

#include <gtest/gtest.h>

#include <set>

namespace fw::mesh {
namespace {

using Point = std::pair<int, int>;

struct Outcome {
    uint32_t drawn = 0;
    double twice = 0, missing = 0;  // shares of the finest triangles
    uint32_t junctions = 0;         // corners on another drawn triangle's side
};

Point cornerOf(const ArpTriangle& t, int k) { return {t.corner[k % 3][0], t.corner[k % 3][1]}; }

Outcome look(const std::pmr::vector<ArpTriangle>& arp, const std::vector<int8_t>& status) {
    Outcome o;
    std::set<Point> corners, junctions;
    for (uint32_t i = 0; i < arp.size(); ++i) {
        if (!arpDrawn(status, i)) continue;
        ++o.drawn;
        for (int k = 0; k < 3; ++k) corners.insert(cornerOf(arp[i], k));
    }
    uint32_t finest = 0, twice = 0, missing = 0;
    for (uint32_t i = 0; i < arp.size(); ++i) {
        if (arpDrawn(status, i))
            for (int k = 0; k < 3; ++k) {
                const Point a = cornerOf(arp[i], k), b = cornerOf(arp[i], k + 1);
                const int n = std::max(std::abs(b.first - a.first), std::abs(b.second - a.second));
                for (int q = 1; q < n; ++q) {
                    const Point p{a.first + (b.first - a.first) / n * q,
                                  a.second + (b.second - a.second) / n * q};
                    if (corners.count(p) != 0) junctions.insert(p);
                }
            }
        if (arp[i].setLevel != kArpLevels) continue;
        uint32_t covers = 0;
        for (uint32_t k = i; k != kArpNone; k = arp[k].parent) covers += arpDrawn(status, k);
        ++finest;
        twice += covers > 1;
        missing += covers == 0;
    }
    o.twice = double(twice) / finest;
    o.missing = double(missing) / finest;
    o.junctions = uint32_t(junctions.size());
    return o;
}

struct Growth {
    std::pmr::vector<ArpTriangle> arp =
        makeArpTemplate(kArpLevels, std::pmr::new_delete_resource());
    std::vector<int8_t> status = std::vector<int8_t>(arp.size(), kArpInitial);
    uint32_t cycles = 0, mostSweeps = 0;
    std::vector<Outcome> at;  // radius 8, 20, 32, 44

    Growth(ArpRules rules, bool serial) {
        std::vector<uint8_t> eligible(arp.size());
        for (int radius = 0; radius <= 60; radius += 4) {
            arpMarkCircle(arp, 20, 14, float(radius), eligible);
            std::set<std::vector<int8_t>> seen;
            uint32_t sweeps = 0;
            while (arpSweep(arp, rules, eligible, serial, status,
                            std::pmr::new_delete_resource()) != 0) {
                if (++sweeps > 60) break;
                if (!seen.insert(status).second) {
                    ++cycles;
                    break;
                }
            }
            mostSweeps = std::max(mostSweeps, sweeps);
            if (radius % 12 == 8) at.push_back(look(arp, status));
        }
    }
};

TEST(RefinePublished, TheTemplateIsFourWaySplits) {
    const auto arp = makeArpTemplate(kArpLevels, std::pmr::new_delete_resource());
    ASSERT_EQ(1u + 4 + 16 + 64 + 256, arp.size());
    int finest = 0;
    for (uint32_t i = 0; i < arp.size(); ++i) {
        const Point a = cornerOf(arp[i], 0), b = cornerOf(arp[i], 1), c = cornerOf(arp[i], 2);
        const int area = (b.first - a.first) * (c.second - a.second) -
                         (b.second - a.second) * (c.first - a.first);
        EXPECT_EQ(64 * 64 >> (2 * (arp[i].setLevel - 1)), area);
        if (arp[i].setLevel == kArpLevels) finest += area;
        EXPECT_TRUE(arp[i].firstChild == kArpNone || arp[arp[i].firstChild].parent == i);
    }
    EXPECT_EQ(64 * 64, finest);
}

TEST(RefinePublished, PrintedRulesCycleAndDrawTwice) {
    const Growth run(ArpRules::printed, true);
    EXPECT_EQ(15u, run.cycles) << "of 16 radii";
    const uint32_t drawn[4] = {99, 250, 314, 338}, junctions[4] = {46, 110, 136, 147};
    for (size_t k = 0; k < 4; ++k) {
        EXPECT_EQ(drawn[k], run.at[k].drawn);
        EXPECT_EQ(junctions[k], run.at[k].junctions);
        EXPECT_NEAR(k == 0 ? 0.5 : 1, run.at[k].twice, 0.01);
    }
}

TEST(RefinePublished, RepairedRulesCoverEverythingOnce) {
    for (const bool serial : {true, false}) {
        const Growth run(ArpRules::repaired, serial);
        EXPECT_EQ(0u, run.cycles);
        EXPECT_LE(run.mostSweeps, serial ? 1u : 5u);
        const uint32_t drawn[4] = {76, 190, 238, 256}, junctions[4] = {14, 9, 4, 0};
        for (size_t k = 0; k < 4; ++k) {
            EXPECT_EQ(drawn[k], run.at[k].drawn);
            EXPECT_EQ(junctions[k], run.at[k].junctions) << "inside one template";
            EXPECT_EQ(0, run.at[k].twice);
            EXPECT_EQ(0, run.at[k].missing);
        }
    }
}

// The boundary's noise is absolute in R^2: a rough edge close in, a smooth one far out.
TEST(RefinePublished, TheHeatBoundaryIsRoughFirstAndSmoothLater) {
    const ArpHeat heat{{0, 0, 0}, 0, 0.1f, 1};
    const auto spread = [&](float r) {
        float low = 1e9f, high = 0;
        for (int k = 0; k < 1000; ++k) {
            const float d = arpHeatDistance(heat, {r, 0, 0}, float(k) / 500);
            low = std::min(low, d);
            high = std::max(high, d);
        }
        return (high - low) / r;
    };
    EXPECT_NEAR(0.22, double(spread(3)), 0.06);
    EXPECT_LT(spread(10), 0.03f);
}

// Corners alone would miss a fire that starts in the middle; the point set does not.
TEST(RefinePublished, PointsInsideMakeATriangleEligible) {
    const glm::vec3 corner[3] = {{0, 0, 0}, {8, 0, 0}, {0, 8, 0}};
    ArpHeat heat{{2.7f, 2.6f, 0}, 1.8f, 0.1f, 1};
    EXPECT_FALSE(arpEligible(heat, corner, 0, 1));
    EXPECT_TRUE(arpEligible(heat, corner, 4, 1));
    heat.origin = {-20, 0, 0};
    EXPECT_FALSE(arpEligible(heat, corner, 4, 1));
}

TEST(RefinePublished, TwoBurntChildrenHideTheirParent) {
    const auto arp = makeArpTemplate(kArpLevels, std::pmr::new_delete_resource());
    std::vector<uint32_t> burn(arp.size(), 0);
    uint32_t parent = 0;
    while (arp[parent].setLevel != kArpLevels - 1) ++parent;
    burn[arp[parent].firstChild] = 3;
    EXPECT_FALSE(arpHidden(arp, burn, parent));
    burn[arp[parent].firstChild + 2] = 1;
    EXPECT_TRUE(arpHidden(arp, burn, parent));
    burn[parent] = 1;
    EXPECT_FALSE(arpHidden(arp, burn, parent));
    burn.assign(burn.size(), 0);
    burn[arp[0].firstChild] = burn[arp[0].firstChild + 1] = 9;
    EXPECT_FALSE(arpHidden(arp, burn, 0)) << "coarse triangles are shown whatever burns";
    EXPECT_FALSE(arpHidden(arp, burn, uint32_t(arp.size() - 1))) << "the finest have no children";
}

}  // namespace
}  // namespace fw::mesh
