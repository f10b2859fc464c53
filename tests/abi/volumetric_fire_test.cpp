// Volumetric fires through the C ABI on the cpu backend: state, motion, light, refusals.
#include "abi/fire_world.h"

#include <gmock/gmock.h>

#include <cmath>
#include <set>
#include <vector>

namespace {

using host::created;
using host::FireWorld;
using host::getState;
using host::lastMessage;
using host::presetDef;
using ::testing::HasSubstr;

TEST(VolumetricFire, PresetsAreNamedAndBurn) {
    FireWorld w;
    std::set<std::string> names;
    for (uint32_t i = 0; i < FW_FIRE_PRESET_COUNT; ++i) {
        names.insert(fwFirePresetName(i));
        FwVolumetricFireDef def = presetDef(i);
        EXPECT_EQ(i, def.preset);
        def.userData = i + 40;
        const FwVolumetricFireId id = w.make(def);
        w.run(0.1f);
        const FwVolumetricFireState state = w.state(id);
        EXPECT_LE(1u, state.flames) << fwFirePresetName(i);
        EXPECT_EQ(i + 40, state.userData);
        EXPECT_GT(state.height, 0.0f);
        EXPECT_GT(state.lightIntensity, 0.0f);
        EXPECT_GT(state.boundsHigh[1], state.height);
        EXPECT_LE(state.boundsLow[1], 0.001f);
    }
    EXPECT_EQ(size_t(FW_FIRE_PRESET_COUNT), names.size());
    EXPECT_NE(nullptr, fwFirePresetName(99));
    FwVolumetricFireDef def = fwDefaultVolumetricFireDef();
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwInitFirePreset(&def, FW_FIRE_PRESET_COUNT));
}

// Flame height: Heskestad (1984), 0.235 Q^0.4 - 1.02 D. Pulsation: Cetegen and Ahmed (1993), 1.5 /
// sqrt(D).
TEST(VolumetricFire, HeightAndPulsationMatchTheCorrelations) {
    FireWorld w;
    FwVolumetricFireDef def = fwDefaultVolumetricFireDef();
    def.power = 1690;
    def.diameter = 1.6f;
    const FwVolumetricFireId id = w.make(def);
    w.run(0.1f);
    const FwVolumetricFireState state = w.state(id);
    EXPECT_NEAR(state.height, 2.96f, 0.03f);
    EXPECT_NEAR(state.pulseRate, 1.186f, 0.01f);
    EXPECT_EQ(1u, state.flames);
    def.power = 3;  // wide and weak: many small flames
    EXPECT_LT(4u, [&] {
        const FwVolumetricFireId weak = w.make(def);
        w.run(0.1f);
        return w.state(weak).flames;
    }());
}

TEST(VolumetricFire, FollowsPowerPositionAndWind) {
    FireWorld still, windy(4);
    const FwVolumetricFireId a = still.make(fwDefaultVolumetricFireDef());
    const FwVolumetricFireId b = windy.make(fwDefaultVolumetricFireDef());
    still.run(1);
    windy.run(1);
    EXPECT_NEAR(still.state(a).tip[0], 0.0f, 0.12f);
    EXPECT_GT(windy.state(b).tip[0], 0.2f);
    EXPECT_EQ(FW_OK, fwWorld_SetVolumetricFirePower(still.world, a, 0));
    still.run(0.1f);
    EXPECT_GT(still.state(a).power, 20.0f) << "it follows without a jump";
    still.run(6);
    EXPECT_EQ(0u, still.state(a).flames);
    EXPECT_EQ(FW_OK, fwWorld_SetVolumetricFirePower(still.world, a, 60));
    // A carried torch trails behind.
    float place[3] = {};
    for (int i = 0; i < 32; ++i) {
        place[0] += 2.0f / 32;
        EXPECT_EQ(FW_OK, fwWorld_MoveVolumetricFire(still.world, a, place));
        still.run(1.0f / 64);
    }
    EXPECT_LT(still.state(a).tip[0], place[0] - 0.1f);
}

