// Cost of particle fields. field/64x64x64: a step of 64 fields of 64 x 64 cells, a third of each
// preset, after one second; wall time and cpu_ms of the process, measured over a second of steps.
// field/draw_*: an offscreen picture of plain ground, and with a field over part of it; `ratio`:
// its CPU time over that of the ground, interleaved.
#include <benchmark/benchmark.h>

#include "bench/bench_device.h"
#include "flamewright/flamewright.h"

#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <cstring>
#include <vector>

namespace {

struct World {
    FwContext* context = nullptr;
    FwWorld* world = nullptr;
    World() {
        const FwContextDef contextDef = fwDefaultContextDef();
        FwWorldDef def = fwDefaultWorldDef();
        def.maxStepsPerFrame = 64;
        def.maxFlames = 0;
        FwErrorInfo info{};
        if (fwCreateContext(&contextDef, &context, &info) != FW_OK) return;
        fwCreateWorld(context, &def, &world);
    }
    World(const World&) = delete;
    World& operator=(const World&) = delete;
    ~World() {
        fwDestroyWorld(world);
        fwDestroyContext(context);
    }
};

void stepFields(benchmark::State& state) {
    World w;
    if (!w.world) {
        state.SkipWithError("no device");
        return;
    }
    uint64_t bytes = 0;
    for (uint32_t i = 0; i < 64; ++i) {
        FwParticleFieldDef def = fwDefaultParticleFieldDef();
        fwInitFieldPreset(&def, i % FW_FIELD_PRESET_COUNT);
        FwParticleFieldId id{};
        fwWorld_CreateParticleField(w.world, &def, &id);
        FwParticleFieldState field{};
        field.structSize = sizeof field;
        fwWorld_GetParticleFieldState(w.world, id, &field);
        bytes = field.bytes;
    }
    for (int i = 0; i < 2; ++i) fwWorld_Step(w.world, 1.0f);
    constexpr double kSteps = 24;  // per second
    double cpu = 0, least = 1e9;
    for (auto _ : state) {
        const fw::test::Clock::time_point start = fw::test::Clock::now();
        const double before = fw::test::cpuSeconds();
        fwWorld_Step(w.world, 1.0f);
        const double spent = (fw::test::cpuSeconds() - before) / kSteps;
        cpu += spent;
        least = std::min(least, spent);
        state.SetIterationTime(fw::test::secondsSince(start) / kSteps);
    }
    state.counters["cpu_ms"] = 1e3 * cpu / double(state.iterations());
    state.counters["cpu_least_ms"] = 1e3 * least;
    state.counters["field_KiB"] = double(bytes) / 1024;
}
BENCHMARK(stepFields)
    ->Name("field/64x64x64")
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime()
    ->Iterations(5);

constexpr uint32_t kWidth = 1280, kHeight = 720;

struct Picture {
    explicit Picture(World& on) : w(on), pixels(size_t{kWidth} * kHeight * 4) {
        const float places[12] = {-6, 0, -6, 6, 0, -6, 6, 0, 6, -6, 0, 6};
        const uint32_t corners[6] = {0, 2, 1, 0, 3, 2};
        FwMeshDef mesh = fwDefaultMeshDef();
        mesh.positions = places;
        mesh.vertexCount = 4;
        mesh.indices = corners;
        mesh.indexCount = 6;
        mesh.indexSize = 4;
        mesh.texelsPerMetre = 4;
        FwBurnableMeshDef ground = fwDefaultBurnableMeshDef();
        FwMaterialDef material = fwDefaultMaterialDef();
        fwInitMaterialPreset(&material, FW_MATERIAL_NONCOMBUSTIBLE);
        fwWorld_CreateMesh(w.world, &mesh, &ground.mesh);
        fwWorld_CreateMaterial(w.world, &material, &ground.materials[0]);
        FwBurnableMeshId id{};
        fwWorld_CreateBurnableMesh(w.world, &ground, &id);
        const glm::mat4 view =
            glm::lookAt(glm::vec3(0, 2.2f, 4.2f), glm::vec3(0, 0.6f, 0), glm::vec3(0, 1, 0));
        glm::mat4 projection(0.0f);
        projection[0][0] = 1.8f * float(kHeight) / float(kWidth);
        projection[1][1] = -1.8f;
        projection[2][2] = projection[2][3] = -1.0f;
        projection[3][2] = -0.05f;
        shot.width = kWidth;
        shot.height = kHeight;
        shot.pixels = pixels.data();
        shot.view = fwDefaultView();
        std::memcpy(shot.view.view, glm::value_ptr(view), sizeof shot.view.view);
        std::memcpy(shot.view.projection, glm::value_ptr(projection), sizeof shot.view.projection);
    }
    struct Cost {
        double wall = 0, cpu = 0;  // s
    };
    Cost take() {
        const fw::test::Clock::time_point start = fw::test::Clock::now();
        const double before = fw::test::cpuSeconds();
        fwWorld_RenderOffscreen(w.world, &shot);
        return {fw::test::secondsSince(start), fw::test::cpuSeconds() - before};
    }
    World& w;
    std::vector<uint8_t> pixels;
    FwOffscreenDef shot = fwDefaultOffscreenDef();
};

// preset FW_FIELD_PRESET_COUNT: the ground alone.
void drawField(benchmark::State& state, uint32_t preset) {
    World w;
    if (!w.world) {
        state.SkipWithError("no device");
        return;
    }
    Picture picture(w);
    FwParticleFieldId id{};
    if (preset < FW_FIELD_PRESET_COUNT) {
        FwParticleFieldDef def = fwDefaultParticleFieldDef();
        fwInitFieldPreset(&def, preset);
        def.shape = FW_FIELD_SPHEROID;
        def.width = def.height = preset == FW_FIELD_FIRE ? 32 : 64;
        def.sourceSize = 1;
        def.size[0] = def.size[1] = def.size[2] = 2;
        fwWorld_CreateParticleField(w.world, &def, &id);
    }
    fwWorld_Step(w.world, 2.0f);
    const auto hide = [&](uint32_t hidden) {
        if (id.index1) fwWorld_SetParticleFieldHidden(w.world, id, hidden);
        fwWorld_Step(w.world, 0.01f);
    };
    for (int i = 0; i < 2; ++i) {  // pipelines are compiled at first use
        hide(1), picture.take();
        hide(0), picture.take();
    }
    double with = 0, without = 0;
    for (auto _ : state) {
        hide(1);
        without += picture.take().cpu;
        hide(0);
        const Picture::Cost cost = picture.take();
        with += cost.cpu;
        state.SetIterationTime(cost.wall);
    }
    state.counters["cpu_ms"] = 1e3 * with / double(state.iterations());
    state.counters["ratio"] = with / without;
}
#define FW_FIELD_ROW(name, preset)             \
    BENCHMARK_CAPTURE(drawField, name, preset) \
        ->Name("field/draw_" #name)            \
        ->Unit(benchmark::kMillisecond)        \
        ->UseManualTime()                      \
        ->Iterations(9)
FW_FIELD_ROW(ground, FW_FIELD_PRESET_COUNT);
FW_FIELD_ROW(fire, FW_FIELD_FIRE);
FW_FIELD_ROW(smoke, FW_FIELD_SMOKE);
FW_FIELD_ROW(water, FW_FIELD_WATER);

}  // namespace
