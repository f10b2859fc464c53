// Fire from object to object on the cpu backend: each switch alone does what it says, limits hold,
// and neither the frame rate nor the order of anything matters.
#include "abi/abi_support.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <random>

namespace {

using host::lastMessage;

// Sheets of 0.4 x 0.2 m that lie flat, where they are put.
struct Panels {
    explicit Panels(const FwWorldDef& def, float burnTime = 20, float texelsPerMetre = 64)
        : sheet(0.4f, 0.2f) {
        context = host::createCpuContext(host);
        EXPECT_EQ(FW_OK, fwCreateWorld(context, &def, &world)) << lastMessage(context);
        const FwMeshDef meshDef = sheet.def(texelsPerMetre);
        EXPECT_EQ(FW_OK, fwWorld_CreateMesh(world, &meshDef, &mesh)) << lastMessage(world);
        const FwMaterialDef even = host::evenMaterial(0.02f, burnTime);
        EXPECT_EQ(FW_OK, fwWorld_CreateMaterial(world, &even, &material));
    }
    ~Panels() { fwDestroyContext(context); }
    Panels(const Panels&) = delete;
    Panels& operator=(const Panels&) = delete;

    FwBurnableMeshDef def(float x, float y, float z) const {
        FwBurnableMeshDef made = fwDefaultBurnableMeshDef();
        made.mesh = mesh;
        made.materials[0] = material;
        // Without temperatures: fire comes by contact and embers alone.
        made.flags = FW_BURNABLE_LITE | FW_BURNABLE_TWO_SIDED;
        made.transform[12] = x;
        made.transform[13] = y;
        made.transform[14] = z;
        return made;
    }
    FwBurnableMeshId add(const FwBurnableMeshDef& made) {
        FwBurnableMeshId id{};
        EXPECT_EQ(FW_OK, fwWorld_CreateBurnableMesh(world, &made, &id)) << lastMessage(world);
        ids.push_back(id);
        return id;
    }
    FwBurnableMeshId add(float x, float y, float z) { return add(def(x, y, z)); }
    void ignite(FwBurnableMeshId id, float x, float y, float z, float radius = 0.02f) {
        FwIgnitionDef ball = fwDefaultIgnitionDef();
        ball.object = id;
        ball.position[0] = x;
        ball.position[1] = y;
        ball.position[2] = z;
        ball.radius = radius;
        uint32_t texels = 0;
        EXPECT_EQ(FW_OK, fwWorld_Ignite(world, &ball, &texels)) << lastMessage(world);
        EXPECT_LT(0u, texels);
    }
    void run(double seconds, float deltaTime = 1.0f / 32.0f) {
        for (double t = 0; t < seconds - 1e-9; t += double(deltaTime)) {
            ASSERT_EQ(FW_OK, fwWorld_Step(world, deltaTime)) << lastMessage(world);
            std::vector<FwEvent> some(256);
            some.resize(fwWorld_PollEvents(world, some.data(), 256));
            events.insert(events.end(), some.begin(), some.end());
        }
    }
    FwObjectState state(FwBurnableMeshId id) {
        FwObjectState made{};
        made.structSize = sizeof made;
        EXPECT_EQ(FW_OK, fwWorld_GetObjectState(world, id, &made)) << lastMessage(world);
        return made;
    }
    uint32_t lit(size_t i) { return state(ids[i]).ignited; }
    uint32_t alight() {  // objects that ever caught
        uint32_t count = 0;
        for (size_t i = 0; i < ids.size(); ++i) count += lit(i) > 0 ? 1 : 0;
        return count;
    }
    uint64_t hash() {
        uint64_t all = 0;
        for (const FwBurnableMeshId id : ids) {
            EXPECT_EQ(FW_OK, fwDebug_RequestBurnMap(world, id)) << lastMessage(world);
            uint64_t one = 0;
            EXPECT_EQ(FW_OK, fwDebug_FetchBurnMap(world, id, nullptr, 0, nullptr, &one, nullptr))
                << lastMessage(world);
            all = all * 0x9E3779B97F4A7C15ull + one;
        }
        return all;
    }
    size_t heard(uint32_t type) const {
        return size_t(std::count_if(events.begin(), events.end(),
                                    [&](const FwEvent& event) { return event.type == type; }));
    }
    const FwEvent* event(uint32_t type) const {
        for (const FwEvent& one : events)
            if (one.type == type) return &one;
        return nullptr;
    }