// A floating origin, a portal, a respawn: faster than 100 m/s counts as a teleport.
TEST(VolumetricFire, KeepsItsShapeWhenTeleported) {
    for (const float way : {5.0f, 50.0f, 1000.0f}) {
        FireWorld stays(2), moves(2);
        FwVolumetricFireDef def = presetDef(FW_FIRE_CAMP);
        def.seed = 7;
        const FwVolumetricFireId a = stays.make(def), b = moves.make(def);
        stays.run(5);
        moves.run(5);
        const float to[3] = {-way, 0, 0.5f * way};
        ASSERT_EQ(FW_OK, fwWorld_MoveVolumetricFire(moves.world, b, to));
        for (int frame = 0; frame < 32; ++frame) {
            stays.run(1.0f / 32);
            moves.run(1.0f / 32);
            const FwVolumetricFireState here = stays.state(a), there = moves.state(b);
            for (int i = 0; i < 3; ++i) {
                EXPECT_NEAR(here.tip[i] + to[i], there.tip[i], 0.005f) << way << ", " << frame;
                EXPECT_NEAR(here.boundsLow[i] + to[i], there.boundsLow[i], 0.02f) << way;
                EXPECT_NEAR(here.boundsHigh[i] + to[i], there.boundsHigh[i], 0.02f) << way;
            }
            EXPECT_NEAR(here.lightIntensity, there.lightIntensity, 0.01f * here.lightIntensity);
        }
    }
    // Below that speed it trails behind.
    FireWorld flies;
    const FwVolumetricFireId id = flies.make(presetDef(FW_FIRE_CAMP));
    flies.run(2);
    const float near[3] = {-1, 0, 0};
    ASSERT_EQ(FW_OK, fwWorld_MoveVolumetricFire(flies.world, id, near));
    flies.run(1.0f / 32);
    EXPECT_GT(flies.state(id).tip[0], near[0] + 0.2f);
}

// A fire that changes its flames takes the dying ones along.
TEST(VolumetricFire, LeavesNoFlameBehindWhenTeleported) {
    FireWorld w;
    FwVolumetricFireDef def = fwDefaultVolumetricFireDef();
    def.diameter = 2;
    def.power = 1500;
    const FwVolumetricFireId id = w.make(def);
    w.run(1);
    ASSERT_EQ(FW_OK, fwWorld_SetVolumetricFirePower(w.world, id, 5));
    w.run(1.0f / 16);
    ASSERT_LT(1u, w.state(id).flames);
    const float to[3] = {80, 0, 0};
    ASSERT_EQ(FW_OK, fwWorld_MoveVolumetricFire(w.world, id, to));
    w.run(1.0f / 32);
    EXPECT_GT(w.state(id).boundsLow[0], to[0] - 5) << "nothing burns at the old place";
}

TEST(VolumetricFire, FollowsTheHostsPoints) {
    FireWorld w(3);
    FwFirePoint points[3] = {{{1, 0, 0}, 0.2f}, {{1.5f, 0.5f, 0}, 0.2f}, {{2.5f, 0.6f, 0}, 0.1f}};
    FwVolumetricFireDef def = fwDefaultVolumetricFireDef();
    def.points = points;
    def.pointCount = 3;
    const FwVolumetricFireId id = w.make(def);
    points[0].position[0] = -50;  // copied
    w.run(0.1f);
    EXPECT_NEAR(w.state(id).tip[0], 2.5f, 0.1f);
    EXPECT_NEAR(w.state(id).height, 1.7f, 0.15f);
    EXPECT_EQ(FW_OK, fwWorld_SetVolumetricFirePoints(w.world, id, nullptr, 0));
    w.run(1);
    EXPECT_LT(w.state(id).tip[0], 1.5f);
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_SetVolumetricFirePoints(w.world, id, points, 1));
    EXPECT_THAT(lastMessage(w.world), HasSubstr("pointCount is 1; it is 0 or in [2, 32]"));
    points[2].radius = -1;
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_SetVolumetricFirePoints(w.world, id, points, 3));
    EXPECT_THAT(lastMessage(w.world), HasSubstr("points[2].radius is -1"));
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_SetVolumetricFirePoints(w.world, id, nullptr, 3));
    // Equal points, a loop, a jump: every finite path is drawn.
    const FwFirePoint odd[4] = {{{0, 0, 0}, 0}, {{0, 0, 0}, 1}, {{9, 0, 0}, 0}, {{0, 0, 0}, 3}};
    EXPECT_EQ(FW_OK, fwWorld_SetVolumetricFirePoints(w.world, id, odd, 4));
    w.run(0.1f);
    EXPECT_TRUE(std::isfinite(w.state(id).tip[0] + w.state(id).boundsHigh[1]));
}

TEST(VolumetricFire, IsALight) {
    FireWorld w;
    FwVolumetricFireDef def = fwDefaultVolumetricFireDef();
    const FwVolumetricFireId large = w.make(def);
    def.power = 5;
    def.diameter = 0.13f;
    def.position[0] = 3;
    (void)w.make(def);
    def.flags = FW_FIRE_NO_LIGHT;
    (void)w.make(def);
    w.run(0.1f);
    FwLight lights[8];
    ASSERT_EQ(2u, fwWorld_GetLights(w.world, lights, 8));
    EXPECT_GT(lights[0].intensity, lights[1].intensity);
    EXPECT_NEAR(lights[0].power, 60000.0f, 1.0f);
    EXPECT_NEAR(lights[1].position[0], 3.0f, 0.05f);
    EXPECT_NE(lights[0].id, lights[1].id);
    EXPECT_TRUE(lights[0].id >> 31);
    ASSERT_EQ(1u, fwWorld_GetLights(w.world, lights + 4, 1));
    EXPECT_EQ(lights[0].id, lights[4].id);
    EXPECT_EQ(FW_OK, fwWorld_SetVolumetricFireHidden(w.world, large, 1));
    w.run(0.1f);
    EXPECT_EQ(1u, fwWorld_GetLights(w.world, lights, 8));
}

