// Cost of volumetric flames, and the device's times of probe, march and composite (least): an
// offscreen picture with them, submitted and waited for, less one where they are hidden,
// interleaved. cpu_ms: the same for all threads of this process. boxed: share of the picture inside
// their bounds; lit: share that they change.
#include <benchmark/benchmark.h>

#include "bench/bench_device.h"
#include "flamewright/flamewright.h"
#include "flamewright/flamewright_debug.h"

#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

namespace {

struct Case {
    uint32_t width, height, fires;
    uint32_t flags;                              // FwVolumetricFireFlags
    float boxed;                                 // share of the picture inside one fire's bounds
    uint32_t cell = 2, steps = 64, octaves = 4;  // as FwWorldDef's
    uint32_t preset = FW_FIRE_CAMP;
    uint32_t tier = FW_FIRE_TIER_AUTO;
};

class Fires {
 public:
    explicit Fires(const Case& what) : case_(what), pixels_(size_t{what.width} * what.height * 4) {}
    Fires(const Fires&) = delete;
    Fires& operator=(const Fires&) = delete;
    ~Fires() {
        fwDestroyWorld(world_);
        fwDestroyContext(context_);
    }

    const char* make() {
        const FwContextDef contextDef = fwDefaultContextDef();
        FwWorldDef worldDef = fwDefaultWorldDef();
        worldDef.maxFlames = 0;
        worldDef.volumePixelSize = case_.cell;
        worldDef.rayStepCount = case_.steps;
        worldDef.volumeOctaves = case_.octaves;
        FwErrorInfo info{};
        if (fwCreateContext(&contextDef, &context_, &info) != FW_OK ||
            fwCreateWorld(context_, &worldDef, &world_) != FW_OK)
            return "no device";
        for (uint32_t i = 0; i < case_.fires; ++i) {
            FwVolumetricFireDef def = fwDefaultVolumetricFireDef();
            fwInitFirePreset(&def, case_.preset);
            def.flags = case_.flags;
            def.tier = case_.tier;
            def.seed = 7 + i;
            def.position[0] = 1.1f * (float(i % 8) - 0.5f * float(std::min(case_.fires, 8u) - 1));
            def.position[1] = 2.4f * float(i / 8);
            FwVolumetricFireId id{};
            if (fwWorld_CreateVolumetricFire(world_, &def, &id) != FW_OK) return "no fire";
            fires_.push_back(id);
        }
        for (int i = 0; i < 10; ++i) fwWorld_Step(world_, 0.1f);
        look();
        return nullptr;
    }

    struct Cost {
        double wall = 0, cpu = 0;  // s
    };
    Cost take(bool hidden) {
        for (const FwVolumetricFireId id : fires_)
            fwWorld_SetVolumetricFireHidden(world_, id, hidden ? 1 : 0);
        fwWorld_Step(world_, 0.01f);
        const fw::test::Clock::time_point start = fw::test::Clock::now();
        const double cpu = fw::test::cpuSeconds();
        fwWorld_RenderOffscreen(world_, &shot_);
        return {fw::test::secondsSince(start), fw::test::cpuSeconds() - cpu};
    }
    // ms of the passes with this prefix in the last frame with timings.
    double passes(const char* name) {
        FwPassTime times[64];
        const uint32_t count = fwDebug_GetPassTimes(world_, times, 64);
        double sum = 0;
        for (uint32_t i = 0; i < count && i < 64; ++i)
            if (std::strncmp(times[i].name, name, std::strlen(name)) == 0)
                sum += times[i].milliseconds;
        return sum;
    }
    [[nodiscard]] double lit() const {
        size_t sum = 0;
        for (size_t i = 0; i < pixels_.size(); i += 4) sum += pixels_[i] > 2;
        return 4.0 * double(sum) / double(pixels_.size());
    }
    [[nodiscard]] double boxed() const { return boxed_; }

 private:
    // Distance at which all bounds cover the case's share, seen from the side.
    void look() {
        glm::vec3 low(1e9f), high(-1e9f);
        for (const FwVolumetricFireId id : fires_) {
            FwVolumetricFireState state{};
            state.structSize = sizeof state;
            fwWorld_GetVolumetricFireState(world_, id, &state);
            low = glm::min(low, glm::make_vec3(state.boundsLow));
            high = glm::max(high, glm::make_vec3(state.boundsHigh));
        }
        const glm::vec3 size = high - low, middle = 0.5f * (low + high);
        const float aspect = float(case_.width) / float(case_.height);
        float tall = std::sqrt(size.x * size.y / (case_.boxed * aspect));  // m over the picture
        tall = std::max({tall, size.y, size.x / aspect});
        boxed_ = size.x * size.y / (tall * tall * aspect);
        const float away = 6.0f * tall;
        const glm::mat4 view =
            glm::lookAt(middle + glm::vec3(0, 0, away), middle, glm::vec3(0, 1, 0));
        glm::mat4 projection(0.0f);
        projection[0][0] = 12.0f / aspect;
        projection[1][1] = -12.0f;
        projection[2][2] = projection[2][3] = -1.0f;
        projection[3][2] = -0.05f;
        shot_.width = case_.width;
        shot_.height = case_.height;
        shot_.pixels = pixels_.data();
        shot_.view = fwDefaultView();
        std::memcpy(shot_.view.view, glm::value_ptr(view), sizeof shot_.view.view);
        std::memcpy(shot_.view.projection, glm::value_ptr(projection),
                    sizeof shot_.view.projection);
    }

