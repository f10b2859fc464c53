// A context with its own Vulkan device through the C ABI: the same burn as on the cpu, and pictures
// without a host. Skips with a message without a device; with FLAMEWRIGHT_REQUIRE_GPU it fails.
#include "abi/abi_support.h"

#include <cstdlib>

namespace {

using host::created;
using host::getState;
using host::Host;
using host::lastMessage;
using host::materialOf;

// Null without Vulkan; the test is then skipped or failed.
FwContext* createOwnDevice(Host& host) {
    FwContextDef def = fwDefaultContextDef();
    def.callbacks = host.callbacks();
    FwContext* context = nullptr;
    FwErrorInfo error{};
    if (fwCreateContext(&def, &context, &error) == FW_OK) return context;
    EXPECT_EQ(FW_ERROR_UNSUPPORTED_DEVICE, error.result) << error.message;
    EXPECT_EQ(0, host.blocks);
    if (std::getenv("FLAMEWRIGHT_REQUIRE_GPU")) ADD_FAILURE() << "no device: " << error.message;
    return nullptr;
}

#define OWN_DEVICE_OR_SKIP(name, host)       \
    FwContext* name = createOwnDevice(host); \
    if (!name) GTEST_SKIP() << "no Vulkan device"

struct DeviceSession {
    uint64_t hash = 0, tick = 0, steps = 0;
    std::vector<FwEvent> events;
    FwPointState point{};
};

// One session for any backend: gusts, a pose, water, a second object that is created and destroyed.
DeviceSession play(FwContext* context) {
    DeviceSession run;
    FwWorldDef worldDef = fwDefaultWorldDef();
    worldDef.paceFactor = 4;
    FwWorld* world = nullptr;
    EXPECT_EQ(FW_OK, fwCreateWorld(context, &worldDef, &world)) << lastMessage(context);
    if (!world) return run;
    const host::Sheet sheet(0.8f, 0.4f, 3);
    FwMeshDef meshDef = sheet.def(64);
    meshDef.noiseAmplitude = 0.15f;
    const FwMeshId mesh = created(fwWorld_CreateMesh, world, meshDef);
    FwMaterialDef paper = materialOf(FW_MATERIAL_PAPER);
    const FwMaterialId material = created(fwWorld_CreateMaterial, world, paper);
    FwBurnableMeshDef def = fwDefaultBurnableMeshDef();
    def.mesh = mesh;
    def.materials[0] = material;
    FwBurnableMeshId object{}, other{};
    EXPECT_EQ(FW_OK, fwWorld_CreateBurnableMesh(world, &def, &object)) << lastMessage(world);
    const float point[3] = {0.4f, 0, 0.2f};
    EXPECT_EQ(FW_OK, fwWorld_TagPoint(world, object, point, 3));
    const auto ball = [&](uint32_t kind, float x, float radius, float delay) {
        FwIgnitionDef ignition = fwDefaultIgnitionDef();
        ignition.kind = kind;
        ignition.position[0] = x;
        ignition.position[2] = 0.2f;
        ignition.radius = radius;
        ignition.delay = delay;
        EXPECT_EQ(FW_OK, fwWorld_Ignite(world, &ignition, nullptr)) << lastMessage(world);
    };
    ball(FW_IGNITE, 0.1f, 0.03f, 0);
    ball(FW_WET, 0.6f, 0.05f, 0.3f);
    ball(FW_DRY, 0.6f, 0.1f, 2.0f);
    ball(FW_EXTINGUISH, 0.15f, 0.05f, 1.1f);
    ball(FW_IGNITE, 0.7f, 0.02f, 2.2f);
    for (int frame = 0; frame < 120; ++frame) {
        if (frame % 20 == 3) {
            const float wind[3] = {float(frame % 7) - 2.0f, 0, float(frame % 3) - 1.0f};
            EXPECT_EQ(FW_OK, fwWorld_SetWind(world, wind));
        }
        if (frame == 50) {
            const float tilted[16] = {0.8f, 0.6f, 0, 0, -0.6f, 0.8f, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
            EXPECT_EQ(FW_OK, fwWorld_SetTransform(world, object, tilted));
        }
        if (frame == 30) {
            EXPECT_EQ(FW_OK, fwWorld_CreateBurnableMesh(world, &def, &other));
        }
        if (frame == 70) {
            EXPECT_EQ(FW_OK, fwWorld_DestroyBurnableMesh(world, other));
        }
        EXPECT_EQ(FW_OK, fwWorld_Step(world, 1.0f / 32)) << lastMessage(world);
    }
    FwQueryId query{};
    EXPECT_EQ(FW_OK, fwWorld_RequestPoint(world, object, point, &query));
    EXPECT_EQ(FW_OK, fwDebug_RequestBurnMap(world, object));
    run.point.structSize = sizeof run.point;
    FwResult map = FW_NOT_READY, answer = FW_NOT_READY;
    for (int i = 0; i < 8 && (map != FW_OK || answer != FW_OK); ++i) {
        if (map != FW_OK)
            map = fwDebug_FetchBurnMap(world, object, nullptr, 0, nullptr, &run.hash, &run.tick);
        if (answer != FW_OK) answer = fwWorld_FetchPoint(world, query, &run.point);
        EXPECT_EQ(FW_OK, fwWorld_Step(world, 0));
    }
    EXPECT_EQ(FW_OK, map);
    EXPECT_EQ(FW_OK, answer);
    const FwWorldStats stats = getState(fwWorld_GetStats, world);
    run.steps = stats.steps;
    run.events.resize(64);
    run.events.resize(fwWorld_PollEvents(world, run.events.data(), 64));
    fwDestroyWorld(world);
    return run;
}

TEST(OwnDevice, BurnsLikeTheCpu) {
    Host gpu, cpu;
    OWN_DEVICE_OR_SKIP(context, gpu);
    FwContext* reference = host::createCpuContext(cpu);
    const DeviceSession a = play(context), b = play(reference);
    EXPECT_EQ(b.hash, a.hash);
    EXPECT_EQ(b.tick, a.tick);
    EXPECT_EQ(120u * 128, a.tick);
    EXPECT_EQ(b.point.kind, a.point.kind);
    EXPECT_EQ(b.point.age, a.point.age);
    ASSERT_EQ(b.events.size(), a.events.size());
    for (size_t i = 0; i < a.events.size(); ++i) {
        EXPECT_EQ(b.events[i].type, a.events[i].type);
        EXPECT_EQ(b.events[i].tag, a.events[i].tag);
        EXPECT_EQ(b.events[i].value, a.events[i].value);
    }
    EXPECT_TRUE(gpu.errors.empty()) << gpu.lastError;
    fwDestroyContext(reference);
    fwDestroyContext(context);
    EXPECT_EQ(0, gpu.blocks);
    EXPECT_EQ(0, gpu.bytes);
}

// The lights of a young fire after eight steps, without a picture.
std::vector<FwLight> lightsOf(FwContext* context) {
    FwWorld* world = nullptr;
    const FwWorldDef worldDef = fwDefaultWorldDef();
    EXPECT_EQ(FW_OK, fwCreateWorld(context, &worldDef, &world)) << lastMessage(context);
    const host::Sheet sheet(0.8f, 0.4f, 3);
    (void)host::addBurnable(world, sheet.def(64), fwDefaultMaterialDef());
    FwIgnitionDef ignition = fwDefaultIgnitionDef();
    ignition.position[0] = 0.4f;
    ignition.position[2] = 0.2f;
    ignition.radius = 0.15f;
    EXPECT_EQ(FW_OK, fwWorld_Ignite(world, &ignition, nullptr));
    for (int i = 0; i < 8; ++i) EXPECT_EQ(FW_OK, fwWorld_Step(world, 1.0f / 32));
    std::vector<FwLight> lights(64);
    lights.resize(fwWorld_GetLights(world, lights.data(), 64));
    fwDestroyWorld(world);
    return lights;
}

TEST(OwnDevice, LightsWithoutAPictureMatchTheCpu) {
    Host gpu, cpu;
    OWN_DEVICE_OR_SKIP(context, gpu);
    FwContext* reference = host::createCpuContext(cpu);
    const std::vector<FwLight> a = lightsOf(context), b = lightsOf(reference);
    ASSERT_FALSE(a.empty());
    ASSERT_FALSE(b.empty());
    // Each backend clusters its own lights: the sums agree but for flicker, at most 22 %.
    double power[2] = {}, intensity[2] = {};
    for (int side = 0; side < 2; ++side)
        for (const FwLight& light : side == 0 ? a : b) {
            power[side] += double(light.power);
            intensity[side] += double(light.intensity);
            EXPECT_NEAR(1.0, double(light.intensity / light.power) / (0.3 / 12.566), 0.23);
            for (int i = 0; i < 3; ++i) EXPECT_FLOAT_EQ(b[0].color[i], light.color[i]);
            EXPECT_NEAR(0.4f, light.position[0], 0.3f);
            EXPECT_NE(0u, light.id);
        }
    EXPECT_NEAR(power[1], power[0], 0.1 * power[1]);
    EXPECT_NEAR(intensity[1], intensity[0], 0.3 * intensity[1]);
    std::printf("           %.0f W and %.0f W/sr, cpu %.0f W and %.0f W/sr\n", power[0],
                intensity[0], power[1], intensity[1]);
    fwDestroyContext(reference);
    fwDestroyContext(context);
    EXPECT_EQ(0, gpu.blocks);
}

TEST(OwnDevice, RefusesHostDeviceCallsAndInvalidPictures) {
    Host host;
    OWN_DEVICE_OR_SKIP(context, host);
    const FwContextInfo info = getState(fwContext_GetInfo, context);
    EXPECT_EQ(uint32_t(FW_BACKEND_VULKAN), info.backend);
    EXPECT_EQ(1u, info.ownDevice);
    EXPECT_LT(0u, std::strlen(info.deviceName));
    FwWorld* world = nullptr;
    const FwWorldDef worldDef = fwDefaultWorldDef();
    ASSERT_EQ(FW_OK, fwCreateWorld(context, &worldDef, &world)) << lastMessage(context);
    const FwVulkanFrame frame = fwDefaultVulkanFrame();
    const FwView view = fwDefaultView();
    EXPECT_EQ(FW_ERROR_WRONG_BACKEND, fwWorld_RecordOutside(world, &frame, &view));

    FwOffscreenDef def = fwDefaultOffscreenDef();
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_RenderOffscreen(world, &def));
    EXPECT_NE(std::string::npos, lastMessage(world).find("pixels is null"));
    std::vector<uint32_t> pixels(64 * 64);
    def.pixels = pixels.data();
    for (const uint32_t bad : {0u, 8193u}) {
        FwOffscreenDef wrong = def;
        wrong.width = bad;
        EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_RenderOffscreen(world, &wrong));
    }
    def.width = def.height = 64;
    const auto refuse = [&](const char* name, const FwOffscreenDef& wrong) {
        EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_RenderOffscreen(world, &wrong)) << name;
        EXPECT_NE(std::string::npos, lastMessage(world).find(name)) << lastMessage(world);
    };
    const float nan = std::nanf("");
    FwOffscreenDef wrong = def;
    wrong.view.projection[5] = nan;
    refuse("projection[5]", wrong);
    wrong = def;
    wrong.view.view[3] = nan;
    refuse("view[3]", wrong);
    wrong = def;
    wrong.view.exposure = 0;
    refuse("exposure", wrong);
    wrong = def;
    wrong.view.sunDirection[0] = 7;
    refuse("sunDirection[0]", wrong);
    for (const float bad : {-1.0f, 8.5f, nan}) {
        wrong = def;
        wrong.view.haze = bad;
        refuse("FwOffscreenDef::view.haze is ", wrong);
    }
    wrong = def;
    wrong.view.reserved = 1;
    refuse("FwOffscreenDef::view.reserved is 1", wrong);
    wrong = def;
    wrong.background[1] = nan;
    refuse("background[1]", wrong);
    wrong = def;
    wrong.view.structSize = 3;
    EXPECT_EQ(FW_ERROR_VERSION, fwWorld_RenderOffscreen(world, &wrong));
    def.background[0] = 1;
    ASSERT_EQ(FW_OK, fwWorld_RenderOffscreen(world, &def)) << lastMessage(world);
    EXPECT_EQ(0xFF0000FFu, pixels[0]);  // red, opaque, sRGB
    def.width = def.height = 1;
    def.background[0] = 0;
    ASSERT_EQ(FW_OK, fwWorld_RenderOffscreen(world, &def)) << lastMessage(world);
    EXPECT_EQ(0xFF000000u, pixels[0]);
    // The passes of a picture are timed like those of a frame.
    FwFireEmitterDef emitter = fwDefaultFireEmitterDef();
    (void)created(fwWorld_CreateFireEmitter, world, emitter);
    ASSERT_EQ(FW_OK, fwWorld_Step(world, 0.1f));
    ASSERT_EQ(FW_OK, fwWorld_RenderOffscreen(world, &def));
    const FwContextInfo capable = getState(fwContext_GetInfo, context);
    FwPassTime times[64];
    const uint32_t count = std::min(fwDebug_GetPassTimes(world, times, 64), 64u);
    bool sorted = false;
    for (uint32_t i = 0; i < count; ++i)
        sorted |= std::string(times[i].name) == "flame_sort" && times[i].milliseconds > 0;
    EXPECT_EQ(capable.gpuTimers != 0, sorted);
    // After a loss nothing runs, and everything is still freed.
    fwContext_NotifyDeviceLost(context);
    EXPECT_EQ(FW_ERROR_DEVICE_LOST, fwWorld_Step(world, 0.1f));
    EXPECT_EQ(FW_ERROR_DEVICE_LOST, fwWorld_RenderOffscreen(world, &def));
    fwDestroyContext(context);
    EXPECT_EQ(0, host.blocks);
}

