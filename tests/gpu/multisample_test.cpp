// Burning surfaces in a target of four samples.
#include "host_draw.h"

namespace fw::test::host_draw {
namespace {

constexpr float kPlaces[4][2] = {  // Vulkan's standard samples, px from the pixel's centre
    {-0.125f, -0.375f},
    {0.375f, -0.125f},
    {-0.375f, 0.125f},
    {0.125f, 0.375f}};

class Multisampled : public HostDraw {
 protected:
    Multisampled() { look_ = FW_MATERIAL_NEWSPAPER; }
    static Shot surfaces(uint32_t samples) {
        Shot shot;
        shot.samples = samples;
        shot.flags = FW_TARGET_NO_FLAMES;
        return shot;
    }
};

class BurntAway : public Multisampled {
 protected:
    BurntAway() {
        litRadius_ = 9;         // the whole ball
        texelsPerMetre_ = 160;  // half a pixel exceeds the gutter of charts
        burnFrames_ = 200;
    }
};

// A pixel's centre may lie beside a triangle that covers some of its samples. A lookup at the
// centre found unburnt texels there and left outlines.
TEST_F(BurntAway, LeavesNoPixelAtFourSamples) {
    if (!device_) return;
    EXPECT_EQ(0u, shoot(surfaces(1)).unlike(8, kWidth - 8, 0, 0, 1));
    for (const auto& place : kPlaces) {  // four positions, for slivers at the ball's outline
        Shot shot = surfaces(4);
        shot.shift[0] = place[0];
        shot.shift[1] = place[1];
        EXPECT_EQ(0u, shoot(shot).unlike(8, kWidth - 8, 0, 0, 1)) << place[0] << ", " << place[1];
    }
    EXPECT_EQ(0u, shoot(surfaces(4)).unlike(8, kWidth - 8, 0, 0, 1));
}

class Rim : public Multisampled {
 protected:
    Rim() {
        litRadius_ = 0.2f;
        burnFrames_ = 44;
    }
};

double toLight(double stored) {
    return stored <= 0.04045 ? stored / 12.92 : std::pow((stored + 0.055) / 1.055, 2.4);
}

// Against the mean of four pictures, one per sample position.
TEST_F(Rim, OfAHoleIsAsSmoothAsFourPictures) {
    if (!device_) return;
    std::vector<double> parts(size_t{kWidth} * kHeight * 3);
    for (const auto& place : kPlaces) {
        Shot shot = surfaces(1);
        shot.shift[0] = place[0];
        shot.shift[1] = place[1];
        const Picture picture = shoot(shot);
        for (size_t i = 0; i < parts.size(); ++i)
            parts[i] += 0.25 * toLight(double(picture.rgb[i]));
    }
    const Picture single = shoot(surfaces(1)), several = shoot(surfaces(4));
    // Inside the ball's outline, right of the host's occluder.
    double singleOff = 0, severalOff = 0;
    for (uint32_t y = 18; y < 46; ++y) {
        for (uint32_t x = 50; x < 59; ++x) {
            for (uint32_t c = 0; c < 3; ++c) {
                const size_t i = (size_t{y} * kWidth + x) * 3 + c;
                singleOff += std::pow(toLight(double(single.rgb[i])) - parts[i], 2);
                severalOff += std::pow(toLight(double(several.rgb[i])) - parts[i], 2);
            }
        }
    }
    EXPECT_LT(severalOff, 0.35 * singleOff);
}

}  // namespace
}  // namespace fw::test::host_draw
