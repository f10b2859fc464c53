// The vk backend as its users see it: a Context per device, a VkBackend per world. It records into
// the host's command buffers, or submits by itself on a device of its own. Parts: table, device,
// memory, frame_ring, barriers, descriptors, pipelines, timers.
#pragma once
#include "core/owned.h"
#include "gpu/backend.h"
#include "gpu/passes/draw.h"
#include "gpu/vk/memory.h"
#include "gpu/vk/pipelines.h"

namespace fw::gpu::vk {

struct BackendState;

// A host's device and the parts that its worlds share. One per FwContext. Errors are core::Error or
// std::bad_alloc, and leave things unchanged.
class Context {
 public:
    // `host` null: own instance and device, through libvulkan.so.1. `host` is copied; its device,
    // pipeline cache and allocation callbacks must outlive the context. `log` and `memory`, too.
    // gpuMemoryBudget: bytes, 0: none.
    Context(const FwVulkanHost* host, uint64_t gpuMemoryBudget, std::pmr::memory_resource* memory,
            const core::Log& log)
        : device(host, log),
          deviceMemory(device, gpuMemoryBudget, memory),
          pipelines(device, memory) {}

    void prepare() { pipelines.prepare(); }                                  // [any]
    [[nodiscard]] bool ready() const noexcept { return pipelines.ready(); }  // [any]
    FwTargetId registerTarget(const FwVulkanTargetDef& def) {                // [any]
        return pipelines.registerTarget(def);
    }
    // The host has waited. [any]
    void unregisterTarget(FwTargetId id) { pipelines.unregisterTarget(id); }
    void notifyDeviceLost() noexcept { device.notifyLost(); }                 // [any]
    [[nodiscard]] bool deviceLost() const noexcept { return device.lost(); }  // [any]

    // By component, of all worlds together, and "blocks". [any]
    void memoryRows(std::pmr::vector<MemoryRow>& out) const { deviceMemory.rows(out); }
    // FW_OUTPUT_AUTO: the format does not say. [any]
    [[nodiscard]] static FwOutputEncoding encodingOf(VkFormat color) noexcept;
    // As fwTarget_IsReady. Throws FW_ERROR_STALE_ID. [any]
    bool targetReady(FwTargetId id, FwPipelineProgress& progress) {
        return pipelines.targetReady(id, progress);
    }

    // All of FwContextInfo but backend and cpuMemoryUsed. [any]
    void fillInfo(FwContextInfo& info) const noexcept;
    [[nodiscard]] bool ownDevice() const noexcept { return device.own; }
    // Extensions and features that a host may enable for us; structSize stays. [any]
    static void requirements(FwVulkanRequirements& requirements) noexcept;

    Device device;  // before its users: destroyed after them
    DeviceMemory deviceMemory;
    Pipelines pipelines;
};

struct WorldLimits {
    uint32_t maxLights = 16;                          // [0, 64]
    uint32_t maxFlames = 4096;                        // [0, 65536]
    uint32_t maxRefinedTriangles = 400000;            // aimed at, of all objects
    uint32_t volumePixelSize = 2, rayStepCount = 64;  // as FwWorldDef
    uint32_t seed = 1;                                // of everything cosmetic
    float up[3] = {0, 1, 0};                          // world up
    float paceFactor = 1;                             // as FwWorldDef
    AppearanceSources appearances;                    // empty: recordInside draws nothing
    // Buffers end where the last thing in them does, so that a validation layer sees an access past
    // it. For tests: every new object grows them.
    bool exactBuffers = false;
};

// One per FwWorld.
//
// HostImages device:  if (!beginOutside(frame, views)) return FW_NOT_READY;   may throw: bad frame
//               run(plan);                                       exactly once, may be without steps
//               endOutside();
//               recordInside(...) / recordComposite(...)         any number of times, or none
// Own device:   beginOwn(); run(plan); endOwn();                 submits and waits
//               renderOffscreen(def);                            a picture of the present state
// cancelOutside() after a begin whose run threw; nothing was recorded then.
class VkBackend final : public Backend {
 public:
    VkBackend(Context& context, const WorldLimits& limits, std::pmr::memory_resource* memory,
              const core::Log& log);
    ~VkBackend() override;  // the host has waited; never waits itself
    VkBackend(const VkBackend&) = delete;
    VkBackend& operator=(const VkBackend&) = delete;

