// Cost of heat haze: a camp fire's column over a 1280 x 720 picture whose colour the host provides,
// with and without haze, interleaved. Time: a picture with haze; ratio: its processor time over
// that without.
#include <benchmark/benchmark.h>

#include "bench/composite_host.h"

namespace {

const char* makeFire(fw::test::CompositeHost& host, FwTargetId& target) {
    FwWorldDef worldDef = fwDefaultWorldDef();
    worldDef.maxFlames = 0;
    if (const char* why = host.make(worldDef)) return why;
    FwVolumetricFireDef fire = fwDefaultVolumetricFireDef();
    fwInitFirePreset(&fire, FW_FIRE_CAMP);
    fire.flags = FW_FIRE_NO_SMOKE;
    FwVolumetricFireId id{};
    target = host.target(FW_TARGET_HAZE);
    if (target.index1 == 0 || fwWorld_CreateVolumetricFire(host.world(), &fire, &id) != FW_OK)
        return "no fire on a target with haze";
    const glm::vec3 at(0, 0.6f, 0);
    host.look(at + glm::vec3(0, 0, 5.5f), at, 4);
    return nullptr;
}

constexpr float kApart = 1 / 30.0f;  // s

void drawHaze(benchmark::State& state) {
    fw::test::CompositeHost host;
    FwTargetId target{};
    if (const char* why = makeFire(host, target)) {
        state.SkipWithError(why);
        return;
    }
    double with = 0, without = 0, cpuWith = 0, cpuWithout = 0;
    const auto both = [&] {
        double wall = 0, cpu = 0;
        host.view().haze = 0;
        if (!host.frame(target, kApart, wall, cpu)) return false;
        without = wall, cpuWithout += cpu;
        host.view().haze = 1;
        if (!host.frame(target, kApart, wall, cpu)) return false;
        with = wall, cpuWith += cpu;
        return true;
    };
    for (int i = 0; i < 20;
         ++i) {  // pipelines are compiled at first use, and haze builds up slowly
        if (both()) continue;
        state.SkipWithError("a frame was not drawn");
        return;
    }
    cpuWith = cpuWithout = 0;
    for (auto _ : state) {
        both();
        state.SetIterationTime(with);
    }
    state.counters["without_ms"] = 1e3 * without;
    state.counters["ratio"] = cpuWith / cpuWithout;
}

BENCHMARK(drawHaze)
    ->Name("volume/haze/720p")
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime()
    ->Iterations(15);

}  // namespace
