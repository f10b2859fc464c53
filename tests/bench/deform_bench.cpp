// Cost of deformation per frame at 60 Hz: the sum of the passes' timers, for the bunny as a
// receding solid, as a sheet, and on the reference springs. cpu_ms: all threads of this process
// less a world without deformation. Needs FLAMEWRIGHT_ASSETS.
#include <benchmark/benchmark.h>

#include "bench/bunny_scene.h"
#include "flamewright_reference.h"

namespace {

using fw::test::BunnyScene;
using fw::test::cpuSeconds;

void deform(benchmark::State& state, const char* file, uint32_t flags) {
    BunnyScene scene, plain;
    FwWorldDef worldDef = fwDefaultWorldDef();
    worldDef.paceFactor = 40;
    worldDef.wind[0] = 1;
    const char* why = scene.make(file, flags, worldDef);
    if (!why) why = plain.make(file, 0, worldDef);
    if (why) {
        state.SkipWithError(why);
        return;
    }
    scene.light();
    plain.light();
    constexpr float kFrame = 1.0f / 60;
    constexpr const char* kPasses[] = {"recede",  "link_cache",   "soft",
                                       "springs", "skin_to_mesh", "inner"};
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
