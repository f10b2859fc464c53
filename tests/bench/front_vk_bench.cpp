// The front on a device: cost of a step with all tiles, with three in a hundred, with the reference
// kernel, and its growth with maps and objects. Compared rows are interleaved in one process; times
// are submit and wait without recording.
#include "bench/bench_device.h"

#include "core/memory.h"
#include "fire/heat.h"
#include "fire/presets.h"
#include "flamewright/flamewright_debug.h"
#include "gpu/vk/vk_backend.h"
#include "support/meshes.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <string>

namespace fw::test::front_vk_bench {
namespace {

// A flat map of `side` x `side` texels, all covered.
const mesh::BurnDomain& flatMap(uint32_t side) {
    static std::map<uint32_t, mesh::BurnDomain> maps;
    auto found = maps.find(side);
    if (found != maps.end()) return found->second;
    const double density = 256;
    const Mesh plane = makePlane(double(side) / density, double(side) / density);
    mesh::BakeInput input = plane.input(density, side);
    input.trustUvs = true;
    return maps.emplace(side, mesh::bake(input, std::pmr::get_default_resource())).first->second;
}

// True for passes of the front's step; predict and reduce are not.
bool isSimulation(const char* pass) {
    for (const char* name : {"schedule", "gather", "arrival", "arrival_rim", "commit"})
        if (std::strcmp(pass, name) == 0) return true;
    return false;
}

// A world on the shared device; one step per frame.
class Bench {
 public:
    Bench()
        : host_(benchDevice().host()),
          memory_(FwCallbacks{}),
          log_(FwCallbacks{}),
          context_(&host_, 0, &memory_, log_),
          backend_(context_, {}, &memory_, log_) {
        context_.prepare();
        view_ = fwDefaultView();
    }
    void addMesh(uint32_t slot, const mesh::BurnDomain& domain) {
        backend_.createMesh(slot, domain);
        domains_.push_back(&domain);
    }
    // rate: texels/s. `heat`: one record for all materials, or null.
    uint32_t addObject(uint32_t mesh, double rate, uint32_t flags = 0,
                       const gpu::HeatMaterial* heat = nullptr) {
        const mesh::BurnDomain& domain = *domains_[mesh];
        gpu::BurnMaterial m{};
        m.sigma0 = uint32_t(std::lround(4096 / (rate * double(domain.texelSide)) *
                                        double(domain.quantum) / 8 * 4194304));
        m.driveMax = 60 * 1024;
        m.breadthMax = 14 * 256;
        m.burnTicks = m.flameTicks = heat ? gpu::kNoneTexel : 4 * 4096;
        m.air = 256;
        m.upCeiling = {0, 1024, 0, 0};
        m.flags = 1;
        m.windowMax = 1u << 20;
        m.powerPerArea = 1e5f;
        m.timeScale = 1;
        const std::vector<gpu::BurnMaterial> materials(gpu::kMaterialsPerObject, m);
        gpu::ObjectInit init{};
        init.mesh = mesh;
        init.record.flags = gpu::kObjectLive | flags;
        init.record.window = 512;
        init.record.horizon = 8192;
        init.record.originQuantum = {domain.origin[0], domain.origin[1], domain.origin[2],
                                     domain.quantum};
        init.record.worldRow0 = {1, 0, 0, 0};
        init.record.worldRow1 = {0, 1, 0, 0};
        init.record.worldRow2 = {0, 0, 1, 0};
        init.record.tint = {1, 1, 1, domain.texelSide * domain.texelSide};
        init.materials = materials;
        std::vector<gpu::HeatMaterial> heats(heat ? gpu::kMaterialsPerObject : 0);
        for (gpu::HeatMaterial& one : heats) one = *heat;
        init.heat = heats;
        backend_.createObject(objects_, init);
        return objects_++;
    }
    void ignite(uint32_t object, uint32_t texel) {
        events_.push_back({object, texel, gpu::kEventIgnite, now_ + 1});
    }
    // Returns the seconds from submit to completion.
    double step(uint32_t switches = 0, bool reduce = false, bool heat = false) {
        std::sort(events_.begin(), events_.end(), [](const auto& a, const auto& b) {
            return a.object != b.object ? a.object < b.object : a.texel < b.texel;
        });
        gpu::StepPlan step;
        step.now = now_;
        step.reduce = reduce;
        step.heat = heat;
        step.events = events_;
        gpu::FramePlan plan;
        plan.frameIndex = ++index_;
        plan.steps = {&step, 1};
        plan.switches = switches;
        plan.endTick = now_ += gpu::kStepTicks;
        DeviceWithoutLayers& d = benchDevice();
        VkCommandBufferBeginInfo begin{};
        begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
        vkBeginCommandBuffer(d.commands, &begin);
        FwVulkanFrame frame{};
        frame.commandBuffer = d.commands;
        frame.frameIndex = index_;
        frame.completedFrameIndex = index_ - 1;
        const Clock::time_point recordStart = Clock::now();
        (void)backend_.beginOutside(frame, view_);
        while (const gpu::Readback* readback = backend_.nextReadback()) {
            runTiles = readback->runTiles;
            frontTiles = readback->frontTiles;
            ++timedSteps;
            double simulation = 0;
            for (const gpu::PassTime& time : backend_.passTimes()) {
                passes[time.name] += time.milliseconds;
                if (isSimulation(time.name)) simulation += time.milliseconds;
            }
            simulationMs.push_back(simulation);
        }
        backend_.run(plan);
        backend_.endOutside();
        recordSeconds = secondsSince(recordStart);
        vkEndCommandBuffer(d.commands);
        VkSubmitInfo submit{};
        submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
        submit.commandBufferCount = 1;
        submit.pCommandBuffers = &d.commands;
        const Clock::time_point start = Clock::now();
        const double cpuStart = cpuSeconds();
        vkQueueSubmit(d.queue, 1, &submit, d.fence);
        vkWaitForFences(d.device, 1, &d.fence, VK_TRUE, ~0ull);
        const double seconds = secondsSince(start);
        stepCpuSeconds = cpuSeconds() - cpuStart;
        vkResetFences(d.device, 1, &d.fence);
        events_.clear();
        return seconds;
    }
    void forgetTimes() {
        passes.clear();
        simulationMs.clear();
        timedSteps = 0;
    }
    // Mean milliseconds of each pass per step, as counters.
    void report(benchmark::State& state, const std::string& prefix = "") const {
        for (const auto& [name, milliseconds] : passes)
            state.counters[prefix + name] = milliseconds / std::max(timedSteps, 1u);
        state.counters[prefix + "sim_ms"] = median(simulationMs);
    }

