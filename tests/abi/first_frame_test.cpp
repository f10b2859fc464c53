// The first frame after a load looks like the frame after the save: flames and light of meshes,
// particles of emitters, shapes of volumetric fires.
#include "abi/busy_world.h"

#include <cmath>
#include <memory>

namespace {

using namespace host;

// A burning wooden board, an emitter that shows its flames, a free emitter, a volumetric fire.
struct Camp : HostedWorld {
    explicit Camp(uint32_t backend) : HostedWorld(backend, pacedDef(8)) {
        if (!world) return;
        const Sheet sheet(0.6f, 0.4f, 4);
        FwBurnableMeshDef made = fwDefaultBurnableMeshDef();
        const float upright[16] = {1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1};
        std::copy_n(upright, 16, made.transform);
        board = addBurnable(world, sheet.def(64), fwDefaultMaterialDef(), made);
        FwFireEmitterDef emitter = fwDefaultFireEmitterDef();
        emitter.position[0] = -2;
        ok(fwWorld_CreateFireEmitter(world, &emitter, &camp));
        emitter.shape = FW_EMITTER_MESH;
        emitter.object = board;
        emitter.power = 30;
        ok(fwWorld_CreateFireEmitter(world, &emitter, &flames));
        FwVolumetricFireDef fireDef = fwDefaultVolumetricFireDef();
        ok(fwWorld_CreateVolumetricFire(world, &fireDef, &fire));
    }
    void burn() {
        FwIgnitionDef ball = fwDefaultIgnitionDef();
        ball.position[0] = 0.3f;
        ball.position[1] = 0.1f;
        ball.radius = 0.12f;
        ok(fwWorld_Ignite(world, &ball, nullptr));
        const float there[3] = {2, 0, 1};
        ok(fwWorld_MoveVolumetricFire(world, fire, there));
        ok(fwWorld_SetVolumetricFirePower(world, fire, 300));
        for (int i = 0; i < 300; ++i) step();
    }
    void step() { ok(fwWorld_Step(world, 1.0f / 60)); }
    FwFireEmitterState emitterState(FwFireEmitterId id) {
        return getState(fwWorld_GetFireEmitterState, world, id);
    }
    FwVolumetricFireState fireState() {
        return getState(fwWorld_GetVolumetricFireState, world, fire);
    }
    double meshPower() {  // W radiated by burning meshes
        FwLight lights[64];
        double power = 0;
        const uint32_t count = fwWorld_GetLights(world, lights, 64);
        for (uint32_t i = 0; i < count; ++i)
            if (lights[i].id < 1u << 30) power += double(lights[i].power);
        return power;
    }
    uint32_t quads() {  // shown in a picture
        std::vector<uint32_t> pixels(160 * 90);
        FwOffscreenDef picture = fwDefaultOffscreenDef();
        picture.width = 160;
        picture.height = 90;
        picture.pixels = pixels.data();
        const float view[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -0.7f, -5, 1};
        const float wide = 1.2f, tall = wide * 16 / 9;
        const float projection[16] = {wide, 0, 0, 0, 0, -tall, 0, 0, 0, 0, -1, -1, 0, 0, -0.1f, 0};
        std::copy_n(view, 16, picture.view.view);
        std::copy_n(projection, 16, picture.view.projection);
        ok(fwWorld_RenderOffscreen(world, &picture));
        return getState(fwWorld_GetStats, world).flames;
    }

