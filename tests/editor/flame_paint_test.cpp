// Brushes on a flame's shape: dabs stay in their circle and limits, a smear drags, a gradient
// blends two values inside the flame.
#include "document/flame_paint.h"

#include <gtest/gtest.h>

#include <cmath>

namespace fw::test::flame_paint_test {
namespace {

using namespace fwedit;

constexpr int kWide = ProfilePaint::kWidth, kHigh = ProfilePaint::kHeight;

size_t texel(int x, int y) { return size_t(y) * kWide + size_t(x); }

// Half of the greatest width, equally hot everywhere.
ProfilePaint column() {
    ProfilePaint paint;
    for (int y = 0; y < kHigh; ++y)
        for (int x = 0; x < kWide / 2; ++x) {
            paint.kelvin[texel(x, y)] = 1200;
            paint.soot[texel(x, y)] = 1;
        }
    return paint;
}

TEST(FlamePaint, DabsStayInTheirCircleOnBothSides) {
    Dab dab{
        .x = 20, .y = 60, .radiusX = 6, .radiusY = 9, .value = 1900, .strength = 1, .hardness = 1};
    ProfilePaint right = column(), left = column();
    paintDab(right, dab);
    dab.x = -20;
    paintDab(left, dab);
    EXPECT_EQ(right, left);
    for (int y = 0; y < kHigh; ++y)
        for (int x = 0; x < kWide; ++x) {
            const float away = std::hypot((float(x) + 0.5f - 20) / 6, (float(y) + 0.5f - 60) / 9);
            EXPECT_EQ(away < 1        ? 1900.0f
                      : x < kWide / 2 ? 1200.0f
                                      : 0.0f,
                      right.kelvin[texel(x, y)]);
        }
}

TEST(FlamePaint, PaintedHeatGlowsAndErasedHeatIsGone) {
    ProfilePaint paint;
    Dab dab{.x = 10, .y = 40, .value = 1500, .strength = 1, .hardness = 1};
    paintDab(paint, dab);
    EXPECT_EQ(1500, paint.kelvin[texel(10, 40)]);
    EXPECT_GT(paint.soot[texel(10, 40)], 0.5f);
    dab.tool = ProfileTool::kErase;
    paintDab(paint, dab);
    EXPECT_EQ(ProfilePaint{}, paint);
    dab = {
        .plane = ProfilePlane::kSoot, .x = 10, .y = 40, .value = 99, .strength = 1, .hardness = 1};
    paintDab(paint, dab);
    EXPECT_EQ(ProfilePaint::kMostSoot, paint.soot[texel(10, 40)]);
    EXPECT_EQ(0, paint.kelvin[texel(10, 40)]);
}

TEST(FlamePaint, SmoothingLevelsAnEdge) {
    ProfilePaint paint = column();
    const Dab dab{.tool = ProfileTool::kSmooth,
                  .x = 32,
                  .y = 60,
                  .radiusX = 8,
                  .radiusY = 8,
                  .strength = 1,
                  .hardness = 1};
    const auto step = [&] { return paint.kelvin[texel(31, 60)] - paint.kelvin[texel(32, 60)]; };
    const float before = step();
    for (int k = 0; k < 4; ++k) paintDab(paint, dab);
    EXPECT_LT(step(), 0.4f * before);
    EXPECT_GT(step(), 0);
}

// From inside the column out over its edge: it grows a tongue of heat and emission.
TEST(FlamePaint, SmearsDragHeatAlong) {
    for (const float side : {1.0f, -1.0f}) {
        ProfilePaint paint = column();
        Dab dab{.tool = ProfileTool::kSmear,
                .y = 60,
                .radiusX = 5,
                .radiusY = 5,
                .alongX = side,
                .strength = 1,
                .hardness = 0.8f};
        for (int k = 0; k < 12; ++k) {
            dab.x = side * (28 + float(k));
            paintDab(paint, dab);
        }
        EXPECT_GT(paint.kelvin[texel(38, 60)], 1000) << side;
        EXPECT_GT(paint.soot[texel(38, 60)], 0.8f) << side;
        EXPECT_EQ(0, paint.kelvin[texel(38, 70)]) << side;
        EXPECT_EQ(1200, paint.kelvin[texel(20, 90)]) << side;
    }
}

TEST(FlamePaint, GradientsBlendInsideTheFlame) {
    ProfilePaint paint = column();
    const Gradient up{
        .fromX = 0, .fromY = 20, .toX = 0, .toY = 100, .fromValue = 1800, .toValue = 1000};
    paintGradient(paint, up);
    EXPECT_EQ(1800, paint.kelvin[texel(5, 3)]);
    EXPECT_NEAR(1400, paint.kelvin[texel(5, 60)], 6);
    EXPECT_EQ(1000, paint.kelvin[texel(5, 120)]);
    EXPECT_EQ(1, paint.soot[texel(5, 60)]);
    EXPECT_EQ(0, paint.kelvin[texel(kWide - 1, 60)]) << "nothing outside the flame";

    // Slanted, equal on both sides of the axis, half strength.
    ProfilePaint right = column(), left = column();
    Gradient across{.plane = ProfilePlane::kSoot,
                    .fromX = 4,
                    .fromY = 40,
                    .toX = 24,
                    .toY = 60,
                    .fromValue = 2,
                    .toValue = 0,
                    .strength = 0.5f,
                    .aspect = 2};
    paintGradient(right, across);
    across.fromX = -across.fromX, across.toX = -across.toX;
    paintGradient(left, across);
    EXPECT_EQ(right, left);
    EXPECT_NEAR(1.5f, right.soot[texel(2, 38)], 0.01f);
    EXPECT_NEAR(0.5f, right.soot[texel(26, 62)], 0.01f);
    EXPECT_EQ(column().kelvin, right.kelvin);

    Gradient nowhere{.fromX = 7, .fromY = 9, .toX = 7, .toY = 9};
    ProfilePaint same = column();
    paintGradient(same, nowhere);
    EXPECT_EQ(column(), same);
}

}  // namespace
}  // namespace fw::test::flame_paint_test
