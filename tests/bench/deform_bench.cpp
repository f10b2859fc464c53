// What deformation costs a frame at 60 Hz: the passes' own timers, summed, over the bunny as a
// solid that recedes, as a sheet, and on the published springs. cpu_ms: of all this process's
// threads, less that of a world without deformation. Rows need FLAMEWRIGHT_ASSETS.
#include <benchmark/benchmark.h>

#include "flamewright/flamewright.h"
#include "flamewright/flamewright_debug.h"
#include "support/meshes.h"

#include <cstring>
#include <ctime>
#include <string>

namespace {

struct Scene {
    FwContext* context = nullptr;
    FwWorld* world = nullptr;
    FwBurnableMeshId object{};
    ~Scene() {
        fwDestroyWorld(world);
        fwDestroyContext(context);
    }
};

// Null text: fine.
const char* build(Scene& scene, const char* file, uint32_t flags, std::string& error) {
    fw::test::Mesh mesh;
    if (!fw::test::loadGlb(file, mesh, error)) return error.c_str();
    const FwContextDef contextDef = fwDefaultContextDef();
    FwErrorInfo info{};
    if (fwCreateContext(&contextDef, &scene.context, &info) != FW_OK) {
        error = info.message;
        return error.c_str();
    }
    FwWorldDef worldDef = fwDefaultWorldDef();
    worldDef.paceFactor = 40;
    worldDef.maxFlames = 0;
    worldDef.wind[0] = 1;
    FwMeshDef meshDef = fwDefaultMeshDef();
    meshDef.positions = mesh.positions.data();
    meshDef.uvs = mesh.uvs.empty() ? nullptr : mesh.uvs.data();
    meshDef.indices = mesh.indices.data();
    meshDef.vertexCount = mesh.vertexCount();
    meshDef.indexCount = uint32_t(mesh.indices.size());
    FwBurnableMeshDef objectDef = fwDefaultBurnableMeshDef();
    objectDef.flags = flags;
    const FwPin pin = {{0, 0.9f, 0}, {0, 0.9f, 0}, 0.1f, 0};
    objectDef.pins = &pin;
    objectDef.pinCount = 1;
    FwMaterialDef pine = fwDefaultMaterialDef();
    FwIgnitionDef match = fwDefaultIgnitionDef();
    match.position[0] = -0.3f;
    match.position[1] = 0.3f;
    match.position[2] = 0.3f;
    match.radius = 0.2f;
    if (fwCreateWorld(scene.context, &worldDef, &scene.world) != FW_OK ||
        fwWorld_CreateMesh(scene.world, &meshDef, &objectDef.mesh) != FW_OK ||
        fwWorld_CreateMaterial(scene.world, &pine, &objectDef.materials[0]) != FW_OK ||
        fwWorld_CreateBurnableMesh(scene.world, &objectDef, &scene.object) != FW_OK)
        return "the scene cannot be made";
    fwWorld_Ignite(scene.world, &match, nullptr);
    return nullptr;
}

double cpuSeconds() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

void deform(benchmark::State& state, const char* file, uint32_t flags) {
    Scene scene, plain;
    std::string error;
    const char* why = build(scene, file, flags, error);
    if (!why) why = build(plain, file, 0, error);
    if (why) {
        state.SkipWithError(why);
        return;
    }
    constexpr float kFrame = 1.0f / 60;
    constexpr const char* kPasses[] = {"recede", "bend", "soft", "springs", "drape"};
    double spent[std::size(kPasses)] = {};  // ms
    const auto passes = [&] {
        FwPassTime times[64];
        const uint32_t count = fwDebug_GetPassTimes(scene.world, times, 64);
        double sum = 0;
        for (uint32_t i = 0; i < count && i < 64; ++i)
            for (size_t pass = 0; pass < std::size(kPasses); ++pass) {
                if (std::strcmp(times[i].name, kPasses[pass]) != 0) continue;
                spent[pass] += times[i].milliseconds;
                sum += times[i].milliseconds;
            }
        return sum;
    };
    for (int i = 0; i < 20; ++i) {  // pipelines are compiled at first use
        fwWorld_Step(scene.world, kFrame);
        fwWorld_Step(plain.world, kFrame);
    }
    double cpu = 0;
    for (auto _ : state) {
        const double start = cpuSeconds();
        fwWorld_Step(scene.world, kFrame);
        const double middle = cpuSeconds();
        fwWorld_Step(plain.world, kFrame);
        cpu += (middle - start) - (cpuSeconds() - middle);
        state.SetIterationTime(std::max(passes(), 1e-6) * 1e-3);
    }
    for (size_t pass = 0; pass < std::size(kPasses); ++pass)
        if (spent[pass] > 0)
            state.counters[kPasses[pass]] = spent[pass] / double(state.iterations());
    state.counters["cpu_ms"] = 1e3 * cpu / double(state.iterations());
}

BENCHMARK_CAPTURE(deform, recession31k, "bunny_31k.glb", FW_BURNABLE_RECEDE)
    ->Name("deform/recession/31k")
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime()
    ->Iterations(60);
BENCHMARK_CAPTURE(deform, xpbd4k, "bunny_4k.glb", FW_BURNABLE_SHELL)
    ->Name("deform/xpbd/4k")
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime()
    ->Iterations(60);
BENCHMARK_CAPTURE(deform, xpbd31k, "bunny_31k.glb", FW_BURNABLE_SHELL)
    ->Name("deform/xpbd/31k")
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime()
    ->Iterations(60);
BENCHMARK_CAPTURE(deform, published4k, "bunny_4k.glb", FW_BURNABLE_SPRINGS)
    ->Name("deform/published/4k")
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime()
    ->Iterations(60);
BENCHMARK_CAPTURE(deform, published31k, "bunny_31k.glb", FW_BURNABLE_SPRINGS)
    ->Name("deform/published/31k")
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime()
    ->Iterations(60);

}  // namespace
