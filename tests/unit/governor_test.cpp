// The budget governor under varying load: it settles within 60 frames and stays under noise,
// ignores single hitches, restores quality, and keeps full detail without a limit.
#include "world/governor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <vector>

namespace {

using namespace fw;
using world::FrameCost;
using world::Governor;

constexpr uint32_t kReadback = 3, kTurn = 16;  // frames until a level has its cost

// Cost of a scene at each level, ms. Measured late; changes take a while.
struct Scene {
    std::array<float, world::kDetailLevels> costs;
    float fixed = 0;  // ms, independent of the level
    float from = -1, to = -1;
    uint32_t turned = kTurn;
    std::vector<float> late = std::vector<float>(kReadback, 0.0f);

    float frame(uint32_t level, float noise) {
        const float wanted = fixed + costs[level];
        const auto shown = [&] { return from + (to - from) * float(turned) / float(kTurn); };
        if (to < 0) from = to = wanted;
        if (wanted != to) from = shown(), to = wanted, turned = 0;
        turned = std::min(turned + 1, kTurn);
        late.push_back(shown() * noise);
        const float measured = late.front();
        late.erase(late.begin());
        return measured;
    }
    static Scene of(float most, float ratio, float fixed = 0) {
        Scene scene;
        for (float& cost : scene.costs) cost = most, most /= ratio;
        scene.fixed = fixed;
        return scene;
    }
};

struct Session {
    Governor governor;
    std::mt19937 random{7};
    float limit = 5;
    std::vector<uint32_t> levels;
    std::vector<float> costs;

