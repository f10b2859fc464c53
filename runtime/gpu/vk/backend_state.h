// The state of a VkBackend: the device's parts, the tables of the scene, and the renderers, each
// with its buffers, dirty flags and recording. Internal to the backend's .cpp files.
#pragma once
#include "gpu/vk/field_renderer.h"
#include "gpu/vk/flame_renderer.h"
#include "gpu/vk/own_device.h"
#include "gpu/vk/particle_renderer.h"
#include "gpu/vk/readback.h"
#include "gpu/vk/scene_tables.h"
#include "gpu/vk/simulation.h"
#include "gpu/vk/surface_renderer.h"
#include "gpu/vk/view_draws.h"
#include "gpu/vk/vk_backend.h"

#include <memory>

namespace fw::gpu::vk {

struct OpenFrame {
    bool open = false, ran = false, recording = false, readback = false;
    bool unseen = false;   // nothing draws before the next one
    bool refined = false;  // the refinement budget was allocated again
    VkCommandBuffer commands = VK_NULL_HANDLE;
    uint64_t ringFrame = 0, planFrame = 0;
    uint32_t endTick = 0;
    FrameInFlight* slot = nullptr;
    std::array<OutsideView*, kMaxViews> views{};  // that it is recorded for
    uint32_t viewCount = 0;
};

struct BackendState {
    BackendState(Context& shared, const WorldLimits& limits, std::pmr::memory_resource* pmr,
                 const core::Log& logTo);
    ~BackendState();
    BackendState(const BackendState&) = delete;
    BackendState& operator=(const BackendState&) = delete;

    Context& context;
    Device& device = context.device;
    DeviceMemory& deviceMemory = context.deviceMemory;
    WorldLimits limits;
    std::pmr::memory_resource* memory;
    const core::Log& log;

    RetireQueue retired{device, deviceMemory, memory};
    FrameRing ring{device};
    WorldBuffers buffers;
    PassSets sets{device, context.pipelines, retired, memory};
    BarrierTracker barriers;
    Buffer views;             // view ring: frame in flight, then view
    uint32_t viewStride = 0;  // bytes

    SceneTables scene{deviceMemory, retired, memory};
    SimulationState simulation{memory};
    DeformRenderer deforming{memory};
    FlameRenderer flames{memory};
    ParticleRenderer particles{float(limits.maxLights)};
    FieldRenderer particleFields{memory};
    SurfaceRenderer surfaces{memory};
    RefineRenderer refine{memory};
    std::shared_ptr<void> extended;  // of an extension, from its first use on
    DrawTargets targets;
    OutsideViews outsideViews{memory};
    ReadbackResults results{memory};
    Detail detail;          // as of the frame's plan
    uint32_t crossing = 0;  // of kSwitchCrossing and kSwitchNoDepthFirst
    ViewParams seen{};      // of the last pushView
    OwnDevice own;
    OpenFrame open;

    void openFrame(VkCommandBuffer commands, uint64_t ringFrame) noexcept;
    // Writes a view's parameters for the passes and draws that follow; returns their offset in
    // `views`. Throws where a frame has too many.
    uint32_t pushView(FrameInFlight& slot, const FwView& view, const VkViewport& viewport);
    // The views that the open frame is recorded for.
    [[nodiscard]] std::span<OutsideView* const> seenFrom() const noexcept {
        return {open.views.data(), open.viewCount};
    }
    [[nodiscard]] bool showsQuads() const noexcept {
        return !simulation.burnEmpty || particles.shows();
    }
    [[nodiscard]] bool showsAnything() const noexcept {
        return (surfaces.drawVertices || particles.shows()) && scene.appearanceTextures.live;
    }
    // Of a view of `height` px; 0: it was never drawn, `otherwise` px.
    [[nodiscard]] ViewParams paramsOf(const FwView& view, float height,
                                      float otherwise) const noexcept;

 private:
    void destroyAll() noexcept;
};

}  // namespace fw::gpu::vk