    Case case_;
    std::vector<uint8_t> pixels_;
    FwContext* context_ = nullptr;
    FwWorld* world_ = nullptr;
    std::vector<FwVolumetricFireId> fires_;
    FwOffscreenDef shot_ = fwDefaultOffscreenDef();
    double boxed_ = 0;
};

void drawFires(benchmark::State& state, const Case& what) {
    Fires fires(what);
    if (const char* why = fires.make()) {
        state.SkipWithError(why);
        return;
    }
    double cpu = 0, least = 1e9;
    constexpr const char* kPasses[] = {"volume_probe", "volume_march", "volume_composite"};
    double passes[3] = {1e9, 1e9, 1e9};
    const auto both = [&] {
        const Fires::Cost without = fires.take(true), with = fires.take(false);
        cpu += with.cpu - without.cpu;
        least = std::min(least, with.cpu - without.cpu);
        for (int i = 0; i < 3; ++i)
            if (const double ms = fires.passes(kPasses[i]); ms > 0)
                passes[i] = std::min(passes[i], ms);
        return std::max(with.wall - without.wall, 1e-6);
    };
    for (int i = 0; i < 3; ++i) both();  // pipelines are compiled at first use
    cpu = 0, least = 1e9;
    passes[0] = passes[1] = passes[2] = 1e9;
    for (auto _ : state) state.SetIterationTime(both());
    state.counters["cpu_least_ms"] = 1e3 * least;
    state.counters["probe_ms"] = passes[0];
    state.counters["march_ms"] = passes[1];
    state.counters["composite_ms"] = passes[2];
    state.counters["cpu_ms"] = 1e3 * cpu / double(state.iterations());
    state.counters["boxed"] = fires.boxed();
    state.counters["lit"] = fires.lit();
}

#define FW_VOLUME_ROW(name, row, ...)                     \
    BENCHMARK_CAPTURE(drawFires, name, Case{__VA_ARGS__}) \
        ->Name(row)                                       \
        ->Unit(benchmark::kMillisecond)                   \
        ->UseManualTime()                                 \
        ->Iterations(9)
FW_VOLUME_ROW(samework, "volume/samework/360p", 640, 360, 1, FW_FIRE_NO_SMOKE, 0.30f, 1);
FW_VOLUME_ROW(delivered, "volume/delivered/720p", 1280, 720, 1, FW_FIRE_NO_SMOKE, 0.30f);
FW_VOLUME_ROW(quarter, "volume/onequarter_screen/720p", 1280, 720, 1, FW_FIRE_NO_SMOKE, 0.25f);
FW_VOLUME_ROW(small, "volume/15percent_screen/720p", 1280, 720, 1, FW_FIRE_NO_SMOKE, 0.15f);
FW_VOLUME_ROW(high, "volume/high/720p", 1280, 720, 1, FW_FIRE_NO_SMOKE, 0.15f, 2, 64, 4,
              FW_FIRE_CAMP, FW_FIRE_TIER_MARCH_HIGH);
FW_VOLUME_ROW(steps16, "volume/steps16/720p", 1280, 720, 1, FW_FIRE_NO_SMOKE, 0.30f, 2, 16);
FW_VOLUME_ROW(steps24, "volume/steps24/720p", 1280, 720, 1, FW_FIRE_NO_SMOKE, 0.30f, 2, 24);
FW_VOLUME_ROW(steps32, "volume/steps32/720p", 1280, 720, 1, FW_FIRE_NO_SMOKE, 0.30f, 2, 32);
FW_VOLUME_ROW(octaves1, "volume/octaves1/720p", 1280, 720, 1, FW_FIRE_NO_SMOKE, 0.30f, 2, 64, 1,
              FW_FIRE_HOUSE);
FW_VOLUME_ROW(octaves2, "volume/octaves2/720p", 1280, 720, 1, FW_FIRE_NO_SMOKE, 0.30f, 2, 64, 2,
              FW_FIRE_HOUSE);
FW_VOLUME_ROW(octaves3, "volume/octaves3/720p", 1280, 720, 1, FW_FIRE_NO_SMOKE, 0.30f, 2, 64, 3,
              FW_FIRE_HOUSE);
FW_VOLUME_ROW(octaves4, "volume/octaves4/720p", 1280, 720, 1, FW_FIRE_NO_SMOKE, 0.30f, 2, 64, 4,
              FW_FIRE_HOUSE);
FW_VOLUME_ROW(flames32, "volume/flames32/720p", 1280, 720, 32, FW_FIRE_NO_SMOKE, 1.0f);

}  // namespace