    void frames(Scene& scene, uint32_t count) {
        std::uniform_real_distribution<float> noise(0.97f, 1.03f);
        levels.clear(), costs.clear();
        for (uint32_t f = 0; f < count; ++f) {
            const float cost = scene.frame(governor.level, noise(random));
            world::govern({limit, 0}, {cost, 0}, governor);
            levels.push_back(governor.level);
            costs.push_back(cost);
        }
    }
    // True if the level is constant after frame `from`.
    [[nodiscard]] bool steadyFrom(uint32_t from) const {
        for (size_t f = from; f < levels.size(); ++f)
            if (levels[f] != levels.back()) return false;
        return true;
    }
};

TEST(Governor, HigherLevelsOnlyReduceDetail) {
    for (uint32_t level = 1; level < world::kDetailLevels; ++level) {
        const gpu::Detail more = world::detailOf(level - 1), less = world::detailOf(level);
        EXPECT_LE(less.marched, more.marched);
        EXPECT_LE(less.marchedHigh, more.marchedHigh);
        EXPECT_LE(less.rayStepCount, more.rayStepCount);
        EXPECT_LT(less.triangles, more.triangles);
        EXPECT_GT(less.triangles, 0.0f);
        EXPECT_LE(less.lights, more.lights);
        EXPECT_GE(gpu::lightsOf(less, 1), 1u);
        EXPECT_EQ(gpu::lightsOf(less, 0), 0u);
        EXPECT_GE(less.marched, 1u);
        EXPECT_GE(less.rayStepCount, 6u);
    }
    EXPECT_EQ(world::detailOf(0), gpu::Detail{});
    EXPECT_EQ(world::detailOf(1000), world::detailOf(world::kDetailLevels - 1));
}

TEST(Governor, SettlesWithinSixtyFramesAfterALoadStep) {
    for (const float ratio : {1.05f, 1.1f, 1.25f, 1.4f, 1.5f, 1.7f, 2.0f, 3.0f}) {
        for (const float load : {5.3f, 6.0f, 8.0f, 12.0f, 16.0f, 25.0f, 60.0f}) {
            Session run;
            Scene idle = Scene::of(2, ratio);
            run.frames(idle, 100);
            EXPECT_EQ(run.governor.level, 0u);
            Scene scene = Scene::of(load, ratio);
            run.frames(scene, 700);
            EXPECT_TRUE(run.steadyFrom(60)) << "load " << load << ", ratio " << ratio;
            const uint32_t level = run.levels.back();
            EXPECT_TRUE(scene.costs[level] <= 1.04f * run.limit ||
                        level + 1 == world::kDetailLevels)
                << scene.costs[level] << " ms at " << level;
            EXPECT_GT(level, 0u);
        }
    }
}

TEST(Governor, RestoresDetailWhenTheLoadDrops) {
    Session run;
    Scene heavy = Scene::of(20, 1.4f);
    run.frames(heavy, 200);
    ASSERT_GT(run.governor.level, 2u);
    Scene light = Scene::of(2, 1.4f);
    run.frames(light, 300);
    EXPECT_EQ(run.governor.level, 0u);
    EXPECT_TRUE(run.steadyFrom(60));
}

TEST(Governor, IgnoresASingleHitch) {
    Session run;
    Scene scene = Scene::of(4, 1.3f);
    run.frames(scene, 100);
    for (uint32_t k = 0; k < 20; ++k) {
        world::govern({5, 0}, {40, 0}, run.governor);
        run.frames(scene, 15);
        EXPECT_EQ(run.governor.level, 0u);
    }
}

TEST(Governor, StopsAtTheLowestDetail) {
    Session run;
    Scene scene = Scene::of(1, 1.3f, 9);
    run.frames(scene, 600);
    EXPECT_EQ(run.governor.level, world::kDetailLevels - 1);
    EXPECT_TRUE(run.steadyFrom(60));
}

TEST(Governor, CountsProcessorTime) {
    Governor governor;
    for (uint32_t f = 0; f < 20; ++f) world::govern({0, 1}, {100, 3}, governor);
    EXPECT_GT(governor.level, 0u);
}

TEST(Governor, RestoresAllDetailWithoutALimit) {
    Governor governor;
    for (uint32_t f = 0; f < 60; ++f) world::govern({1, 0}, {9, 0}, governor);
    ASSERT_GT(governor.level, 3u);
    for (uint32_t f = 0; f < 60; ++f) world::govern({}, {9, 9}, governor);
    EXPECT_EQ(governor.level, 0u);
}

// Random loads: levels stay in range and change no more often than the loads.
TEST(Governor, FollowsRandomLoadsWithoutHunting) {
    std::mt19937 random(3);
    for (uint32_t turn = 0; turn < 200; ++turn) {
        Session run;
        uint32_t changes = 0;
        for (uint32_t part = 0; part < 8; ++part) {
            Scene scene = Scene::of(std::uniform_real_distribution<float>(0.5f, 30)(random),
                                    std::uniform_real_distribution<float>(1.02f, 2.2f)(random),
                                    std::uniform_real_distribution<float>(0, 4)(random));
            const uint32_t before = run.governor.level;
            run.frames(scene, 240);
            uint32_t last = before;
            for (const uint32_t level : run.levels) {
                ASSERT_LT(level, world::kDetailLevels);
                changes += level != last ? 1 : 0;
                last = level;
            }
        }
        EXPECT_LE(changes, 8u * 4u);
    }
}

// Bytes follow the level at once, but freeing is measured late. Milliseconds have no limit here.
TEST(Governor, RespectsAByteBudget) {
    for (const double limit : {0.9e6, 0.55e6, 0.3e6, 0.05e6}) {
        Governor governor;
        std::vector<uint32_t> levels;
        const auto frames = [&](double given, uint32_t count) {
            levels.clear();
            for (uint32_t f = 0; f < count; ++f) {
                const double bytes = 1e6 * double(world::detailOf(governor.level).memory);
                world::govern({0, 0, given}, {3, 1, bytes}, governor);
                levels.push_back(governor.level);
            }
        };
        frames(limit, 400);
        const uint32_t settled = levels[60];
        for (size_t f = 60; f < levels.size(); ++f) EXPECT_EQ(settled, levels[f]) << limit;
        const bool fits = 1e6 * double(world::detailOf(settled).memory) <= 1.04 * limit;
        EXPECT_TRUE(fits || settled + 1 == world::kDetailLevels) << limit;
        frames(0, 60);
        EXPECT_EQ(0u, governor.level) << limit;
    }
}

}  // namespace
