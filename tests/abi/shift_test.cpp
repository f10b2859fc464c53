// fwWorld_ShiftOrigin: a world whose origin moves burns and looks as one whose does not.
#include "abi/busy_world.h"

#include <gmock/gmock.h>

#include <cmath>

namespace {

using namespace host;
using ::testing::HasSubstr;

// Places that a host reads move with the origin.
struct ShiftedWorld {
    explicit ShiftedWorld(uint32_t backend) {
        FwContextDef contextDef = fwDefaultContextDef();
        contextDef.backend = backend;
        contextDef.callbacks = host.callbacks();
        FwErrorInfo error{};
        if (fwCreateContext(&contextDef, &context, &error) != FW_OK) return;
        FwWorldDef def = fwDefaultWorldDef();
        def.flags = FW_WORLD_RADIATION | FW_WORLD_PLUME | FW_WORLD_CONTACT | FW_WORLD_EMBERS;
        def.paceFactor = 12;
        def.seed = 5;
        def.wind[0] = 1.5f;
        ok(fwCreateWorld(context, &def, &world));
        FwMeshDef meshDef = sheet.def(48);
        meshDef.noiseAmplitude = 0.15f;
        FwMeshId mesh{};
        ok(fwWorld_CreateMesh(world, &meshDef, &mesh));
        FwMaterialDef paper = fwDefaultMaterialDef();
        ok(fwInitMaterialPreset(&paper, FW_MATERIAL_PAPER));
        FwMaterialDef pine = fwDefaultMaterialDef();
        FwMaterialId materials[2] = {};
        ok(fwWorld_CreateMaterial(world, &paper, &materials[0]));
        ok(fwWorld_CreateMaterial(world, &pine, &materials[1]));
        for (int i = 0; i < 8; ++i) {
            FwBurnableMeshDef made = fwDefaultBurnableMeshDef();
            made.mesh = mesh;
            made.materials[0] = materials[i % 2];
            const float turn = 0.37f * float(i);
            float at[16] = {std::cos(turn), 0, -std::sin(turn), 0, 0, 1, 0, 0,
                            std::sin(turn), 0, std::cos(turn),  0, 0, 0, 0, 1};
            at[12] = 0.37f * float(i % 4) + 0.0123f * float(i);
            at[13] = 0.11f * float(i / 4);
            at[14] = 0.31f * float(i / 4) + 0.00371f * float(i);
            std::copy_n(at, 16, made.transform);
            FwBurnableMeshId id{};
            ok(fwWorld_CreateBurnableMesh(world, &made, &id));
            ids.push_back(id);
        }
        FwWindZoneDef swirl = fwDefaultWindZoneDef();
        swirl.shape = FW_WIND_SPHERE;
        swirl.flow = FW_WIND_VORTEX;
        swirl.axis[0] = 0, swirl.axis[1] = 1;
        swirl.position[0] = 0.7f;
        swirl.size[0] = 0.9f;
        FwWindZoneId zone{};
        ok(fwWorld_CreateWindZone(world, &swirl, &zone));
        FwGustDef gusts = fwDefaultGustDef();
        gusts.strength = 0.8f;
        gusts.size = 1.5f;
        ok(fwWorld_SetGusts(world, &gusts));
        FwBlockerDef wall = fwDefaultBlockerDef();
        wall.transform[12] = 0.6f, wall.transform[13] = 0.3f, wall.transform[14] = 0.2f;
        wall.halfSize[0] = 0.3f, wall.halfSize[1] = 0.3f, wall.halfSize[2] = 0.01f;
        FwBlockerId blocker{};
        ok(fwWorld_AddBlocker(world, &wall, &blocker));
        FwRoomDef closet = fwDefaultRoomDef();
        closet.position[0] = 1.1f;
        closet.halfSize[0] = closet.halfSize[1] = closet.halfSize[2] = 0.45f;
        closet.vent = 0.02f;
        ok(fwWorld_CreateRoom(world, &closet, &room));
        FwVolumetricFireDef fireDef = fwDefaultVolumetricFireDef();
        fireDef.position[0] = -3;
        fireDef.seed = 9;
        ok(fwWorld_CreateVolumetricFire(world, &fireDef, &fire));
        FwFireEmitterDef emitterDef = fwDefaultFireEmitterDef();
        emitterDef.position[0] = 3;
        emitterDef.seed = 4;
        ok(fwWorld_CreateFireEmitter(world, &emitterDef, &emitter));
        FwIgnitionDef ball = fwDefaultIgnitionDef();
        ball.object = ids[0];
        ball.position[0] = 0.1f;
        ball.position[2] = 0.1f;
        ball.radius = 0.08f;
        ok(fwWorld_Ignite(world, &ball, nullptr));
    }
    ShiftedWorld(const ShiftedWorld&) = delete;
    ShiftedWorld& operator=(const ShiftedWorld&) = delete;
    ~ShiftedWorld() {
        fwDestroyContext(context);
        EXPECT_EQ(0, host.blocks);
    }
    void ok(FwResult result) { EXPECT_EQ(FW_OK, result) << lastMessage(world); }
    void run(int frames) {
        for (int i = 0; i < frames; ++i)
            ok(fwWorld_Step(world, i % 3 == 0 ? 1.0f / 60 : 1.0f / 24));
    }
    void shift(float x, float y, float z) {
        const float by[3] = {x, y, z};
        float applied[3] = {};
        ok(fwWorld_ShiftOrigin(world, by, applied));
        for (int i = 0; i < 3; ++i) {
            EXPECT_EQ(std::round(by[i]), applied[i]);
            moved[i] += double(applied[i]);
        }
        double origin[3] = {};
        ok(fwWorld_GetOrigin(world, origin));
        for (int i = 0; i < 3; ++i) EXPECT_EQ(moved[i], origin[i]);
    }
    uint64_t hash() {
        uint64_t all = 0;
        for (const FwBurnableMeshId id : ids) ok(fwDebug_RequestBurnMap(world, id));
        for (const FwBurnableMeshId id : ids) {
            uint64_t one = 0, tick = 0;
            come(world,
                 [&] { return fwDebug_FetchBurnMap(world, id, nullptr, 0, nullptr, &one, &tick); });
            all = all * 31 + one + tick;
        }
        return all;
    }
    uint32_t caught() {
        uint32_t count = 0;
        for (const FwBurnableMeshId id : ids) {
            FwObjectState state{};
            state.structSize = sizeof state;
            ok(fwWorld_GetObjectState(world, id, &state));
            count += state.ignited > 0 ? 1 : 0;
        }
        return count;
    }
    std::vector<FwEvent> events() {
        std::vector<FwEvent> all(256);
        all.resize(fwWorld_PollEvents(world, all.data(), 256));
        return all;
    }
    FwVolumetricFireState fireState() {
        FwVolumetricFireState state{};
        state.structSize = sizeof state;
        ok(fwWorld_GetVolumetricFireState(world, fire, &state));
        return state;
    }

