// Wind zones, the host's wind grid and gusts through the C ABI: effect on fire and embers,
// agreement of backends and frame rates, refusals.
#include "abi/panels.h"

#include <array>
#include <cmath>
#include <limits>

namespace {

using namespace host;

FwMaterialDef leaning() {  // spread follows the wind
    FwMaterialDef def = evenMaterial(0.02f, 6);
    def.windGain = 1;
    def.headGain = 1;
    def.driveMax = 8;
    def.lengthToBreadth = 3;
    return def;
}

// Sheets of one wind-driven material, side by side along z, each lit in its middle.
struct Meadow : HostedWorld {
    explicit Meadow(uint32_t backend, uint32_t sheets = 3, uint32_t flags = 0)
        : HostedWorld(backend, worldDef(flags)), sheet(1, 0.3f) {
        if (!world) return;
        FwBurnableMeshDef made = fwDefaultBurnableMeshDef();
        made.mesh = created(fwWorld_CreateMesh, world, sheet.def(64));
        made.materials[0] = created(fwWorld_CreateMaterial, world, leaning());
        made.flags = FW_BURNABLE_LITE;
        for (uint32_t i = 0; i < sheets; ++i) {
            made.transform[14] = float(i);
            ids.push_back(created(fwWorld_CreateBurnableMesh, world, made));
        }
    }

    FwWindZoneId blow(const FwWindZoneDef& def) {
        return created(fwWorld_CreateWindZone, world, def);
    }
    void light() {
        for (size_t i = 0; i < ids.size(); ++i) ignite({}, 0.5f, 0, float(i) + 0.15f, 0.03f);
    }
    void run(int steps, int stepsAFrame = 1) {
        for (int i = 0; i < steps; i += stepsAFrame)
            ASSERT_EQ(FW_OK, fwWorld_Step(world, float(stepsAFrame) / 32)) << lastMessage(world);
    }
    std::array<float, 3> windAt(float x, float y, float z) {
        const float point[3] = {x, y, z};
        std::array<float, 3> wind{};
        EXPECT_EQ(FW_OK, fwWorld_GetWindAt(world, point, wind.data())) << lastMessage(world);
        return wind;
    }
    uint64_t hash(size_t i) { return HostedWorld::hash(ids[i]); }
    // True if sheet i has burnt x m from its middle.
    bool burnt(size_t i, float x) {
        return point(ids[i], 0.5f + x, 0, float(i) + 0.15f).kind != FW_POINT_UNBURNT;
    }