// One failure at every allocation of a world's life on a device; the second call must succeed.
TEST(OwnDevice, SurvivesOneFailureAtEveryAllocation) {
    Host host;
    OWN_DEVICE_OR_SKIP(context, host);
    ASSERT_EQ(FW_OK, fwContext_Prepare(context)) << lastMessage(context);
    const host::Sheet sheet(0.3f, 0.2f);
    uint32_t failures = 0;
    const auto session = [&](int64_t failAt) {
        const int64_t blocks = host.blocks;
        host.failAt = failAt < 0 ? -1 : host.allocations + failAt;
        const auto twice = [&](const auto& call) {
            FwResult result = call();
            if (result == FW_ERROR_OUT_OF_MEMORY) {
                ++failures;
                result = call();
            }
            EXPECT_EQ(FW_OK, result) << "at " << failAt << ": " << host.lastError;
        };
        FwWorld* world = nullptr;
        const FwWorldDef worldDef = fwDefaultWorldDef();
        twice([&] { return fwCreateWorld(context, &worldDef, &world); });
        const FwMeshDef meshDef = sheet.def(40);
        FwMeshId mesh{};
        twice([&] { return fwWorld_CreateMesh(world, &meshDef, &mesh); });
        const FwMaterialDef materialDef = ::host::evenMaterial(0.05f, 0.4f);
        FwMaterialId material{};
        twice([&] { return fwWorld_CreateMaterial(world, &materialDef, &material); });
        const uint32_t pixels[4] = {};
        FwImageDef imageDef = fwDefaultImageDef();
        imageDef.width = imageDef.height = 2;
        imageDef.pixels = pixels;
        FwImageId image{};
        twice([&] { return fwWorld_CreateImage(world, &imageDef, &image); });
        FwBurnableMeshDef def = fwDefaultBurnableMeshDef();
        def.mesh = mesh;
        def.materials[0] = material;
        def.baseColor = image;
        FwBurnableMeshId object{};
        twice([&] { return fwWorld_CreateBurnableMesh(world, &def, &object); });
        FwIgnitionDef ignition = fwDefaultIgnitionDef();
        ignition.radius = 0.05f;
        twice([&] { return fwWorld_Ignite(world, &ignition, nullptr); });
        for (int i = 0; i < 6; ++i) twice([&] { return fwWorld_Step(world, 1.0f / 32); });
        const FwObjectState state = getState(fwWorld_GetObjectState, world, object);
        EXPECT_LT(0u, state.ignited) << "at " << failAt;
        host.failAt = -1;
        fwDestroyWorld(world);
        if (failAt >= 0) {
            EXPECT_EQ(blocks, host.blocks) << "at " << failAt;
        }
    };
    session(-1);  // lets the context's own lists grow first
    const int64_t first = host.allocations;
    session(-1);
    const int64_t allocations = host.allocations - first;
    for (int64_t at = 0; at < allocations && !HasFailure(); ++at) session(at);
    EXPECT_LT(allocations / 2, int64_t(failures));
    fwDestroyContext(context);
    EXPECT_EQ(0, host.blocks);
}

TEST(OwnDevice, RefusesATooSmallBudget) {
    Host host;
    OWN_DEVICE_OR_SKIP(context, host);
    fwDestroyContext(context);
    FwContextDef def = fwDefaultContextDef();
    def.callbacks = host.callbacks();
    def.gpuMemoryBudget = 4096;
    FwErrorInfo error{};
    const FwResult result = fwCreateContext(&def, &context, &error);
    if (result == FW_OK) {  // the first world needs more
        FwWorld* world = nullptr;
        const FwWorldDef worldDef = fwDefaultWorldDef();
        EXPECT_EQ(FW_ERROR_OUT_OF_MEMORY, fwCreateWorld(context, &worldDef, &world));
        EXPECT_NE(std::string::npos, lastMessage(context).find("4096")) << lastMessage(context);
        fwDestroyContext(context);
    } else {
        EXPECT_EQ(FW_ERROR_OUT_OF_MEMORY, result) << error.message;
    }
    EXPECT_EQ(0, host.blocks);
}

}  // namespace
