// Fire from object to object on the cpu backend: contacts and the limits of spread hold,
// independent of frame rate and processing order.
#include "abi/panels.h"

#include <algorithm>
#include <random>

namespace {

using namespace host;

// A row of panels one centimetre apart, lit at its start.
void makeRow(Panels& p, int count) {
    for (int i = 0; i < count; ++i) p.add(float(i) * 0.41f, 0, 0);
    p.ignite(p.ids[0], 0.01f, 0, 0.1f);
}

TEST(Spread, ContactAloneCrossesAGap) {
    for (const uint32_t flags :
         {0u, uint32_t(FW_WORLD_RADIATION), uint32_t(FW_WORLD_PLUME), uint32_t(FW_WORLD_CONTACT)}) {
        Panels p(worldDef(flags));
        makeRow(p, 3);
        p.run(24);
        EXPECT_EQ(flags == FW_WORLD_CONTACT ? 2u : 1u, p.alight()) << flags;
        if (flags != FW_WORLD_CONTACT) continue;
        // 0.39 m at 0.02 m/s, then one centimetre as an ordinary link and at 0.05 m/s.
        const FwEvent* spread = p.event(FW_EVENT_SPREAD_TO);
        ASSERT_NE(nullptr, spread);
        EXPECT_NEAR(0.39 / 0.02 + 0.01 / 0.02 + 0.01 / 0.05, double(spread->value), 1.0);
        EXPECT_EQ(p.ids[1].index1, spread->object.index1);
        EXPECT_EQ(p.ids[0].index1, spread->other.index1);
        EXPECT_EQ(p.ids[0].generation, spread->other.generation);
        EXPECT_EQ(1u, spread->tag);
        EXPECT_NEAR(0.61f, spread->position[0], 0.02f);
        p.run(24);
        EXPECT_EQ(3u, p.alight());
        EXPECT_EQ(2u, p.heard(FW_EVENT_SPREAD_TO));
        EXPECT_EQ(3u, p.heard(FW_EVENT_IGNITED));
    }
}

// Two sheets of one mesh side by side.
FwMeshId makePair(Panels& p, float gap) {
    Sheet both(0.4f, 0.2f);
    const Sheet one = both;
    for (size_t i = 0; i < one.positions.size() / 3; ++i) {
        both.positions.insert(both.positions.end(),
                              {one.positions[3 * i] + 0.4f + gap, one.positions[3 * i + 1],
                               one.positions[3 * i + 2]});
        both.uvs.insert(both.uvs.end(), {one.uvs[2 * i], one.uvs[2 * i + 1] + 1});
    }
    for (const uint32_t index : one.indices) both.indices.push_back(index + 4);
    return created(fwWorld_CreateMesh, p.world, both.def(64));
}

// s until fire arrives; < 0 if it never does.
double arrivalAt(Panels& p, float x) {
    const float point[3] = {x, 0, 0.1f};
    FwQueryId query{};
    EXPECT_EQ(FW_OK, fwWorld_RequestArrival(p.world, p.ids[0], point, &query));
    FwArrivalState state{};
    state.structSize = sizeof state;
    for (int i = 0; i < 200; ++i) {
        if (fwWorld_FetchArrival(p.world, query, &state) == FW_OK) break;
        EXPECT_EQ(FW_OK, fwWorld_Step(p.world, 0));
    }
    return state.kind == FW_ARRIVAL_NEVER ? -1 : double(state.seconds);
}

TEST(Spread, PartsOfOneMeshLightEachOtherByContact) {
    for (const uint32_t flags : {0u, uint32_t(FW_WORLD_CONTACT)})
        for (const float gap : {0.002f, 0.01f, 0.06f}) {
            // NO_SPREAD concerns other objects only; with TTL 1 every jump must succeed.
            FwWorldDef world = worldDef(flags);
            world.spreadChance = 0;
            Panels p(world);
            FwBurnableMeshDef def = p.def(0, 0, 0);
            def.mesh = makePair(p, gap);
            def.flags |= FW_BURNABLE_NO_SPREAD;
            p.add(def);
            p.ignite(p.ids[0], 0, 0, 0.1f);
            p.run(1);
            const bool crosses = flags != 0 && gap < 0.05f;
            const double arrival = arrivalAt(p, 0.6f);
            const uint32_t all = p.state(p.ids[0]).texels;
            p.run(16);
            EXPECT_GT(all / 2, p.lit(0));
            p.run(24);
            EXPECT_NEAR(crosses ? all : all / 2, p.lit(0), crosses ? 0 : all / 40) << flags << gap;
            EXPECT_EQ(0u, p.heard(FW_EVENT_SPREAD_TO));
            if (!crosses) {
                EXPECT_GT(0, arrival);
                continue;
            }
            // Expected: the distance less a texel, plus an eighth of a second at the gap.
            EXPECT_NEAR((0.6 + double(gap)) / 0.02 - 1, arrival, 1.2) << gap;
            EXPECT_NEAR(arrival - 40, arrivalAt(p, 0.6f), 0.04) << gap;
        }
}

TEST(Spread, DoesNotCrossAWideGap) {
    Panels p(worldDef(FW_WORLD_CONTACT));
    p.add(0, 0, 0);
    p.add(0.46f, 0, 0);
    p.ignite(p.ids[0], 0.39f, 0, 0.1f);
    p.run(20);
    EXPECT_EQ(1u, p.alight());
    // A contact begins when the objects meet.
    Panels q(worldDef(FW_WORLD_CONTACT));
    q.add(0, 0, 0);
    q.add(0.9f, 0, 0);
    q.ignite(q.ids[0], 0.39f, 0, 0.1f);
    q.run(5);
    EXPECT_EQ(1u, q.alight());
    FwBurnableMeshDef near = q.def(0.42f, 0, 0);
    ASSERT_EQ(FW_OK, fwWorld_SetTransform(q.world, q.ids[1], near.transform));
    q.run(0.9);
    EXPECT_EQ(1u, q.alight());
    q.run(2);
    EXPECT_EQ(2u, q.alight());
}

TEST(Spread, FlagsMayChangeWhileRunning) {
    Panels p(worldDef(0));
    makeRow(p, 2);
    p.run(22);
    EXPECT_EQ(1u, p.alight());
    ASSERT_EQ(FW_OK, fwWorld_SetFlags(p.world, FW_WORLD_CONTACT));
    p.run(3);
    EXPECT_EQ(2u, p.alight());
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_SetFlags(p.world, 128));
    EXPECT_EQ("flags is 0x80; the known flags are 0x7f.\n - While calling fwWorld_SetFlags.",
              lastMessage(p.world));
}