    std::map<std::string, double> passes;  // ms since forgetTimes
    std::vector<double> simulationMs;      // of each step since: the front's passes only
    uint32_t timedSteps = 0;
    uint32_t runTiles = 0, frontTiles = 0;
    double recordSeconds = 0;   // of the last step
    double stepCpuSeconds = 0;  // of the last step, submit to completion, all threads

 private:
    FwVulkanHost host_;
    core::Memory memory_;
    core::Log log_;
    gpu::vk::Context context_;
    gpu::vk::VkBackend backend_;
    FwView view_;
    std::vector<const mesh::BurnDomain*> domains_;
    uint32_t objects_ = 0;
    std::vector<gpu::TexelEvent> events_;
    uint32_t now_ = 4096;
    uint64_t index_ = 0;
};

// Rows of fires, so that about `share` of the tiles are due.
void igniteLines(Bench& bench, uint32_t object, uint32_t side, double share) {
    const uint32_t tiles = side / 8;
    const auto rows = std::max(1u, uint32_t(share * tiles / 2 + 0.5));
    for (uint32_t row = 0; row < rows; ++row) {
        const uint32_t y = (2 * row + 1) * side / (2 * rows);
        for (uint32_t x = 0; x < side; ++x) bench.ignite(object, y * side + x);
    }
}

enum Kernel { kDense, kSparse, kPublished };

uint32_t flagsOf(Kernel kernel) {
    return kernel == kPublished ? uint32_t(gpu::kObjectExtended) : 0;
}

void runSteps(benchmark::State& state, Bench& bench, Kernel kernel, bool heat = false) {
    const uint32_t switches = kernel == kDense ? uint32_t(FW_DEBUG_DENSE) : 0;
    int step = 0;
    const auto run = [&] { return bench.step(switches, false, heat && step++ % 4 == 2); };
    for (int i = 0; i < 6; ++i) run();
    bench.forgetTimes();
    double tiles = 0;
    std::vector<double> cpu;
    for (auto _ : state) {
        state.SetIterationTime(run());
        tiles += bench.runTiles;
        cpu.push_back(bench.stepCpuSeconds);
    }
    state.counters["cpu_ms"] = median(cpu) * 1e3;
    state.counters["tiles"] = tiles / double(std::max<size_t>(cpu.size(), 1));
    bench.report(state);
}

// One kernel on one map size; three tiles in a hundred burn. The reference kernel has no lists: its
// cost does not depend on the fire.
void frontRows(benchmark::State& state, Kernel kernel) {
    const auto side = uint32_t(state.range(0));
    Bench bench;
    bench.addMesh(0, flatMap(side));
    igniteLines(bench, bench.addObject(0, 12, flagsOf(kernel)), side, 0.03);
    runSteps(state, bench, kernel);
}

// One row with the ratio: dense over sparse on the same map, interleaved.
void frontRatio(benchmark::State& state) {
    const auto side = uint32_t(state.range(0));
    Bench dense, sparse;
    for (Bench* bench : {&dense, &sparse}) {
        bench->addMesh(0, flatMap(side));
        igniteLines(*bench, bench->addObject(0, 12), side, 0.03);
    }
    for (int i = 0; i < 6; ++i) {
        dense.step(FW_DEBUG_DENSE);
        sparse.step();
    }
    dense.forgetTimes();
    sparse.forgetTimes();
    std::vector<double> a, b;
    double tiles = 0;
    for (auto _ : state) {
        a.push_back(dense.step(FW_DEBUG_DENSE));
        b.push_back(sparse.step());
        tiles += sparse.runTiles;
        state.SetIterationTime(a.back() + b.back());
    }
    state.counters["dense_ms"] = median(a) * 1e3;
    state.counters["sparse_ms"] = median(b) * 1e3;
    state.counters["ratio"] = median(a) / median(b);
    // Without the prediction, which costs both the same.
    state.counters["dense_sim_ms"] = median(dense.simulationMs);
    state.counters["sparse_sim_ms"] = median(sparse.simulationMs);
    state.counters["sim_ratio"] = median(dense.simulationMs) / median(sparse.simulationMs);
    state.counters["active_percent"] =
        100 * tiles / double(a.size()) / (double(side / 8) * (side / 8));
}

// Thick wood on a map of `side` texels a side.
const gpu::HeatMaterial& woodOn(uint32_t side) {
    static std::map<uint32_t, gpu::HeatMaterial> woods;
    const mesh::BurnDomain& domain = flatMap(side);
    fire::HeatPlace place;
    place.texelArea = domain.texelSide * domain.texelSide;
    return woods.try_emplace(side, fire::heatMaterial(fire::presetDef(FW_MATERIAL_PINE), place))
        .first->second;
}

// A front across a whole 1024 map.
void frontWide(benchmark::State& state, bool heat) {
    Bench bench;
    bench.addMesh(0, flatMap(1024));
    const uint32_t object = bench.addObject(0, 12, 0, heat ? &woodOn(1024) : nullptr);
    for (uint32_t x = 0; x < 1024; ++x) bench.ignite(object, 512 * 1024 + x);
    runSteps(state, bench, kSparse, heat);
}

// Times of a case step by step, and of each pass.
struct Samples {
    std::vector<double> seconds, cpu, record;
    std::map<std::string, double> passes;  // ms per step
    void add(Bench& bench, bool reduce, bool heat = false) {
        seconds.push_back(bench.step(0, reduce, heat));
        cpu.push_back(bench.stepCpuSeconds);
        record.push_back(bench.recordSeconds);
    }
    void finish(const Bench& bench) {
        for (const auto& [name, milliseconds] : bench.passes)
            passes[name] = milliseconds / std::max(bench.timedSteps, 1u);
    }
};

// Two cases interleaved in one process so that their ratio is sound. Each has a row: the first that
// runs measures both, the other shows its half.
struct InTurns {
    static constexpr int kSteps = 60;
    Samples samples[2];
    bool shown[2] = {true, true};
    // One step in four reduces, and another heats.
    void measure(Bench& a, Bench& b, bool heat) {
        *this = {};
        a.forgetTimes();
        b.forgetTimes();
        for (int i = 0; i < kSteps; ++i) {
            samples[0].add(a, i % 4 == 0, heat && i % 4 == 2);
            samples[1].add(b, i % 4 == 0, heat && i % 4 == 2);
        }
        samples[0].finish(a);
        samples[1].finish(b);
        shown[0] = shown[1] = false;
    }
    // `ratio`: cost of the second over the first.
    void show(benchmark::State& state, int which) {
        const Samples& own = samples[which];
        size_t i = 0;
        for (auto _ : state) state.SetIterationTime(own.seconds[i++ % own.seconds.size()]);
        state.counters["median_ms"] = median(own.seconds) * 1e3;
        state.counters["cpu_ms"] = median(own.cpu) * 1e3;
        state.counters["record_ms"] = median(own.record) * 1e3;
        state.counters["ratio"] = median(samples[1].seconds) / median(samples[0].seconds);
        state.counters["cpu_ratio"] = median(samples[1].cpu) / median(samples[0].cpu);
        for (const auto& [name, milliseconds] : own.passes) state.counters[name] = milliseconds;
        shown[which] = true;
    }
};

// `heat`: all of them have heat.
void burningAndIdle(Bench& bench, uint32_t burning, uint32_t idle, bool heat = false) {
    const gpu::HeatMaterial* wood = heat ? &woodOn(128) : nullptr;
    bench.addMesh(0, flatMap(128));
    bench.addMesh(1, flatMap(64));
    for (uint32_t i = 0; i < burning; ++i)
        bench.ignite(bench.addObject(0, 12, 0, wood), 64 * 128 + 64);
    for (uint32_t i = 0; i < idle; ++i) bench.addObject(1, 12, 0, wood);
    for (int i = 0; i < 20; ++i) bench.step(0, i % 4 == 0, heat && i % 4 == 2);
}

// Ten burning objects, without and with a thousand idle ones.
void objectsBurning(benchmark::State& state, int which, bool heat) {
    static InTurns both[2];
    InTurns& turns = both[heat];
    if (turns.shown[which]) {
        Bench few, many;
        burningAndIdle(few, 10, 0, heat);
        burningAndIdle(many, 10, 1000, heat);
        turns.measure(few, many, heat);
    }
    turns.show(state, which);
}

// One burning object beside many idle ones; many burning ones.
void objectCount(benchmark::State& state, bool burn) {
    const auto count = uint32_t(state.range(0));
    Bench bench;
    burningAndIdle(bench, burn ? count : 1, burn ? 0 : count);
    bench.forgetTimes();
    Samples samples;
    for (auto _ : state) {
        samples.add(bench, samples.seconds.size() % 4 == 0);
        state.SetIterationTime(samples.seconds.back());
    }
    state.counters["cpu_ms"] = median(samples.cpu) * 1e3;
    state.counters["record_ms"] = median(samples.record) * 1e3;
    bench.report(state);
}

// The same small fire on a small and on a large map.
void mapSize(benchmark::State& state, int which, bool heat) {
    static InTurns both[2];
    InTurns& turns = both[heat];
    if (turns.shown[which]) {
        const auto setUp = [&](Bench& bench, uint32_t side) {
            bench.addMesh(0, flatMap(side));
            const gpu::HeatMaterial* wood = heat ? &woodOn(side) : nullptr;
            bench.ignite(bench.addObject(0, 12, 0, wood), side / 2 * side + side / 2);
            for (int i = 0; i < 30; ++i) bench.step(0, false, heat && i % 4 == 2);
        };
        Bench small, large;
        setUp(small, 256);
        setUp(large, 1024);
        turns.measure(small, large, heat);
    }
    turns.show(state, which);
}

// A real mesh in 512^2 texels; a fire in every 64th tile.
void frontMesh(benchmark::State& state, const char* name, Kernel kernel) {
    static std::map<std::string, mesh::BurnDomain> domains;
    auto found = domains.find(name);
    if (found == domains.end()) {
        Mesh mesh;
        std::string error;
        if (!loadGlb(name, mesh, error)) return state.SkipWithError(error.c_str());
        const mesh::BakeInput input = mesh.input(4096, 512);
        found = domains.emplace(name, mesh::bake(input, std::pmr::get_default_resource())).first;
    }
    const mesh::BurnDomain& domain = found->second;
    Bench bench;
    bench.addMesh(0, domain);
    const uint32_t object = bench.addObject(0, 12, flagsOf(kernel));
    for (uint32_t tile = 0; tile < domain.tileCount(); tile += 64) {
        const uint32_t corner = tile / domain.tilesX * 8 * domain.width + tile % domain.tilesX * 8;
        for (uint32_t lane = 0; lane < 64; ++lane) {
            const uint32_t texel = corner + lane / 8 * domain.width + lane % 8;
            if (!domain.real(texel)) continue;
            bench.ignite(object, texel);
            break;
        }
    }
    runSteps(state, bench, kernel);
    state.counters["map_tiles"] = domain.tileCount();
}

// Thick wood on half of a real mesh in 1024^2 texels, all flaming; every step heats and reduces,
// while a world does so in one of four.
void heatMesh(benchmark::State& state) {
    Mesh mesh;
    std::string error;
    if (!loadGlb("bunny_31k.glb", mesh, error)) return state.SkipWithError(error.c_str());
    const mesh::BurnDomain domain =
        mesh::bake(mesh.input(4096, 1024), std::pmr::get_default_resource());
    fire::HeatPlace place;
    place.texelArea = domain.texelSide * domain.texelSide;
    const gpu::HeatMaterial wood = fire::heatMaterial(fire::presetDef(FW_MATERIAL_PINE), place);
    Bench bench;
    bench.addMesh(0, domain);
    const uint32_t object = bench.addObject(0, 0.001, 0, &wood);
    uint32_t lit = 0;
    for (uint32_t i = 0; i < domain.texelCount() / 2; ++i) {
        if (!domain.real(i)) continue;
        bench.ignite(object, i);
        ++lit;
    }
    for (int i = 0; i < 6; ++i) bench.step(0, true, true);
    bench.forgetTimes();
    std::vector<double> cpu;
    for (auto _ : state) {
        state.SetIterationTime(bench.step(0, true, true));
        cpu.push_back(bench.stepCpuSeconds);
    }
    bench.report(state);
    state.counters["cpu_ms"] = median(cpu) * 1e3;
    state.counters["texels"] = lit;
}

// CPU time of recording a frame of a world without fire.
void recordIdle(benchmark::State& state) {
    Bench bench;
    bench.addMesh(0, flatMap(128));
    for (int i = 0; i < 100; ++i) bench.addObject(0, 12);
    for (int i = 0; i < 4; ++i) bench.step();
    for (auto _ : state) {
        bench.step();
        state.SetIterationTime(bench.recordSeconds);
    }
}

BENCHMARK_CAPTURE(frontRows, dense, kDense)
    ->Name("front/dense")
    ->RangeMultiplier(2)
    ->Range(128, 1024)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond)
    ->Iterations(12);
BENCHMARK_CAPTURE(frontRows, sparse, kSparse)
    ->Name("front/sparse3")
    ->RangeMultiplier(2)
    ->Range(128, 1024)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond)
    ->Iterations(12);