    host::Host host;
    host::Sheet sheet;
    FwContext* context = nullptr;
    FwWorld* world = nullptr;
    FwMeshId mesh{};
    FwMaterialId material{};
    std::vector<FwBurnableMeshId> ids;
    std::vector<FwEvent> events;
};

FwWorldDef worldDef(uint32_t flags) {
    FwWorldDef def = fwDefaultWorldDef();
    def.flags = flags;
    def.maxStepsPerFrame = 64;
    return def;
}

// A row of panels, a centimetre between them, lit at its start.
void makeRow(Panels& p, int count) {
    for (int i = 0; i < count; ++i) p.add(float(i) * 0.41f, 0, 0);
    p.ignite(p.ids[0], 0.01f, 0, 0.1f);
}

TEST(AbiSpread, ContactIsTheOnlyWayAcrossAGap) {
    for (const uint32_t flags :
         {0u, uint32_t(FW_WORLD_RADIATION), uint32_t(FW_WORLD_PLUME), uint32_t(FW_WORLD_CONTACT)}) {
        Panels p(worldDef(flags));
        makeRow(p, 3);
        p.run(24);
        EXPECT_EQ(flags == FW_WORLD_CONTACT ? 2u : 1u, p.alight()) << flags;
        if (flags != FW_WORLD_CONTACT) continue;
        // 0.39 m at 0.02 m/s, then a centimetre as an ordinary link and at 0.05 m/s.
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

TEST(AbiSpread, AGapThatIsTooWideIsNotCrossed) {
    Panels p(worldDef(FW_WORLD_CONTACT));
    p.add(0, 0, 0);
    p.add(0.46f, 0, 0);
    p.ignite(p.ids[0], 0.39f, 0, 0.1f);
    p.run(20);
    EXPECT_EQ(1u, p.alight());
    // Moved near, it catches: a contact begins when they meet.
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

TEST(AbiSpread, FlagsChangeWhileItRuns) {
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

TEST(AbiSpread, ChanceHopsAndNoSpreadHold) {
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

    // Half of many pairs, and another half under another seed.
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

TEST(AbiSpread, TimeToLiveStopsAFront) {
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
    // Of one object, while another goes on.
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

TEST(AbiSpread, BurningTilesAreCapped) {
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
            FwWorldStats stats{};
            stats.structSize = sizeof stats;
            ASSERT_EQ(FW_OK, fwWorld_GetStats(p.world, &stats));
            most = std::max(most, stats.burningTiles);
            // Once full, no more until some went out.
            if (before >= 2) {
                EXPECT_LE(stats.burningTiles, before);
                reached = true;
            }
            before = stats.burningTiles;
            if (i == 8 * 32) soon = p.lit(0);
        }
        EXPECT_TRUE(reached);
        EXPECT_GE(most, 2u);
        EXPECT_LE(most, 4u);  // a substep's arrivals more
        Panels free(worldDef(0), 8.0f);
        free.add(0, 0, 0);
        free.ignite(free.ids[0], 0.06f, 0, 0.06f, 0.01f);
        free.run(8);
        EXPECT_GT(free.lit(0), soon + 30);
    }
}

// A fierce fire of 0.4 x 0.2 m at the origin, and a sheet of paper, which has a temperature.
struct Hearth : Panels {
    explicit Hearth(const FwWorldDef& def) : Panels(def, 600.0f) {
        FwMaterialDef hot = host::evenMaterial(0.0005f, 600.0f);
        hot.heatOfCombustion = 4e7f;
        hot.burningFlux = 0.1f;
        EXPECT_EQ(FW_OK, fwWorld_CreateMaterial(world, &hot, &material));
        add(0, 0, 0);
        FwMaterialDef paper = fwDefaultMaterialDef();
        EXPECT_EQ(FW_OK, fwInitMaterialPreset(&paper, FW_MATERIAL_PAPER));
        EXPECT_EQ(FW_OK, fwWorld_CreateMaterial(world, &paper, &material));
    }
    FwBurnableMeshDef paper(float x, float y, float z, bool upright) const {
        FwBurnableMeshDef made = def(x, y, z);
        made.flags = FW_BURNABLE_TWO_SIDED;
        if (upright) {  // its x goes up, its normal along the world's x
            made.transform[0] = 0;
            made.transform[1] = 1;
            made.transform[4] = -1;
            made.transform[5] = 0;
        }
        return made;
    }
    void light() {
        for (float x = 0.02f; x < 0.4f; x += 0.06f)
            for (float z = 0.02f; z < 0.2f; z += 0.06f) ignite(ids[0], x, 0, z, 0.04f);
    }
};

TEST(AbiSpread, RadiationLightsWhatItShinesOn) {
    const auto caught = [](uint32_t flags, float x, const FwBlockerDef* wall, double seconds) {
        Hearth p(worldDef(flags));
        p.add(p.paper(x, 0, 0, true));
        FwBlockerId id{};
        if (wall) {
            EXPECT_EQ(FW_OK, fwWorld_AddBlocker(p.world, wall, &id)) << lastMessage(p.world);
        }
        p.light();
        p.run(seconds);
        const FwEvent* spread = p.event(FW_EVENT_SPREAD_TO);
        EXPECT_EQ(p.lit(1) > 0, spread != nullptr);
        if (spread) {
            EXPECT_EQ(p.ids[0].index1, spread->other.index1);
            EXPECT_EQ(1u, spread->tag);
        }
        return p.lit(1) > 0;
    };
    EXPECT_TRUE(caught(FW_WORLD_RADIATION, 0.5f, nullptr, 20));
    EXPECT_FALSE(caught(0, 0.5f, nullptr, 20));
    EXPECT_FALSE(caught(FW_WORLD_PLUME | FW_WORLD_CONTACT, 0.5f, nullptr, 20));
    EXPECT_FALSE(caught(FW_WORLD_RADIATION, 4.0f, nullptr, 60));
    FwBlockerDef wall = fwDefaultBlockerDef();
    wall.transform[12] = 0.45f;
    wall.halfSize[0] = 0.02f;
    wall.halfSize[1] = wall.halfSize[2] = 5;
    EXPECT_FALSE(caught(FW_WORLD_RADIATION, 0.5f, &wall, 20));
    wall.transform[12] = 2;  // behind it
    EXPECT_TRUE(caught(FW_WORLD_RADIATION, 0.5f, &wall, 20));
}

// Two boards of 0.4 x 0.2 m, upright, face to face 10 cm apart: the first burns all over, fiercely.
struct TwoBoards : Panels {
    static constexpr double kPower = 4e6, kGap = 0.1;  // W/m^2, m
    TwoBoards(const FwWorldDef& def, const FwMaterialDef& receiver) : Panels(def, 600.0f, 256) {
        FwMaterialDef hot = host::evenMaterial(0.0005f, 600.0f);
        hot.heatOfCombustion = 4e7f;
        hot.burningFlux = float(kPower) / hot.heatOfCombustion;
        EXPECT_EQ(FW_OK, fwWorld_CreateMaterial(world, &hot, &material));
        add(upright(0));
        EXPECT_EQ(FW_OK, fwWorld_CreateMaterial(world, &receiver, &material));
        FwBurnableMeshDef second = upright(float(kGap));
        second.flags = FW_BURNABLE_TWO_SIDED;
        add(second);
    }
    FwBurnableMeshDef upright(float x) const {  // its x goes up, its normal along the world's x
        FwBurnableMeshDef made = def(x, 0, 0);
        made.transform[0] = made.transform[5] = 0;
        made.transform[1] = 1;
        made.transform[4] = -1;
        return made;
    }
    void light() {
        for (float y = 0.02f; y < 0.4f; y += 0.06f)
            for (float z = 0.02f; z < 0.2f; z += 0.06f) ignite(ids[0], 0, y, z, 0.04f);
    }
    // s until the second caught; 0: it did not.
    double caught(double seconds) {
        light();
        run(seconds);
        const FwEvent* spread = event(FW_EVENT_SPREAD_TO);
        return spread ? double(spread->value) : 0.0;
    }
    // W/m^2 on the second board, where it is most: flames of its two halves as rows of four points.
    static double formula() {
        constexpr double kPi = 3.14159265358979;
        const double watts = kPower * 0.04, diameter = std::sqrt(4 * 0.04 / kPi);
        const double height = 0.235 * std::pow(watts / 1000, 0.4) - 1.02 * diameter;
        double most = 0;
        for (double y = 0.06; y < 0.35; y += 0.02) {
            double flux = 0;
            for (const double half : {0.1, 0.3})
                for (int i = 0; i < 4; ++i) {
                    const double up = half + height * (2 * i + 1) / 8 - y, beside = 0.04;
                    const double length = std::sqrt(kGap * kGap + up * up + beside * beside);
                    const double d = std::max(length, 0.15);
                    flux += 0.33 * watts / 4 * (kGap / length) / (4 * kPi * d * d);
                }
            most = std::max(most, flux);
        }
        return most;
    }
};

FwMaterialDef receiverOf(float thickness, bool thick) {
    FwMaterialDef def = host::evenMaterial(0.001f, thick ? 0.0f : 60.0f);
    def.thickness = thickness;
    def.density = 1300;
    def.specificHeat = 2000;
    def.conductivity = 0.85f;
    def.ignitionTemperature = 450;  // so low that losses are small beside what comes in
    def.autoIgnitionTemperature = 800;
    return def;
}

TEST(AbiSpread, S7_6_TwoBoardsTenCentimetresApart) {
    const double flux = 0.9 * TwoBoards::formula();  // absorbed
    for (const bool thick : {false, true}) {
        const FwMaterialDef def = receiverOf(thick ? 0.05f : 0.0019f, thick);
        const double rise = double(def.ignitionTemperature) - 293;
        const double volumetric = double(def.density) * double(def.specificHeat);
        const double expected = thick ? 3.14159265 / 4 * double(def.conductivity) * volumetric *
                                            (rise / flux) * (rise / flux)
                                      : volumetric * double(def.thickness) * rise / flux;
        TwoBoards p(worldDef(FW_WORLD_RADIATION), def);
        const double caught = p.caught(expected * 2 + 10);
        std::printf("two boards, %s: %.0f W/m^2, caught after %.2f s, formula %.2f s (%+.0f %%)\n",
                    thick ? "thick" : "thin", flux, caught, expected,
                    (caught / expected - 1) * 100);
        EXPECT_NEAR(expected, caught, expected * 0.25);
    }
}

TEST(AbiSpread, S7_6_TwoBoardsAndAWallBetween) {
    FwBlockerDef wall = fwDefaultBlockerDef();
    wall.transform[12] = 0.05f;
    wall.halfSize[0] = 0.01f;
    wall.halfSize[1] = wall.halfSize[2] = 5;
    for (const bool walled : {false, true}) {
        TwoBoards p(
            worldDef(FW_WORLD_RADIATION | FW_WORLD_PLUME | FW_WORLD_CONTACT | FW_WORLD_EMBERS),
            receiverOf(0.0018f, false));
        FwBlockerId id{};
        if (walled) {
            ASSERT_EQ(FW_OK, fwWorld_AddBlocker(p.world, &wall, &id)) << lastMessage(p.world);
        }
        const double caught = p.caught(120);
        std::printf("two boards, %s: %u texels lit\n", walled ? "a wall between" : "no wall",
                    p.lit(1));
        EXPECT_EQ(walled, caught == 0.0);
        EXPECT_EQ(walled, p.lit(1) == 0);
        EXPECT_LT(0u, p.lit(0));
    }
}

TEST(AbiSpread, APlumeLightsWhatIsAbove) {
    for (const uint32_t flags : {uint32_t(FW_WORLD_PLUME), uint32_t(FW_WORLD_CONTACT)}) {
        for (const float height : {1.0f, -1.0f}) {
            Hearth p(worldDef(flags));
            p.add(p.paper(0, height, 0, false));
            p.light();
            p.run(20);
            EXPECT_EQ(flags == FW_WORLD_PLUME && height > 0, p.lit(1) > 0) << height;
        }
    }
}

TEST(AbiSpread, TheHostSaysWhatIsSeen) {
    for (const float seen : {0.0f, 1.0f}) {
        FwWorldDef def = worldDef(FW_WORLD_RADIATION);
        float part = seen;
        def.visibilityData = &part;
        def.visibility = [](void* data, FwBurnableMeshId from, FwBurnableMeshId to) {
            EXPECT_NE(from.index1, to.index1);
            return *static_cast<const float*>(data);
        };
        Hearth p(def);
        p.add(p.paper(0.5f, 0, 0, true));
        p.light();
        p.run(20);
        EXPECT_EQ(seen > 0, p.lit(1) > 0);
    }
}

TEST(AbiSpread, WhatWasReceivedIsTakenBackWithTheFlag) {
    // Switched off before it is hot enough, it cools and never catches.
    for (const bool off : {false, true}) {
        Hearth p(worldDef(FW_WORLD_RADIATION));
        p.add(p.paper(0.5f, 0, 0, true));
        p.light();
        p.run(0.5);
        ASSERT_EQ(0u, p.lit(1));
        if (off) {
            ASSERT_EQ(FW_OK, fwWorld_SetFlags(p.world, 0));
        }
        p.run(60);
        EXPECT_EQ(off, p.lit(1) == 0);
    }
}

// A strong fire upwind of what an ember may light.
void makeEmbers(Panels& p) {
    p.add(0, 0, 0);
    for (int i = 0; i < 12; ++i)
        for (int k = -2; k < 3; ++k) p.add(1.0f + 0.42f * float(i), -0.5f, float(k) * 0.22f);
    for (float x = 0.02f; x < 0.4f; x += 0.06f)
        for (float z = 0.02f; z < 0.2f; z += 0.06f) p.ignite(p.ids[0], x, 0, z, 0.04f);
}

TEST(AbiSpread, EmbersLightWhatLiesDownwind) {
    FwWorldDef def = worldDef(FW_WORLD_EMBERS);
    def.paceFactor = 30;
    def.wind[0] = 3;
    const auto burns = [](Panels& p) {
        makeEmbers(p);
        p.run(20);
        return p.alight() - 1;
    };
    const auto fierce = [&](const FwWorldDef& world) {
        auto made = std::make_unique<Panels>(world, 600.0f);
        FwMaterialDef hot = host::evenMaterial(0.0005f, 600.0f);
        hot.heatOfCombustion = 4e7f;
        hot.burningFlux = 0.1f;
        EXPECT_EQ(FW_OK, fwWorld_CreateMaterial(made->world, &hot, &made->material));
        return made;
    };
    auto with = fierce(def);
    const uint32_t spots = burns(*with);
    EXPECT_GT(spots, 2u);
    EXPECT_EQ(spots, with->heard(FW_EVENT_SPREAD_TO));
    EXPECT_GE(with->heard(FW_EVENT_SPOT_FIRE), size_t(spots));
    const FwEvent* spot = with->event(FW_EVENT_SPOT_FIRE);
    ASSERT_NE(nullptr, spot);
    EXPECT_GT(spot->position[0], 0.9f);
    EXPECT_NEAR(-0.5f, spot->position[1], 0.01f);

    FwWorldDef upwind = def;
    upwind.wind[0] = -3;
    EXPECT_GT(spots, burns(*fierce(upwind)));
    FwWorldDef none = def;
    none.flags = FW_WORLD_CONTACT | FW_WORLD_RADIATION | FW_WORLD_PLUME;
    EXPECT_EQ(0u, burns(*fierce(none)));
    FwWorldDef never = def;
    never.spreadChance = 0;
    EXPECT_EQ(0u, burns(*fierce(never)));

    // A wall right behind the fire stops them all.
    auto walled = fierce(def);
    FwBlockerDef wall = fwDefaultBlockerDef();
    wall.transform[12] = 0.7f;
    wall.halfSize[0] = 0.05f;
    wall.halfSize[1] = wall.halfSize[2] = 30;
    FwBlockerId id{};
    ASSERT_EQ(FW_OK, fwWorld_AddBlocker(walled->world, &wall, &id)) << lastMessage(walled->world);
    EXPECT_EQ(0u, burns(*walled));
    ASSERT_EQ(FW_OK, fwWorld_RemoveBlocker(walled->world, id));
    walled->run(20);
    EXPECT_GT(walled->alight(), 1u);
}

TEST(AbiSpread, BlockersAreCheckedAndCounted) {
    Panels p(worldDef(0));
    FwBlockerDef def = fwDefaultBlockerDef();
    EXPECT_EQ(0.5f, def.halfSize[1]);
    FwBlockerId id{};
    def.halfSize[2] = 31;
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_AddBlocker(p.world, &def, &id));
    EXPECT_EQ(
        "FwBlockerDef::halfSize[2] is 31; the limits are [0, 30].\n"
        " - While calling fwWorld_AddBlocker.",
        lastMessage(p.world));
    EXPECT_EQ(0u, id.index1);
    def.halfSize[2] = 0;
    std::vector<FwBlockerId> all;
    for (int i = 0; i < 64; ++i) {
        ASSERT_EQ(FW_OK, fwWorld_AddBlocker(p.world, &def, &id));
        all.push_back(id);
    }
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_AddBlocker(p.world, &def, &id));
    EXPECT_EQ(FW_OK, fwWorld_RemoveBlocker(p.world, all[3]));
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_RemoveBlocker(p.world, all[3]));
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_MoveBlocker(p.world, all[3], def.transform));
    def.transform[0] = NAN;
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_MoveBlocker(p.world, all[4], def.transform));
    FwWorldDef wrong = worldDef(0);
    wrong.spreadChance = 1.5f;
    FwWorld* none = nullptr;
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwCreateWorld(p.context, &wrong, &none));
    FwBurnableMeshDef object = p.def(0, 0, 0);
    object.timeToLive = -1;
    FwBurnableMeshId made{};
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_CreateBurnableMesh(p.world, &object, &made));
}

