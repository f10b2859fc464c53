// Refinement with drawing: geometry cost of a frame of a burning box at full detail (refine/full:
// every vertex placed, all triangles drawn, indices static) and with levels (refine/adaptive),
// interleaved frame by frame over two seconds around the time when 25 % (or 5 %) are lit, or after
// all has burnt. Cost: an offscreen picture that looks past the box (refinement passes and the
// surface draw without its pixels) less that of a world where the box is hidden and unrefined.
// Time: all threads of this process, because a software device draws on them.
//
// Counters of adaptive rows, same run. ratio: full / adaptive; wall: the same by the clock; unlike:
// mean difference of the two pictures in 1/1000 of 1/255; alone: pixels of 10,000 that only one of
// them shows. A row whose pictures differ by more than the limit is an error.
#include "flamewright_reference.h"
#include "support/cpu_time.h"
#include "support/refine_scene.h"

#include <benchmark/benchmark.h>
#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

namespace fw::test::refine_vk_bench {
namespace {

struct Model {
    const char* name;
    double size[3];  // m
    int cells[3];
    float density;  // texels per m: edges of more than 48 texels are halved
};
constexpr Model k10k{"10k", {1, 1, 1}, {1, 1, 1}, 128};        // 12 -> 192 coarse, 12,288
constexpr Model k15k{"15k", {0.4, 1, 1}, {1, 3, 3}, 171};      // 60 -> 240 coarse, 15,360
constexpr Model k20k{"20k", {0.8, 0.8, 1.2}, {2, 2, 4}, 166};  // 80 -> 320 coarse, 20,480
constexpr Model k50k{"50k", {0.6, 1, 1.6}, {2, 4, 7}, 236};    // 200 -> 800 coarse, 51,200

enum class How { hidden, full, adaptive, published };

struct World {
    FwWorld* world = nullptr;
    FwBurnableMeshId object{};
    World() = default;
    World(const World&) = delete;
    World& operator=(const World&) = delete;
    ~World() { fwDestroyWorld(world); }

