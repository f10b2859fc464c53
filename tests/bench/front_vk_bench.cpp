// The front on a device: what a step costs when everything runs, when three tiles in a hundred do,
// when the published kernel runs, and how that grows with maps and objects. Rows that are compared
// run in turns within one process; the times are those of submit and wait, without the recording.
#include <vulkan/vulkan.h>

#include "core/memory.h"
#include "flamewright/flamewright_debug.h"
#include "gpu/vk/vk_backend.h"
#include "support/meshes.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <map>
#include <string>

namespace fw::test {
namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

// CPU time of the whole process, which on a software device is the device's: what a step costs
// however busy the machine is.
double cpuSeconds() {
    std::timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return double(t.tv_sec) + double(t.tv_nsec) * 1e-9;
}

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values.empty() ? 0 : values[values.size() / 2];
}

// A flat map of `side` x `side` texels; all of it real.
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

struct DeviceWithoutLayers {
    VkInstance instance = VK_NULL_HANDLE;
    VkPhysicalDevice physicalDevice = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    VkQueue queue = VK_NULL_HANDLE;
    uint32_t family = 0;
    VkCommandPool pool = VK_NULL_HANDLE;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    VkFence fence = VK_NULL_HANDLE;

    DeviceWithoutLayers() {
        VkApplicationInfo application{};
        application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
        application.apiVersion = VK_API_VERSION_1_0;
        VkInstanceCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
        info.pApplicationInfo = &application;
        if (vkCreateInstance(&info, nullptr, &instance) != VK_SUCCESS) return;
        uint32_t count = 1;
        vkEnumeratePhysicalDevices(instance, &count, &physicalDevice);
        const float priority = 1;
        VkDeviceQueueCreateInfo queueInfo{};
        queueInfo.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
        queueInfo.queueCount = 1;
        queueInfo.pQueuePriorities = &priority;
        VkDeviceCreateInfo deviceInfo{};
        deviceInfo.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
        deviceInfo.queueCreateInfoCount = 1;
        deviceInfo.pQueueCreateInfos = &queueInfo;
        if (vkCreateDevice(physicalDevice, &deviceInfo, nullptr, &device) != VK_SUCCESS) return;
        vkGetDeviceQueue(device, 0, 0, &queue);
        VkCommandPoolCreateInfo poolInfo{};
        poolInfo.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
        poolInfo.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
        vkCreateCommandPool(device, &poolInfo, nullptr, &pool);
        VkCommandBufferAllocateInfo allocate{};
        allocate.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
        allocate.commandPool = pool;
        allocate.commandBufferCount = 1;
        vkAllocateCommandBuffers(device, &allocate, &commands);
        VkFenceCreateInfo fenceInfo{};
        fenceInfo.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
        vkCreateFence(device, &fenceInfo, nullptr, &fence);
    }
    FwVulkanHost host() const {
        FwVulkanHost host{};
        host.structSize = sizeof host;
        host.apiVersion = VK_API_VERSION_1_0;
        host.getInstanceProcAddr = vkGetInstanceProcAddr;
        host.instance = instance;
        host.physicalDevice = physicalDevice;
        host.device = device;
        return host;
    }
};

DeviceWithoutLayers& benchDevice() {
    static DeviceWithoutLayers device;
    return device;
}

// A world of its own on the shared device; one step a frame.
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
    // rate: texels per second.
    uint32_t addObject(uint32_t mesh, double rate, uint32_t flags = 0) {
        const mesh::BurnDomain& domain = *domains_[mesh];
        gpu::BurnMaterial m{};
        m.sigma0 = uint32_t(std::lround(4096 / (rate * double(domain.texelSide)) *
                                        double(domain.quantum) / 8 * 4194304));
        m.driveMax = 60 * 1024;
        m.breadthMax = 14 * 256;
        m.burnTicks = m.flameTicks = 4 * 4096;
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
        backend_.createObject(objects_, init);
        return objects_++;
    }
    void ignite(uint32_t object, uint32_t texel) {
        events_.push_back({object, texel, gpu::kEventIgnite, now_ + 1});
    }
    // Returns the seconds from submit to the end.
    double step(uint32_t switches = 0, bool reduce = false) {
        std::sort(events_.begin(), events_.end(), [](const auto& a, const auto& b) {
            return a.object != b.object ? a.object < b.object : a.texel < b.texel;
        });
        gpu::StepPlan step;
        step.now = now_;
        step.reduce = reduce;
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
        (void)backend_.beginOutside(frame);
        while (const gpu::Readback* readback = backend_.nextReadback()) {
            runTiles = readback->runTiles;
            frontTiles = readback->frontTiles;
            ++timedSteps;
            for (const gpu::PassTime& time : backend_.passTimes())
                passes[time.name] += time.milliseconds;
        }
        backend_.run(plan);
        backend_.endOutside(view_);
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
        timedSteps = 0;
    }
    // Mean milliseconds of each pass of a step, as counters.
    void report(benchmark::State& state, const std::string& prefix = "") const {
        for (const auto& [name, milliseconds] : passes)
            state.counters[prefix + name] = milliseconds / std::max(timedSteps, 1u);
    }

    std::map<std::string, double> passes;  // ms since forgetTimes
    uint32_t timedSteps = 0;
    uint32_t runTiles = 0, frontTiles = 0;
    double recordSeconds = 0;   // of the last step
    double stepCpuSeconds = 0;  // of the last step, submit to the end, all threads

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