BENCHMARK_CAPTURE(frontRows, published, kPublished)
    ->Name("front/published")
    ->RangeMultiplier(2)
    ->Range(128, 1024)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond)
    ->Iterations(12);
#define FW_MESH_ROW(kernel, value, mesh, file)                 \
    BENCHMARK_CAPTURE(frontMesh, kernel##_##mesh, file, value) \
        ->Name("front/" #kernel "_" #mesh "/512")              \
        ->UseManualTime()                                      \
        ->Unit(benchmark::kMillisecond)                        \
        ->Iterations(12)
FW_MESH_ROW(dense, kDense, bunny4k, "bunny_4k.glb");
FW_MESH_ROW(sparse, kSparse, bunny4k, "bunny_4k.glb");
FW_MESH_ROW(published, kPublished, bunny4k, "bunny_4k.glb");
FW_MESH_ROW(dense, kDense, bunny31k, "bunny_31k.glb");
FW_MESH_ROW(sparse, kSparse, bunny31k, "bunny_31k.glb");
FW_MESH_ROW(published, kPublished, bunny31k, "bunny_31k.glb");
BENCHMARK(heatMesh)
    ->Name("heat/bunny31k/1024")
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond)
    ->Iterations(12);
BENCHMARK(frontRatio)
    ->Name("front/dense_over_sparse3")
    ->Arg(512)
    ->Arg(1024)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond)
    ->Iterations(15);