    bool make(FwContext* context, const Model& model, How how) {
        const Mesh mesh = gridBox(model.size[0], model.size[1], model.size[2], model.cells[0],
                                  model.cells[1], model.cells[2]);
        FwWorldDef worldDef = fwDefaultWorldDef();
        worldDef.maxStepsPerFrame = 64;
        worldDef.maxFlames = 0;
        worldDef.maxRefinedTriangles = 100000;
        FwMeshDef meshDef = fwDefaultMeshDef();
        meshDef.positions = mesh.positions.data();
        meshDef.uvs = mesh.uvs.data();
        meshDef.indices = mesh.indices.data();
        meshDef.vertexCount = mesh.vertexCount();
        meshDef.indexCount = uint32_t(mesh.indices.size());
        meshDef.texelsPerMetre = model.density;
        meshDef.mapSize = 2048;
        meshDef.noiseAmplitude = 0;
        FwMaterialDef wood = fwDefaultMaterialDef();
        wood.spreadRate = 0.02f;  // burns through in 4 s
        wood.windGain = wood.upGain = wood.headGain = wood.ceilingGain = 0;
        wood.burnTime = 4;
        FwBurnableMeshDef def = fwDefaultBurnableMeshDef();
        def.flags = FW_BURNABLE_LITE | (how == How::hidden      ? uint32_t{FW_BURNABLE_HIDDEN}
                                        : how == How::published ? FW_BURNABLE_REFINE_PUBLISHED
                                                                : uint32_t{FW_BURNABLE_REFINE});
        def.refineDepth = how == How::published ? 4 : 3;  // ours halves long edges beforehand
        FwIgnitionDef match = fwDefaultIgnitionDef();
        match.position[0] = 0;
        match.position[1] = 0.45f;
        match.position[2] = 0.37f;
        match.radius = 0.03f;
        return fwCreateWorld(context, &worldDef, &world) == FW_OK &&
               fwWorld_CreateMesh(world, &meshDef, &def.mesh) == FW_OK &&
               fwWorld_CreateMaterial(world, &wood, &def.materials[0]) == FW_OK &&
               fwWorld_CreateBurnableMesh(world, &def, &object) == FW_OK &&
               fwDebug_SetSwitches(world, how == How::full ? FW_DEBUG_REFINE_FULL : 0) == FW_OK &&
               fwWorld_Ignite(world, &match, nullptr) == FW_OK;
    }
    [[nodiscard]] float lit() const {
        FwObjectState state{};
        state.structSize = sizeof state;
        fwWorld_GetObjectState(world, object, &state);
        return state.burntFraction;
    }
};

struct Camera {  // orthographic, so that distance limits no level
    FwView view = fwDefaultView();
    explicit Camera(const Model& m, float aside = 0) {
        const glm::vec3 middle(m.size[0] / 2, m.size[1] / 2, m.size[2] / 2);
        const glm::mat4 look =
            glm::lookAt(middle + glm::vec3(-2, 1.2f, 1.6f), middle, glm::vec3(0, 1, 0));
        const float half = 1.0f;
        glm::mat4 projection(1.0f);
        projection[0][0] = 1 / half;
        projection[1][1] = -1 / half;
        projection[2][2] = -1 / 6.0f;
        projection[3][0] = aside;
        std::memcpy(view.view, glm::value_ptr(look), sizeof view.view);
        std::memcpy(view.projection, glm::value_ptr(projection), sizeof view.projection);
    }
    bool draw(const World& world, uint32_t side, std::vector<uint8_t>& pixels) const {
        pixels.resize(size_t{side} * side * 4);
        FwOffscreenDef shot = fwDefaultOffscreenDef();
        shot.width = shot.height = side;
        shot.pixels = pixels.data();
        shot.view = view;
        return fwWorld_RenderOffscreen(world.world, &shot) == FW_OK;
    }
};

constexpr int kFrames = 120;
constexpr uint32_t kSmall = 64, kLarge = 512;  // pixels
// Limits of picture differences. Measured: 9 to 20, and 1 to 3.
constexpr double kMostUnlike = 50, kMostAlone = 10;

struct Difference {
    double unlike = 0, alone = 0;  // as the counters
};
Difference differenceOf(const std::vector<uint8_t>& a, const std::vector<uint8_t>& b) {
    uint64_t sum = 0, alone = 0;
    for (size_t i = 0; i < a.size(); i += 4) {
        bool shown[2] = {};
        for (size_t k = i; k < i + 3; ++k) {
            sum += uint64_t(std::abs(int(a[k]) - int(b[k])));
            shown[0] |= a[k] != 0;
            shown[1] |= b[k] != 0;
        }
        alone += shown[0] != shown[1] ? 1 : 0;
    }
    const double pixels = double(a.size()) / 4;
    return {double(sum) / (3 * pixels) * 1000, double(alone) / pixels * 10000};
}

struct Trial {
    FwContext* context = nullptr;
    World worlds[3];
    ~Trial() {
        for (World& w : worlds) fwDestroyWorld(std::exchange(w.world, nullptr));
        fwDestroyContext(context);
    }
    // Returns null on success.
    const char* make(const Model& model, How third = How::adaptive) {
        const FwContextDef def = fwDefaultContextDef();
        FwErrorInfo info{};
        if (fwCreateContext(&def, &context, &info) != FW_OK) return "there is no device";
        int at = 0;
        for (const How how : {How::hidden, How::full, third})
            if (!worlds[at++].make(context, model, how)) return "the scene cannot be made";
        return nullptr;
    }
};

constexpr float kStep = 0.25f;  // s, of the time before the measurement

// Time when this share of the box is lit; negative: never.
float secondsTo(const Model& model, float lit) {
    Trial trial;
    if (trial.make(model)) return -1;
    for (float seconds = 0; seconds < 400; seconds += kStep) {
        if (trial.worlds[0].lit() >= lit) return seconds;
        fwWorld_Step(trial.worlds[0].world, kStep);
    }
    return -1;
}

// lit: share of the box; above 1: all of it has burnt out.
void refine(benchmark::State& state, const Model& model, float lit, How how) {
    const bool adaptive = how != How::full;
    float start = secondsTo(model, std::min(lit, 0.9999f));
    start += lit < 1 ? -1 : 10;
    Trial trial;
    if (const char* why =
            start < 0 ? "it does not burn" : trial.make(model, adaptive ? how : How::adaptive))
        return state.SkipWithError(why);
    const Camera camera(model), aside(model, 9);
    std::vector<uint8_t> pixels, other;
    for (float seconds = 0; seconds < start; seconds += kStep)
        for (const World& w : trial.worlds) {
            fwWorld_Step(w.world, kStep);
            aside.draw(w, kSmall, pixels);
        }
    double cpu[3] = {}, wall[3] = {}, middle = 0;
    using Clock = std::chrono::steady_clock;
    int frames = 0;
    for (auto _ : state) {
        double one[3] = {};
        for (int w = 0; w < 3; ++w) {
            fwWorld_Step(trial.worlds[w].world, 1 / 60.0f);
            const double before = cpuSeconds();
            const Clock::time_point from = Clock::now();
            aside.draw(trial.worlds[w], kSmall, pixels);
            wall[w] += std::chrono::duration<double>(Clock::now() - from).count();
            one[w] = cpuSeconds() - before;
            cpu[w] += one[w];
        }
        if (++frames == kFrames / 2) middle = double(trial.worlds[0].lit());
        state.SetIterationTime(std::max(one[adaptive ? 2 : 1] - one[0], 1e-9));
    }
    if (!adaptive) return;
    state.counters["lit"] = middle;
    state.counters["ratio"] = (cpu[1] - cpu[0]) / (cpu[2] - cpu[0]);
    state.counters["wall"] = (wall[1] - wall[0]) / (wall[2] - wall[0]);
    camera.draw(trial.worlds[1], kLarge, pixels);
    camera.draw(trial.worlds[2], kLarge, other);
    const Difference difference = differenceOf(pixels, other);
    state.counters["unlike"] = difference.unlike;
    state.counters["alone"] = difference.alone;
    if (const char* folder = std::getenv("FLAMEWRIGHT_BENCH_PICTURES"))
        for (const auto& [name, picture] : {std::pair{"full", &pixels}, {"adaptive", &other}}) {
            const std::string path = std::string(folder) + "/" + name + "_" + model.name + ".rgba";
            if (FILE* file = std::fopen(path.c_str(), "wb")) {
                std::fwrite(picture->data(), 1, picture->size(), file);
                std::fclose(file);
            }
        }
    // The reference refinement shows other triangles and has no such limit.
    if (how == How::adaptive && (difference.unlike > kMostUnlike || difference.alone > kMostAlone))
        state.SkipWithError("the pictures differ by more than refinement may change");
}

#define FW_REFINE_ROW(row, model, lit, adaptive)                      \
    BENCHMARK_CAPTURE(refine, row##_##model, k##model, lit, adaptive) \
        ->Name("refine/" #row "/" #model)                             \
        ->UseManualTime()                                             \
        ->Iterations(kFrames)                                         \
        ->Unit(benchmark::kMillisecond)

FW_REFINE_ROW(full, 10k, 0.25f, How::full);
FW_REFINE_ROW(adaptive, 10k, 0.25f, How::adaptive);
FW_REFINE_ROW(full, 15k, 0.25f, How::full);
FW_REFINE_ROW(adaptive, 15k, 0.25f, How::adaptive);
FW_REFINE_ROW(full, 20k, 0.25f, How::full);
FW_REFINE_ROW(adaptive, 20k, 0.25f, How::adaptive);
FW_REFINE_ROW(published, 20k, 0.25f, How::published);
FW_REFINE_ROW(full, 50k, 0.25f, How::full);
FW_REFINE_ROW(adaptive, 50k, 0.25f, How::adaptive);
FW_REFINE_ROW(full_lit5, 20k, 0.05f, How::full);
FW_REFINE_ROW(adaptive_lit5, 20k, 0.05f, How::adaptive);
FW_REFINE_ROW(full_burnt, 20k, 2.0f, How::full);
FW_REFINE_ROW(adaptive_burnt, 20k, 2.0f, How::adaptive);

}  // namespace
}  // namespace fw::test::refine_vk_bench