TEST(Spread, RespectsProbabilityHopsAndNoSpread) {
    FwWorldDef never = worldDef(FW_WORLD_CONTACT);
    never.spreadChance = 0;
    Panels p(never);
    makeRow(p, 2);
    p.run(30);
    EXPECT_EQ(1u, p.alight());

    for (const uint32_t hops : {1u, 2u}) {
        FwWorldDef def = worldDef(FW_WORLD_CONTACT);
        def.maxHops = hops;
        Panels q(def);
        makeRow(q, 4);
        q.run(90);
        EXPECT_EQ(hops + 1, q.alight());
    }
    Panels q(worldDef(FW_WORLD_CONTACT));
    q.add(0, 0, 0);
    FwBurnableMeshDef stingy = q.def(0.41f, 0, 0);
    stingy.flags |= FW_BURNABLE_NO_SPREAD;
    q.add(stingy);
    q.add(0.82f, 0, 0);
    q.ignite(q.ids[0], 0.3f, 0, 0.1f);
    q.run(60);
    EXPECT_EQ(2u, q.alight());

    // About half of many pairs, and another half with another seed.
    uint32_t both[2] = {};
    uint64_t which[2] = {};
    for (uint32_t seed = 0; seed < 2; ++seed) {
        FwWorldDef half = worldDef(FW_WORLD_CONTACT);
        half.spreadChance = 0.5f;
        half.seed = seed + 1;
        Panels r(half);
        for (int i = 0; i < 40; ++i) {
            r.add(0, float(i), 0);
            r.add(0.41f, float(i), 0);
        }
        for (int i = 0; i < 40; ++i) r.ignite(r.ids[size_t(i) * 2], 0.38f, float(i), 0.1f);
        r.run(6);
        for (size_t i = 0; i < 40; ++i) {
            const bool caught = r.lit(i * 2 + 1) > 0;
            both[seed] += caught ? 1 : 0;
            which[seed] |= uint64_t(caught) << i;
        }
        EXPECT_LT(10u, both[seed]);
        EXPECT_GT(30u, both[seed]);
    }
    EXPECT_NE(which[0], which[1]);
}

TEST(Spread, TimeToLiveStopsAFront) {
    FwWorldDef def = worldDef(0);
    def.timeToLive = 3;
    Panels p(def);
    makeRow(p, 1);
    p.run(3.5);
    const uint32_t then = p.lit(0);
    EXPECT_LT(5u, then);
    p.run(10);
    EXPECT_EQ(then, p.lit(0));
    // 3 s at 0.02 m/s: half a disc of 6 cm and the ball.
    EXPECT_NEAR(0.5 * 3.14159 * 0.08 * 0.08 * 64 * 64, then, 25);
    // The limit is per object; another object burns on.
    Panels q(worldDef(0));
    FwBurnableMeshDef brief = q.def(0, 0, 0);
    brief.timeToLive = 2;
    q.add(brief);
    q.add(0, 1, 0);
    q.ignite(q.ids[0], 0.2f, 0, 0.1f);
    q.ignite(q.ids[1], 0.2f, 1, 0.1f);
    q.run(8);
    EXPECT_LT(q.lit(0) * 2, q.lit(1));
}

