// Flames by curve points: the painted outline and temperatures.
#include "document/flame_curve.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "editor/yard.h"

namespace {

using namespace fwtest;
using ::testing::HasSubstr;

TEST(FlameCurve, TheOutlineInterpolatesWithoutOvershoot) {
    const Keys outline = {{0, 0.5f}, {0.2f, 0.9f}, {0.6f, 0.9f}, {0.7f, 0.1f}, {1, 0.05f}};
    for (const Key& point : outline) EXPECT_FLOAT_EQ(point.value, radiusAt(outline, point.time));
    for (size_t i = 0; i + 1 < outline.size(); ++i) {
        const Key &a = outline[i], &b = outline[i + 1];
        for (int k = 0; k <= 20; ++k) {
            const float at = a.time + (b.time - a.time) * static_cast<float>(k) / 20;
            const float radius = radiusAt(outline, at);
            EXPECT_GE(radius, std::min(a.value, b.value) - 1e-6f) << at;
            EXPECT_LE(radius, std::max(a.value, b.value) + 1e-6f) << at;
        }
    }
    EXPECT_FLOAT_EQ(0.5f, radiusAt(outline, -1));
    EXPECT_FLOAT_EQ(0.05f, radiusAt(outline, 2));
    EXPECT_FLOAT_EQ(0.3f, radiusAt({{0.5f, 0.3f}}, 0.1f));  // one point: the same width everywhere
}

TEST(FlameCurve, SootEndsAtTheOutlineAndHeatRisesToTheCore) {
    const FlameCurve curve = {{{0, 0.6f}, {1, 0.6f}}, {{0, 900}, {1, 1500}}};
    const std::vector<float> texels = texelsOfCurve(curve);
    ASSERT_EQ(size_t{2} * kShapeWidth * kShapeHeight, texels.size());
    for (uint32_t y = 0; y < kShapeHeight; ++y) {
        float before = 1e9f;
        for (uint32_t x = 0; x < kShapeWidth; ++x) {
            const size_t i = 2 * (size_t{y} * kShapeWidth + x);
            const float out = kShapeReach * (static_cast<float>(x) + 0.5f) / kShapeWidth;
            EXPECT_TRUE(texels[i] >= 0 && texels[i] <= 3000 && texels[i + 1] >= 0 &&
                        texels[i + 1] <= 2);
            EXPECT_EQ(out > 0.6f, texels[i + 1] == 0) << out << " at row " << y;
            EXPECT_LE(texels[i], before);  // colder outwards
            before = texels[i];
        }
    }
    const size_t middle = 2 * (size_t{kShapeHeight} / 2 * kShapeWidth);
    EXPECT_NEAR(1500 + 273, texels[middle], 15);
    EXPECT_GT(texels[middle + 1], 0.9f);
}

TEST(FlameCurve, TexelsTooColdToGlowAreEmpty) {
    for (const float value : texelsOfCurve({{{0, 0.5f}, {1, 0.5f}}, {{0, 200}, {1, 300}}}))
        EXPECT_EQ(0, value);
}

TEST(FlameCurve, CanBeSetUndoneAndSaved) {
    Yard yard;
    yard.run(
        "add flame camp name=Campfire\n"
        "set Campfire outline 0:0.5 0.4:0.7 1:0.05\nexpect step \"Outline of Campfire\"\n"
        "set Campfire stops 0:900 1:1800\nexpect step \"Temperatures of Campfire\"\n"
        "expect Campfire outline 0:0.5 0.4:0.7 1:0.05\n"
        "save a.fwscene\nnew\nopen a.fwscene\nexpect Campfire stops 0:900 1:1800\n"
        "set Campfire stops none\nundo\nexpect Campfire stops 0:900 1:1800\n"
        // Limits: inside the picture, and no hotter than a profile can hold.
        "set Campfire outline 0:9 2:0.5\nexpect Campfire outline 0:1.25 1:0.5\n"
        "set Campfire stops 0:9000\nexpect Campfire stops 0:2700\nplay 0\n");
    EXPECT_THAT(yard.fails("set Campfire outline 0.5"), HasSubstr("2 numbers"));
    std::string error;
    ASSERT_TRUE(burnToPlayhead(*yard.host, yard.host->cpu(error), error)) << error;
    EXPECT_THAT(yard.host->burn->report, ::testing::IsEmpty());
}

}  // namespace
