// Fire through the air on the cpu backend: radiation, plumes, embers, walls between, and the host's
// sight answers.
#include "abi/panels.h"

#include <algorithm>
#include <cstdio>

namespace {

using namespace host;

// A fierce fire of 0.4 x 0.2 m at the origin, and a sheet of paper, which has a temperature.
struct Hearth : Panels {
    explicit Hearth(const FwWorldDef& def) : Panels(def, 600.0f) {
        FwMaterialDef hot = host::evenMaterial(0.0005f, 600.0f);
        hot.heatOfCombustion = 4e7f;
        hot.burningFlux = 0.1f;
        EXPECT_EQ(FW_OK, fwWorld_CreateMaterial(world, &hot, &material));
        add(0, 0, 0);
        FwMaterialDef paper = materialOf(FW_MATERIAL_PAPER);
        EXPECT_EQ(FW_OK, fwWorld_CreateMaterial(world, &paper, &material));
    }
    FwBurnableMeshDef paper(float x, float y, float z, bool upright) const {
        FwBurnableMeshDef made = def(x, y, z);
        made.flags = FW_BURNABLE_TWO_SIDED;
        if (upright) {  // object x points up, its normal along world x
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

TEST(Spread, RadiationIgnitesExposedObjects) {
    const auto caught = [](uint32_t flags, float x, const FwHeatOccluderDef* wall, double seconds) {
        Hearth p(worldDef(flags));
        p.add(p.paper(x, 0, 0, true));
        FwHeatOccluderId id{};
        if (wall) {
            EXPECT_EQ(FW_OK, fwWorld_AddHeatOccluder(p.world, wall, &id)) << lastMessage(p.world);
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
    FwHeatOccluderDef wall = fwDefaultHeatOccluderDef();
    wall.transform[12] = 0.45f;
    wall.halfSize[0] = 0.02f;
    wall.halfSize[1] = wall.halfSize[2] = 5;
    EXPECT_FALSE(caught(FW_WORLD_RADIATION, 0.5f, &wall, 20));
    wall.transform[12] = 2;  // behind it
    EXPECT_TRUE(caught(FW_WORLD_RADIATION, 0.5f, &wall, 20));
}

// Two upright boards of 0.4 x 0.2 m, face to face 10 cm apart. The first burns fiercely all over.
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
    FwBurnableMeshDef upright(float x) const {  // object x points up, its normal along world x
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
    // s until the second board caught; 0 if it did not.
    double caught(double seconds) {
        light();
        run(seconds);
        const FwEvent* spread = event(FW_EVENT_SPREAD_TO);
        return spread ? double(spread->value) : 0.0;
    }
    // W/m^2 at the most exposed point of the second board; each half's flames are a row of four
    // points.
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
    def.ignitionTemperature = 450;  // K, so low that losses are small against the input
    def.autoIgnitionTemperature = 800;
    return def;
}

TEST(Spread, IgnitionTimeOfFacingBoardsMatchesTheFluxFormula) {
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

TEST(Spread, AWallBetweenBoardsPreventsIgnition) {
    FwHeatOccluderDef wall = fwDefaultHeatOccluderDef();
    wall.transform[12] = 0.05f;
    wall.halfSize[0] = 0.01f;
    wall.halfSize[1] = wall.halfSize[2] = 5;
    for (const bool walled : {false, true}) {
        TwoBoards p(
            worldDef(FW_WORLD_RADIATION | FW_WORLD_PLUME | FW_WORLD_CONTACT | FW_WORLD_EMBERS),
            receiverOf(0.0018f, false));
        FwHeatOccluderId id{};
        if (walled) {
            ASSERT_EQ(FW_OK, fwWorld_AddHeatOccluder(p.world, &wall, &id)) << lastMessage(p.world);
        }
        const double caught = p.caught(120);
        std::printf("two boards, %s: %u texels lit\n", walled ? "a wall between" : "no wall",
                    p.lit(1));
        EXPECT_EQ(walled, caught == 0.0);
        EXPECT_EQ(walled, p.lit(1) == 0);
        EXPECT_LT(0u, p.lit(0));
    }
}

// A window in a wall of four boxes: a board behind it is lit, a board beside it is not.
TEST(Spread, AHoleInTheWallLetsRadiationThrough) {
    for (const float beside : {0.0f, 3.0f}) {  // m from the board to the window, sideways
        TwoBoards p(worldDef(FW_WORLD_RADIATION), receiverOf(0.0018f, false));
        const auto wall = [&](float y, float z, float high, float wide) {
            FwHeatOccluderDef box = fwDefaultHeatOccluderDef();
            box.transform[12] = 0.05f;
            box.transform[13] = y;
            box.transform[14] = z + beside;
            box.halfSize[0] = 0.01f;
            box.halfSize[1] = high;
            box.halfSize[2] = wide;
            (void)created(fwWorld_AddHeatOccluder, p.world, box);
        };
        wall(-5, 0, 5.2f, 20);  // up to 0.2 m
        wall(6, 0, 5, 20);      // from 1 m
        wall(0.6f, -10.2f, 0.5f, 10);
        wall(0.6f, 10.4f, 0.5f, 10);
        const double caught = p.caught(120);
        std::printf("two boards, a window %.0f m aside: %u texels lit\n", double(beside), p.lit(1));
        EXPECT_EQ(beside == 0, caught > 0);
        EXPECT_EQ(beside == 0, p.lit(1) > 0);
    }
}

TEST(Spread, PlumesIgniteObjectsAbove) {
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

TEST(Spread, RespectsTheHostsVisibilityAnswers) {
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

TEST(Spread, ClearingTheFlagStopsReceivedHeat) {
    // Switched off before it is hot enough, the object cools and never catches.
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

// A strong fire upwind of an object that embers may ignite.
void makeEmbers(Panels& p) {
    p.add(0, 0, 0);
    for (int i = 0; i < 12; ++i)
        for (int k = -2; k < 3; ++k) p.add(1.0f + 0.42f * float(i), -0.5f, float(k) * 0.22f);
    for (float x = 0.02f; x < 0.4f; x += 0.06f)
        for (float z = 0.02f; z < 0.2f; z += 0.06f) p.ignite(p.ids[0], x, 0, z, 0.04f);
}

TEST(Spread, EmbersIgniteObjectsDownwind) {
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
    FwHeatOccluderDef wall = fwDefaultHeatOccluderDef();
    wall.transform[12] = 0.7f;
    wall.halfSize[0] = 0.05f;
    wall.halfSize[1] = wall.halfSize[2] = 30;
    const FwHeatOccluderId id = created(fwWorld_AddHeatOccluder, walled->world, wall);
    EXPECT_EQ(0u, burns(*walled));
    ASSERT_EQ(FW_OK, fwWorld_RemoveHeatOccluder(walled->world, id));
    walled->run(20);
    EXPECT_GT(walled->alight(), 1u);
}

}  // namespace