BENCHMARK_CAPTURE(frontWide, plain, false)
    ->Name("front/wide/1024")
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond)
    ->Iterations(20);
BENCHMARK_CAPTURE(frontWide, heat, true)
    ->Name("front/wide_heat/1024")
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond)
    ->Iterations(20);
#define FW_IN_TURNS(function, name, which, heat)             \
    BENCHMARK_CAPTURE(function, which##_##heat, which, heat) \
        ->Name(name)                                         \
        ->UseManualTime()                                    \
        ->Unit(benchmark::kMillisecond)                      \
        ->Iterations(InTurns::kSteps)
FW_IN_TURNS(objectsBurning, "objects/burning10", 0, false);
FW_IN_TURNS(objectsBurning, "objects/burning10_idle1000", 1, false);
FW_IN_TURNS(objectsBurning, "objects/burning10_heat", 0, true);
FW_IN_TURNS(objectsBurning, "objects/burning10_idle1000_heat", 1, true);
FW_IN_TURNS(mapSize, "front/mapsize_smallfire/256", 0, false);
FW_IN_TURNS(mapSize, "front/mapsize_smallfire/1024", 1, false);
FW_IN_TURNS(mapSize, "front/mapsize_smallfire_heat/256", 0, true);
FW_IN_TURNS(mapSize, "front/mapsize_smallfire_heat/1024", 1, true);
BENCHMARK_CAPTURE(objectCount, idle, false)
    ->Name("objects/idle")
    ->RangeMultiplier(10)
    ->Range(1, 1000)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond)
    ->Iterations(12);
BENCHMARK_CAPTURE(objectCount, burning, true)
    ->Name("objects/burning")
    ->RangeMultiplier(10)
    ->Range(1, 100)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond)
    ->Iterations(12);
BENCHMARK(recordIdle)
    ->Name("record/idle")
    ->UseManualTime()
    ->Unit(benchmark::kMicrosecond)
    ->Iterations(200);

}  // namespace
}  // namespace fw::test::front_vk_bench