    FwBurnableMeshId board{};
    FwFireEmitterId camp{}, flames{};
    FwVolumetricFireId fire{};
};

void matchesTheFrameAfterTheSave(uint32_t backend) {
    Camp first(backend);
    if (!first.world) GTEST_SKIP() << "there is no such backend here";
    first.burn();
    const Bytes bytes = saveOf(first.world);
    first.step();
    const double power = first.meshPower();
    EXPECT_GT(power, 1000);
    const FwFireEmitterState camp = first.emitterState(first.camp);
    const FwFireEmitterState flames = first.emitterState(first.flames);
    const FwVolumetricFireState fire = first.fireState();
    EXPECT_GT(flames.particles, 5u);
    const uint32_t quads = backend == FW_BACKEND_VULKAN ? first.quads() : 0;
    for (const bool fresh : {true, false}) {
        const auto other = fresh ? std::make_unique<Camp>(backend) : nullptr;
        Camp& w = fresh ? *other : first;
        w.ok(fwWorld_Load(w.world, bytes.data(), bytes.size()));
        w.step();
        EXPECT_NEAR(power, w.meshPower(), 0.5 * power) << fresh;
        const FwFireEmitterState campNow = w.emitterState(w.camp);
        const FwFireEmitterState flamesNow = w.emitterState(w.flames);
        EXPECT_NEAR(double(camp.particles), double(campNow.particles), 0.1 * camp.particles + 2);
        EXPECT_NEAR(double(flames.particles), double(flamesNow.particles),
                    0.3 * flames.particles + 2);
        EXPECT_GT(campNow.lightIntensity, 0.5f * camp.lightIntensity);
        const FwVolumetricFireState fireNow = w.fireState();
        EXPECT_EQ(fire.flames, fireNow.flames);
        EXPECT_NEAR(fire.power, fireNow.power, 1.0f);
        EXPECT_NEAR(fire.height, fireNow.height, 0.05f);
        for (int i = 0; i < 3; ++i) EXPECT_NEAR(fire.tip[i], fireNow.tip[i], 0.3f) << i;
        if (backend == FW_BACKEND_VULKAN) {
            const uint32_t now = w.quads();
            std::printf("           %u quads, %u after the load\n", quads, now);
            EXPECT_NEAR(double(quads), double(now), 0.35 * quads) << fresh;
        }
    }
}
TEST(FirstFrame, MatchesTheFrameAfterTheSave) { matchesTheFrameAfterTheSave(FW_BACKEND_CPU); }
TEST(FirstFrame, MatchesTheFrameAfterTheSaveOnADevice) {
    matchesTheFrameAfterTheSave(FW_BACKEND_VULKAN);
}

// FwWorldStats::flames on a backend that draws.
TEST(FirstFrame, StatsCountTheQuadsOfThePicture) {
    Camp w(FW_BACKEND_VULKAN);
    if (!w.world) GTEST_SKIP() << "there is no such backend here";
    w.step();
    w.ok(fwWorld_DestroyFireEmitter(w.world, w.camp));
    w.ok(fwWorld_DestroyFireEmitter(w.world, w.flames));
    w.step();
    EXPECT_EQ(0u, w.quads()) << "nothing burns yet";
    w.burn();
    EXPECT_GT(w.quads(), 0u) << "smoke, at least";
    FwIgnitionDef douse = fwDefaultIgnitionDef();
    douse.kind = FW_EXTINGUISH;
    douse.radius = 2;
    w.ok(fwWorld_Ignite(w.world, &douse, nullptr));
    for (int i = 0; i < 120; ++i) w.step();
    EXPECT_EQ(0u, w.quads()) << "nothing burns any more";
}

// Every backend fills every figure of FwWorldStats except those of drawing.
TEST(FirstFrame, EveryFigureOfTheStatsIsFilled) {
    for (const uint32_t backend : {FW_BACKEND_CPU, FW_BACKEND_VULKAN}) {
        Camp w(backend);
        if (!w.world) continue;
        w.burn();
        if (backend == FW_BACKEND_VULKAN) (void)w.quads();
        w.ok(fwWorld_Step(w.world, 10));  // longer than a frame may be
        FwWorldStats stats{};
        stats.structSize = sizeof stats;
        w.ok(fwWorld_GetStats(w.world, &stats));
        EXPECT_LT(0u, stats.steps);
        EXPECT_LT(0u, stats.tick);
        EXPECT_LT(0u, stats.readbackFrame);
        EXPECT_EQ(1u, stats.objects);
        EXPECT_EQ(1u, stats.burningObjects);
        EXPECT_EQ(1u, stats.meshes);
        EXPECT_EQ(1u, stats.materials);
        EXPECT_LT(0u, stats.frontTiles);
        EXPECT_LT(0u, stats.runTiles);
        EXPECT_LT(0u, stats.burningTiles);
        EXPECT_LT(0u, stats.hotTiles);
        EXPECT_LT(0u, stats.droppedSteps);
        EXPECT_LT(500u, stats.texels);
        EXPECT_EQ(backend == FW_BACKEND_VULKAN, stats.flames > 0);
    }
}

}  // namespace
