// Cost per frame of a hundred burning low-poly houses: step, passes and draws of an offscreen
// picture down the street. Time: all threads of this process, because a software device draws on
// them.
//
// Counters per frame. step_ms: fire, lists, predictions. draw_ms: every second picture, drawn again
// with nothing moved. refine_ms: the additional cost of the first. triangles: mean refined
// triangles; budget: their limit; refine_us_per_1000: refine_ms per thousand, which turns a time
// into a budget (plugin/docs/integration.md). plain_...: the same street without refinement,
// interleaved; ratio: to that. wall_ms: by the clock. refine_...: the device's timers.
#include "bench/bench_device.h"
#include "support/houses.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <map>
#include <string>

namespace fw::test::houses_bench {
namespace {

constexpr uint32_t kWidth = 640, kHeight = 360, kBudget = 60000;
constexpr float kFrameTime = 1.0f / 60, kWarmUp = 6;  // s
constexpr int kFrames = 60;

struct Costs {
    double all = 0, step = 0, draw = 0, triangles = 0, wall = 0;
};

struct Street {
    FwContext* context = nullptr;
    Village village;
    std::vector<uint8_t> pixels = std::vector<uint8_t>(size_t{kWidth} * kHeight * 4);
    std::map<std::string, double> passes;  // ms, of every second frame
    float way = 0;                         // m
    bool again = false;                    // the last frame was drawn twice

    ~Street() {
        fwDestroyWorld(std::exchange(village.world, nullptr));
        fwDestroyContext(context);
    }
    void draw() {
        FwOffscreenDef shot = fwDefaultOffscreenDef();
        shot.width = kWidth;
        shot.height = kHeight;
        shot.pixels = pixels.data();
        shot.view =
            streetView({0, 2.5f, 8 - way}, {2.0f, 1.2f, -4 - way}, float(kWidth) / float(kHeight));
        fwWorld_RenderOffscreen(village.world, &shot);
    }
    // Returns null on success.
    const char* make(bool refined) {
        constexpr uint32_t houses = 100;
        const FwContextDef def = fwDefaultContextDef();
        FwErrorInfo info{};
        if (fwCreateContext(&def, &context, &info) != FW_OK) return "there is no device";
        if (!village.make(context, houses, kBudget, 8, refined)) return "the houses cannot be made";
        for (float t = 0; t < kWarmUp; t += 0.25f) {
            fwWorld_Step(village.world, 0.25f);
            if (t < 2) draw();
        }
        return village.stats().burningObjects == houses ? nullptr : "not all of them burn";
    }
    // Of the previous frame if it was drawn once.
    void notePasses() {
        FwPassTime times[64];
        const uint32_t count = std::min(fwDebug_GetPassTimes(village.world, times, 64), 64u);
        for (uint32_t i = 0; i < count; ++i) passes[times[i].name] += 2 * times[i].milliseconds;
    }
    Costs frame() {
        Costs c;
        const Clock::time_point from = Clock::now();
        const double start = cpuSeconds();
        fwWorld_Step(village.world, kFrameTime);
        const double stepped = cpuSeconds();
        if (!again) notePasses();
        draw();
        const double drawn = cpuSeconds();
        c.wall = secondsSince(from);
        again = !again;
        if (again) draw();
        c.step = stepped - start;
        c.draw = again ? 2 * (cpuSeconds() - drawn) : 0;  // of every second frame
        c.all = drawn - start;
        c.triangles = village.stats().refinedTriangles;
        way += 4 * kFrameTime;
        return c;
    }
};

void houses(benchmark::State& state) {
    Street refined, plain;
    for (Street* street : {&plain, &refined})
        if (const char* why = street->make(street == &refined)) return state.SkipWithError(why);
    Costs sum, bare;
    const auto add = [](Costs& to, const Costs& c) {
        to.step += c.step;
        to.all += c.all;
        to.draw += c.draw;
        to.triangles += c.triangles;
        to.wall += c.wall;
    };
    for (auto _ : state) {
        add(bare, plain.frame());
        const Costs c = refined.frame();
        add(sum, c);
        state.SetIterationTime(c.all);
    }
    const double frames = double(state.iterations());
    state.counters["step_ms"] = 1e3 * sum.step / frames;
    state.counters["refine_ms"] = 1e3 * (sum.all - sum.step - sum.draw) / frames;
    state.counters["draw_ms"] = 1e3 * sum.draw / frames;
    state.counters["triangles"] = sum.triangles / frames;
    state.counters["budget"] = kBudget;
    state.counters["refine_us_per_1000"] =
        1e9 * (sum.all - sum.step - sum.draw) / std::max(sum.triangles, 1.0);
    state.counters["wall_ms"] = 1e3 * sum.wall / frames;
    state.counters["plain_ms"] = 1e3 * bare.all / frames;
    state.counters["plain_draw_ms"] = 1e3 * bare.draw / frames;
    state.counters["ratio"] = sum.all / bare.all;
    for (const auto& [name, ms] : refined.passes)
        if (name.starts_with("refine")) state.counters[name] = ms / frames;
}

// The street with a budget of three fifths of its frame time: how soon detail settles, and the time
// and triangles left then. By the device's timers.
void budget(benchmark::State& state) {
    constexpr int kFree = 40;
    Street street;
    if (const char* why = street.make(true)) return state.SkipWithError(why);
    FwBudgetState at{};
    at.structSize = sizeof at;
    const auto frame = [&] {
        fwWorld_Step(street.village.world, kFrameTime);
        street.draw();
        fwWorld_GetBudgetState(street.village.world, &at);
    };
    for (int i = 0; i < kFree; ++i) frame();
    const float free = at.gpuMilliseconds;
    const uint32_t triangles = street.village.stats().refinedTriangles;
    FwBudgetDef def = fwDefaultBudgetDef();
    def.gpuMilliseconds = 0.6f * free;
    fwWorld_SetBudget(street.village.world, &def);
    int settled = 0, frames = 0;
    for (auto _ : state) {
        const uint32_t before = at.level;
        const double start = cpuSeconds();
        frame();
        state.SetIterationTime(cpuSeconds() - start);
        ++frames;
        if (at.level != before) settled = frames;
    }
    state.counters["free_ms"] = double(free);
    state.counters["budget_ms"] = double(def.gpuMilliseconds);
    state.counters["held_ms"] = double(at.gpuMilliseconds);
    state.counters["level"] = at.level;
    state.counters["settled_after"] = settled;
    state.counters["triangles_free"] = triangles;
    state.counters["triangles"] = street.village.stats().refinedTriangles;
}

BENCHMARK(budget)
    ->Name("houses100/budget")
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime()
    ->Iterations(140);

BENCHMARK(houses)
    ->Name("houses100/frame")
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime()
    ->Iterations(kFrames);

}  // namespace
}  // namespace fw::test::houses_bench
