// Cost of the surface pass: the bunny, half burnt, on some 30 % of a 1280 x 720 picture. Time: an
// offscreen picture with it, submitted and waited for, less one where it is hidden, interleaved; no
// flames. cpu_ms: the same for all threads of this process.
#include <benchmark/benchmark.h>

#include "bench/bunny_scene.h"

#include <algorithm>

namespace {

using fw::test::BunnyPicture;
using fw::test::BunnyScene;

void drawSurface(benchmark::State& state, float burntFraction) {
    BunnyScene scene;
    FwWorldDef worldDef = fwDefaultWorldDef();
    worldDef.paceFactor = 200;
    worldDef.maxStepsPerFrame = 32;
    const char* why = scene.make("bunny_31k.glb", 0, worldDef);
    if (!why && burntFraction > 0) why = scene.burnUntil(burntFraction);
    if (why) {
        state.SkipWithError(why);
        return;
    }
    BunnyPicture picture;
    double cpu = 0, least = 1e9;
    const auto surface = [&] {
        const BunnyPicture::Cost without = picture.take(scene, true);
        const BunnyPicture::Cost with = picture.take(scene, false);
        cpu += with.cpu - without.cpu;
        least = std::min(least, with.cpu - without.cpu);
        return std::max(with.wall - without.wall, 1e-6);
    };
    for (int i = 0; i < 3; ++i) surface();  // pipelines are compiled at first use
    cpu = 0;
    least = 1e9;
    for (auto _ : state) {
        state.SetIterationTime(surface());
    }
    state.counters["cpu_least_ms"] = 1e3 * least;
    state.counters["cpu_ms"] = 1e3 * cpu / double(state.iterations());
    state.counters["covered"] = picture.covered();
}

BENCHMARK_CAPTURE(drawSurface, half, 0.5f)
    ->Name("surface/bunny31k/720p")
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime()
    ->Iterations(15);
BENCHMARK_CAPTURE(drawSurface, fresh, 0.0f)
    ->Name("surface/bunny31k_fresh/720p")
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime()
    ->Iterations(15);

}  // namespace
