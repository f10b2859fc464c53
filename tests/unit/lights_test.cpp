// Lights within a host's budget: their sum is that of all fires for any count, and none jumps.
#include "components/lights.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory_resource>
#include <random>

namespace {

using namespace fw;

FwLight lightAt(uint32_t id, float x, float z, float power) {
    FwLight light{};
    light.position[0] = x;
    light.position[2] = z;
    light.radius = 0.2f;
    light.color[0] = light.color[1] = light.color[2] = 1;
    light.power = power;
    light.intensity = power * components::kLightShare / components::kSphere;
    light.id = id;
    return light;
}

template <class Lights>
double powerOf(const Lights& lights) {
    double sum = 0;
    for (const FwLight& light : lights) sum += double(light.power);
    return sum;
}

struct Gathering {
    std::vector<FwLight> operator()(std::span<const FwLight> sources, uint32_t most) {
        std::vector<FwLight> out(most);
        out.resize(components::gatherLights(sources, kept, most, out, taken));
        kept.clear();
        for (const FwLight& light : out) kept.push_back(light.id);
        return out;
    }
    std::vector<uint32_t> kept;
    std::pmr::vector<uint8_t> taken;
};

std::vector<FwLight> manyFires(uint32_t count) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> place(-20, 20), power(100, 90000);
    std::vector<FwLight> fires;
    for (uint32_t i = 0; i < count; ++i)
        fires.push_back(lightAt(i + 1, place(random), place(random), power(random)));
    return fires;
}

TEST(Lights, FewLightsCarryThePowerOfAll) {
    for (const uint32_t count : {0u, 1u, 5u, 64u, 300u}) {
        const std::vector<FwLight> fires = manyFires(count);
        for (const uint32_t most : {0u, 1u, 3u, 16u, 64u}) {
            const std::vector<FwLight> lights = Gathering()(fires, most);
            EXPECT_EQ(std::min(most, count), lights.size());
            if (most == 0) continue;
            EXPECT_NEAR(powerOf(lights), powerOf(fires), 1e-4 * powerOf(fires));
            for (size_t i = 0; i < lights.size(); ++i) {
                EXPECT_NEAR(lights[i].intensity,
                            lights[i].power * components::kLightShare / components::kSphere,
                            1e-3f * lights[i].intensity);
                EXPECT_TRUE(i == 0 || lights[i - 1].intensity >= lights[i].intensity);
            }
        }
    }
}

TEST(Lights, MergesNeighbours) {
    const FwLight fires[] = {lightAt(1, 0, 0, 3000), lightAt(2, 1, 0, 1000),
                             lightAt(3, 50, 0, 1000)};
    const std::vector<FwLight> lights = Gathering()(fires, 2);
    ASSERT_EQ(2u, lights.size());
    EXPECT_EQ(1u, lights[0].id);
    EXPECT_NEAR(lights[0].position[0], 0.25f, 1e-4f);
    EXPECT_NEAR(lights[0].power, 4000, 0.1f);
    EXPECT_GT(lights[0].radius, 0.4f) << "its radius covers both";
    EXPECT_EQ(3u, lights[1].id) << "a distant fire keeps its own light";
    // A single light includes fires too far to be merged.
    const std::vector<FwLight> one = Gathering()(fires, 1);
    EXPECT_NEAR(one[0].power, 5000, 0.1f);
    EXPECT_LT(one[0].position[0], 0.3f);
}

TEST(Lights, EqualFiresDoNotAlternate) {
    Gathering gather;
    std::vector<FwLight> fires = {lightAt(1, 0, 0, 1000), lightAt(2, 30, 0, 900)};
    const uint32_t first = gather(fires, 1)[0].id;
    for (int frame = 0; frame < 100; ++frame) {
        fires[0].intensity = 24 * components::flicker(frame / 60.0, 0);
        fires[1].intensity = 24 * components::flicker(frame / 60.0, 2);
        EXPECT_EQ(first, gather(fires, 1)[0].id) << frame;
    }
    fires[1].intensity = 60;
    EXPECT_EQ(2u, gather(fires, 1)[0].id);
}

// Clusters change with readbacks: no light pops and none is lost.
TEST(Lights, FollowsChangesContinuously) {
    std::pmr::vector<FwLight> shown;
    std::vector<FwLight> known = manyFires(10);
    constexpr float kFrame = 1.0f / 60;
    for (int frame = 0; frame < 60; ++frame) components::followLights(shown, known, kFrame, 16);
    ASSERT_EQ(10u, shown.size());
    const double all = powerOf(known);
    EXPECT_NEAR(powerOf(shown), all, 0.01 * all);
    // The same fires in other clusters under other ids.
    for (FwLight& light : known) light.id += 100;
    std::rotate(known.begin(), known.begin() + 3, known.end());
    float most = 0;
    for (const FwLight& light : shown) most = std::max(most, light.power);
    for (int frame = 0; frame < 60; ++frame) {
        const std::pmr::vector<FwLight> before = shown;
        components::followLights(shown, known, kFrame, 16);
        EXPECT_LE(shown.size(), 16u);
        EXPECT_NEAR(powerOf(shown), all, 0.01 * all) << frame;
        if (frame == 0) continue;  // six had no room and joined their neighbours
        for (const FwLight& light : shown)
            for (const FwLight& was : before)
                if (was.id == light.id) {
                    EXPECT_LT(std::abs(was.power - light.power), 0.4f * most);
                }
    }
    EXPECT_EQ(10u, shown.size());
    components::followLights(shown, {}, kFrame, 16);
    EXPECT_TRUE(shown.empty()) << "nothing burns: nothing shines";
}

// A steady fire: bounded from frame to frame, right on average.
TEST(Lights, ASteadyFireFlickersWithinItsBound) {
    double sum = 0, steepest = 0;
    constexpr int kFrames = 60 * 60;
    for (int frame = 0; frame < kFrames; ++frame) {
        const double now = frame / 60.0, phase = components::flickerPhase(12345);
        const double here = double(components::flicker(now, phase));
        sum += here;
        steepest =
            std::max(steepest, std::abs(double(components::flicker(now + 1 / 60.0, phase)) - here));
    }
    EXPECT_NEAR(sum / kFrames, 1, 0.005);
    EXPECT_LT(steepest, 0.07);
    EXPECT_GT(steepest, 0.02) << "it does flicker";
}

}  // namespace
