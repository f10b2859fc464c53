// Cost of keeping walls from intersecting, for the deforming bunny of surface_bench. A turn is four
// frames, each a step of 1/60 s and a picture: hidden, two without any measure (their difference is
// noise_pct), and between them one with the row's measure. Of the least process time: surface_ms is
// without measure less hidden; added_ms and added_pct are the measure's cost.
// none: FW_BURNABLE_RECEDE without bounds; product: FW_BURNABLE_RECEDE; published:
// FW_BURNABLE_SPRINGS | FW_BURNABLE_DEPTH_PEEL; undone: camera-facing walls only
#include <benchmark/benchmark.h>

#include "bench/bunny_scene.h"
#include "flamewright_reference.h"

#include <algorithm>

namespace {

using fw::test::BunnyPicture;
using fw::test::BunnyScene;
using fw::test::median;

constexpr uint32_t kNoHandling = FW_DEBUG_SELF_INTERSECTION | FW_DEBUG_NO_DEPTH_PEEL;

void selfcross(benchmark::State& state, uint32_t flags, uint32_t switches) {
    BunnyScene scene;
    FwWorldDef worldDef = fwDefaultWorldDef();
    worldDef.paceFactor = 200;
    worldDef.maxStepsPerFrame = 32;
    const char* why = scene.make("bunny_31k.glb", flags, worldDef);
    if (!why) why = scene.burnUntil(0.5f);
    if (why) {
        state.SkipWithError(why);
        return;
    }
    BunnyPicture picture;
    std::vector<double> hiddens, undone, ways, noise;  // ms of process time
    const auto frame = [&](bool hidden, uint32_t with) {
        fwDebug_SetSwitches(scene.world, with);
        return picture.take(scene, hidden, 1.0f / 60, true);
    };
    const auto turn = [&] {
        const BunnyPicture::Cost without = frame(true, kNoHandling);
        const BunnyPicture::Cost a = frame(false, kNoHandling);
        const BunnyPicture::Cost way = frame(false, switches);
        const BunnyPicture::Cost b = frame(false, kNoHandling);
        hiddens.push_back(1e3 * without.cpu);
        undone.push_back(1e3 * std::min(a.cpu, b.cpu));
        ways.push_back(1e3 * way.cpu);
        noise.push_back(1e3 * std::abs(a.cpu - b.cpu));
        return std::max(way.wall - without.wall, 1e-6);
    };
    for (int i = 0; i < 3; ++i) turn();  // pipelines are compiled at first use
    for (std::vector<double>* all : {&hiddens, &undone, &ways, &noise}) all->clear();
    for (auto _ : state) state.SetIterationTime(turn());
    const auto least = [](const std::vector<double>& of) {
        return *std::min_element(of.begin(), of.end());
    };
    const double base = least(undone) - least(hiddens), added = least(ways) - least(undone);
    state.counters["surface_ms"] = base;
    state.counters["added_ms"] = added;
    state.counters["added_pct"] = 100 * added / base;
    state.counters["noise_pct"] = 100 * median(noise) / base;
}

BENCHMARK_CAPTURE(selfcross, none, FW_BURNABLE_RECEDE, kNoHandling)
    ->Name("selfcross/none")
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime()
    ->Iterations(15);
BENCHMARK_CAPTURE(selfcross, product, FW_BURNABLE_RECEDE, 0)
    ->Name("selfcross/product")
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime()
    ->Iterations(15);
BENCHMARK_CAPTURE(selfcross, published, FW_BURNABLE_SPRINGS | FW_BURNABLE_DEPTH_PEEL, 0)
    ->Name("selfcross/published")
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime()
    ->Iterations(15);

}  // namespace