    Sheet sheet;
    std::vector<FwBurnableMeshId> ids;
};

FwWindZoneDef fanAt(float z, float speed) {
    FwWindZoneDef def = fwDefaultWindZoneDef();
    def.shape = FW_WIND_CONE;
    const float at[3] = {-2, 0, z};
    std::copy_n(at, 3, def.position);
    def.size[0] = 6;
    def.size[1] = 1;
    def.speed = speed;
    def.falloff = 0.2f;
    return def;
}

// A fan before the second sheet: its fire runs away from the fan, the others burn as without it.
TEST(FireInWindZone, AFanDrivesOnlyTheFireInItsReach) {
    Meadow still(FW_BACKEND_CPU), blown(FW_BACKEND_CPU);
    (void)blown.blow(fanAt(1.15f, 6));
    for (Meadow* m : {&still, &blown}) {
        m->light();
        m->run(32 * 5);
    }
    EXPECT_EQ(still.hash(0), blown.hash(0));
    EXPECT_EQ(still.hash(2), blown.hash(2));
    EXPECT_NE(still.hash(1), blown.hash(1));
    EXPECT_FALSE(still.burnt(1, 0.25f));
    EXPECT_TRUE(blown.burnt(1, 0.25f));
    EXPECT_FALSE(blown.burnt(1, -0.25f));
}

// A zone over everything equals the world's wind; full shelter equals none.
TEST(FireInWindZone, EqualsTheWorldsWindEverywhere) {
    Meadow world(FW_BACKEND_CPU), zone(FW_BACKEND_CPU), both(FW_BACKEND_CPU), still(FW_BACKEND_CPU);
    const float wind[3] = {4, 0, 0};
    ASSERT_EQ(FW_OK, fwWorld_SetWind(world.world, wind));
    FwWindZoneDef def = fwDefaultWindZoneDef();
    for (float& size : def.size) size = 50;
    def.speed = 4;
    def.falloff = 0;
    (void)zone.blow(def);
    ASSERT_EQ(FW_OK, fwWorld_SetWind(both.world, wind));
    def.blend = FW_WIND_REPLACE;
    def.speed = 0;
    (void)both.blow(def);
    for (Meadow* m : {&world, &zone, &both, &still}) {
        m->light();
        m->run(32 * 4);
    }
    for (size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(world.hash(i), zone.hash(i));
        EXPECT_EQ(still.hash(i), both.hash(i));
        EXPECT_NE(world.hash(i), still.hash(i));
    }
}

TEST(FireInWindZone, BothBackendsAgree) {
    uint64_t hashes[2][3] = {};
    const uint32_t backends[] = {FW_BACKEND_CPU, FW_BACKEND_VULKAN};
    for (int b = 0; b < 2; ++b) {
        Meadow m(backends[b], 3, FW_WORLD_EMBERS | FW_WORLD_CONTACT);
        if (!m.world) GTEST_SKIP() << "there is no such backend here";
        const FwWindZoneId fan = m.blow(fanAt(1.15f, 7));
        FwWindZoneDef swirl = fwDefaultWindZoneDef();
        swirl.shape = FW_WIND_SPHERE;
        swirl.flow = FW_WIND_VORTEX;
        swirl.axis[0] = 0, swirl.axis[1] = 1;
        swirl.position[0] = 1, swirl.position[2] = 2;
        swirl.size[0] = 3;
        const FwWindZoneId vortex = m.blow(swirl);
        m.light();
        for (int part = 0; part < 6; ++part) {
            m.run(24);
            FwWindZoneDef def = fanAt(1.15f, part == 4 ? 0.0f : 7.0f);
            def.axis[2] = 0.3f * float(part) - 0.5f;
            ASSERT_EQ(FW_OK, fwWorld_SetWindZone(m.world, fan, &def)) << lastMessage(m.world);
            if (part == 3) {
                ASSERT_EQ(FW_OK, fwWorld_DestroyWindZone(m.world, vortex));
            }
        }
        for (size_t i = 0; i < 3; ++i) hashes[b][i] = m.hash(i);
    }
    for (size_t i = 0; i < 3; ++i) EXPECT_EQ(hashes[0][i], hashes[1][i]) << i;
}

// Embers fly with the wind at their fire.
TEST(FireInWindZone, CarriesEmbers) {
    uint32_t lit[2] = {};
    for (const bool blows : {false, true}) {
        FwWorldDef def = worldDef(FW_WORLD_EMBERS);
        def.paceFactor = 300;  // many embers
        Panels p(def, 4000);
        FwBurnableMeshDef large = p.def(0, 0, 0);
        p.add(large);
        for (int i = 0; i < 12; ++i) p.add(6.0f + 0.5f * float(i % 4), 0, 0.25f * float(i / 4));
        if (blows) {
            FwWindZoneDef zone = fwDefaultWindZoneDef();
            zone.shape = FW_WIND_SPHERE;
            zone.size[0] = 3;
            zone.speed = 16;
            zone.falloff = 0;
            (void)created(fwWorld_CreateWindZone, p.world, zone);
        }
        p.ignite(p.ids[0], 0.2f, 0, 0.1f, 0.3f);
        p.run(20);
        lit[blows] = p.alight() - 1;
    }
    EXPECT_EQ(0u, lit[0]);
    EXPECT_LT(0u, lit[1]);
}

// 3 x 2 x 4 points over [-1, 1] x [-0.5, 0.5] x [-0.5, 2.5] m with wind by place.
struct Grid {
    Grid(void (*blows)(float x, float y, float z, float* wind), uint32_t blend = FW_WIND_REPLACE) {
        def.counts[0] = 3, def.counts[2] = 4;
        def.origin[0] = -1, def.origin[1] = def.origin[2] = -0.5f;
        def.blend = blend;
        for (uint32_t i = 0; i < 24; ++i)
            blows(-1 + float(i % 3), -0.5f + float(i / 3 % 2), -0.5f + float(i / 6),
                  velocities + 3 * size_t{i});
        def.velocities = velocities;
    }
    Grid(const Grid&) = delete;
    Grid& operator=(const Grid&) = delete;
    FwWindGridDef def = fwDefaultWindGridDef();
    float velocities[72] = {};
};
void evenly(float, float, float, float* wind) { wind[0] = 4; }
void turning(float, float, float z, float* wind) { wind[0] = 6 * (1 - z); }  // right, then left
void shearing(float x, float y, float z, float* wind) {
    wind[0] = z;
    wind[1] = 2 * x - y;
    wind[2] = x * y - 1;
}

// A uniform grid equals the world's wind, instead of it or added to it, and can be removed.
TEST(WindGrid, EqualsTheWorldsWindEverywhere) {
    Meadow world(FW_BACKEND_CPU), grid(FW_BACKEND_CPU), both(FW_BACKEND_CPU), gone(FW_BACKEND_CPU),
        still(FW_BACKEND_CPU);
    const float wind[3] = {4, 0, 0}, half[3] = {2, 0, 0};
    ASSERT_EQ(FW_OK, fwWorld_SetWind(world.world, wind));
    const Grid even(evenly);
    ASSERT_EQ(FW_OK, fwWorld_SetWindGrid(grid.world, &even.def)) << lastMessage(grid.world);
    ASSERT_EQ(FW_OK, fwWorld_SetWind(both.world, half));
    const Grid more([](float, float, float, float* w) { w[0] = 2; }, FW_WIND_ADD);
    ASSERT_EQ(FW_OK, fwWorld_SetWindGrid(both.world, &more.def)) << lastMessage(both.world);
    ASSERT_EQ(FW_OK, fwWorld_SetWindGrid(gone.world, &even.def));
    ASSERT_EQ(FW_OK, fwWorld_SetWindGrid(gone.world, nullptr)) << lastMessage(gone.world);
    for (Meadow* m : {&world, &grid, &both, &gone, &still}) {
        m->light();
        m->run(32 * 4);
    }
    for (size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(world.hash(i), grid.hash(i));
        EXPECT_EQ(world.hash(i), both.hash(i));
        EXPECT_EQ(still.hash(i), gone.hash(i));
        EXPECT_NE(world.hash(i), still.hash(i));
    }
}

// The wind turns along z: the fires at its ends run in opposite directions.
TEST(WindGrid, DrivesFireByTheLocalWind) {
    Meadow m(FW_BACKEND_CPU);
    const Grid turns(turning);
    ASSERT_EQ(FW_OK, fwWorld_SetWindGrid(m.world, &turns.def)) << lastMessage(m.world);
    m.light();
    m.run(32 * 5);
    EXPECT_TRUE(m.burnt(0, 0.25f));
    EXPECT_FALSE(m.burnt(0, -0.25f));
    EXPECT_TRUE(m.burnt(2, -0.25f));
    EXPECT_FALSE(m.burnt(2, 0.25f));
}

TEST(WindGrid, IsTrilinearBetweenItsPoints) {
    Meadow m(FW_BACKEND_CPU);
    const float around[3] = {-3, 0.5f, 8};
    ASSERT_EQ(FW_OK, fwWorld_SetWind(m.world, around));
    Grid grid(shearing);
    ASSERT_EQ(FW_OK, fwWorld_SetWindGrid(m.world, &grid.def)) << lastMessage(m.world);
    for (const auto& at : {std::array{-0.9f, 0.2f, 2.1f}, std::array{0.77f, -0.4f, 0.0f},
                           std::array{1.0f, 0.5f, 2.5f}, std::array{-1.0f, -0.5f, -0.5f}}) {
        float expected[3] = {};
        shearing(at[0], at[1], at[2], expected);
        const std::array<float, 3> wind = m.windAt(at[0], at[1], at[2]);
        for (size_t i = 0; i < 3; ++i) EXPECT_NEAR(expected[i], wind[i], 0.03f) << i;
    }
    for (const float beyond : {-1.002f, 1.002f}) EXPECT_EQ(8, m.windAt(beyond, 0, 0)[2]);
    // Halfway inside the fade the strength is half.
    grid.def.fade = 0.4f;
    ASSERT_EQ(FW_OK, fwWorld_SetWindGrid(m.world, &grid.def));
    EXPECT_NEAR(0.5f * (8 - 1 + 0.8f * 0.1f), m.windAt(0.8f, 0.1f, 1)[2], 0.03f);
    EXPECT_NEAR(1, m.windAt(0.5f, 0.0f, 1)[0], 0.03f);
}

TEST(WindGrid, BackendsAndFrameRatesAgreeInGusts) {
    uint64_t hashes[3][3] = {};
    for (int k = 0; k < 3; ++k) {
        Meadow m(k == 2 ? FW_BACKEND_VULKAN : FW_BACKEND_CPU, 3,
                 FW_WORLD_EMBERS | FW_WORLD_CONTACT | FW_WORLD_PLUME);
        if (!m.world) GTEST_SKIP() << "there is no such backend here";
        const float around[3] = {3, 0, 1};
        ASSERT_EQ(FW_OK, fwWorld_SetWind(m.world, around));
        FwGustDef gusts = fwDefaultGustDef();
        gusts.strength = 0.8f;
        gusts.size = 1.5f;
        ASSERT_EQ(FW_OK, fwWorld_SetGusts(m.world, &gusts)) << lastMessage(m.world);
        m.light();
        for (int part = 0; part < 6; ++part) {
            m.run(24, k == 1 ? 12 : 1);
            Grid turns(part % 2 ? turning : shearing, FW_WIND_ADD);
            turns.velocities[5] += float(part);
            ASSERT_EQ(FW_OK, fwWorld_SetWindGrid(m.world, &turns.def)) << lastMessage(m.world);
        }
        for (size_t i = 0; i < 3; ++i) hashes[k][i] = m.hash(i);
    }
    for (size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(hashes[0][i], hashes[1][i]) << i;
        EXPECT_EQ(hashes[0][i], hashes[2][i]) << i;
    }
    EXPECT_NE(hashes[0][0], hashes[0][1]);
}

// A gust drifts with the wind, and the mean wind stays the same.
TEST(WindGrid, GustsDriftWithTheWind) {
    Meadow m(FW_BACKEND_CPU, 1);
    const float around[3] = {4, 0, 0};
    ASSERT_EQ(FW_OK, fwWorld_SetWind(m.world, around));
    FwGustDef gusts = fwDefaultGustDef();
    gusts.strength = 0.5f;
    gusts.size = 4;
    ASSERT_EQ(FW_OK, fwWorld_SetGusts(m.world, &gusts)) << lastMessage(m.world);
    constexpr int kPlaces = 4000;
    double mean = 0, least = 99, most = 0;
    std::vector<float> before;
    for (int i = 0; i < kPlaces; ++i) {
        before.push_back(m.windAt(0.5f * float(i), 0, 0)[0]);
        mean += double(before.back()) / kPlaces;
        least = std::min(least, double(before.back()));
        most = std::max(most, double(before.back()));
    }
    EXPECT_NEAR(4, mean, 0.15);
    EXPECT_LE(2, least);
    EXPECT_GT(3, least);
    EXPECT_GE(6, most);
    EXPECT_LT(5, most);
    m.run(32);  // 4 m further
    for (int i = 0; i < 40; ++i)
        EXPECT_NEAR(before[size_t(i)], m.windAt(0.5f * float(i) + 4, 0, 0)[0], 0.02f) << i;
    // When the wind turns, gusts keep their place.
    const float other[3] = {0, 0, 3};
    const std::array<float, 3> here = m.windAt(1, 0, 0);
    ASSERT_EQ(FW_OK, fwWorld_SetWind(m.world, other));
    EXPECT_NEAR(here[0] / 4, m.windAt(1, 0, 0)[2] / 3, 0.02f);
    gusts.strength = 0;
    ASSERT_EQ(FW_OK, fwWorld_SetGusts(m.world, &gusts));
    EXPECT_EQ(3, m.windAt(1, 0, 0)[2]);
}

TEST(WindGrid, RefusesBadValuesByName) {
    Meadow m(FW_BACKEND_CPU, 1);
    const auto expectRefused = [&](FwResult result, const char* says) {
        EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, result) << says;
        EXPECT_EQ(0u, lastMessage(m.world).find(says)) << lastMessage(m.world);
    };
    Grid good(evenly);
    ASSERT_EQ(FW_OK, fwWorld_SetWindGrid(m.world, &good.def));
    const auto expectGrid = [&](void (*damage)(Grid&), const char* says) {
        Grid bad(shearing);
        damage(bad);
        expectRefused(fwWorld_SetWindGrid(m.world, &bad.def), says);
    };
    expectGrid([](Grid& g) { g.def.counts[1] = 1; },
               "FwWindGridDef::counts[1] is 1; the limits are [2, 64].");
    expectGrid([](Grid& g) { g.def.counts[2] = 65; },
               "FwWindGridDef::counts[2] is 65; the limits are [2, 64].");
    expectGrid([](Grid& g) { g.def.counts[0] = g.def.counts[1] = g.def.counts[2] = 64; },
               "FwWindGridDef::counts makes 64 x 64 x 64 = 262144 points; the limit is 32768.");
    expectGrid([](Grid& g) { g.def.velocities = nullptr; }, "FwWindGridDef::velocities is null.");
    expectGrid([](Grid& g) { g.velocities[7] = -120.5f; },
               "FwWindGridDef::velocities[7] is -120.5 m/s; the limits are [-120, 120].");
    expectGrid([](Grid& g) { g.velocities[71] = std::numeric_limits<float>::quiet_NaN(); },
               "FwWindGridDef::velocities[71] is ");
    expectGrid([](Grid& g) { g.def.cellSize = 0; },
               "FwWindGridDef::cellSize is 0; the limits are [0.01, 1000].");
    expectGrid([](Grid& g) { g.def.fade = -1; },
               "FwWindGridDef::fade is -1; the limits are [0, 1000].");
    expectGrid([](Grid& g) { g.def.origin[2] = 2e6f; }, "FwWindGridDef::origin[2] is 2e+06;");
    expectGrid([](Grid& g) { g.def.blend = 2; }, "FwWindGridDef::blend is 2; the limit is 1.");
    expectGrid([](Grid& g) { g.def.reserved = 1; },
               "FwWindGridDef::flags is 0x0 and reserved is 1; both are zero.");
    EXPECT_NEAR(4, m.windAt(0, 0, 0)[0], 0.01f);  // unchanged
    FwGustDef gusts = fwDefaultGustDef();
    gusts.strength = 1.5f;
    expectRefused(fwWorld_SetGusts(m.world, &gusts),
                  "FwGustDef::strength is 1.5; the limits are [0, 1].");
    gusts.strength = 1;
    gusts.size = 0.1f;
    expectRefused(fwWorld_SetGusts(m.world, &gusts),
                  "FwGustDef::size is 0.1; the limits are [0.5, 1000].");
    expectRefused(fwWorld_SetGusts(m.world, nullptr), "FwGustDef is null.");
}