// A straight front over the map, so that about `share` of its tiles are due: rows of fires.
void igniteLines(Bench& bench, uint32_t object, uint32_t side, double share) {
    const uint32_t tiles = side / 8;
    const auto rows = std::max(1u, uint32_t(share * tiles / 2 + 0.5));
    for (uint32_t row = 0; row < rows; ++row) {
        const uint32_t y = (2 * row + 1) * side / (2 * rows);
        for (uint32_t x = 0; x < side; ++x) bench.ignite(object, y * side + x);
    }
}

// Dense, sparse at three per cent, and published on one map size, step for step in turns.
void frontRows(benchmark::State& state) {
    const auto side = uint32_t(state.range(0));
    const auto which = uint32_t(state.range(1));  // 0 dense, 1 sparse3, 2 published
    Bench bench;
    bench.addMesh(0, flatMap(side));
    const uint32_t object =
        bench.addObject(0, 12, which == 2 ? uint32_t(gpu::kObjectPublished) : 0);
    igniteLines(bench, object, side, 0.03);
    const uint32_t switches = which == 0 ? uint32_t(FW_DEBUG_DENSE) : 0;
    for (int i = 0; i < 6; ++i) bench.step(switches);
    bench.forgetTimes();
    double tiles = 0;
    std::vector<double> cpu;
    for (auto _ : state) {
        state.SetIterationTime(bench.step(switches));
        tiles += bench.runTiles;
        cpu.push_back(bench.stepCpuSeconds);
    }
    state.counters["cpu_ms"] = median(cpu) * 1e3;
    state.counters["tiles"] = tiles / double(std::max<size_t>(cpu.size(), 1));
    bench.report(state);
}

// One row that holds the ratio: dense over sparse on the same map, in turns.
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
    state.counters["active_percent"] =
        100 * tiles / double(a.size()) / (double(side / 8) * (side / 8));
}

// A front across a whole 1024 map.
void frontWide(benchmark::State& state) {
    Bench bench;
    bench.addMesh(0, flatMap(1024));
    const uint32_t object = bench.addObject(0, 12);
    for (uint32_t x = 0; x < 1024; ++x) bench.ignite(object, 512 * 1024 + x);
    for (int i = 0; i < 6; ++i) bench.step();
    for (auto _ : state) state.SetIterationTime(bench.step());
    state.counters["tiles"] = bench.runTiles;
}

// Ten burning objects, without and with a thousand idle ones beside them, in turns.
void objectsBurning(benchmark::State& state) {
    Bench few, many;
    for (Bench* bench : {&few, &many}) {
        bench->addMesh(0, flatMap(128));
        bench->addMesh(1, flatMap(64));
        for (int i = 0; i < 10; ++i) {
            const uint32_t object = bench->addObject(0, 12);
            bench->ignite(object, 64 * 128 + 64);
        }
        for (int i = 0; bench == &many && i < 1000; ++i) bench->addObject(1, 12);
        for (int i = 0; i < 20; ++i) bench->step(0, i % 4 == 0);
    }
    few.forgetTimes();
    std::vector<double> a, b, recordA, recordB;
    int i = 0;
    for (auto _ : state) {
        const bool reduce = i++ % 4 == 0;
        a.push_back(few.step(0, reduce));
        recordA.push_back(few.recordSeconds);
        b.push_back(many.step(0, reduce));
        recordB.push_back(many.recordSeconds);
        state.SetIterationTime(a.back() + b.back());
    }
    state.counters["burning10_ms"] = median(a) * 1e3;
    state.counters["burning10_idle1000_ms"] = median(b) * 1e3;
    few.report(state);
    state.counters["record10_ms"] = median(recordA) * 1e3;
    state.counters["record10_idle1000_ms"] = median(recordB) * 1e3;
}

// The same small fire on a small and on a large map, in turns.
void mapSize(benchmark::State& state) {
    Bench small, large;
    const auto setUp = [](Bench& bench, uint32_t side) {
        bench.addMesh(0, flatMap(side));
        bench.ignite(bench.addObject(0, 12), side / 2 * side + side / 2);
        for (int i = 0; i < 30; ++i) bench.step();
    };
    setUp(small, 256);
    setUp(large, 1024);
    std::vector<double> a, b;
    for (auto _ : state) {
        a.push_back(small.step());
        b.push_back(large.step());
        state.SetIterationTime(a.back() + b.back());
    }
    state.counters["256_ms"] = median(a) * 1e3;
    state.counters["1024_ms"] = median(b) * 1e3;
    state.counters["ratio"] = median(b) / median(a);
}

// CPU time of recording a frame of a world that does not burn.
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

BENCHMARK(frontRows)
    ->Name("front/dense")
    ->Args({128, 0})
    ->Args({256, 0})
    ->Args({512, 0})
    ->Args({1024, 0})
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond)
    ->Iterations(12);
BENCHMARK(frontRows)
    ->Name("front/sparse3")
    ->Args({128, 1})
    ->Args({256, 1})
    ->Args({512, 1})
    ->Args({1024, 1})
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond)
    ->Iterations(12);
BENCHMARK(frontRows)
    ->Name("front/published")
    ->Args({128, 2})
    ->Args({256, 2})
    ->Args({512, 2})
    ->Args({1024, 2})
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
BENCHMARK(frontWide)
    ->Name("front/wide/1024")
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond)
    ->Iterations(20);
BENCHMARK(objectsBurning)
    ->Name("objects/burning10_idle1000")
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond)
    ->Iterations(40);
BENCHMARK(mapSize)
    ->Name("front/mapsize_smallfire")
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond)
    ->Iterations(60);
BENCHMARK(recordIdle)
    ->Name("record/idle")
    ->UseManualTime()
    ->Unit(benchmark::kMicrosecond)
    ->Iterations(200);

}  // namespace
}  // namespace fw::test