    Host host;
    Sheet sheet{0.3f, 0.25f, 3};
    FwContext* context = nullptr;
    FwWorld* world = nullptr;
    std::vector<FwBurnableMeshId> ids;
    FwRoomId room{};
    FwVolumetricFireId fire{};
    FwFireEmitterId emitter{};
    double moved[3] = {};
};

void burnsOnAlike(uint32_t backend, int frames) {
    ShiftedWorld stays(backend), moves(backend);
    if (!stays.world) GTEST_SKIP() << "there is no such backend here";
    stays.run(40);
    moves.run(40);
    moves.shift(-1000, 17, 523.6f);
    for (int part = 0; part < 4; ++part) {
        stays.run(frames / 4);
        moves.run(frames / 4);
        if (part == 1) moves.shift(777, 0, -250000);
        ASSERT_EQ(stays.hash(), moves.hash()) << part;
        FwLight a[16] = {}, b[16] = {};
        const uint32_t count = fwWorld_GetLights(stays.world, a, 16);
        ASSERT_EQ(count, fwWorld_GetLights(moves.world, b, 16));
        for (uint32_t i = 0; i < count && part == 0; ++i) {
            EXPECT_EQ(a[i].id, b[i].id);
            for (int k = 0; k < 3; ++k)
                EXPECT_NEAR(double(a[i].position[k]) + moves.moved[k], double(b[i].position[k]),
                            0.02);
        }
        const FwVolumetricFireState here = stays.fireState(), there = moves.fireState();
        for (int k = 0; k < 3 && part == 0; ++k)
            EXPECT_NEAR(double(here.tip[k]) + moves.moved[k], double(there.tip[k]), 0.02);
        EXPECT_EQ(here.flames, there.flames);
    }
    EXPECT_GE(stays.caught(), 2u);
    const std::vector<FwEvent> a = stays.events(), b = moves.events();
    ASSERT_EQ(a.size(), b.size());
    for (size_t i = 0; i < a.size(); ++i) {
        EXPECT_EQ(a[i].type, b[i].type);
        EXPECT_EQ(a[i].value, b[i].value);
        for (int k = 0; k < 3; ++k)
            EXPECT_NEAR(double(a[i].position[k]) + moves.moved[k], double(b[i].position[k]), 0.04)
                << "events that wait move too";
    }
}
TEST(ShiftOrigin, BurnsOnAsIfNothingHadMoved) { burnsOnAlike(FW_BACKEND_CPU, 240); }
TEST(ShiftOrigin, BurnsOnAsIfNothingHadMovedOnADevice) { burnsOnAlike(FW_BACKEND_VULKAN, 120); }

// A volumetric fire and an emitter go on as they were, to the frame.
TEST(ShiftOrigin, FiresAndEmittersLoseNothing) {
    ShiftedWorld w(FW_BACKEND_CPU);
    w.run(120);
    const FwVolumetricFireState before = w.fireState();
    FwFireEmitterState particles{};
    particles.structSize = sizeof particles;
    w.ok(fwWorld_GetFireEmitterState(w.world, w.emitter, &particles));
    w.shift(2000, 0, -300);
    const FwVolumetricFireState at = w.fireState();
    w.ok(fwWorld_Step(w.world, 1.0f / 60));
    const FwVolumetricFireState after = w.fireState();
    for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(double(before.tip[k]) + w.moved[k], double(at.tip[k]), 0.001);
        EXPECT_NEAR(double(before.tip[k]) + w.moved[k], double(after.tip[k]), 0.1);
    }
    FwFireEmitterState now{};
    now.structSize = sizeof now;
    w.ok(fwWorld_GetFireEmitterState(w.world, w.emitter, &now));
    EXPECT_NEAR(double(particles.particles), double(now.particles), 3);
    EXPECT_NEAR(double(particles.lightPosition[0]) + 2000, double(now.lightPosition[0]), 0.05);
}