TEST(FireInWindZone, ReportsWindAndRefusesBadValues) {
    Panels p(worldDef(0));
    float wind[3] = {-1, -1, -1};
    const float here[3] = {0.5f, 0, 0}, far[3] = {30, 0, 0};
    const float around[3] = {1, 0, 2};
    ASSERT_EQ(FW_OK, fwWorld_SetWind(p.world, around));
    FwWindZoneDef def = fwDefaultWindZoneDef();
    FwWindZoneId id = created(fwWorld_CreateWindZone, p.world, def);
    ASSERT_EQ(FW_OK, fwWorld_GetWindAt(p.world, here, wind));
    EXPECT_NEAR(6, wind[0], 0.02f);
    EXPECT_EQ(2, wind[2]);
    ASSERT_EQ(FW_OK, fwWorld_GetWindAt(p.world, far, wind));
    EXPECT_EQ(1, wind[0]);
    const float nowhere[3] = {0, std::numeric_limits<float>::infinity(), 0};
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_GetWindAt(p.world, nowhere, wind));
    EXPECT_NE(std::string::npos, lastMessage(p.world).find("point[1] is")) << lastMessage(p.world);
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_GetWindAt(p.world, here, nullptr));
    def.speed = 121;
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_SetWindZone(p.world, id, &def));
    EXPECT_EQ(
        "FwWindZoneDef::speed is 121; the limits are [-120, 120].\n"
        " - While calling fwWorld_SetWindZone.",
        lastMessage(p.world));
    ASSERT_EQ(FW_OK, fwWorld_GetWindAt(p.world, here, wind));
    EXPECT_NEAR(6, wind[0], 0.02f);  // unchanged
    def.speed = 1;
    for (int i = 1; i < 64; ++i) {
        (void)created(fwWorld_CreateWindZone, p.world, def);
    }
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_CreateWindZone(p.world, &def, &id));
    EXPECT_EQ("64 wind zones are there; the limit is 64.\n - While calling fwWorld_CreateWindZone.",
              lastMessage(p.world));
    const FwWindZoneId first{1, 1};
    ASSERT_EQ(FW_OK, fwWorld_DestroyWindZone(p.world, first));
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_DestroyWindZone(p.world, first));
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_SetWindZone(p.world, first, &def));
}

}  // namespace
