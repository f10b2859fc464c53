// Queries of a game's characters about every kind of fire.
#include "abi/fire_world.h"
#include "abi/panels.h"

#include <cfloat>
#include <cmath>

namespace {

using host::FireWorld;
using host::lastMessage;
using host::presetDef;

FwSurroundings ask(FwWorld* world, float x, float y, float z) {
    FwSurroundings at{};
    at.structSize = sizeof at;
    const float point[3] = {x, y, z};
    EXPECT_EQ(FW_OK, fwWorld_SampleSurroundings(world, point, &at)) << lastMessage(world);
    return at;
}

TEST(SurroundingsQuery, AreSafeWhereNothingBurns) {
    FireWorld w;
    const FwSurroundings at = ask(w.world, 1, 2, 3);
    EXPECT_EQ(0, at.heatFlux);
    EXPECT_EQ(293, at.temperature);
    EXPECT_EQ(0, at.smoke);
    EXPECT_EQ(0, at.danger);
    EXPECT_EQ(FLT_MAX, at.nearest);
    EXPECT_EQ(0u, at.nearestLight);
}

TEST(SurroundingsQuery, ReportTheHeatAndSmokeOfAFire) {
    FireWorld w;
    (void)w.make(presetDef(FW_FIRE_HOUSE));
    w.run(1);
    const FwSurroundings inside = ask(w.world, 0, 0.3f, 0), near = ask(w.world, 3, 1, 0),
                         far = ask(w.world, 30, 1, 0);
    EXPECT_GT(inside.temperature, 700);
    EXPECT_GT(inside.danger, 10);
    EXPECT_EQ(0, inside.nearest);
    EXPECT_GT(near.heatFlux, 4 * far.heatFlux);
    EXPECT_LT(far.danger, 0.2f);
    EXPECT_NEAR(far.nearest, 29, 1);
    EXPECT_TRUE(near.nearestLight >> 31);
    const float left[3] = {-10, 6, 0}, right[3] = {10, 6, 0}, beside[3] = {10, 6, 30};
    float seen = -1, clear = -1;
    ASSERT_EQ(FW_OK, fwWorld_SampleVisibility(w.world, left, right, &seen));
    ASSERT_EQ(FW_OK, fwWorld_SampleVisibility(w.world, beside, right, &clear));
    EXPECT_LT(seen, 0.9f);
    EXPECT_EQ(1, clear);
}

// Burning sheets; the light named by the answer is one that the host has.
TEST(SurroundingsQuery, IncludeBurningMeshes) {
    host::Panels panels(fwDefaultWorldDef(), 100);
    const FwBurnableMeshId sheet = panels.add(0, 0, 0);
    EXPECT_EQ(FLT_MAX, ask(panels.world, 0, 0.5f, 0).nearest);
    panels.ignite(sheet, 0.2f, 0, 0.1f, 0.05f);
    panels.run(5);
    const FwSurroundings above = ask(panels.world, 0.2f, 0.4f, 0.1f);
    EXPECT_GT(above.temperature, 320);
    EXPECT_GT(above.heatFlux, 500);
    EXPECT_GT(above.nearestPower, 0);
    FwLight light{};
    ASSERT_EQ(1u, fwWorld_GetLights(panels.world, &light, 1));
    EXPECT_EQ(light.id, above.nearestLight);
    EXPECT_LT(ask(panels.world, 0.2f, -1, 0.1f).temperature, 294) << "heat rises";
}

TEST(SurroundingsQuery, FillAWalkabilityMask) {
    FireWorld w;
    (void)w.make(presetDef(FW_FIRE_BONFIRE));
    w.run(1);
    const float corner[3] = {-8, 1.5f, -8}, column[3] = {1, 0, 0}, row[3] = {0, 0, 1};
    std::vector<uint8_t> mask(17 * 17, 1);
    ASSERT_EQ(FW_OK, fwWorld_MakeSafetyMask(w.world, corner, column, row, 17, 17, mask.data()));
    EXPECT_EQ(255, mask[8 * 17 + 8]) << "in the fire";
    EXPECT_LT(mask[0], 127) << "at the edge";
    for (uint32_t x = 9; x < 16; ++x) EXPECT_GE(mask[8 * 17 + x], mask[8 * 17 + x + 1]) << x;
    const FwSurroundings at = ask(w.world, 3, 1.5f, 0);
    EXPECT_EQ(uint8_t(std::min(127 * at.danger, 255.0f)), mask[8 * 17 + 11]);
}

TEST(SurroundingsQuery, RefuseInvalidQueries) {
    FireWorld w;
    const float nowhere[3] = {NAN, 0, 0}, here[3] = {0, 0, 0};
    FwSurroundings at{};
    EXPECT_EQ(FW_ERROR_VERSION, fwWorld_SampleSurroundings(w.world, here, &at));
    at.structSize = sizeof at;
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_SampleSurroundings(w.world, nowhere, &at));
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_SampleSurroundings(w.world, here, nullptr));
    float seen = 0;
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_SampleVisibility(w.world, here, nowhere, &seen));
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_SampleVisibility(w.world, here, here, nullptr));
    uint8_t mask = 0;
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT,
              fwWorld_MakeSafetyMask(w.world, here, here, here, 0, 1, &mask));
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT,
              fwWorld_MakeSafetyMask(w.world, here, here, here, 1, 4097, &mask));
    EXPECT_NE(std::string::npos, lastMessage(w.world).find("the limits are [1, 4096] each"));
    EXPECT_EQ(FW_OK, fwWorld_MakeSafetyMask(w.world, here, here, here, 1, 1, &mask));
}

}  // namespace
