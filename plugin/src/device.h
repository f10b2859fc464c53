// The device of a context: CPU (cpu.cpp) or Vulkan (vulkan.cpp).
#pragma once
#include "core/log.h"
#include "core/memory.h"
#include "gpu/backend.h"
#include "world/world.h"

#include <chrono>

namespace fw::edge {

class Device {
 public:
    virtual ~Device() = default;

    virtual gpu::Backend* createBackend(const FwWorldDef& def) = 0;
    virtual void destroyBackend(gpu::Backend* backend) noexcept = 0;
    virtual void fillInfo(FwContextInfo& info) const noexcept = 0;
    // Memory that all worlds share. [any]
    virtual void memoryRows(std::pmr::vector<gpu::MemoryRow>& out) const = 0;
    // Throws unless it is a registered target. [any]
    virtual void checkTarget(FwTargetId id) = 0;
    virtual void unregisterTarget(FwTargetId id) = 0;  // [any]
    virtual void prepare() = 0;
    // Runs one frame of deltaTime s to its end. Throws FW_ERROR_WRONG_BACKEND on a host device.
    virtual void step(gpu::Backend& backend, world::World& world, float deltaTime) = 0;
    virtual void renderOffscreen(gpu::Backend& backend, const FwOffscreenDef& def) = 0;
    // True: a step with deltaTime 0 answers requests, without a frame of the host.
    [[nodiscard]] virtual bool answersAtOnce() const noexcept = 0;
    virtual void destroy() noexcept = 0;  // frees itself

    Device() = default;
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;
};

Device* createCpuDevice(core::Memory& memory);
// host null: creates an own device.
Device* createVulkanDevice(const FwVulkanHost* host, uint64_t gpuMemoryBudget, core::Memory& memory,
                           const core::Log& log);

// Adds the duration of a call to the world's budget.
class Stopwatch {
 public:
    explicit Stopwatch(world::World& world) noexcept : world_(world) {}
    ~Stopwatch() {
        world_.budget().spend(
            std::chrono::duration<float, std::milli>(Clock::now() - from_).count());
    }
    Stopwatch(const Stopwatch&) = delete;
    Stopwatch& operator=(const Stopwatch&) = delete;

 private:
    using Clock = std::chrono::steady_clock;
    world::World& world_;
    Clock::time_point from_ = Clock::now();
};

}  // namespace fw::edge
