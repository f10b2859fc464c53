// Flamethrowers against the world on the cpu backend. Most cases settle a complaint about a game,
// which their comment cites; fire through walls is the most frequent.
#include "abi/panels.h"

#include <gmock/gmock.h>

namespace {

using host::created;
using host::getState;
using host::lastMessage;
using host::materialOf;
using host::Panels;
using ::testing::HasSubstr;

// Panels stand across x, 2 m high and 1 m wide; a jet 1 m above the floor blows along x.
struct Range : Panels {
    explicit Range(bool warms = false, FwContext* given = nullptr)
        : Panels(fwDefaultWorldDef(), 60, 64, given), heat(warms) {
        jetDef = fwDefaultFireEmitterDef();
        jetDef.flags = FW_EMITTER_JET | FW_EMITTER_IGNITES;
        jetDef.position[1] = 1;
        jetDef.direction[0] = 1;
        jetDef.direction[1] = 0;
        jetDef.power = 2000;
    }
    FwBurnableMeshDef panel(float x, float z) const {
        FwBurnableMeshDef made = def(0, 0, 0);
        if (heat) made.flags = FW_BURNABLE_TWO_SIDED;
        constexpr float kScale = 5;
        const float turned[16] = {0, kScale, 0,      0, -kScale, 0, 0,        0,
                                  0, 0,      kScale, 0, x,       0, z - 0.5f, 1};
        std::copy(std::begin(turned), std::end(turned), made.transform);
        return made;
    }
    FwBurnableMeshId wall(float x, float z = 0) { return add(panel(x, z)); }
    FwBurnableMeshId floor(float y) {
        FwBurnableMeshDef made = panel(0, 0);
        const float flat[16] = {20, 0, 0, 0, 0, 20, 0, 0, 0, 0, 20, 0, 0, y, -2, 1};
        std::copy(std::begin(flat), std::end(flat), made.transform);
        return add(made);
    }
    void fire() {
        EXPECT_EQ(FW_OK, fwWorld_CreateFireEmitter(world, &jetDef, &jet)) << lastMessage(world);
    }
    FwFireEmitterState jetState() { return getState(fwWorld_GetFireEmitterState, world, jet); }
    // States and heat of every object.
    std::vector<uint64_t> burnMaps() {
        std::vector<uint64_t> all;
        for (const FwBurnableMeshId id : ids) all.push_back(HostedWorld::hash(id));
        return all;
    }
    FwFireEmitterDef jetDef{};
    FwFireEmitterId jet{};
    bool heat;
};

// "Flamethrowers go through walls" (RMC-14#5776, #6308).
TEST(Jet, AClosedWallBurnsAndProtectsTheRoomBehind) {
    for (const bool heat : {false, true}) {
        Range r(heat);
        r.wall(3);
        r.wall(4.5f);
        r.fire();
        r.run(4);
        EXPECT_LT(0u, r.lit(0)) << heat;
        EXPECT_EQ(0u, r.lit(1)) << heat;
        EXPECT_EQ(16u, r.jetState().blockedRays);
        EXPECT_NEAR(3, r.jetState().clearDistance, 0.1f);
        EXPECT_NEAR(700000, r.jetState().heated, 1);  // W, 0.35 of 2 MW
    }
}

// "It stops at the tile before the wall, the wall never burns" (RMC-14 fix #7016).
TEST(Jet, AWallThatStopsTheJetBurns) {
    Range r(true);
    r.wall(5);
    r.fire();
    r.run(3);
    EXPECT_EQ(1u, r.heard(FW_EVENT_IGNITED));
    FwQueryId query{};
    const float there[3] = {5, 1, 0};
    ASSERT_EQ(FW_OK, fwWorld_RequestPoint(r.world, r.ids[0], there, &query));
    const FwPointState point = getState(fwWorld_FetchPoint, r.world, query);
    EXPECT_GT(point.temperature, 600);
}

// Fire must come through a window (ValveSoftware/Source-1-Games#3720, the opposite fault).
TEST(Jet, PassesThroughAHole) {
    Range r;
    r.wall(3, -0.75f);
    r.wall(3, 0.75f);  // 0.5 m apart
    r.wall(5);
    r.fire();
    r.run(4);
    EXPECT_LT(0u, r.lit(2));
    EXPECT_LT(r.jetState().blockedRays, 17u);
}

// A sheet protects the objects behind it until it burns through. A sheet without holes always
// blocks the jet.
TEST(Jet, PassesThroughABurntHole) {
    for (const bool holes : {true, false}) {
        Range r(true);
        FwMaterialDef paper = materialOf(FW_MATERIAL_PAPER);
        ASSERT_EQ(FW_OK, fwWorld_CreateMaterial(r.world, &paper, &r.material));
        FwBurnableMeshDef sheet = r.panel(3, 0);
        if (!holes) sheet.flags |= FW_BURNABLE_NO_HOLES;
        r.add(sheet);
        r.wall(4.5f);
        r.fire();
        double came = 0;
        for (double t = 0; t < 12 && came == 0; t += 0.125) {
            r.run(0.125);
            if (r.lit(1) > 0) came = t;
        }
        if (!holes) {
            EXPECT_EQ(0, came);
            continue;
        }
        // The hole takes as long as its appearance says, from the moment at which the stream lit
        // it.
        FwPointState point{};
        point.structSize = sizeof point;
        FwQueryId query{};
        const float there[3] = {3, 1, 0};
        ASSERT_EQ(FW_OK, fwWorld_RequestPoint(r.world, r.ids[0], there, &query));
        ASSERT_EQ(FW_OK, fwWorld_FetchPoint(r.world, query, &point));
        EXPECT_LT(1, came);
        EXPECT_GT(8, came);
        EXPECT_EQ(0, point.fuel);
        r.run(0.25);
        EXPECT_GT(r.jetState().clearDistance, 4) << "its particles pass as well";
    }
}

// Runs `play` on the cpu and on a device and compares the burn maps.
template <class Play>
void bothBackendsAgree(Play play) {
    const FwContextDef def = fwDefaultContextDef();
    FwContext* device = nullptr;
    FwErrorInfo error{};
    if (fwCreateContext(&def, &device, &error) != FW_OK)
        GTEST_SKIP() << "no Vulkan device: " << error.message;
    std::vector<std::vector<uint64_t>> hashes;
    for (FwContext* given : {static_cast<FwContext*>(nullptr), device}) {
        Range r(true, given);
        play(r);
        hashes.push_back(r.burnMaps());
    }
    EXPECT_EQ(hashes[0], hashes[1]);
}

// Through a hole and under water both backends burn equally bit for bit. The device knows of the
// hole two to three frames before the CPU.
TEST(Jet, BothBackendsAgreeThroughAHole) {
    bothBackendsAgree([](Range& r) {
        FwMaterialDef paper = materialOf(FW_MATERIAL_PAPER);
        ASSERT_EQ(FW_OK, fwWorld_CreateMaterial(r.world, &paper, &r.material));
        r.wall(3);
        r.wall(4.5f);
        r.wall(3, 1.2f);
        FwParticleFieldDef water = fwDefaultParticleFieldDef();
        ASSERT_EQ(FW_OK, fwInitFieldPreset(&water, FW_FIELD_WATER));
        water.flags = FW_FIELD_WETS;
        water.seed = 3;
        water.position[0] = 3;
        water.position[2] = 1.3f;  // on the third wall only
        water.size[0] = water.size[1] = 2;
        (void)created(fwWorld_CreateParticleField, r.world, water);
        r.fire();
        r.run(9, 1.0f / 16);
        if (r.isCpu) {
            EXPECT_LT(0u, r.lit(1)) << "it came through";
        }
    });
}

// Stuck fuel burns on after the jet stops, with its own power. Nothing is lost: the power over all
// eighths of a second sums to the stuck energy.
TEST(Jet, StuckFuelBurnsOnAndIsConserved) {
    Range r(true);
    r.wall(3);
    r.wall(4.5f);
    r.jetDef.stick = 0.25f;
    r.jetDef.stickTime = 5;
    r.jetDef.power = 400;
    r.fire();
    double gave = 0, most = 0;
    const auto exchanges = [&](int count) {
        for (int i = 0; i < count; ++i) {
            r.run(0.125);
            gave += double(r.jetState().stuckPower) / 8;  // kJ
            most = std::max(most, double(r.jetState().stuckPower));
        }
    };
    exchanges(16);
    ASSERT_EQ(FW_OK, fwWorld_SetFireEmitterPower(r.world, r.jet, 0));
    exchanges(15);  // until the last of the stream arrives
    EXPECT_LT(0u, r.jetState().stuckPatches);
    EXPECT_GT(17u, r.jetState().stuckPatches);
    const double left = double(r.jetState().stuckFuel), before = gave;
    EXPECT_LT(10, left);
    EXPECT_GT(35, most);  // kW, the power of the jet
    EXPECT_LT(0, r.jetState().heated) << "the wall is heated";
    exchanges(42);
    EXPECT_NEAR(left, gave - before, 1e-3 * left);
    EXPECT_EQ(0, r.jetState().stuckFuel);
    EXPECT_EQ(0u, r.jetState().stuckPatches);
    EXPECT_EQ(0, r.jetState().heated);
    // A quarter of 0.35 of the fuel that left the nozzle in these two seconds and hit.
    EXPECT_NEAR(0.25 * 0.35 * 400 * 2, gave, 0.08 * gave);
    EXPECT_LT(0u, r.lit(0));
    EXPECT_EQ(0u, r.lit(1)) << "behind";
}

// A short burst does not light a wall; the same burst of sticking fuel does. Water removes as much
// fuel as it can evaporate, FW_EXTINGUISH all of it.
TEST(Jet, StuckFuelLightsAWallAndWaterRemovesIt) {
    const auto litBy = [](float stick, uint32_t kind) {
        Range r(true);
        r.wall(3);
        r.jetDef.power = 250;
        r.jetDef.stick = stick;
        r.jetDef.stickTime = 8;
        r.fire();
        r.run(0.75);
        EXPECT_EQ(FW_OK, fwWorld_SetFireEmitterPower(r.world, r.jet, 0));
        r.run(0.75);
        const float before = r.jetState().stuckFuel;
        if (kind) {
            FwIgnitionDef water = fwDefaultIgnitionDef();
            water.kind = kind;
            water.position[0] = 3;
            water.position[1] = 1;
            water.radius = 1.5f;
            water.water = kind == FW_WET ? 5.0f : 0.0f;
            EXPECT_EQ(FW_OK, fwWorld_Ignite(r.world, &water, nullptr));
            r.run(0.25);
            const float after = r.jetState().stuckFuel;
            EXPECT_LT(after, before - 2);
            if (kind == FW_EXTINGUISH) {
                EXPECT_EQ(0, after);
            }
        }
        r.run(9);
        return r.lit(0) > 0;
    };
    EXPECT_FALSE(litBy(0, 0));
    EXPECT_TRUE(litBy(0.9f, 0));
    EXPECT_FALSE(litBy(0.9f, FW_EXTINGUISH));
    (void)litBy(0.9f, FW_WET);
}

// The water of a field follows from the field, so a played log wets stuck fuel once.
TEST(Jet, APlayedLogWetsStuckFuelAsItWas) {
    constexpr uint64_t kEnd = 3 * 4096;  // ticks
    const auto make = [](Range& r, bool wets) {
        r.wall(3);
        r.jetDef.power = 250;
        r.jetDef.stick = 0.9f;
        r.jetDef.stickTime = 20;
        r.fire();
        FwParticleFieldDef water = fwDefaultParticleFieldDef();
        EXPECT_EQ(FW_OK, fwInitFieldPreset(&water, FW_FIELD_WATER));
        water.flags = wets ? uint32_t(FW_FIELD_WETS) : 0u;
        water.seed = 7;
        water.position[0] = 3;
        water.rotation[1] = water.rotation[3] = 0.70710678f;
        water.size[0] = water.size[1] = 2.2f;
        water.sourceSize = 1;
        water.width = water.height = 32;
        (void)created(fwWorld_CreateParticleField, r.world, water);
    };
    Range dry(true), first(true), again(true);
    make(dry, false), make(first, true), make(again, true);
    ASSERT_EQ(FW_OK, fwWorld_StartCommandLog(first.world));
    dry.run(3), first.run(3);
    EXPECT_LT(first.jetState().stuckFuel, 0.9f * dry.jetState().stuckFuel) << "it gets wet";
    uint64_t size = 0;
    ASSERT_EQ(FW_OK, fwWorld_FetchCommandLog(first.world, nullptr, &size));
    std::vector<std::byte> log(size);
    ASSERT_EQ(FW_OK, fwWorld_FetchCommandLog(first.world, log.data(), &size));
    ASSERT_EQ(FW_OK, fwWorld_OpenCommandLog(again.world, log.data(), log.size()));
    for (float seconds = 1; seconds > 0;) {
        ASSERT_EQ(FW_OK, fwWorld_PlayCommandLog(again.world, kEnd, &seconds));
        ASSERT_EQ(FW_OK, fwWorld_Step(again.world, seconds));
    }
    EXPECT_EQ(first.jetState().stuckFuel, again.jetState().stuckFuel);
    EXPECT_EQ(first.burnMaps(), again.burnMaps());
}

TEST(Jet, BothBackendsAgreeUnderStuckFuel) {
    bothBackendsAgree([](Range& r) {
        r.wall(3);
        r.wall(3, 1.2f);
        r.jetDef.stick = 0.6f;
        r.fire();
        r.run(1, 1.0f / 16);
        EXPECT_EQ(FW_OK, fwWorld_SetFireEmitterPower(r.world, r.jet, 0));
        r.run(4, 1.0f / 16);
        EXPECT_LT(0, r.jetState().stuckFuel);
    });
}

// The joint of two walls does not leak (RMC-14#8951).
TEST(Jet, ACornerDoesNotLeak) {
    Range r;
    r.wall(3, -0.5f);
    r.wall(3, 0.5f);
    r.wall(4.5f);
    r.fire();
    r.run(4);
    EXPECT_LT(0u, r.lit(0));
    EXPECT_LT(0u, r.lit(1));
    EXPECT_EQ(0u, r.lit(2));
    EXPECT_EQ(16u, r.jetState().blockedRays);
}

// "Through walls at an angle" (RMC-14#8951): a floor that the jet grazes protects the room below.
TEST(Jet, AGrazedFloorBurnsAndTheCellarDoesNot) {
    Range r;
    r.floor(0.4f);
    r.floor(0.1f);
    r.jetDef.position[1] = 0.9f;
    r.jetDef.direction[1] = -0.12f;
    r.fire();
    r.run(4);
    EXPECT_LT(0u, r.lit(0));
    EXPECT_EQ(0u, r.lit(1));
}

// "The nozzle touches the wall and fires on the other side" (ppg-bugs-and-requests#1484).
TEST(Jet, ANozzleInsideAWallBurnsThatWall) {
    for (const float nozzle : {2.99f, 3.0f, 3.05f, 3.3f}) {
        Range r;
        r.wall(3);
        r.wall(4.5f);
        r.jetDef.position[0] = nozzle;
        r.fire();
        r.run(4);
        EXPECT_LT(0u, r.lit(0)) << nozzle;
        EXPECT_EQ(0u, r.lit(1)) << nozzle;
        EXPECT_NEAR(0, r.jetState().clearDistance, 0.02f) << nozzle;
    }
    Range through;  // a nozzle on the far side is in another room
    through.wall(3);
    through.wall(4.5f);
    through.jetDef.position[0] = 3.3f;
    through.jetDef.behind = 0;
    through.fire();
    through.run(4);
    EXPECT_EQ(0u, through.lit(0));
    EXPECT_LT(0u, through.lit(1));
}

// "A door beside the path stops the flame" (cmss13#4189).
TEST(Jet, AnOpenDoorBesideThePathDoesNotBlock) {
    Range r;
    FwHeatOccluderDef door = fwDefaultHeatOccluderDef();
    door.halfSize[0] = 0.5f;
    door.halfSize[1] = 1;
    door.halfSize[2] = 0.02f;
    door.transform[12] = 1.5f;
    door.transform[13] = 1;
    door.transform[14] = 0.45f;
    FwHeatOccluderId occluder = created(fwWorld_AddHeatOccluder, r.world, door);
    r.wall(5);
    r.fire();
    r.run(4);
    EXPECT_LT(0u, r.lit(0));
    EXPECT_NEAR(5, r.jetState().clearDistance, 0.1f);
    // A closed door does.
    Range closed;
    door.transform[14] = 0;
    door.halfSize[2] = 0.5f;
    door.halfSize[0] = 0.02f;
    ASSERT_EQ(FW_OK, fwWorld_AddHeatOccluder(closed.world, &door, &occluder));
    closed.wall(5);
    closed.fire();
    closed.run(4);
    EXPECT_EQ(0u, closed.lit(0));
    EXPECT_NEAR(1.48f, closed.jetState().clearDistance, 0.05f);
}

// A metal sheet without thickness, at any stream speed and frame rate.
TEST(Jet, AThinWallStopsAFastStream) {
    for (const float dt : {1.0f / 90, 1.0f / 8}) {
        Range r;
        FwHeatOccluderDef sheet = fwDefaultHeatOccluderDef();
        sheet.halfSize[0] = 0;
        sheet.halfSize[1] = sheet.halfSize[2] = 3;
        sheet.transform[12] = 2;
        (void)created(fwWorld_AddHeatOccluder, r.world, sheet);
        r.wall(2.5f);
        r.jetDef.speed = 120;
        r.fire();
        r.run(4, dt);
        EXPECT_EQ(0u, r.lit(0)) << dt;
        EXPECT_NEAR(2, r.jetState().clearDistance, 0.05f);
    }
}

// "Sets things alight behind doors" (Barotrauma#4146), while its owner walks by.
TEST(Jet, AMovingNozzleBurnsOnlyObjectsOnItsPath) {
    Range r;
    for (const float z : {-3.0f, -2.0f, -1.0f, 0.0f}) r.wall(3, z);
    r.wall(4.5f, -1);
    r.jetDef.position[2] = -3;
    r.fire();
    for (int i = 0; i < 60; ++i) {
        const float place[3] = {0, 1, -3 + 0.04f * float(i)};
        ASSERT_EQ(FW_OK, fwWorld_MoveFireEmitter(r.world, r.jet, place, nullptr));
        r.run(0.1);
    }
    for (size_t i = 0; i < 3; ++i) EXPECT_LT(0u, r.lit(i)) << i;
    EXPECT_EQ(0u, r.lit(4));
}

TEST(Jet, IsDeterministicAndWaterPreventsIgnition) {
    uint64_t hashes[2] = {};
    for (uint64_t& hash : hashes) {
        Range r(true);
        r.wall(3);
        r.wall(3, 1);
        r.fire();
        r.run(2);
        hash = r.hash();
    }
    EXPECT_EQ(hashes[0], hashes[1]);
    const auto secondsTo = [](float water, float power) {
        Range r(true);
        r.wall(3);
        r.jetDef.power = power;
        if (water > 0) {
            FwIgnitionDef wet = fwDefaultIgnitionDef();
            wet.kind = FW_WET;
            wet.position[0] = 3;
            wet.position[1] = 1;
            wet.radius = 3;
            wet.water = water;
            EXPECT_EQ(FW_OK, fwWorld_Ignite(r.world, &wet, nullptr));
        }
        r.fire();
        for (int i = 0; i < 320; ++i) {
            r.run(1.0 / 32);
            if (r.lit(0) > 0) return float(i + 1) / 32;
        }
        return 99.0f;
    };
    const float dry = secondsTo(0, 2000), wet = secondsTo(300, 2000), weak = secondsTo(0, 500);
    EXPECT_LT(dry, 2.0f);
    EXPECT_GT(wet, 2 * dry);
    EXPECT_GT(weak, dry);
}

TEST(Jet, RefusesConflictingFlags) {
    Range r;
    r.wall(3);
    r.jetDef.flags = FW_EMITTER_IGNITES;
    FwFireEmitterId id{};
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_CreateFireEmitter(r.world, &r.jetDef, &id));
    EXPECT_THAT(lastMessage(r.world), HasSubstr("FW_EMITTER_IGNITES goes with FW_EMITTER_JET"));
    r.jetDef.flags = FW_EMITTER_JET;
    r.jetDef.stick = 0.5f;
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_CreateFireEmitter(r.world, &r.jetDef, &id));
    EXPECT_THAT(lastMessage(r.world), HasSubstr("FwFireEmitterDef::stick is 0.5"));
    r.jetDef.stick = 0;
    r.jetDef.flags = FW_EMITTER_JET | FW_EMITTER_NO_COLLISION;
    r.fire();
    r.run(1);
    EXPECT_EQ(0u, r.jetState().blockedRays);
    EXPECT_EQ(0u, r.lit(0));
}

}  // namespace
