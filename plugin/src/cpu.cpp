// The CPU device: simulation without Vulkan.
#include "device.h"
#include "gpu/cpu/cpu_backend.h"

#include <cstdio>

namespace fw::edge {
namespace {

class CpuDevice final : public Device {
 public:
    explicit CpuDevice(core::Memory& memory) : memory_(memory) {}

    gpu::Backend* createBackend(const FwWorldDef& def) override {
        return std::pmr::polymorphic_allocator<>(&memory_).new_object<gpu::cpu::CpuBackend>(
            &memory_, def.maxLights);
    }
    void destroyBackend(gpu::Backend* backend) noexcept override {
        std::pmr::polymorphic_allocator<>(&memory_).delete_object(
            static_cast<gpu::cpu::CpuBackend*>(backend));
    }
    void fillInfo(FwContextInfo& info) const noexcept override {
        std::snprintf(info.deviceName, sizeof info.deviceName, "cpu");
        info.gpuTimers = 1;
    }
    void memoryRows(std::pmr::vector<gpu::MemoryRow>&) const override {}
    void checkTarget(FwTargetId) override {
        core::fail(FW_ERROR_WRONG_BACKEND,
                   "The context is on the cpu backend; the call needs FW_BACKEND_VULKAN.");
    }
    void unregisterTarget(FwTargetId id) override { checkTarget(id); }
    void prepare() override {}
    void step(gpu::Backend&, world::World& world, float deltaTime) override {
        const edge::Stopwatch time(world);
        world.advance(world.lastFrame() + 1, deltaTime);
    }
    void renderOffscreen(gpu::Backend&, const FwOffscreenDef&) override {
        core::fail(FW_ERROR_WRONG_BACKEND,
                   "The context is on the cpu backend, which draws nothing; use "
                   "FW_BACKEND_VULKAN with FwContextDef::vulkan null.");
    }
    [[nodiscard]] bool answersAtOnce() const noexcept override { return true; }
    void destroy() noexcept override {
        std::pmr::polymorphic_allocator<>(&memory_).delete_object(this);
    }

 private:
    core::Memory& memory_;
};

}  // namespace

Device* createCpuDevice(core::Memory& memory) {
    return std::pmr::polymorphic_allocator<>(&memory).new_object<CpuDevice>(memory);
}

}  // namespace fw::edge
