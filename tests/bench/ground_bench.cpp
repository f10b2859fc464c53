// Cost of relief: cobbles and charred logs as in sample 11 at 1280 x 720, over two thirds of the
// picture. The ratio is ground/parallax over ground/bump. cpu_ms: all threads per frame; draw_ms:
// less a frame that draws nothing.
#include <benchmark/benchmark.h>

#include "bench/bunny_scene.h"
#include "common/relief_pictures.h"
#include "common/studio.h"

#include <algorithm>
#include <memory>

namespace {

using fw::test::cpuSeconds;

constexpr uint32_t kFrames = 12;

void ground(benchmark::State& state, sample::ReliefMode mode) {
    sample::Options options;
    options.headless = true;
    options.width = 1280;
    options.height = 720;
    std::unique_ptr<sample::VulkanHost> host;
    try {
        host = std::make_unique<sample::VulkanHost>(sample::HostRequest{});
    } catch (const sample::Failure& why) {
        state.SkipWithError(why.what());
        return;
    }
    constexpr uint32_t kWarm = 2;  // pipelines are compiled at first use
    sample::Stage stage(*host, options, {}, 2 * kFrames + 2 * kWarm + 1);
    std::vector<sample::ReliefModel> models(2);
    models[0].picture = sample::cobbles(1024, 4);
    sample::addReliefBlock(models[0], {0, 0, 0}, {4, 4});
    models[1].picture = sample::charredWood(512, 0.32f, 5);
    models[1].repeats = true;
    models[1].length = 0.8f;
    sample::addReliefLog(models[1], {-0.4f, 0.06f, 0.2f}, {0.4f, 0.06f, 0.2f}, 0.06f);
    sample::Relief relief(*host, stage, models);
    FwView view = fwDefaultView();
    sample::duskLight(view, 0.5f);
    FwLight fire{};
    fire.position[1] = 0.3f;
    fire.color[0] = fire.color[1] = fire.color[2] = 1;
    fire.intensity = 3000;
    fire.radius = 0.2f;
    sample::OrbitCamera orbit;
    orbit.distance = 3.2f;
    orbit.pitch = 0.5f;

    const auto frame = [&](bool draws) {
        const double start = cpuSeconds();
        sample::StageFrame now;
        if (!stage.next(now)) return 0.0;
        sample::setCamera(view, orbit.camera(), now);
        relief.prepare(now, view, {&fire, 1});
        stage.beginScene(now);
        if (draws) relief.draw(now, mode, {{0, 0}, now.extent});
        stage.endScene(now);
        stage.finish(now);
        vkDeviceWaitIdle(host->device);
        return 1e3 * (cpuSeconds() - start);
    };
    std::vector<double> with, without;
    for (uint32_t i = 0; i < kWarm; ++i) frame(true), frame(false);
    for (auto _ : state) {
        with.push_back(frame(true));
        without.push_back(frame(false));
    }
    const auto middle = [](std::vector<double> of) {
        std::nth_element(of.begin(), of.begin() + long(of.size() / 2), of.end());
        return of[of.size() / 2];
    };
    state.counters["cpu_ms"] = middle(with);
    state.counters["draw_ms"] = middle(with) - middle(without);
}

BENCHMARK_CAPTURE(ground, bump, sample::ReliefMode::kBump)
    ->Name("ground/bump")
    ->Unit(benchmark::kMillisecond)
    ->Iterations(kFrames);
BENCHMARK_CAPTURE(ground, parallax, sample::ReliefMode::kParallax)
    ->Name("ground/parallax")
    ->Unit(benchmark::kMillisecond)
    ->Iterations(kFrames);

}  // namespace
