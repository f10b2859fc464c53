// A frame of the tower-defence game: the fourth wave on the road, the bot's towers working, every
// object of the village a burnable mesh. A frame is a tick of the rules, a world step of the same
// time, and the library's picture at 1280 x 720. Time: all threads of this process. step_ms: rules
// and step; rules_us: rules and their calls into the world; burning: objects on fire at the end.
#include <benchmark/benchmark.h>

#include "bench/bench_device.h"
#include "game/bot.h"
#include "overview.h"
#include "siege.h"
#include "world_def.h"

#include <cstring>
#include <memory>
#include <vector>

namespace fw::test::game_bench {
namespace {

using fw::test::cpuSeconds;

constexpr uint32_t kWidth = 1280, kHeight = 720, kSeed = 1;

void gameFrame(benchmark::State& bench) {
    const FwContextDef contextDef = fwDefaultContextDef();
    FwContext* made = nullptr;
    if (fwCreateContext(&contextDef, &made, nullptr) != FW_OK)
        return bench.SkipWithError("no device");
    const std::unique_ptr<FwContext, decltype(&fwDestroyContext)> context(made, &fwDestroyContext);
    const FwWorldDef worldDef = tower::villageWorld(kSeed, 14);
    FwWorld* world = nullptr;
    if (fwCreateWorld(context.get(), &worldDef, &world) != FW_OK)
        return bench.SkipWithError("no world");
    const tower::Battlefield field = tower::makeBattlefield(kSeed);
    tower::FireVillage fires(context.get(), world, field.scene, nullptr);
    tower::Siege siege(world, fires, field, game::gameInProgress(field.ground, kSeed));

    std::vector<uint8_t> pixels(size_t{kWidth} * kHeight * 4);
    FwOffscreenDef shot = fwDefaultOffscreenDef();
    shot.width = kWidth;
    shot.height = kHeight;
    shot.pixels = pixels.data();
    shot.view = fwDefaultView();
    const sample::Camera camera = tower::Overview{}.camera();
    const glm::mat4 view = sample::viewMatrix(camera);
    const glm::mat4 projection = sample::projectionMatrix(camera, float(kWidth) / float(kHeight));
    std::memcpy(shot.view.view, &view[0][0], sizeof shot.view.view);
    std::memcpy(shot.view.projection, &projection[0][0], sizeof shot.view.projection);

    double rules = 0, step = 0;
    auto frame = [&](int32_t ticks) {
        const double began = cpuSeconds();
        siege.give(game::botsOrder(siege.state()));
        siege.advance(ticks);
        const double called = cpuSeconds();
        fwWorld_Step(world, float(ticks) * tower::kTickSeconds);
        const double stepped = cpuSeconds();
        fwWorld_RenderOffscreen(world, &shot);
        rules += called - began;
        step += stepped - began;
        return cpuSeconds() - began;
    };
    // 6 s, until enough burns; pipelines are compiled at first use.
    for (int i = 0; i < 24; ++i) {
        siege.advance(8);
        fwWorld_Step(world, 8 * tower::kTickSeconds);
    }
    frame(1);
    rules = step = 0;
    for (auto _ : bench) bench.SetIterationTime(frame(1));
    const auto frames = double(bench.iterations());
    bench.counters["rules_us"] = 1e6 * rules / frames;
    bench.counters["step_ms"] = 1e3 * step / frames;
    bench.counters["burning"] = fires.burning();
}
BENCHMARK(gameFrame)
    ->Name("game/frame")
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime()
    ->Iterations(24);

}  // namespace
}  // namespace fw::test::game_bench
