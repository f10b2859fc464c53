// All heat-transfer modes: ten burning objects without and with a thousand idle ones. A frame is an
// eighth of a second and holds one exchange. Counts the world's work, recording, submit and wait.
#include "bench/bench_device.h"

#include "core/memory.h"
#include "fire/presets.h"
#include "gpu/vk/vk_backend.h"
#include "support/world_defs.h"
#include "world/world.h"

#include <benchmark/benchmark.h>

#include <map>

namespace fw::test {
namespace {

class WorldBench {
 public:
    explicit WorldBench(uint32_t flags)
        : host_(benchDevice().host()),
          memory_(FwCallbacks{}),
          log_(FwCallbacks{}),
          context_(&host_, 0, &memory_, log_),
          backend_(context_, {}, &memory_, log_),
          view_(fwDefaultView()),
          world(plainWorldDef(flags), backend_, log_, &memory_) {
        context_.prepare();
    }
    // Flat boards of 0.5 m in rows 1.5 m apart; the first ten stand apart and burn slowly.
    void fill(uint32_t burning, uint32_t idle) {
        const Mesh board = makePlane(0.5, 0.5);
        FwBurnableMeshDef def =
            plainBurnableDef(world.scene().createMesh(plainMeshDef(board, 192)));
        FwMaterialDef wood = fire::presetDef(FW_MATERIAL_PLYWOOD);
        def.materials[0] = world.scene().createMaterial(wood);
        for (const int i : {0, 5, 10, 15}) def.transform[i] = 1;
        for (uint32_t i = 0; i < burning + idle; ++i) {
            const bool lit = i < burning;
            def.transform[12] = lit ? -20 - 1.5f * float(i) : 1.5f * float(i % 32);
            def.transform[14] = 1.5f * float(i / 32);
            const FwBurnableMeshId id = world.createBurnableMesh(def);
            if (!lit) continue;
            FwIgnitionDef ball{};
            ball.structSize = sizeof ball;
            ball.kind = FW_IGNITE;
            ball.object = id;
            ball.position[0] = def.transform[12] + 0.25f;
            ball.position[1] = 0.25f;
            ball.position[2] = def.transform[14];
            ball.radius = 0.05f;
            (void)world.burn().ignite(ball);
        }
    }
    void frame() {
        DeviceWithoutLayers& d = benchDevice();
        const Clock::time_point start = Clock::now();
        const double cpuStart = cpuSeconds();
        VkCommandBufferBeginInfo begin{};
        begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
        vkBeginCommandBuffer(d.commands, &begin);
        FwVulkanFrame frame{};
        frame.commandBuffer = d.commands;
        frame.frameIndex = ++index_;
        frame.completedFrameIndex = index_ - 1;
        (void)backend_.beginOutside(frame, view_);
        world.advance(index_, 0.125f);
        backend_.endOutside();
        vkEndCommandBuffer(d.commands);
        hostSeconds.push_back(secondsSince(start));
        VkSubmitInfo submit{};
        submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
        submit.commandBufferCount = 1;
        submit.pCommandBuffers = &d.commands;
        vkQueueSubmit(d.queue, 1, &submit, d.fence);
        vkWaitForFences(d.device, 1, &d.fence, VK_TRUE, ~0ull);
        vkResetFences(d.device, 1, &d.fence);
        seconds.push_back(secondsSince(start));
        cpu.push_back(cpuSeconds() - cpuStart);
    }
    void forget() {
        seconds.clear();
        cpu.clear();
        hostSeconds.clear();
    }

    std::vector<double> seconds, cpu, hostSeconds;  // of each frame; the last without the device

 private:
    FwVulkanHost host_;
    core::Memory memory_;
    core::Log log_;
    gpu::vk::Context context_;
    gpu::vk::VkBackend backend_;
    FwView view_;
    uint64_t index_ = 0;

 public:
    world::World world;
};

constexpr int kFrames = 60;

// Interleaved, so that their ratio is sound; the first row that runs measures both.
void exchange(benchmark::State& state, uint32_t flags, int which) {
    struct Both {
        std::vector<double> seconds[2], cpu[2], host[2];
        bool shown[2] = {true, true};
    };
    static std::map<uint32_t, Both> all;
    Both& both = all[flags];
    if (both.shown[which]) {
        WorldBench few(flags), many(flags);
        few.fill(10, 0);
        many.fill(10, 1000);
        WorldBench* benches[2] = {&few, &many};
        for (int i = 0; i < 20 + kFrames; ++i)
            for (WorldBench* bench : benches) {
                if (i == 20) bench->forget();
                bench->frame();
            }
        for (int i = 0; i < 2; ++i) {
            both.seconds[i] = benches[i]->seconds;
            both.cpu[i] = benches[i]->cpu;
            both.host[i] = benches[i]->hostSeconds;
            both.shown[i] = false;
        }
    }
    size_t i = 0;
    for (auto _ : state) state.SetIterationTime(both.seconds[which][i++ % kFrames]);
    state.counters["median_ms"] = median(both.seconds[which]) * 1e3;
    state.counters["cpu_ms"] = median(both.cpu[which]) * 1e3;
    state.counters["host_ms"] = median(both.host[which]) * 1e3;
    state.counters["ratio"] = median(both.seconds[1]) / median(both.seconds[0]);
    state.counters["cpu_ratio"] = median(both.cpu[1]) / median(both.cpu[0]);
    both.shown[which] = true;
}

#define FW_EXCHANGE_ROW(flags, which, name)         \
    BENCHMARK_CAPTURE(exchange, name, flags, which) \
        ->Name("objects/" name)                     \
        ->UseManualTime()                           \
        ->Unit(benchmark::kMillisecond)             \
        ->Iterations(kFrames)
FW_EXCHANGE_ROW(15u, 0, "exchange10");
FW_EXCHANGE_ROW(15u, 1, "exchange10_idle1000");
FW_EXCHANGE_ROW(0u, 0, "noexchange10");
FW_EXCHANGE_ROW(0u, 1, "noexchange10_idle1000");

}  // namespace
}  // namespace fw::test