// The host may set the tier at any time.
TEST(VolumetricFire, AcceptsATierAtAnyTime) {
    FireWorld w;
    const FwVolumetricFireDef def = fwDefaultVolumetricFireDef();
    const FwVolumetricFireId id = w.make(def);
    for (uint32_t tier = FW_FIRE_TIER_AUTO; tier <= FW_FIRE_TIER_SHARED_IMPOSTOR; ++tier)
        EXPECT_EQ(tier == 4 ? FW_ERROR_INVALID_ARGUMENT : FW_OK,  // 4 is reserved
                  fwWorld_SetVolumetricFireTier(w.world, id, tier));
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_SetVolumetricFireTier(w.world, id, 6));
    EXPECT_NE(std::string::npos, std::string(lastMessage(w.world)).find("tier is 6"));
    EXPECT_EQ(FW_OK, fwWorld_DestroyVolumetricFire(w.world, id));
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_SetVolumetricFireTier(w.world, id, FW_FIRE_TIER_AUTO));
}

// A light before the first frame must match the light that the first frame computes.
TEST(VolumetricFire, LightsTheSceneBeforeItsFirstFrame) {
    FwFirePoint line[2] = {{{3, 0, 0}, 0.1f}, {{4, 1, 0}, 0.1f}};
    for (int kind = 0; kind < 5; ++kind) {
        FireWorld w;
        FwVolumetricFireDef def = presetDef(kind == 1   ? FW_FIRE_CANDLE
                                            : kind == 2 ? FW_FIRE_MAGIC_BLUE
                                            : kind == 3 ? FW_FIRE_DYING_EMBERS
                                                        : FW_FIRE_CAMP);
        if (kind == 4) {
            def.points = line;
            def.pointCount = 2;
        }
        const FwVolumetricFireId id = w.make(def);
        const float place[3] = {2, 0.5f, 0};
        EXPECT_EQ(FW_OK, fwWorld_MoveVolumetricFire(w.world, id, place));
        FwLight before{}, after{};
        ASSERT_EQ(1u, fwWorld_GetLights(w.world, &before, 1)) << kind;
        const FwVolumetricFireState expected = w.state(id);
        w.run(1.0f / 32);
        ASSERT_EQ(1u, fwWorld_GetLights(w.world, &after, 1));
        const FwVolumetricFireState state = w.state(id);
        EXPECT_NEAR(before.intensity / after.intensity, 1.0f, 0.4f) << "it flickers, " << kind;
        EXPECT_NEAR(before.power / after.power, 1.0f, 0.02f) << kind;
        EXPECT_EQ(before.id, after.id);
        for (int i = 0; i < 3; ++i) {
            EXPECT_NEAR(before.color[i], after.color[i], 0.02f) << kind;
            EXPECT_NEAR(before.position[i], after.position[i], 0.2f * state.height + 0.02f)
                << kind << ", axis " << i;
        }
        EXPECT_EQ(expected.flames, state.flames) << kind;
        // Small flames side by side rise higher together.
        EXPECT_NEAR(expected.height / state.height, 1.0f, kind == 3 ? 0.35f : 0.05f) << kind;
        EXPECT_FLOAT_EQ(expected.pulseRate, state.pulseRate);
    }
    FireWorld w;
    FwVolumetricFireDef def = fwDefaultVolumetricFireDef();
    const FwVolumetricFireId id = w.make(def);
    def.flags = FW_FIRE_NO_LIGHT;
    (void)w.make(def);
    FwLight lights[4];
    EXPECT_EQ(1u, fwWorld_GetLights(w.world, lights, 4));
    EXPECT_EQ(FW_OK, fwWorld_SetVolumetricFirePower(w.world, id, 0));
    EXPECT_EQ(0u, fwWorld_GetLights(w.world, lights, 4)) << "it was never lit";
}

