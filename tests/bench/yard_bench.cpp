// A yard of crates through the C ABI: cost of a step on a server without a GPU and on a device.
// Also bytes of a network client, and zero cost of objects that do not burn.
#include "bench/bench_device.h"
#include "common/yard.h"
#include "flamewright/flamewright_debug.h"

#include <benchmark/benchmark.h>

#include <map>
#include <stdexcept>
#include <string>

namespace fw::test::yard_bench {
namespace {

constexpr float kStep = 1.0f / 32;
constexpr int kWarm = 160, kSteps = 128;
constexpr int kIdleSteps = 1024;  // many steps, because they vary by more than the difference
constexpr uint32_t kExchange =
    FW_WORLD_RADIATION | FW_WORLD_PLUME | FW_WORLD_CONTACT | FW_WORLD_EMBERS;

class YardBench {
 public:
    YardBench(uint32_t backend, uint32_t flags, uint32_t burning, uint32_t idle,
              bool lights = true) {
        FwContextDef def = fwDefaultContextDef();
        def.backend = backend;
        FwErrorInfo error{};
        if (fwCreateContext(&def, &context_, &error) != FW_OK)
            throw std::runtime_error(error.message);
        FwWorldDef worldDef = fwDefaultWorldDef();
        worldDef.flags = flags;
        worldDef.paceFactor = 10;
        if (fwCreateWorld(context_, &worldDef, &world_) != FW_OK)
            throw std::runtime_error("the bench has no world");
        yard_ = makeYard(world_, burning + idle);
        for (uint32_t i = 0; lights && i < burning; ++i) lightCrate(world_, yard_, i);
    }
    ~YardBench() { fwDestroyContext(context_); }
    YardBench(const YardBench&) = delete;
    YardBench& operator=(const YardBench&) = delete;

    void step() {
        const Clock::time_point start = Clock::now();
        const double cpuStart = cpuSeconds();
        if (fwWorld_Step(world_, kStep) != FW_OK) throw std::runtime_error("a step fails");
        seconds.push_back(secondsSince(start));
        cpu.push_back(cpuSeconds() - cpuStart);
        FwPassTime times[64];
        const uint32_t count = fwDebug_GetPassTimes(world_, times, 64);
        for (uint32_t i = 0; i < count && i < 64; ++i)
            passes[times[i].name] += double(times[i].milliseconds);
    }
    // A board as tall as a man between every third row, and the crates themselves.
    void shield() {
        const uint32_t rows = (uint32_t(yard_.crates.size()) + yard_.columns - 1) / yard_.columns;
        FwHeatOcclusionDef def = fwDefaultHeatOcclusionDef();
        def.cellSize = 0.15f;
        def.counts[0] = 6 * yard_.columns;
        def.counts[1] = 12;
        def.counts[2] = 6 * rows;
        for (float& origin : def.origin) origin = -0.45f;
        def.origin[1] = 0;
        std::vector<uint8_t> cells(size_t(def.counts[0]) * def.counts[1] * def.counts[2], 0);
        for (uint32_t z = 0; z < def.counts[2]; z += 18)
            for (uint32_t i = 0; i < def.counts[0] * def.counts[1]; ++i)
                cells[size_t(z) * def.counts[0] * def.counts[1] + i] = 1;
        def.cells = cells.data();
        def.flags = FW_HEAT_OCCLUSION_ALL_OBJECTS;
        if (fwWorld_SetHeatOcclusion(world_, &def) != FW_OK)
            throw std::runtime_error("the yard has no shield");
    }
    [[nodiscard]] FwWorld* world() const { return world_; }
    void forget() { seconds.clear(), cpu.clear(), passes.clear(); }
    [[nodiscard]] uint32_t burning() { return stateOf(world_, yard_).burning; }

    std::vector<double> seconds, cpu;
    std::map<std::string, double> passes;  // ms, since `forget`