// The same inputs at the same ticks, however time is cut into frames and lists are shuffled.
uint64_t mixedStory(float deltaTime, uint32_t switches) {
    FwWorldDef def = worldDef(FW_WORLD_CONTACT | FW_WORLD_EMBERS);
    def.paceFactor = 10;
    def.wind[0] = 2;
    def.maxBurningTiles = 60;
    Panels p(def, 30.0f);
    EXPECT_EQ(FW_OK, fwDebug_SetSwitches(p.world, switches));
    std::mt19937 random(4);
    for (int i = 0; i < 30; ++i)
        p.add(float(random() % 300) / 100, float(random() % 5) * 0.03f,
              float(random() % 100) / 100);
    const FwBurnableMeshDef first = p.def(0, 0, 0);
    EXPECT_EQ(FW_OK, fwWorld_SetTransform(p.world, p.ids[0], first.transform));
    p.ignite(p.ids[0], 0.2f, 0, 0.1f);
    for (int turn = 0; turn < 40; ++turn) {  // a second each
        const FwBurnableMeshDef there =
            p.def(float(random() % 300) / 100, 0.02f, float(random() % 100) / 100);
        EXPECT_EQ(FW_OK, fwWorld_SetTransform(p.world, p.ids[1 + random() % 29], there.transform));
        const float wind[3] = {float(random() % 5), 0, 1};
        EXPECT_EQ(FW_OK, fwWorld_SetWind(p.world, wind));
        p.run(1, deltaTime);
    }
    EXPECT_GT(p.alight(), 4u);
    return p.hash();
}

TEST(AbiSpread, FrameRateAndOrderDoNotMatter) {
    const uint64_t hash = mixedStory(1.0f / 32, 0);
    EXPECT_EQ(hash, mixedStory(0.25f, 0));
    EXPECT_EQ(hash, mixedStory(1.0f / 64, 0));
    EXPECT_EQ(hash, mixedStory(1.0f, FW_DEBUG_SHUFFLE));
    EXPECT_EQ(hash, mixedStory(1.0f / 32, FW_DEBUG_NEVER_IDLE));
}

}  // namespace