TEST(Spread, BurningTilesAreCapped) {
    for (const bool ofWorld : {true, false}) {
        FwWorldDef def = worldDef(0);
        if (ofWorld) def.maxBurningTiles = 2;
        Panels p(def, 8.0f);
        FwBurnableMeshDef one = p.def(0, 0, 0);
        if (!ofWorld) one.maxBurningTiles = 2;
        p.add(one);
        p.ignite(p.ids[0], 0.06f, 0, 0.06f, 0.01f);
        uint32_t most = 0;
        bool reached = false;
        uint32_t before = 0, soon = 0;
        for (int i = 0; i < 40 * 32; ++i) {
            p.run(1.0 / 32);
            const FwWorldStats stats = getState(fwWorld_GetStats, p.world);
            most = std::max(most, stats.burningTiles);
            // Once the cap is reached, no tile is added until some went out.
            if (before >= 2) {
                EXPECT_LE(stats.burningTiles, before);
                reached = true;
            }
            before = stats.burningTiles;
            if (i == 8 * 32) soon = p.lit(0);
        }
        EXPECT_TRUE(reached);
        EXPECT_EQ(most, 2u);
        Panels free(worldDef(0), 8.0f);
        free.add(0, 0, 0);
        free.ignite(free.ids[0], 0.06f, 0, 0.06f, 0.01f);
        free.run(8);
        EXPECT_GT(free.lit(0), soon + 30);
    }
}

TEST(Spread, ValidatesAndCountsOccluders) {
    Panels p(worldDef(0));
    FwHeatOccluderDef def = fwDefaultHeatOccluderDef();
    EXPECT_EQ(0.5f, def.halfSize[1]);
    FwHeatOccluderId id{};
    def.halfSize[2] = 31;
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_AddHeatOccluder(p.world, &def, &id));
    EXPECT_EQ(
        "FwHeatOccluderDef::halfSize[2] is 31; the limits are [0, 30].\n"
        " - While calling fwWorld_AddHeatOccluder.",
        lastMessage(p.world));
    EXPECT_EQ(0u, id.index1);
    def.halfSize[2] = 0;
    std::vector<FwHeatOccluderId> all;
    for (int i = 0; i < 64; ++i) {
        ASSERT_EQ(FW_OK, fwWorld_AddHeatOccluder(p.world, &def, &id));
        all.push_back(id);
    }
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_AddHeatOccluder(p.world, &def, &id));
    EXPECT_EQ(FW_OK, fwWorld_RemoveHeatOccluder(p.world, all[3]));
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_RemoveHeatOccluder(p.world, all[3]));
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_MoveHeatOccluder(p.world, all[3], def.transform));
    def.transform[0] = NAN;
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_MoveHeatOccluder(p.world, all[4], def.transform));
    FwWorldDef wrong = worldDef(0);
    wrong.spreadChance = 1.5f;
    FwWorld* none = nullptr;
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwCreateWorld(p.context, &wrong, &none));
    FwBurnableMeshDef object = p.def(0, 0, 0);
    object.timeToLive = -1;
    FwBurnableMeshId made{};
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_CreateBurnableMesh(p.world, &object, &made));
}

// The same commands at the same ticks, however time is split into frames and lists are shuffled.
uint64_t mixedSession(float deltaTime, uint32_t switches) {
    FwWorldDef def = worldDef(FW_WORLD_CONTACT | FW_WORLD_EMBERS);
    def.paceFactor = 10;
    def.wind[0] = 2;
    def.maxBurningTiles = 60;
    Panels p(def, 30.0f);
    EXPECT_EQ(FW_OK, fwDebug_SetSwitches(p.world, switches));
    std::mt19937 random(4);
    // One draw a statement: compilers order the arguments of a call differently.
    const auto draw = [&random](uint32_t below) { return float(random() % below); };
    for (int i = 0; i < 30; ++i) {
        const float z = draw(100) / 100;
        const float y = draw(5) * 0.03f;
        const float x = draw(300) / 100;
        p.add(x, y, z);
    }
    const FwBurnableMeshDef first = p.def(0, 0, 0);
    EXPECT_EQ(FW_OK, fwWorld_SetTransform(p.world, p.ids[0], first.transform));
    p.ignite(p.ids[0], 0.2f, 0, 0.1f);
    for (int turn = 0; turn < 40; ++turn) {  // one second per turn
        const float z = draw(100) / 100;
        const float x = draw(300) / 100;
        const FwBurnableMeshDef there = p.def(x, 0.02f, z);
        EXPECT_EQ(FW_OK, fwWorld_SetTransform(p.world, p.ids[1 + random() % 29], there.transform));
        const float wind[3] = {draw(5), 0, 1};
        EXPECT_EQ(FW_OK, fwWorld_SetWind(p.world, wind));
        p.run(1, deltaTime);
    }
    EXPECT_GT(p.alight(), 4u);
    return p.hash();
}

TEST(Spread, IsIndependentOfFrameRateAndOrder) {
    const uint64_t hash = mixedSession(1.0f / 32, 0);
    EXPECT_EQ(hash, mixedSession(0.25f, 0));
    EXPECT_EQ(hash, mixedSession(1.0f / 64, 0));
    EXPECT_EQ(hash, mixedSession(1.0f, FW_DEBUG_SHUFFLE));
    EXPECT_EQ(hash, mixedSession(1.0f / 32, FW_DEBUG_NEVER_IDLE));
}

}  // namespace