// Saves know where the origin was; who loads one is there again.
TEST(ShiftOrigin, SavesAndTimelinesGoBackToTheirOrigin) {
    ShiftedWorld w(FW_BACKEND_CPU);
    FwTimelineDef timeline = fwDefaultTimelineDef();
    timeline.interval = 0.5f;
    w.ok(fwWorld_StartTimeline(w.world, &timeline));
    w.run(60);
    const Bytes old = saveOf(w.world);
    const uint64_t then = w.hash();
    FwWorldStats stats{};
    stats.structSize = sizeof stats;
    w.ok(fwWorld_GetStats(w.world, &stats));
    w.shift(512, 0, 64);
    w.run(40);
    const Bytes shifted = saveOf(w.world);
    const uint64_t later = w.hash();
    FwWorldStats end{};
    end.structSize = sizeof end;
    w.ok(fwWorld_GetStats(w.world, &end));
    double origin[3] = {};
    float seconds = 0;
    while (fwWorld_Seek(w.world, stats.tick - 128 * 10, &seconds) == FW_OK && seconds > 0)
        w.ok(fwWorld_Step(w.world, seconds));
    w.ok(fwWorld_GetOrigin(w.world, origin));
    EXPECT_EQ(0.0, origin[0]) << "before the shift";
    while (fwWorld_Seek(w.world, end.tick, &seconds) == FW_OK && seconds > 0)
        w.ok(fwWorld_Step(w.world, seconds));
    w.ok(fwWorld_GetOrigin(w.world, origin));
    EXPECT_EQ(512.0, origin[0]);
    EXPECT_EQ(64.0, origin[2]);
    ShiftedWorld other(FW_BACKEND_CPU);
    other.ok(fwWorld_Load(other.world, shifted.data(), shifted.size()));
    EXPECT_EQ(later, other.hash());
    other.ok(fwWorld_GetOrigin(other.world, origin));
    EXPECT_EQ(512.0, origin[0]);
    EXPECT_NEAR(512 - 3, double(other.fireState().lightPosition[0]), 1);
    EXPECT_EQ(shifted, saveOf(other.world));
    other.ok(fwWorld_Load(other.world, old.data(), old.size()));
    EXPECT_EQ(then, other.hash());
    other.ok(fwWorld_GetOrigin(other.world, origin));
    EXPECT_EQ(0.0, origin[0]);
}

