// Cost of fire-emitter particles on an own device: moving them (the `particles` pass of a frame
// without a picture), a picture of them less one where they are hidden, and sorting. And the cost
// at half against full resolution on a host device. cpu_ms: all threads per frame; per_ns: per
// particle.
#include <benchmark/benchmark.h>

#include "bench/composite_host.h"
#include "flamewright/flamewright_debug.h"

#include <algorithm>
#include <string>
#include <vector>

namespace {

using fw::test::Clock;
using fw::test::cpuSeconds;
using fw::test::secondsSince;

FwWorldDef sparksWorld() {
    FwWorldDef def = fwDefaultWorldDef();
    def.maxParticles = 1u << 20;
    def.maxFlames = 0;
    return def;
}

bool makeSparks(FwWorld* world, uint32_t particles, bool flipbooks, FwFireEmitterId& emitter) {
    FwFireEmitterDef def = fwDefaultFireEmitterDef();
    def.flags = FW_EMITTER_GROUND;
    def.shape = FW_EMITTER_DISC;
    def.radius = 3;
    def.life = 1;
    def.size0 = 0.3f;
    def.size1 = 0.5f;
    def.speed = 2;
    def.maxParticles = particles;
    def.rate = float(particles) * 1.2f;  // all alive, always
    def.lifeVariance = 0;
    def.smoke = 0.3f;
    const auto open = [&](uint32_t preset, FwFlipbookId& book) {
        FwFlipbookDef bookDef = fwDefaultFlipbookDef();
        bookDef.preset = preset;
        return fwWorld_CreateFlipbook(world, &bookDef, &book) == FW_OK;
    };
    if (flipbooks && !(open(FW_FLIPBOOK_FLAME, def.fireFlipbooks[0]) &&
                       open(FW_FLIPBOOK_ROLL, def.fireFlipbooks[1]) &&
                       open(FW_FLIPBOOK_SMOKE, def.smokeFlipbooks[0])))
        return false;
    return fwWorld_CreateFireEmitter(world, &def, &emitter) == FW_OK;
}

class Sparks {
 public:
    Sparks(const Sparks&) = delete;
    Sparks& operator=(const Sparks&) = delete;
    explicit Sparks(uint32_t particles, float away, bool flipbooks = false)
        : particles_(particles), pixels_(1280 * 720 * 4) {
        const FwContextDef contextDef = fwDefaultContextDef();
        const FwWorldDef worldDef = sparksWorld();
        FwErrorInfo info{};
        if (fwCreateContext(&contextDef, &context_, &info) != FW_OK ||
            fwCreateWorld(context_, &worldDef, &world_) != FW_OK)
            return;
        if (!makeSparks(world_, particles, flipbooks, emitter_)) return;
        for (int i = 0; i < 100; ++i) fwWorld_Step(world_, 1.0f / 60);
        glm::mat4 projection(0.0f);
        projection[0][0] = 2.0f * 9 / 16;
        projection[1][1] = -2.0f;
        projection[2][2] = projection[2][3] = -1.0f;
        projection[3][2] = -0.05f;
        const glm::mat4 view =
            glm::lookAt(glm::vec3(0, 2, away), glm::vec3(0, 2, 0), glm::vec3(0, 1, 0));
        shot_.pixels = pixels_.data();
        std::memcpy(shot_.view.view, glm::value_ptr(view), sizeof shot_.view.view);
        std::memcpy(shot_.view.projection, glm::value_ptr(projection),
                    sizeof shot_.view.projection);
        works_ = true;
    }
    ~Sparks() {
        fwDestroyWorld(world_);
        fwDestroyContext(context_);
    }
    [[nodiscard]] bool works() const { return works_; }
    void step() { fwWorld_Step(world_, 1.0f / 60); }
    // s, wall time and all threads.
    void draw(bool hidden, double& wall, double& cpu) {
        fwWorld_SetFireEmitterHidden(world_, emitter_, hidden ? 1 : 0);
        step();
        const Clock::time_point start = Clock::now();
        const double before = cpuSeconds();
        fwWorld_RenderOffscreen(world_, &shot_);
        wall = secondsSince(start);
        cpu = cpuSeconds() - before;
    }
    // s, as last measured.
    [[nodiscard]] double pass(const char* name) {
        FwPassTime times[64];
        const uint32_t count = std::min(fwDebug_GetPassTimes(world_, times, 64), 64u);
        for (uint32_t i = 0; i < count; ++i)
            if (std::string(times[i].name) == name) return times[i].milliseconds * 1e-3;
        return 0;
    }
    [[nodiscard]] uint32_t particles() const { return particles_; }

