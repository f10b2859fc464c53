// Wind zones through the C ABI: what a fan does to fire on a sheet and to what embers light, that
// both backends agree, and what is refused.
#include "abi/panels.h"

#include <cmath>
#include <limits>

namespace {

using namespace host;

FwMaterialDef leaning() {  // as wind has it
    FwMaterialDef def = evenMaterial(0.02f, 6);
    def.windGain = 1;
    def.headGain = 1;
    def.driveMax = 8;
    def.lengthToBreadth = 3;
    return def;
}

// Sheets of one such material, side by side along z, each lit in its middle.
struct Meadow {
    explicit Meadow(uint32_t backend, uint32_t sheets = 3, uint32_t flags = 0) : sheet(1, 0.3f) {
        FwContextDef contextDef = fwDefaultContextDef();
        contextDef.backend = backend;
        contextDef.callbacks = host.callbacks();
        FwErrorInfo error{};
        if (fwCreateContext(&contextDef, &context, &error) != FW_OK) return;
        FwWorldDef def = worldDef(flags);
        EXPECT_EQ(FW_OK, fwCreateWorld(context, &def, &world)) << lastMessage(context);
        const FwMeshDef meshDef = sheet.def(64);
        FwBurnableMeshDef made = fwDefaultBurnableMeshDef();
        EXPECT_EQ(FW_OK, fwWorld_CreateMesh(world, &meshDef, &made.mesh)) << lastMessage(world);
        const FwMaterialDef material = leaning();
        EXPECT_EQ(FW_OK, fwWorld_CreateMaterial(world, &material, &made.materials[0]));
        made.flags = FW_BURNABLE_LITE;
        for (uint32_t i = 0; i < sheets; ++i) {
            made.transform[14] = float(i);
            FwBurnableMeshId id{};
            EXPECT_EQ(FW_OK, fwWorld_CreateBurnableMesh(world, &made, &id)) << lastMessage(world);
            ids.push_back(id);
        }
    }
    ~Meadow() {
        fwDestroyContext(context);
        EXPECT_EQ(0, host.blocks);
    }
    Meadow(const Meadow&) = delete;
    Meadow& operator=(const Meadow&) = delete;

    FwWindZoneId blow(const FwWindZoneDef& def) {
        FwWindZoneId id{};
        EXPECT_EQ(FW_OK, fwWorld_CreateWindZone(world, &def, &id)) << lastMessage(world);
        return id;
    }
    void light() {
        FwIgnitionDef ball = fwDefaultIgnitionDef();
        ball.radius = 0.03f;
        for (size_t i = 0; i < ids.size(); ++i) {
            const float at[3] = {0.5f, 0, float(i) + 0.15f};
            std::copy_n(at, 3, ball.position);
            uint32_t texels = 0;
            EXPECT_EQ(FW_OK, fwWorld_Ignite(world, &ball, &texels)) << lastMessage(world);
            EXPECT_LT(0u, texels);
        }
    }
    void run(int steps) {
        for (int i = 0; i < steps; ++i)
            ASSERT_EQ(FW_OK, fwWorld_Step(world, 1.0f / 32)) << lastMessage(world);
    }
    template <class Fetch>
    void come(Fetch fetch) {
        FwResult result = fetch();
        for (int i = 0; i < 8 && result == FW_NOT_READY; ++i) {
            run(0);
            ASSERT_EQ(FW_OK, fwWorld_Step(world, 0)) << lastMessage(world);
            result = fetch();
        }
        ASSERT_EQ(FW_OK, result) << lastMessage(world);
    }
    uint64_t hash(size_t i) {
        EXPECT_EQ(FW_OK, fwDebug_RequestBurnMap(world, ids[i])) << lastMessage(world);
        uint64_t hash = 0;
        come([&] {
            return fwDebug_FetchBurnMap(world, ids[i], nullptr, 0, nullptr, &hash, nullptr);
        });
        return hash;
    }
    // Has it burnt, x m from the middle of sheet i?
    bool burnt(size_t i, float x) {
        const float at[3] = {0.5f + x, 0, float(i) + 0.15f};
        FwQueryId query{};
        EXPECT_EQ(FW_OK, fwWorld_RequestPoint(world, ids[i], at, &query)) << lastMessage(world);
        FwPointState state{};
        state.structSize = sizeof state;
        come([&] { return fwWorld_FetchPoint(world, query, &state); });
        return state.kind != FW_POINT_UNBURNT;
    }

    Host host;
    Sheet sheet;
    FwContext* context = nullptr;
    FwWorld* world = nullptr;
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

// A fan before the second sheet: its fire runs away from it, and the others' as without.
TEST(AbiWindZone, AFanDrivesTheFireThatItBlowsOn) {
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

// A zone that is everywhere is the world's wind, and shelter is none.
TEST(AbiWindZone, IsAWindLikeTheWorlds) {
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

// What turns, stops and goes, on both backends alike.
TEST(AbiWindZone, BothBackendsAgree) {
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

// Embers fly as it blows where their fire is.
TEST(AbiWindZone, CarriesEmbers) {
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
            FwWindZoneId id{};
            ASSERT_EQ(FW_OK, fwWorld_CreateWindZone(p.world, &zone, &id));
        }
        p.ignite(p.ids[0], 0.2f, 0, 0.1f, 0.3f);
        p.run(20);
        lit[blows] = p.alight() - 1;
    }
    EXPECT_EQ(0u, lit[0]);
    EXPECT_LT(0u, lit[1]);
}

TEST(AbiWindZone, SaysWhatBlowsAndWhatIsWrong) {
    Panels p(worldDef(0));
    float wind[3] = {-1, -1, -1};
    const float here[3] = {0.5f, 0, 0}, far[3] = {30, 0, 0};
    const float around[3] = {1, 0, 2};
    ASSERT_EQ(FW_OK, fwWorld_SetWind(p.world, around));
    FwWindZoneDef def = fwDefaultWindZoneDef();
    FwWindZoneId id{};
    ASSERT_EQ(FW_OK, fwWorld_CreateWindZone(p.world, &def, &id));
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
    EXPECT_NEAR(6, wind[0], 0.02f);  // as before
    def.speed = 1;
    for (int i = 1; i < 64; ++i) {
        FwWindZoneId more{};
        ASSERT_EQ(FW_OK, fwWorld_CreateWindZone(p.world, &def, &more));
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
