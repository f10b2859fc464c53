// What a context computes on. Two of them: the cpu (cpu.cpp) and Vulkan (vulkan.cpp).
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
    // One frame of deltaTime s that is over when the call returns; throws
    // FW_ERROR_WRONG_BACKEND where the host records.
    virtual void step(gpu::Backend& backend, world::World& world, float deltaTime) = 0;
    virtual void renderOffscreen(gpu::Backend& backend, const FwOffscreenDef& def) = 0;
    // Answers come without a frame of the host's: a step of no time brings them.
    [[nodiscard]] virtual bool answersAtOnce() const noexcept = 0;
    virtual void destroy() noexcept = 0;  // frees itself

    Device() = default;
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;
};

Device* createCpuDevice(core::Memory& memory);
// `host` null: an own device.
Device* createVulkanDevice(const FwVulkanHost* host, uint64_t gpuMemoryBudget, core::Memory& memory,
                           const core::Log& log);

// Tells a world how long its host's thread was in a call that counts against the budget.
class Stopwatch {
 public:
    explicit Stopwatch(world::World& world) noexcept : world_(world) {}
    ~Stopwatch() {
        world_.spend(std::chrono::duration<float, std::milli>(Clock::now() - from_).count());
    }
    Stopwatch(const Stopwatch&) = delete;
    Stopwatch& operator=(const Stopwatch&) = delete;

 private:
    using Clock = std::chrono::steady_clock;
    world::World& world_;
    Clock::time_point from_ = Clock::now();
};

}  // namespace fw::edge
