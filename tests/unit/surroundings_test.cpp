// Effects of fire on nearby places against measurements.
#include "components/surroundings.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace fw::components;

const FireSource kCampFire = fireSource({0, 0, 0}, 0.4f, 100, 7);

Surroundings at(float x, float y, const SurroundingAir& air = {}) {
    return surroundingsOf({&kCampFire, 1}, air, {x, y, 0});
}

// 100 kW, 30 % radiated, as a point source: 2.4 kW/m^2 at a metre, then inverse square.
TEST(Surroundings, HeatFollowsTheInverseSquare) {
    const float one = at(1, 0.5f).heatFlux, two = at(2, 0.5f).heatFlux, four = at(4, 0.5f).heatFlux;
    EXPECT_NEAR(one, 2387, 240);
    EXPECT_NEAR(one / two, 4, 0.2f);
    EXPECT_NEAR(two / four, 4, 0.2f);
    EXPECT_EQ(0, at(3, 0.5f).excess);
    EXPECT_NEAR(at(3, 0.5f).nearest, 2.6f, 1e-4f);
    EXPECT_EQ(&kCampFire, at(3, 0.5f).source);
    EXPECT_EQ(0.0f, at(0, 0.1f).nearest);
}

// McCaffrey (1979), centreline: 800 K in the flame, 21.6 (z / Q^0.4)^(-5/3) far above.
TEST(Surroundings, PlumeTemperatureMatchesMcCaffrey) {
    EXPECT_NEAR(at(0, 0.3f).excess, 800, 1);
    const float scaled = 5.0f / std::pow(100.0f, 0.4f);
    EXPECT_NEAR(at(0, 5).excess, 21.6f * std::pow(scaled, -5.0f / 3.0f), 0.5f);
    EXPECT_LT(at(1, 5).excess, at(0, 5).excess);
    EXPECT_LT(at(4, 5).excess, 0.1f);
    EXPECT_LT(at(0, -1).excess, 0.1f) << "nothing below the fire";
}

TEST(Surroundings, WallsBlockRadiationAndWindBendsThePlume) {
    fw::volume::Collider wall;
    wall.kind = fw::volume::ColliderKind::Box;
    wall.place = {1, 1, 0};
    wall.extent = {0.1f, 2, 2};
    SurroundingAir air;
    air.walls = {&wall, 1};
    EXPECT_GT(at(2, 0.5f).heatFlux, 500);
    EXPECT_LT(at(2, 0.5f, air).heatFlux, 1);
    EXPECT_GT(at(-2, 0.5f, air).heatFlux, 500) << "the other side is open";
    air = {};
    air.wind = {3, 0, 0};
    EXPECT_GT(at(2.5f, 4, air).excess, 4 * at(-2.5f, 4, air).excess + 1);
    EXPECT_GT(at(2.5f, 4, air).smoke, at(-2.5f, 4, air).smoke);
}

TEST(Surroundings, SmokeRisesAboveTheFlameAndBlocksSight) {
    EXPECT_EQ(0.0f, at(0, 0.2f).smoke) << "soot burns in the flame";
    EXPECT_GT(at(0, 3).smoke, at(0, 6).smoke);
    EXPECT_EQ(0.0f, at(5, 3).smoke);
    const std::span<const FireSource> fire{&kCampFire, 1};
    const float through = sightThrough(fire, {}, {-4, 3, 0}, {4, 3, 0});
    EXPECT_LT(through, 0.95f);
    EXPECT_GT(through, 0.05f);
    EXPECT_EQ(1.0f, sightThrough(fire, {}, {-4, 0.2f, 3}, {4, 0.2f, 3})) << "past the smoke";
    EXPECT_FLOAT_EQ(through, sightThrough(fire, {}, {4, 3, 0}, {-4, 3, 0}));
    // All soot rises through every height: the soot in a plane times its speed is constant.
    const FireSource large = fireSource({0, 0, 0}, 0.4f, 1000, 1);
    EXPECT_GT(sightThrough(fire, {}, {-8, 5, 0}, {8, 5, 0}),
              sightThrough({&large, 1}, {}, {-8, 5, 0}, {8, 5, 0}));
}

TEST(Surroundings, DangerIsTheWorstOfAllEffects) {
    Surroundings one;
    EXPECT_EQ(0, spreadRiskOf(one));
    one.heatFlux = 5000;
    EXPECT_FLOAT_EQ(2, spreadRiskOf(one));
    one.excess = 120;
    EXPECT_FLOAT_EQ(3, spreadRiskOf(one));
    one.smoke = 4;
    EXPECT_FLOAT_EQ(4, spreadRiskOf(one));
}

}  // namespace