 private:
    FwContext* context_ = nullptr;
    FwWorld* world_ = nullptr;
    Yard yard_;
};

double mean(const std::vector<double>& values) {
    double sum = 0;
    for (const double value : values) sum += value;
    return values.empty() ? 0 : sum / double(values.size());
}

void show(benchmark::State& state, YardBench& bench) {
    size_t i = 0;
    for (auto _ : state) state.SetIterationTime(bench.seconds[i++ % bench.seconds.size()]);
    state.counters["mean_ms"] = mean(bench.seconds) * 1e3;
    state.counters["cpu_ms"] = mean(bench.cpu) * 1e3;
    state.counters["most_ms"] = *std::max_element(bench.seconds.begin(), bench.seconds.end()) * 1e3;
    state.counters["burning"] = double(bench.burning());
    for (const char* pass : {"heat", "exchange", "exchange_occlusion", "reduce"})
        state.counters[pass] = bench.passes[pass] / double(bench.seconds.size());
    // ms per step for appearance only.
    double looks = 0;
    for (const char* pass : {"lights", "soot", "support", "predict_restart", "predict_states",
                             "predict_gather", "predict", "predict_rim", "predict_commit"})
        looks += bench.passes[pass];
    state.counters["looks"] = looks / double(bench.seconds.size());
}

void burning(benchmark::State& state, uint32_t backend, uint32_t crates) {
    try {
        YardBench bench(backend, kExchange, crates, 0);
        for (int i = 0; i < kWarm + kSteps; ++i) {
            if (i == kWarm) bench.forget();
            bench.step();
        }
        show(state, bench);
        state.counters["load"] = mean(bench.cpu) / double(kStep);
    } catch (const std::exception& failure) {
        state.SkipWithError(failure.what());
    }
}

// Bytes per second of a client of a burning yard, in both directions at a loss of a fifth, once all
// are alight. Hosts issue no commands then.
void shared(benchmark::State& state, uint32_t crates) {
    try {
        YardBench server(FW_BACKEND_CPU, kExchange, crates, 0);
        YardBench client(FW_BACKEND_CPU, kExchange, crates, 0, false);
        FwNetDef def = fwDefaultNetDef();
        def.token = 1;
        FwPeerId peer{};
        if (fwNet_Serve(server.world(), &def) != FW_OK ||
            fwNet_Join(client.world(), &def) != FW_OK ||
            fwNet_AddPeer(server.world(), &peer) != FW_OK)
            throw std::runtime_error("the worlds cannot be shared");
        uint32_t random = 1, lost = 0, packets = 0;
        const auto carry = [&](FwWorld* from, FwPeerId to, FwWorld* target, FwPeerId sender) {
            unsigned char room[1400];
            for (uint32_t size = sizeof room; fwNet_Write(from, to, room, &size) == FW_OK;
                 size = sizeof room) {
                random = random * 1664525u + 1013904223u;
                ++packets;
                if ((random >> 16) % 5 == 0)
                    ++lost;
                else if (fwNet_Read(target, sender, room, size) != FW_OK)
                    throw std::runtime_error("a packet is refused");
            }
        };
        const auto step = [&] {
            server.step();
            (void)fwNet_Update(server.world(), kStep);
            carry(server.world(), peer, client.world(), {});
            (void)fwNet_Update(client.world(), kStep);
            FwNetAction turn{};
            turn.structSize = sizeof turn;
            while (fwNet_NextAction(client.world(), &turn) == FW_OK &&
                   turn.kind == FW_NET_ACTION_STEP)
                if (fwWorld_Step(client.world(), turn.deltaTime) != FW_OK)
                    throw std::runtime_error("a client's step fails");
            carry(client.world(), {}, server.world(), peer);
        };
        const auto bytes = [&](FwWorld* world) {
            FwNetState now{};
            now.structSize = sizeof now;
            (void)fwNet_GetState(world, {}, &now);
            return now;
        };
        for (int i = 0; i < kWarm; ++i) step();
        server.forget();
        const FwNetState before = bytes(server.world()), beforeUp = bytes(client.world());
        for (int i = 0; i < kSteps; ++i) step();
        const FwNetState after = bytes(server.world()), afterUp = bytes(client.world());
        const double seconds = double(kSteps) * double(kStep);
        show(state, server);
        state.counters["bytes_s"] = double(after.bytesOut - before.bytesOut) / seconds;
        state.counters["up_bytes_s"] = double(afterUp.bytesOut - beforeUp.bytesOut) / seconds;
        state.counters["packets_s"] = double(after.packetsOut - before.packetsOut) / seconds;
        state.counters["lost"] = double(lost) / double(packets);
        state.counters["hashes"] = double(afterUp.hashes);
        state.counters["strays"] = double(afterUp.desyncs);
        if (afterUp.phase != FW_NET_FOLLOWING || afterUp.desyncs != 0 || afterUp.hashes == 0)
            throw std::runtime_error("the client does not burn as the server does");
    } catch (const std::exception& failure) {
        state.SkipWithError(failure.what());
    }
}

// Steps both alternately; shows `with`, and its processor time over `without`'s.
void inTurns(benchmark::State& state, int steps, YardBench& without, YardBench& with) {
    for (int i = 0; i < kWarm + steps; ++i)
        for (YardBench* bench : {&without, &with}) {
            if (i == kWarm) bench->forget();
            bench->step();
        }
    show(state, with);
    state.counters["cpu_ratio"] = mean(with.cpu) / mean(without.cpu);
}

// Ten burn, with and without a thousand idle ones.
void idle(benchmark::State& state) {
    try {
        YardBench few(FW_BACKEND_VULKAN, 0, 10, 0), many(FW_BACKEND_VULKAN, 0, 10, 1000);
        inTurns(state, kIdleSteps, few, many);
        state.counters["ratio"] = median(many.seconds) / median(few.seconds);
    } catch (const std::exception& failure) {
        state.SkipWithError(failure.what());
    }
}

// Three hundred burn, with and without occluders.
void shielded(benchmark::State& state) {
    try {
        YardBench open(FW_BACKEND_VULKAN, kExchange, 300, 0);
        YardBench walled(FW_BACKEND_VULKAN, kExchange, 300, 0);
        walled.shield();
        inTurns(state, kSteps, open, walled);
    } catch (const std::exception& failure) {
        state.SkipWithError(failure.what());
    }
}

BENCHMARK_CAPTURE(burning, server, FW_BACKEND_CPU, 100)
    ->Name("server/burning100_step")
    ->UseManualTime()
    ->Iterations(kSteps)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(burning, device, FW_BACKEND_VULKAN, 300)
    ->Name("world/burning300_step")
    ->UseManualTime()
    ->Iterations(kSteps)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(shared, hundred, 100)
    ->Name("net/delta_bytes")
    ->UseManualTime()
    ->Iterations(kSteps)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(shielded)
    ->Name("world/shielded300_step")
    ->UseManualTime()
    ->Iterations(kSteps)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(idle)
    ->Name("world/idle1000_step")
    ->UseManualTime()
    ->Iterations(kIdleSteps)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace fw::test::yard_bench