 private:
    uint32_t particles_;
    std::vector<uint8_t> pixels_;
    FwContext* context_ = nullptr;
    FwWorld* world_ = nullptr;
    FwFireEmitterId emitter_{};
    FwOffscreenDef shot_ = fwDefaultOffscreenDef();
    bool works_ = false;
};

void simulate(benchmark::State& state, uint32_t particles) {
    Sparks sparks(particles, 20);
    if (!sparks.works()) return state.SkipWithError("no device");
    double cpu = 0, least = 1e9;
    for (auto _ : state) {
        const double before = cpuSeconds();
        sparks.step();
        cpu += cpuSeconds() - before;
        const double took = std::max(sparks.pass("particles"), 1e-9);
        least = std::min(least, took);
        state.SetIterationTime(took);
    }
    state.counters["least_ms"] = 1e3 * least;
    state.counters["cpu_ms"] = 1e3 * cpu / double(state.iterations());
    state.counters["per_ns"] = 1e9 * least / double(particles);
}

void drawQuads(benchmark::State& state, uint32_t particles, float away, bool flipbooks) {
    Sparks sparks(particles, away, flipbooks);
    if (!sparks.works()) return state.SkipWithError("no device");
    double cpu = 0, least = 1e9;
    const auto both = [&] {
        double wall[2], busy[2];
        for (const int hidden : {1, 0}) sparks.draw(hidden != 0, wall[hidden], busy[hidden]);
        cpu += busy[0] - busy[1];
        least = std::min(least, wall[0] - wall[1]);
        return std::max(wall[0] - wall[1], 1e-6);
    };
    for (int i = 0; i < 3; ++i) both();  // pipelines are compiled at first use
    cpu = 0, least = 1e9;
    for (auto _ : state) state.SetIterationTime(both());
    state.counters["least_ms"] = 1e3 * least;
    state.counters["cpu_ms"] = 1e3 * cpu / double(state.iterations());
}

void sortQuads(benchmark::State& state, uint32_t particles) {
    Sparks sparks(particles, 400);
    if (!sparks.works()) return state.SkipWithError("no device");
    double least = 1e9;
    for (auto _ : state) {
        double wall = 0, cpu = 0;
        sparks.draw(false, wall, cpu);
        const double took = std::max(sparks.pass("flame_sort"), 1e-9);
        least = std::min(least, took);
        state.SetIterationTime(took);
    }
    state.counters["least_ms"] = 1e3 * least;
}

// A picture of still particles at half and at full resolution, interleaved, each less a full frame
// without them. full_ms: at full. ratio: of processor time.
void drawHalf(benchmark::State& state, uint32_t particles, float away) {
    fw::test::CompositeHost host;
    FwFireEmitterId emitter{};
    if (const char* why = host.make(sparksWorld())) return state.SkipWithError(why);
    const FwTargetId targets[2] = {host.target(0), host.target(FW_TARGET_HALF_EFFECTS)};
    if (targets[0].index1 == 0 || targets[1].index1 == 0 ||
        !makeSparks(host.world(), particles, false, emitter))
        return state.SkipWithError("no particles at half resolution");
    host.look({0, 2, away}, {0, 2, 0}, 2);
    double wall = 0, cpu = 0;
    for (int i = 0; i < 100; ++i)
        if (!host.frame(targets[0], 1.0f / 60, wall, cpu))
            return state.SkipWithError("a frame was not drawn");
    double walls[2] = {}, busy[2] = {}, least[2] = {1e9, 1e9};
    const auto both = [&] {
        for (const int half : {0, 1}) {
            double took[2], cpus[2];
            for (const int hidden : {1, 0}) {
                fwWorld_SetFireEmitterHidden(host.world(), emitter, uint32_t(hidden));
                host.frame(targets[hidden ? 0 : half], 0, took[hidden], cpus[hidden]);
            }
            walls[half] = took[0] - took[1];
            busy[half] += cpus[0] - cpus[1];
            least[half] = std::min(least[half], walls[half]);
        }
    };
    for (int i = 0; i < 3; ++i) both();  // pipelines are compiled at first use
    for (const int half : {0, 1}) busy[half] = 0, least[half] = 1e9;
    for (auto _ : state) {
        both();
        state.SetIterationTime(std::max(walls[1], 1e-6));
    }
    state.counters["least_ms"] = 1e3 * least[1];
    state.counters["full_ms"] = 1e3 * least[0];
    state.counters["cpu_ms"] = 1e3 * busy[1] / double(state.iterations());
    state.counters["full_cpu_ms"] = 1e3 * busy[0] / double(state.iterations());
    state.counters["ratio"] = busy[1] / busy[0];
}

#define FW_PARTICLE_ROW(function, name, row, ...)  \
    BENCHMARK_CAPTURE(function, name, __VA_ARGS__) \
        ->Name(row)                                \
        ->Unit(benchmark::kMillisecond)            \
        ->UseManualTime()                          \
        ->Iterations(15)
FW_PARTICLE_ROW(simulate, sim10k, "particles/sim/10k", 10000);
FW_PARTICLE_ROW(simulate, sim100k, "particles/sim/100k", 100000);
FW_PARTICLE_ROW(drawQuads, draw2k, "particles/draw/2k", 2000, 60.0f, false);
FW_PARTICLE_ROW(drawQuads, draw2kBooks, "particles/draw/2k_books", 2000, 60.0f, true);
FW_PARTICLE_ROW(drawHalf, half2k, "particles/draw_half/2k", 2000, 60.0f);
FW_PARTICLE_ROW(drawHalf, half2kNear, "particles/draw_half/2k_near", 2000, 12.0f);
FW_PARTICLE_ROW(sortQuads, sort10k, "particles/sort/10k", 10000);

}  // namespace
