// Heat occlusion between a fire and its targets: occluders of the host and burnable meshes, which
// stop occluding where they have burnt away. On the cpu backend;
// tests/gpu/exchange_equality_test.cpp covers the device, busy_world.h covers saves, logs and
// networks.
#include "abi/panels.h"

#include <cmath>
#include <functional>

namespace {

using namespace host;

// A fierce fire of 0.4 x 0.2 m at the origin and paper 0.3 m beside it. An inert wall of 2 x 1 m
// may stand between them at x = 0.55.
struct Kiln : Panels {
    Kiln() : Panels(worldDef(FW_WORLD_RADIATION), 600.0f) {
        FwMaterialDef hot = evenMaterial(0.0005f, 600.0f);
        hot.heatOfCombustion = 4e7f;
        hot.burningFlux = 0.3f;
        EXPECT_EQ(FW_OK, fwWorld_CreateMaterial(world, &hot, &material));
        add(0, 0, 0);
        FwMaterialDef paper = materialOf(FW_MATERIAL_PAPER);
        EXPECT_EQ(FW_OK, fwWorld_CreateMaterial(world, &paper, &material));
        FwBurnableMeshDef board = upright(0.7f, 0, 0, 1, 0);
        board.flags = FW_BURNABLE_TWO_SIDED;
        add(board);
        FwMaterialDef slow = evenMaterial(0.0001f, 2.0f);
        slow.appearance = FW_MATERIAL_PAPER;
        slow.burningFlux = 0.0001f;
        EXPECT_EQ(FW_OK, fwWorld_CreateMaterial(world, &slow, &material));
    }
    // Object x points up, its normal along world x, then turned about the vertical.
    FwBurnableMeshDef upright(float x, float y, float z, float scale, float turn) const {
        FwBurnableMeshDef made = def(x, y, z);
        const float c = scale * std::cos(turn), s = scale * std::sin(turn);
        const float rows[12] = {0, scale, 0, 0, -c, 0, s, 0, s, 0, c, 0};
        std::copy_n(rows, 12, made.transform);
        return made;
    }
    FwBurnableMeshId wall(float x = 0.55f, float turn = 0) {
        FwBurnableMeshDef made =
            upright(x - 0.5f * std::sin(turn), -0.5f, 0.1f - 0.5f * std::cos(turn), 5, turn);
        made.flags |= FW_BURNABLE_NO_SPREAD;
        return add(made);
    }
    static FwHeatOcclusionDef cells() {
        FwHeatOcclusionDef def = fwDefaultHeatOcclusionDef();
        def.origin[0] = -0.5f;
        def.origin[1] = def.origin[2] = -1;
        def.counts[0] = 40;
        def.counts[1] = 60;
        def.counts[2] = 40;
        def.cellSize = 0.05f;
        return def;
    }
    void shield(const FwHeatOcclusionDef& def) {
        EXPECT_EQ(FW_OK, fwWorld_SetHeatOcclusion(world, &def)) << lastMessage(world);
    }
    void bake(const std::vector<FwBurnableMeshId>& walls) {
        FwHeatOcclusionDef def = cells();
        def.objects = walls.data();
        def.objectCount = uint32_t(walls.size());
        shield(def);
    }
    bool caught(double seconds = 20) {
        for (float x = 0.02f; x < 0.4f; x += 0.06f)
            for (float z = 0.02f; z < 0.2f; z += 0.06f) ignite(ids[0], x, 0, z, 0.04f);
        run(seconds);
        return lit(1) > 0;
    }
};

bool kilnCatches(const std::function<void(Kiln&)>& walls) {
    Kiln kiln;
    walls(kiln);
    return kiln.caught();
}

TEST(HeatOcclusionGrid, ABurnableWallOccludes) {
    EXPECT_TRUE(kilnCatches([](Kiln&) {}));
    EXPECT_TRUE(kilnCatches([](Kiln& k) { k.wall(); }));  // not an occluder
    EXPECT_FALSE(kilnCatches([](Kiln& k) { k.bake({k.wall()}); }));
    EXPECT_FALSE(kilnCatches([](Kiln& k) { k.bake({k.wall(0.55f, 0.5f)}); }));
    EXPECT_TRUE(kilnCatches([](Kiln& k) { k.bake({k.wall(1.3f)}); }));  // behind the paper
    // All objects: the wall and the two that do not occlude themselves.
    const auto all = [](bool walled) {
        return [walled](Kiln& k) {
            if (walled) k.wall();
            FwHeatOcclusionDef def = Kiln::cells();
            def.flags = FW_HEAT_OCCLUSION_ALL_OBJECTS;
            k.shield(def);
        };
    };
    EXPECT_FALSE(kilnCatches(all(true)));
    EXPECT_TRUE(kilnCatches(all(false)));
}

TEST(HeatOcclusionGrid, BurntPartsStopOccluding) {
    const auto burnt = [](float height, float radius, double seconds) {
        return [=](Kiln& k) {
            const FwBurnableMeshId wall = k.wall();
            k.bake({wall});
            k.ignite(wall, 0.55f, height, 0.1f, radius);
            k.run(seconds);
        };
    };
    EXPECT_TRUE(kilnCatches(burnt(0.4f, 2.0f, 200)));   // all of it
    EXPECT_TRUE(kilnCatches(burnt(0.3f, 0.35f, 200)));  // a hole where the flames are
    EXPECT_FALSE(kilnCatches(burnt(1.4f, 0.1f, 200)));  // its top
}

TEST(HeatOcclusionGrid, FollowsMovedObjectsAfterTheNextCall) {
    Kiln kiln;
    const FwBurnableMeshId wall = kiln.wall();
    kiln.bake({wall});
    const FwBurnableMeshDef away = kiln.upright(1.3f, -0.5f, -0.4f, 5, 0);
    ASSERT_EQ(FW_OK, fwWorld_SetTransform(kiln.world, wall, away.transform));
    EXPECT_FALSE(kiln.caught());  // still at its old place
    kiln.bake({wall});
    kiln.run(20);
    EXPECT_LT(0u, kiln.lit(1));

    Kiln other;
    const FwBurnableMeshId gone = other.wall();
    other.bake({gone});
    ASSERT_EQ(FW_OK, fwWorld_DestroyBurnableMesh(other.world, gone));
    other.ids.pop_back();
    EXPECT_TRUE(other.caught());  // a destroyed wall does not occlude
    Kiln none;
    none.bake({none.wall()});
    ASSERT_EQ(FW_OK, fwWorld_SetHeatOcclusion(none.world, nullptr));
    EXPECT_TRUE(none.caught());
}

TEST(HeatOcclusionGrid, HostOccludersOcclude) {
    static uint32_t asked = 0;
    const auto plane = [](float x) {  // no thickness, and slanted
        return [x](Kiln& k) {
            FwHeatOcclusionDef def = Kiln::cells();
            float at = x;
            def.distanceData = &at;
            def.distance = [](void* data, const float* place) {
                ++asked;
                const float off = place[0] - *static_cast<float*>(data) + 0.3f * place[2];
                return std::abs(off) / std::sqrt(1.09f);
            };
            k.shield(def);
        };
    };
    EXPECT_FALSE(kilnCatches(plane(0.55f)));
    EXPECT_EQ(40u * 60 * 40, asked);  // during the call, never later
    EXPECT_TRUE(kilnCatches(plane(1.25f)));
    const auto bytes = [](uint32_t x, uint32_t except) {
        return [=](Kiln& k) {
            FwHeatOcclusionDef def = Kiln::cells();
            std::vector<uint8_t> solid(40 * 60 * 40);
            for (uint32_t z = 0; z < 40; ++z)
                for (uint32_t y = 0; y < 60; ++y)
                    solid[(z * 60 + y) * 40 + x] = z / 4 == except ? 0 : 1;
            def.cells = solid.data();
            k.shield(def);
        };
    };
    EXPECT_FALSE(kilnCatches(bytes(21, 99)));
    EXPECT_TRUE(kilnCatches(bytes(21, 5)));  // a slot from z = 0 to 0.2
}

// Jets end at the host's cells, and heat queries behind them are in shade.
TEST(HeatOcclusionGrid, JetsAndHeatQueriesRespectOccluders) {
    for (const bool walled : {false, true}) {
        Kiln kiln;
        FwHeatOcclusionDef def = Kiln::cells();
        std::vector<uint8_t> solid(40 * 60 * 40);
        for (uint32_t i = 0; i < solid.size(); ++i) solid[i] = i % 40 == 21 ? 1 : 0;
        def.cells = solid.data();
        if (walled) kiln.shield(def);
        FwFireEmitterDef jet = fwDefaultFireEmitterDef();
        jet.flags = FW_EMITTER_JET | FW_EMITTER_IGNITES;
        jet.position[0] = -0.45f;
        jet.position[1] = 0.2f;
        jet.position[2] = 0.1f;
        jet.direction[0] = 1;
        jet.direction[1] = 0;
        jet.power = 2000;
        const FwFireEmitterId id = created(fwWorld_CreateFireEmitter, kiln.world, jet);
        kiln.run(3);
        EXPECT_EQ(!walled, kiln.lit(1) > 0);
        const FwFireEmitterState state = getState(fwWorld_GetFireEmitterState, kiln.world, id);
        if (walled) {
            EXPECT_NEAR(1.0f, state.clearDistance, 0.06f);  // from -0.45 to 0.55 m
        }
        ASSERT_EQ(FW_OK, fwWorld_DestroyFireEmitter(kiln.world, id));
    }
    const auto heat = [](bool walled) {
        Kiln kiln;
        if (walled) kiln.bake({kiln.wall()});
        (void)kiln.caught(2);
        FwSurroundings at{};
        at.structSize = sizeof at;
        const float place[3] = {1.2f, 0.4f, 0.1f};
        EXPECT_EQ(FW_OK, fwWorld_SampleSurroundings(kiln.world, place, &at));
        return at.heatFlux;
    };
    const float open = heat(false), shaded = heat(true);
    EXPECT_LT(2000.0f, open);
    EXPECT_LT(shaded, 0.2f * open);
}

TEST(HeatOcclusionGrid, RefusesBadValuesByName) {
    Kiln kiln;
    const auto refused = [&](const std::function<void(FwHeatOcclusionDef&)>& change,
                             const std::string& says) {
        FwHeatOcclusionDef def = fwDefaultHeatOcclusionDef();
        change(def);
        EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_SetHeatOcclusion(kiln.world, &def)) << says;
        EXPECT_EQ(says + "\n - While calling fwWorld_SetHeatOcclusion.", lastMessage(kiln.world));
    };
    refused([](FwHeatOcclusionDef& d) { d.flags = 2; },
            "FwHeatOcclusionDef::flags is 0x2; the known flags are 0x1.");
    refused([](FwHeatOcclusionDef& d) { d.counts[1] = 0; },
            "FwHeatOcclusionDef::counts[1] is 0; the limits are [1, 256].");
    refused([](FwHeatOcclusionDef& d) { d.counts[2] = 257; },
            "FwHeatOcclusionDef::counts[2] is 257; the limits are [1, 256].");
    refused(
        [](FwHeatOcclusionDef& d) { std::fill_n(d.counts, 3, 200u); },
        "FwHeatOcclusionDef::counts makes 200 x 200 x 200 = 8000000 cells; the limit is 2097152.");
    refused([](FwHeatOcclusionDef& d) { d.cellSize = 0.04f; },
            "FwHeatOcclusionDef::cellSize is 0.04; the limits are [0.05, 10].");
    refused([](FwHeatOcclusionDef& d) { d.origin[2] = 2e6f; },
            "FwHeatOcclusionDef::origin[2] is 2e+06; the limits are [-1e+06, 1e+06].");
    refused([](FwHeatOcclusionDef& d) { d.objectCount = 2; },
            "FwHeatOcclusionDef::objects is null, and objectCount is 2.");
    FwHeatOcclusionDef def = fwDefaultHeatOcclusionDef();
    const FwBurnableMeshId none{77, 1};
    def.objects = &none;
    def.objectCount = 1;
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_SetHeatOcclusion(kiln.world, &def));
}

}  // namespace
