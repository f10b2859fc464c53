// The adaptive refinement of the reference implementation: its rules as printed, and the repaired
// rules that reach a stable state.
#include "reference/pattern_frame.h"

#include "core/error.h"
#include "reference/pattern_oracles.h"
#include "support/refine_scene.h"

#include <gtest/gtest.h>

#include <set>

namespace fw::reference {
namespace {

using Point = std::pair<int, int>;

struct Outcome {
    uint32_t drawn = 0;
    double twice = 0, missing = 0;  // shares of the finest triangles
    uint32_t junctions = 0;         // corners on the side of another drawn triangle
};

Point cornerOf(const PatternTriangle& t, int k) { return {t.corner[k % 3][0], t.corner[k % 3][1]}; }

Outcome look(const std::pmr::vector<PatternTriangle>& pattern, const std::vector<int8_t>& status) {
    Outcome o;
    std::set<Point> corners, junctions;
    for (uint32_t i = 0; i < pattern.size(); ++i) {
        if (!isPatternDrawn(status, i)) continue;
        ++o.drawn;
        for (int k = 0; k < 3; ++k) corners.insert(cornerOf(pattern[i], k));
    }
    uint32_t finest = 0, twice = 0, missing = 0;
    for (uint32_t i = 0; i < pattern.size(); ++i) {
        if (isPatternDrawn(status, i))
            for (int k = 0; k < 3; ++k) {
                const Point a = cornerOf(pattern[i], k), b = cornerOf(pattern[i], k + 1);
                const int n = std::max(std::abs(b.first - a.first), std::abs(b.second - a.second));
                for (int q = 1; q < n; ++q) {
                    const Point p{a.first + (b.first - a.first) / n * q,
                                  a.second + (b.second - a.second) / n * q};
                    if (corners.count(p) != 0) junctions.insert(p);
                }
            }
        if (pattern[i].setLevel != kPatternLevels) continue;
        uint32_t covers = 0;
        for (uint32_t k = i; k != kPatternNone; k = pattern[k].parent)
            covers += isPatternDrawn(status, k);
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
    std::pmr::vector<PatternTriangle> pattern =
        makePatternTemplate(4, std::pmr::new_delete_resource());
    std::vector<int8_t> status = std::vector<int8_t>(pattern.size(), kPatternInitial);
    uint32_t cycles = 0, mostSweeps = 0;
    std::vector<Outcome> at;  // radius 8, 20, 32, 44

    Growth(PatternRules rules, bool serial) {
        std::vector<uint8_t> eligible(pattern.size());
        for (int radius = 0; radius <= 60; radius += 4) {
            markPatternCircle(pattern, 20, 14, float(radius), eligible);
            std::set<std::vector<int8_t>> seen;
            uint32_t sweeps = 0;
            while (sweepPattern(pattern, rules, eligible, serial, status,
                                std::pmr::new_delete_resource()) != 0) {
                if (++sweeps > 60) break;
                if (!seen.insert(status).second) {
                    ++cycles;
                    break;
                }
            }
            mostSweeps = std::max(mostSweeps, sweeps);
            if (radius % 12 == 8) at.push_back(look(pattern, status));
        }
    }
};

TEST(RefinePublished, TheTemplateSplitsInFour) {
    const auto pattern = makePatternTemplate(4, std::pmr::new_delete_resource());
    ASSERT_EQ(1u + 4 + 16 + 64 + 256, pattern.size());
    int finest = 0;
    for (uint32_t i = 0; i < pattern.size(); ++i) {
        const Point a = cornerOf(pattern[i], 0), b = cornerOf(pattern[i], 1),
                    c = cornerOf(pattern[i], 2);
        const int area = (b.first - a.first) * (c.second - a.second) -
                         (b.second - a.second) * (c.first - a.first);
        EXPECT_EQ(64 * 64 >> (2 * (pattern[i].setLevel - 1)), area);
        if (pattern[i].setLevel == kPatternLevels) finest += area;
        EXPECT_TRUE(pattern[i].firstChild == kPatternNone ||
                    pattern[pattern[i].firstChild].parent == i);
    }
    EXPECT_EQ(64 * 64, finest);
}

TEST(RefinePublished, PrintedRulesCycleAndOverlap) {
    const Growth run(PatternRules::printed, true);
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
        const Growth run(PatternRules::repaired, serial);
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

std::set<uint32_t> finestDrawn(const std::pmr::vector<PatternTriangle>& pattern,
                               const std::pmr::vector<int8_t>& status) {
    std::set<uint32_t> drawn;
    for (uint32_t i = 0; i < pattern.size(); ++i)
        if (pattern[i].setLevel == kPatternLevels && isPatternDrawn(status, i)) drawn.insert(i);
    return drawn;
}

// The rules run serially on one triangle while a fire grows over it, against the drawn triangles:
// equal finest triangles at every radius and the same final picture of finest triangles.
TEST(RefinePublished, ParallelRulesMatchSerialRules) {
    auto* memory = std::pmr::new_delete_resource();
    const auto pattern = makePatternTemplate(4, memory);
    std::pmr::vector<int8_t> seeds(pattern.size(), kPatternInitial), ours = seeds, parallel = seeds;
    std::vector<uint8_t> eligible(pattern.size());
    for (int radius = 0; radius <= 96; radius += 4) {
        markPatternCircle(pattern, 20, 14, float(radius), eligible);
        for (int sweep = 0; sweep < 12; ++sweep) {  // the printed rules reach no stable state
            sweepPattern(pattern, PatternRules::printed, eligible, true, seeds, memory);
            sweepPattern(pattern, PatternRules::repaired, eligible, false, parallel, memory);
        }
        sweepPattern(pattern, PatternRules::repaired, eligible, true, ours, memory);
        EXPECT_EQ(finestDrawn(pattern, seeds), finestDrawn(pattern, ours)) << radius;
        EXPECT_EQ(ours, parallel) << radius;
    }
    EXPECT_EQ(256u, finestDrawn(pattern, ours).size());
    for (uint32_t i = 0; i < pattern.size(); ++i)
        EXPECT_EQ(pattern[i].setLevel == kPatternLevels, isPatternDrawn(ours, i)) << i;
}

// The boundary's noise is absolute in R^2: a rough edge close in, a smooth one far out.
TEST(RefinePublished, TheHeatBoundaryIsRoughFirstAndSmoothLater) {
    const PatternHeat heat{{0, 0, 0}, 0, 0.1f, 1};
    const auto spread = [&](float r) {
        float low = 1e9f, high = 0;
        for (int k = 0; k < 1000; ++k) {
            const float d = patternHeatDistance(heat, {r, 0, 0}, float(k) / 500);
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
    PatternHeat heat{{2.7f, 2.6f, 0}, 1.8f, 0.1f, 1};
    EXPECT_FALSE(isPatternEligible(heat, corner, 0, 1));
    EXPECT_TRUE(isPatternEligible(heat, corner, 4, 1));
    heat.origin = {-20, 0, 0};
    EXPECT_FALSE(isPatternEligible(heat, corner, 4, 1));
}

TEST(RefinePublished, TwoBurntChildrenHideTheirParent) {
    const auto pattern = makePatternTemplate(4, std::pmr::new_delete_resource());
    std::vector<uint32_t> burn(pattern.size(), 0);
    uint32_t parent = 0;
    while (pattern[parent].setLevel != kPatternLevels - 1) ++parent;
    burn[pattern[parent].firstChild] = 3;
    EXPECT_FALSE(isPatternHidden(pattern, burn, parent));
    burn[pattern[parent].firstChild + 2] = 1;
    EXPECT_TRUE(isPatternHidden(pattern, burn, parent));
    burn[parent] = 1;
    EXPECT_FALSE(isPatternHidden(pattern, burn, parent));
    burn.assign(burn.size(), 0);
    burn[pattern[0].firstChild] = burn[pattern[0].firstChild + 1] = 9;
    EXPECT_FALSE(isPatternHidden(pattern, burn, 0)) << "coarse triangles are always shown";
    EXPECT_FALSE(isPatternHidden(pattern, burn, uint32_t(pattern.size() - 1)))
        << "the finest have no children";
}

// ---- whole meshes

glm::vec3 placeOf(const RefineModel& model, uint32_t draw) {
    const gpu::RefineSlot& slot = model.slots[model.draws[draw].slot];
    return {slot.x, slot.y, slot.z};
}

struct Burning {
    test::RefineScene scene;
    PatternModel model;
    PatternSettings settings;
    PatternState state{std::pmr::new_delete_resource()};
    explicit Burning(uint32_t depth)
        : scene(test::gridBox(1, 0.8, 1.2, 1, 1, 1, 11), patternOptions(depth), 32),
          model(
              makePatternModel(scene.domain, scene.model, depth, std::pmr::new_delete_resource())),
          settings(patternSettings(model, 0, 0, 0.05f)) {
        state.reset(model);
    }
    // How often the list covers each finest triangle; -1: not uniform.
    [[nodiscard]] int covered() const {
        const uint32_t n = 1u << model.depth;
        std::vector<int> covers(size_t(model.triangles()) * n * n * 2, 0);
        for (const uint32_t word : state.list) {
            const uint32_t side = 1u << (model.depth - gpu::patternHalvings(word));
            const auto a = gpu::patternPoint(word, model.depth, 0);
            const bool down = (word & gpu::kPatternDown) != 0;
            for (uint32_t y = 0; y < side; ++y)
                for (uint32_t x = 0; x < side - y; ++x)
                    for (uint32_t turned = 0; turned < (x + y + 1 < side ? 2u : 1u); ++turned) {
                        const uint32_t u = down ? a.x - x - 1 : a.x + x;
                        const uint32_t v = down ? a.y - y - 1 : a.y + y;
                        const uint32_t half = down ? 1 - turned : turned;
                        ++covers[((size_t(gpu::patternCoarse(word)) * n + v) * n + u) * 2 + half];
                    }
        }
        int all = -2;
        for (uint32_t i = 0; i < model.triangles(); ++i)
            for (uint32_t v = 0; v < n; ++v)
                for (uint32_t u = 0; u + v < n; ++u)
                    for (uint32_t half = 0; half < (u + v + 1 < n ? 2u : 1u); ++half) {
                        const int own = covers[((size_t(i) * n + v) * n + u) * 2 + half];
                        all = all == -2 || all == own ? own : -1;
                    }
        return all;
    }
};

TEST(RefinePublished, WordsEncodeTheVerticesOfTheirTriangles) {
    for (const uint32_t depth : {0u, 1u, 2u, 5u}) {
        const Burning b(depth);
        double worst = 0;
        for (uint32_t i = 0; i < b.model.triangles(); ++i) {
            const glm::vec3* corner = &b.model.corners[size_t(i) * 3];
            const gpu::RefineTriangle& t = b.scene.model.triangles[i];
            for (uint32_t k = 0; k < b.model.pattern.size(); ++k) {
                std::set<Point> wanted, named;
                for (uint32_t p = 0; p < (b.model.pattern[k].setLevel == kPatternLevels ? 3u : 6u);
                     ++p) {
                    const auto c = gpu::patternPoint(b.model.words[k], depth, p);
                    const float u = float(c.x) / float(1u << depth),
                                v = float(c.y) / float(1u << depth);
                    const glm::vec3 at = corner[0] * (1 - u - v) + corner[1] * u + corner[2] * v;
                    const uint32_t draw = gpu::patternDrawVertex(t, c.x, c.y);
                    worst =
                        std::max(worst, double(glm::distance(at, placeOf(b.scene.model, draw))));
                    if (p < 3) named.insert({c.x << (6 - depth), c.y << (6 - depth)});
                }
                for (int c = 0; c < 3; ++c) wanted.insert(cornerOf(b.model.pattern[k], c));
                EXPECT_EQ(wanted, named);
            }
        }
        EXPECT_LT(worst, 1e-6) << "m, depth " << depth;
    }
}

TEST(RefinePublished, AMeshIsCoveredOnceAtEveryTimeAndDistance) {
    Burning b(4);
    ASSERT_EQ(12u, b.model.triangles());
    EXPECT_TRUE(advancePattern(b.model, b.settings, 1000, {}, false, b.state));
    EXPECT_EQ(12u, b.state.list.size()) << "no fire yet";
    ignitePattern(b.model, b.settings, {0.5f, 0.4f, 1.2f}, 1000, b.state);
    uint32_t changes = 0, last = 0;
    for (uint32_t tick = 1000; tick < 1000 + 60 * 4096; tick += 2048) {
        const uint32_t step = tick / 2048 % 4;
        PatternView view{{0.5f, 0.4f, 1.2f + float(step)}, step == 0 ? 0.0f : 60.0f};
        changes += advancePattern(b.model, b.settings, tick, view, false, b.state);
        ASSERT_EQ(1, b.covered()) << "s: " << (tick - 1000) / 4096.0;
        if (step != 0) continue;
        EXPECT_GE(b.state.list.size(), last) << "the boundary only grows";
        last = uint32_t(b.state.list.size());
    }
    advancePattern(b.model, b.settings, 1e6, {}, false, b.state);
    EXPECT_EQ(b.model.most(), b.state.list.size()) << "all of it is finest";
    EXPECT_EQ(b.model.most(), b.state.listed[0]);
    EXPECT_GT(changes, 20u);
    EXPECT_FALSE(advancePattern(b.model, b.settings, 1e6, {}, false, b.state)) << "stable";
}

// A fire of 1 cm in the middle of a triangle, far from its corners.
TEST(RefinePublished, FindsAFireMidTriangleAtOnce) {
    Burning b(5), again(5);
    for (Burning* one : {&b, &again}) {
        ignitePattern(one->model, one->settings, {0.55f, 0.35f, 1.2f}, 4096, one->state);
        advancePattern(one->model, one->settings, 4096 + gpu::kStepTicks, {}, false, one->state);
    }
    EXPECT_GT(b.state.list.size(), 12u);
    EXPECT_LT(b.state.list.size(), 200u);
    EXPECT_EQ(b.state.list, again.state.list);
    ignitePattern(b.model, b.settings, {0, 0, 0}, 5000, b.state);
    EXPECT_EQ(4096u, b.state.litTick) << "one source";
    // The refined part lies around the fire.
    const float radius = patternRadius(b.settings, b.state, 4096 + gpu::kStepTicks);
    for (const uint32_t word : b.state.list) {
        if (gpu::patternHalvings(word) < 5) continue;
        const auto c = gpu::patternPoint(word, 5, 0);
        const glm::vec3 at = placeOf(
            b.scene.model,
            gpu::patternDrawVertex(b.scene.model.triangles[gpu::patternCoarse(word)], c.x, c.y));
        EXPECT_LT(glm::distance(at, b.state.heat.origin),
                  (radius + 2.0f) / std::sqrt(b.settings.psi) + 2 * b.model.finest);
    }
}

TEST(RefinePublished, TwoBurntChildrenConsumeTheirParent) {
    EXPECT_FALSE(gpu::isPatternConsumed(3, true));
    EXPECT_TRUE(gpu::isPatternConsumed(7, true));
    EXPECT_TRUE(gpu::isPatternConsumed(7, false));
    EXPECT_FALSE(gpu::isPatternConsumed(1 | 8 | 32, false)) << "one child";
    EXPECT_TRUE(gpu::isPatternConsumed(1 | 8 | 16 | 32, false)) << "that child and the middle";
    EXPECT_TRUE(gpu::isPatternConsumed(1 | 2 | 8 | 16 | 32, false));
    EXPECT_FALSE(gpu::isPatternConsumed(1 | 2 | 8, false));
}

TEST(RefinePublished, RefusesTooManyTriangles) {
    test::RefineScene scene(test::gridBox(1, 1, 1, 17, 17, 17), patternOptions(0), 16);
    try {
        (void)makePatternModel(scene.domain, scene.model, 5, std::pmr::new_delete_resource());
        FAIL() << "3468 triangles of 1365 statuses";
    } catch (const core::Error& error) {
        EXPECT_NE(std::string::npos, std::string(error.message).find("refineDepth is 5"));
    }
}

}  // namespace
}  // namespace fw::reference
