// Refinement in the library, one thread: geometry cost of a frame at full detail (refine_cpu/full:
// every vertex placed, indices static) and with levels (refine_cpu/adaptive: heat, levels, scan,
// emission on change, vertices), over two seconds around the time when 25 % (or 5 %) are lit.
// Drawing is not included; it follows the counted triangles.
//
// Counters of adaptive rows, same run: ratio = full / adaptive time; ratio_still = a full mesh that
// skips still parts / adaptive; triangles = full / drawn.
#include "support/refine_scene.h"

#include <benchmark/benchmark.h>

#include <ctime>
#include <memory>

namespace fw::test::refine_cpu_bench {
namespace {

// s, of this thread only: frames are short and the machine is shared.
double threadSeconds() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}
template <typename Work>
double secondsOf(Work work) {
    const double start = threadSeconds();
    work();
    return threadSeconds() - start;
}

struct Model {
    const char* name;
    double size[3];
    int cells[3];
    float splitTexels;  // halves every side once (the 10k box: twice); then cells of 8 per side
};
constexpr Model k10k{"10k", {1, 1, 1}, {1, 1, 1}, 48};        // 12 -> 192 coarse, 12,288
constexpr Model k15k{"15k", {0.4, 1, 1}, {1, 3, 3}, 36};      // 60 -> 240 coarse, 15,360
constexpr Model k20k{"20k", {0.8, 0.8, 1.2}, {2, 2, 4}, 37};  // 80 -> 320 coarse, 20,480
constexpr Model k50k{"50k", {0.6, 1, 1.6}, {2, 4, 7}, 26};    // 200 -> 800 coarse, 51,200

const RefineScene& sceneOf(const Model& m) {
    static std::map<std::string, std::unique_ptr<RefineScene>> known;
    std::unique_ptr<RefineScene>& scene = known[m.name];
    if (!scene) {
        mesh::RefineOptions o;
        o.depth = 3;
        o.cellTexels = 0;
        o.splitTexels = m.splitTexels;
        scene = std::make_unique<RefineScene>(
            gridBox(m.size[0], m.size[1], m.size[2], m.cells[0], m.cells[1], m.cells[2]), o);
        scene->light({0.02, 0.45, 0.37}, 0.02);
    }
    return *scene;
}

// Everything at its deepest level, indices built once.
struct FullMesh {
    RefinePlayer player;
    explicit FullMesh(const RefineScene& scene) : player(scene) {
        player.settings.morph = false;
        for (size_t e = 0; e < scene.model.edges.size(); ++e)
            player.state.edges[e].level = float(scene.model.edges[e].flags & 15);
        for (size_t i = 0; i < scene.model.triangles.size(); ++i) {
            const uint32_t f = scene.model.triangles[i].flags;
            const uint32_t m = gpu::refineInteriorDepth(f);
            player.state.interiors[i].level = float(m);
            player.state.levels[i] =
                gpu::refinePack(gpu::refineSideDepth(f, 0), gpu::refineSideDepth(f, 1),
                                gpu::refineSideDepth(f, 2), m);
        }
        mesh::refineScan(scene.model, player.state);
        mesh::refineEmit(scene.model, player.state);
    }
    double place(const RefinePlayer& heat, float now, bool skipStill) {
        player.settings.skipStill = skipStill;
        player.state.edgeHeat = heat.state.edgeHeat;
        player.state.interiorHeat = heat.state.interiorHeat;
        const mesh::RefineFrame frame = player.frameAt(now, 1 / 60.0f);
        return secondsOf(
            [&] { mesh::refinePlace(player.scene.model, player.settings, frame, player.state); });
    }
};

constexpr int kFrames = 120;

void refine(benchmark::State& state, const Model& model, double lit, bool adaptive) {
    const RefineScene& scene = sceneOf(model);
    const float start = std::max(0.0f, scene.timeAt(lit) - 1);
    FullMesh full(scene), careful(scene);
    auto player = std::make_unique<RefinePlayer>(scene);
    std::vector<uint32_t> flags;
    double adaptiveSeconds = 0, fullSeconds = 0, carefulSeconds = 0, drawn = 0;
    int k = kFrames, frames = 0;
    for (auto _ : state) {
        if (k == kFrames) {
            player = std::make_unique<RefinePlayer>(scene);
            player->runTo(std::max(0.0f, start - 8), start, 0.05f);
            (void)careful.place(*player, start, false);
            k = 0;
        }
        const float now = start + float(++k) / 60;
        scene.flagsAt(now, flags);
        const double a = secondsOf([&] {
            mesh::refineHeat(scene.domain, flags, false, player->tiles);
            mesh::refineFrame(scene.model, player->settings, player->frameAt(now, 1 / 60.0f),
                              player->state);
        });
        const double f = full.place(*player, now, false);
        carefulSeconds += careful.place(*player, now, true);
        state.SetIterationTime(adaptive ? a : f);
        adaptiveSeconds += a;
        fullSeconds += f;
        drawn += player->triangles();
        ++frames;
    }
    const double all = double(full.player.triangles());
    state.counters["triangles"] = adaptive ? all * frames / drawn : all;
    if (!adaptive) return;
    state.counters["ratio"] = fullSeconds / adaptiveSeconds;
    state.counters["ratio_still"] = carefulSeconds / adaptiveSeconds;
}

#define FW_REFINE_CPU_ROW(row, model, lit, adaptive)                  \
    BENCHMARK_CAPTURE(refine, row##_##model, k##model, lit, adaptive) \
        ->Name("refine_cpu/" #row "/" #model)                         \
        ->UseManualTime()                                             \
        ->Unit(benchmark::kMillisecond)

FW_REFINE_CPU_ROW(full, 10k, 0.25, false);
FW_REFINE_CPU_ROW(adaptive, 10k, 0.25, true);
FW_REFINE_CPU_ROW(full, 15k, 0.25, false);
FW_REFINE_CPU_ROW(adaptive, 15k, 0.25, true);
FW_REFINE_CPU_ROW(full, 20k, 0.25, false);
FW_REFINE_CPU_ROW(adaptive, 20k, 0.25, true);
FW_REFINE_CPU_ROW(full, 50k, 0.25, false);
FW_REFINE_CPU_ROW(adaptive, 50k, 0.25, true);
FW_REFINE_CPU_ROW(full_lit5, 20k, 0.05, false);
FW_REFINE_CPU_ROW(adaptive_lit5, 20k, 0.05, true);

}  // namespace
}  // namespace fw::test::refine_cpu_bench
