// Cost of two views in one recording: a camp fire with smoke and a jet in both, each at 1280 x 720.
// Time: such a frame; twice_one_ms: two frames with one view; ratio: its processor time over
// theirs; not_given: a frame that draws both views but is recorded for the first only.
#include <benchmark/benchmark.h>

#include "bench/composite_host.h"

namespace {

const char* makeFires(fw::test::CompositeHost& host, FwTargetId& target) {
    if (const char* why = host.make(fwDefaultWorldDef())) return why;
    FwVolumetricFireDef fire = fwDefaultVolumetricFireDef();
    fwInitFirePreset(&fire, FW_FIRE_CAMP);
    FwVolumetricFireId id{};
    FwFireEmitterDef jet = fwDefaultFireEmitterDef();
    jet.position[0] = 0.8f;
    FwFireEmitterId emitter{};
    target = host.target(FW_TARGET_NO_SURFACES);
    if (target.index1 == 0 || fwWorld_CreateVolumetricFire(host.world(), &fire, &id) != FW_OK ||
        fwWorld_CreateFireEmitter(host.world(), &jet, &emitter) != FW_OK)
        return "no fires";
    const glm::vec3 at(0.3f, 0.7f, 0);
    host.look(at + glm::vec3(0.064f, 0, 5), at, 4);
    host.second() = host.view();
    host.second().viewId = 1;
    host.look(at - glm::vec3(0, 0, 5), at, 4);
    return nullptr;
}

void drawViews(benchmark::State& state) {
    fw::test::CompositeHost host;
    FwTargetId target{};
    if (const char* why = makeFires(host, target)) {
        state.SkipWithError(why);
        return;
    }
    struct Cost {
        double wall = 0, cpu = 0;  // s, of all threads
    };
    Cost one, two, notGiven;
    double last = 0;
    const auto frame = [&](uint32_t drawn, uint32_t given, Cost& cost) {
        double wall = 0, cpu = 0;
        host.drawnViews = drawn;
        host.givenViews = given;
        const bool there = host.frame(target, 1 / 90.0f, wall, cpu);
        cost.wall += wall, cost.cpu += cpu;
        last = wall;
        return there;
    };
    const auto all = [&] {
        const bool there = frame(1, 1, one) && frame(2, 1, notGiven);
        return frame(2, 2, two) && there;
    };
    for (int i = 0; i < 20; ++i) {  // pipelines are compiled at first use, and fires grow
        if (all()) continue;
        state.SkipWithError("a frame was not drawn");
        return;
    }
    one = two = notGiven = {};
    for (auto _ : state) {
        all();
        state.SetIterationTime(last);
    }
    state.counters["twice_one_ms"] = 2e3 * one.wall / double(state.iterations());
    state.counters["ratio"] = two.cpu / (2 * one.cpu);
    state.counters["not_given"] = notGiven.cpu / (2 * one.cpu);
}

BENCHMARK(drawViews)
    ->Name("views/two/720p")
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime()
    ->Iterations(15);

}  // namespace