// One light each; no two flicker alike.
TEST(VolumetricFire, LightsFlickerIndependently) {
    constexpr int kFires = 6, kFrames = 96;
    FireWorld w;
    FwVolumetricFireId ids[kFires];
    std::vector<double> light[kFires];
    for (int i = 0; i < kFires; ++i) {
        FwVolumetricFireDef def = fwDefaultVolumetricFireDef();
        def.position[0] = 30.0f * float(i);
        ids[i] = w.make(def);
    }
    for (int k = 0; k < kFrames; ++k) {
        w.run(1.0f / 32);
        for (int i = 0; i < kFires; ++i) light[i].push_back(double(w.state(ids[i]).lightIntensity));
    }
    for (std::vector<double>& l : light) {
        double mean = 0, square = 0;
        for (const double v : l) mean += v / kFrames;
        for (double& v : l) {
            v -= mean;
            square += v * v;
        }
        EXPECT_GT(std::sqrt(square / kFrames) / mean, 0.03) << "it flickers";
        EXPECT_LT(std::sqrt(square / kFrames) / mean, 0.4);
        for (double& v : l) v /= std::sqrt(square);
    }
    double together = 0;
    for (int i = 0; i < kFires; ++i)
        for (int j = 0; j < i; ++j)
            for (int k = 0; k < kFrames; ++k) together += light[i][size_t(k)] * light[j][size_t(k)];
    EXPECT_LT(together / (0.5 * kFires * (kFires - 1)), 0.3);
}

// As many as a world allows, with walls, wind and queries: no allocation.
TEST(VolumetricFire, ManyFiresAllocateNothing) {
    FireWorld w;
    FwVolumetricFireDef def = presetDef(FW_FIRE_TORCH);
    std::vector<FwVolumetricFireId> ids;
    for (int i = 0; i < 256; ++i) {
        def.position[0] = 0.3f * float(i % 16);
        def.position[2] = 0.3f * float(i / 16);
        ids.push_back(w.make(def));
    }
    FwFireColliderDef ceiling = fwDefaultFireColliderDef();
    ceiling.kind = FW_COLLIDER_PLANE;
    ceiling.position[1] = 0.4f;
    ceiling.normal[1] = -1;
    (void)created(fwWorld_AddFireCollider, w.world, ceiling);
    w.run(4.0f / 32);
    const int64_t before = w.host.allocations;
    for (int k = 0; k < 16; ++k) {
        const float wind[3] = {0.1f * float(k), 0, 0}, place[3] = {0.02f * float(k), 0, 0};
        ASSERT_EQ(FW_OK, fwWorld_SetWind(w.world, wind));
        ASSERT_EQ(FW_OK, fwWorld_MoveVolumetricFire(w.world, ids[size_t(k)], place));
        ASSERT_EQ(FW_OK, fwWorld_SetVolumetricFirePower(w.world, ids[100], 4 + 0.1f * float(k)));
        w.run(1.0f / 32);
        FwLight lights[64];
        EXPECT_LE(1u, fwWorld_GetLights(w.world, lights, 64));
        (void)getState(fwWorld_SampleVolumetricFires, w.world, place);
    }
    EXPECT_EQ(before, w.host.allocations);
    for (const FwVolumetricFireId id : ids) EXPECT_EQ(1u, w.state(id).flames);
}

TEST(VolumetricFire, RefusesValuesBeyondLimitsByName) {
    FireWorld w;
    FwVolumetricFireDef def = fwDefaultVolumetricFireDef();
    FwVolumetricFireId id{};
    def.flags = 64;
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_CreateVolumetricFire(w.world, &def, &id));
    EXPECT_THAT(lastMessage(w.world), HasSubstr("FwVolumetricFireDef::flags is 0x40"));
    def = fwDefaultVolumetricFireDef();
    def.preset = 9;
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_CreateVolumetricFire(w.world, &def, &id));
    EXPECT_THAT(lastMessage(w.world), HasSubstr("preset is 9; the limits are [0, 8]"));
    def.preset = 0;
    def.pointCount = 2;
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_CreateVolumetricFire(w.world, &def, &id));
    EXPECT_THAT(lastMessage(w.world), HasSubstr("FwVolumetricFireDef::points is null"));
    def.pointCount = 0;
    for (int i = 0; i < 256; ++i) id = w.make(def);
    w.run(0.1f);
    FwVolumetricFireId more{};
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_CreateVolumetricFire(w.world, &def, &more));
    EXPECT_THAT(lastMessage(w.world), HasSubstr("256 volumetric fires"));
    EXPECT_EQ(FW_OK, fwWorld_DestroyVolumetricFire(w.world, id));
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_DestroyVolumetricFire(w.world, id));
    EXPECT_THAT(lastMessage(w.world), HasSubstr("Volumetric fire 256 (generation 1)"));
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_SetVolumetricFirePower(w.world, id, 1));
    const FwVolumetricFireId last = w.make(def);
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_SetVolumetricFirePower(w.world, last, -1));
    const float nowhere[3] = {0, NAN, 0};
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_MoveVolumetricFire(w.world, last, nowhere));
}

}  // namespace