    void createMesh(uint32_t slot, const mesh::BurnDomain& domain) override;
    void destroyMesh(uint32_t slot) noexcept override;
    [[nodiscard]] bool draws() const noexcept override { return true; }
    void createInnerSkin(uint32_t mesh, const mesh::BurnDomain& domain,
                         std::span<const glm::vec3> places) override;
    void createRefinement(uint32_t mesh, uint32_t depth, bool extended,
                          const mesh::BurnDomain& domain, const mesh::RefineModel& model,
                          std::span<const mesh::RefineHoles> materials) override;
    void createObject(uint32_t slot, const ObjectInit& init) override;
    void destroyObject(uint32_t slot) noexcept override;
    void setObjectWind(uint32_t slot, uint32_t wind) override;
    void setRoom(uint32_t slot, const Room& room) noexcept override;
    void setObjectPose(uint32_t slot, const vec4 rows[3], const vec4& tint,
                       uint32_t flags) override;
    [[nodiscard]] mesh::RefineOptions extendedRefineOptions(uint32_t depth) const override;
    void startBoundary(uint32_t slot, const float point[3], uint32_t tick) noexcept override;
    void setVertices(uint32_t slot, std::span<const float> positions,
                     std::span<const float> normals) noexcept override;
    void setFireProfile(uint32_t slot, std::span<const uint32_t> texels) override;
    void setFlipbooks(uint32_t width, uint32_t height, std::span<const std::byte> texels,
                      std::span<const uint32_t> words) override;
    void setTileFlipbooks(uint32_t flipbooks) noexcept override;
    void createField(uint32_t slot, const FieldRules& rules,
                     std::span<const uint8_t> masks) override;
    void destroyField(uint32_t slot) noexcept override;
    void setFieldRules(uint32_t slot, const FieldRules& rules) noexcept override;
    void setFieldMasks(uint32_t slot, std::span<const uint8_t> masks) override;
    [[nodiscard]] uint64_t fieldBytes(uint32_t slot) const noexcept override;
    void createImage(uint32_t slot, uint32_t width, uint32_t height,
                     std::span<const std::byte> pixels, float alphaCutoff) override;
    void destroyImage(uint32_t slot) override;

    void restore(std::span<const RestoredObject> objects, uint32_t tick) override;

    // Vertices as setVertices', from a buffer that the next frame copies, whose positions are in
    // units of so many metres. Throws where memory is refused.
    void setVertexBuffer(uint32_t slot, const FwVulkanVertices& vertices, float metersPerUnit);

    // Checks pacing and opens the frame. False: pipelines are not built yet. Throws core::Error:
    // FW_ERROR_INVALID_ARGUMENT for pacing, FW_ERROR_DEVICE_LOST once latched.
    // views: 1 to kMaxViews, each with a viewId of its own; copied.
    bool beginOutside(const FwVulkanFrame& frame, std::span<const FwView> views);
    bool beginOutside(const FwVulkanFrame& frame, const FwView& view) {
        return beginOutside(frame, {&view, 1});
    }
    void run(const FramePlan& plan) override;
    void endOutside();
    void cancelOutside() noexcept;
    // False: nothing to draw with yet (pipelines missing); nothing recorded.
    bool recordInside(const FwVulkanFrame& frame, FwTargetId target, const FwView& view,
                      const VkViewport& viewport);
    bool recordComposite(const FwVulkanFrame& frame, FwTargetId target, const FwView& view,
                         const FwVulkanComposite& images);

    void beginOwn();  // builds pipelines that are missing
    void endOwn();    // throws FW_ERROR_DEVICE_LOST
    void renderOffscreen(const FwOffscreenDef& def);

    const Readback* nextReadback() override;
    std::span<const PassTime> passTimes() override;
    void memoryRows(std::pmr::vector<MemoryRow>& out) const override;
    [[nodiscard]] uint64_t detailBytes() const noexcept override;
    [[nodiscard]] uint32_t quadsShown() const noexcept override;
    void moveWorld(const double (&by)[3]) noexcept override;

 private:
    core::Owned<BackendState> state_;
};

}  // namespace fw::gpu::vk