// A log with a shift in it plays.
// From one end of space to the other: no place of the loading world overflows on the way.
TEST(ShiftOrigin, LoadsASaveWhoseOriginIsFarOff) {
    ShiftedWorld w(FW_BACKEND_CPU);
    w.shift(512, 0, 64);
    w.run(40);
    Bytes bytes = saveOf(w.world);
    const double origin[3] = {512, 0, 64}, far[3] = {1e9, 0, -1e9};
    const auto* begin = reinterpret_cast<const unsigned char*>(origin);
    const auto at = std::find_end(bytes.begin(), bytes.end(), begin, begin + sizeof origin);
    ASSERT_NE(bytes.end(), at);
    std::memcpy(&*at, far, sizeof far);
    signSave(bytes);
    ShiftedWorld other(FW_BACKEND_CPU);
    other.shift(-900000, 0, 0);
    other.ok(fwWorld_Load(other.world, bytes.data(), bytes.size()));
    double now[3] = {};
    other.ok(fwWorld_GetOrigin(other.world, now));
    EXPECT_EQ(1e9, now[0]);
    EXPECT_EQ(w.hash(), other.hash());
    w.run(20);
    other.run(20);
    EXPECT_EQ(w.hash(), other.hash());
}

TEST(ShiftOrigin, IsInLogs) {
    ShiftedWorld w(FW_BACKEND_CPU), other(FW_BACKEND_CPU);
    const Bytes start = saveOf(w.world);
    w.ok(fwWorld_StartLog(w.world));
    w.run(30);
    w.shift(-300, 2, 40);
    w.run(30);
    uint64_t size = 0;
    w.ok(fwWorld_FetchLog(w.world, nullptr, &size));
    Bytes log(size);
    w.ok(fwWorld_FetchLog(w.world, log.data(), &size));
    FwWorldStats stats{};
    stats.structSize = sizeof stats;
    w.ok(fwWorld_GetStats(w.world, &stats));
    other.ok(fwWorld_Load(other.world, start.data(), start.size()));
    other.ok(fwWorld_OpenLog(other.world, log.data(), log.size()));
    float seconds = 0;
    while (fwWorld_PlayLog(other.world, stats.tick, &seconds) == FW_OK && seconds > 0)
        other.ok(fwWorld_Step(other.world, seconds));
    double origin[3] = {};
    other.ok(fwWorld_GetOrigin(other.world, origin));
    EXPECT_EQ(-300.0, origin[0]);
    EXPECT_EQ(2.0, origin[1]);
    EXPECT_EQ(40.0, origin[2]);
}

TEST(ShiftOrigin, NamesWhatWouldLieTooFar) {
    ShiftedWorld w(FW_BACKEND_CPU);
    const float far[3] = {999999, 0, 0}, bad[3] = {0, NAN, 0}, further[3] = {3e6f, 0, 0};
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_ShiftOrigin(w.world, nullptr, nullptr));
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_ShiftOrigin(w.world, bad, nullptr));
    EXPECT_THAT(lastMessage(w.world), HasSubstr("offset[1]"));
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_ShiftOrigin(w.world, further, nullptr));
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_ShiftOrigin(w.world, far, nullptr));
    EXPECT_THAT(lastMessage(w.world), HasSubstr("burnable mesh 4"));
    double origin[3] = {1, 1, 1};
    w.ok(fwWorld_GetOrigin(w.world, origin));
    EXPECT_EQ(0.0, origin[0]) << "nothing moved";
}

}  // namespace
