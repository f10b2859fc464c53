// Waiting times in the editor without its window: a brush dab on a map of 1024^2, and a scrub to
// any time. Also opening a scene with a bunny of 31,000 triangles and a cached bake, and program
// start to first frame.
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "script/script.h"
#include "support/paths.h"

namespace {

namespace fs = std::filesystem;

// A sheet of one metre with 1024 x 1024 texels.
fwedit::PaintSurface sheet() {
    constexpr uint32_t side = 1024;
    fwedit::PaintSurface surface;
    surface.width = surface.height = side;
    surface.spacing = 1.0f / side;
    for (uint32_t y = 0; y < side; ++y)
        for (uint32_t x = 0; x < side; ++x) {
            surface.positions.insert(surface.positions.end(),
                                     {(float(x) + 0.5f) / side, (float(y) + 0.5f) / side, 0.0f});
            surface.normals.insert(surface.normals.end(), {0.0f, 0.0f, 1.0f});
        }
    surface.real.assign(size_t{side} * side, 1);
    fwedit::indexSurface(surface);
    return surface;
}

// One move of a brush of 10 cm, of which a mouse makes sixty per second.
void stroke(benchmark::State& state) {
    const fwedit::PaintSurface surface = sheet();
    fwedit::Stroke brush;
    brush.value = 0.2f;
    const fwedit::PaintImage empty = fwedit::makePaintImage(fwedit::PaintMultiplier, 1024, 1024);
    fwedit::StrokePainter painter(surface, fwedit::PaintMultiplier, empty, brush);
    float angle = 0;
    size_t texels = 0;
    for (auto _ : state) {
        angle += 0.05f;
        const float radius = 0.05f + 0.35f * std::fmod(angle * 0.01f, 1.0f);
        const fwedit::PaintedArea area = painter.extend(
            {0.5f + radius * std::cos(angle), 0.5f + radius * std::sin(angle), 0.0f});
        texels += size_t{area.x1 - area.x0} * (area.y1 - area.y0);
    }
    state.counters["texels"] =
        benchmark::Counter(double(texels), benchmark::Counter::kAvgIterations);
}
BENCHMARK(stroke)->Name("editor/stroke")->Unit(benchmark::kMillisecond);

// To another time: the lit share for the strip, and the map of burn times.
void scrub(benchmark::State& state) {
    fwedit::ArrivalField field;
    field.width = field.height = 1024;
    field.seconds.resize(size_t{1024} * 1024);
    for (size_t i = 0; i < field.seconds.size(); ++i)
        field.seconds[i] = i % 7 == 0 ? fwedit::kNeverLit : float(i % 4096) * 0.01f;
    float time = 0;
    for (auto _ : state) {
        time = std::fmod(time + 3.7f, 40.0f);
        benchmark::DoNotOptimize(fwedit::litShare(field, time));
        benchmark::DoNotOptimize(fwedit::burnTimeMap(field, time).data());
    }
}
BENCHMARK(scrub)->Name("editor/scrub/1024")->Unit(benchmark::kMillisecond);

void openBunny(benchmark::State& state) {
    const char* assets = std::getenv("FLAMEWRIGHT_ASSETS");
    const fs::path bunny = assets ? fs::path(assets) / "bunny_31k.glb" : fs::path();
    if (!assets || !fs::exists(bunny)) {
        state.SkipWithError("FLAMEWRIGHT_ASSETS has no bunny_31k.glb");
        return;
    }
    const fs::path folder =
        fs::temp_directory_path() / ("fw_editor_bench_" + std::to_string(::getpid()));
    std::string error;
    const auto must = [&](fwedit::ScriptHost& host, const std::string& line) {
        if (error.empty() && !fwedit::runScriptLine(host, line, error))
            state.SkipWithError(error.c_str());
    };
    {
        fwedit::ScriptHost host(folder);
        host.assets.cache = folder / "cache";
        must(host, "import \"" + bunny.string() + "\"");
        must(host, "save bunny.fwscene");
        must(host, "report");  // bakes
    }
    for (auto _ : state) {
        fwedit::ScriptHost host(folder);
        host.assets.cache = folder / "cache";
        must(host, "open bunny.fwscene");
        must(host, "report");
    }
    fs::remove_all(folder);
}
BENCHMARK(openBunny)->Name("editor/open_bunny31k")->Unit(benchmark::kMillisecond)->Iterations(2);

// From the second start on, with warm caches. Includes the end of the program.
void startEditor(benchmark::State& state) {
    std::string command = "\"";
    command.append(fw::test::kEditor);
    command.append("\" --headless --once --page welcome >/dev/null 2>&1");
    if (std::system(command.c_str()) != 0) {
        state.SkipWithError("the editor does not start here");
        return;
    }
    for (auto _ : state) benchmark::DoNotOptimize(std::system(command.c_str()));
}
BENCHMARK(startEditor)
    ->Name("editor/start")
    ->Unit(benchmark::kMillisecond)
    ->Iterations(3)
    ->UseRealTime();

}  // namespace
