// What a hundred burning low-poly houses cost a frame. Time: of all this process's threads, as a
// software device draws on them: the step, the passes and the draws of an offscreen picture down
// the street.
//
// Counters, a frame: step_ms: fire, lists, predictions. refine_ms: a picture that looks past all of
// them (refinement's passes, and draws up to their pixels). draw_ms: what the street's picture
// costs beyond that. triangles: refined ones, in the mean. one_ms: of one house in the same street,
// in turns; ratio: to that.
#include "bench/bench_device.h"
#include "support/houses.h"

#include <benchmark/benchmark.h>

namespace fw::test {
namespace {

constexpr uint32_t kWidth = 640, kHeight = 360, kBudget = 60000;
constexpr float kFrameTime = 1.0f / 60, kWarmUp = 6;  // s
constexpr int kFrames = 60;

struct Costs {
    double step = 0, refine = 0, draw = 0, triangles = 0;
    [[nodiscard]] double all() const { return step + refine + draw; }
};

struct Street {
    FwContext* context = nullptr;
    Village village;
    std::vector<uint8_t> pixels = std::vector<uint8_t>(size_t{kWidth} * kHeight * 4);
    float way = 0;  // m

    ~Street() {
        fwDestroyWorld(std::exchange(village.world, nullptr));
        fwDestroyContext(context);
    }
    void draw(bool aside) {
        FwOffscreenDef shot = fwDefaultOffscreenDef();
        shot.width = kWidth;
        shot.height = kHeight;
        shot.pixels = pixels.data();
        shot.view = streetView({0, 2.5f, 8 - way}, {2.0f, 1.2f, -4 - way},
                               float(kWidth) / float(kHeight), aside);
        fwWorld_RenderOffscreen(village.world, &shot);
    }
    // Null: fine.
    const char* make(uint32_t houses) {
        const FwContextDef def = fwDefaultContextDef();
        FwErrorInfo info{};
        if (fwCreateContext(&def, &context, &info) != FW_OK) return "there is no device";
        if (!village.make(context, houses, kBudget, 8)) return "the houses cannot be made";
        for (float t = 0; t < kWarmUp; t += 0.25f) {
            fwWorld_Step(village.world, 0.25f);
            draw(true);
        }
        draw(false);
        return village.stats().burningObjects == houses ? nullptr : "not all of them burn";
    }
    Costs frame() {
        Costs c;
        const double start = cpuSeconds();
        fwWorld_Step(village.world, kFrameTime);
        const double stepped = cpuSeconds();
        draw(true);
        const double passed = cpuSeconds();
        draw(false);
        c.step = stepped - start;
        c.refine = passed - stepped;
        c.draw = cpuSeconds() - passed - c.refine;
        c.triangles = village.stats().refinedTriangles;
        way += 4 * kFrameTime;
        return c;
    }
};

void houses(benchmark::State& state) {
    Street many, one;
    for (Street* street : {&one, &many})
        if (const char* why = street->make(street == &one ? 1 : 100))
            return state.SkipWithError(why);
    Costs sum, lone;
    const auto add = [](Costs& to, const Costs& c) {
        to.step += c.step;
        to.refine += c.refine;
        to.draw += c.draw;
        to.triangles += c.triangles;
    };
    for (auto _ : state) {
        add(lone, one.frame());
        const Costs c = many.frame();
        add(sum, c);
        state.SetIterationTime(std::max(c.all(), 1e-9));
    }
    const double frames = double(state.iterations());
    state.counters["step_ms"] = 1e3 * sum.step / frames;
    state.counters["refine_ms"] = 1e3 * sum.refine / frames;
    state.counters["draw_ms"] = 1e3 * sum.draw / frames;
    state.counters["triangles"] = sum.triangles / frames;
    state.counters["one_ms"] = 1e3 * lone.all() / frames;
    state.counters["ratio"] = sum.all() / lone.all();
}

BENCHMARK(houses)
    ->Name("houses100/frame")
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime()
    ->Iterations(kFrames);

}  // namespace
}  // namespace fw::test
