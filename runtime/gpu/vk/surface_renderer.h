// Burnable meshes as draws show them: the list of their draws, which follows the objects.
#pragma once
#include "gpu/passes/draw.h"
#include "gpu/vk/device.h"
#include "gpu/vk/frame.h"

namespace fw::gpu::vk {

struct BackendState;

struct SurfaceRenderer {
    explicit SurfaceRenderer(std::pmr::memory_resource* pmr) : drawItems(pmr), surfaceSteps(pmr) {}
    // Records of objects that are new, moved or gone, and the list of what draws show.
    void recordObjects(BackendState& s, FrameRecorder& recorder);
    // The draws of an object follow its materials; `chooses`: and its fire, which selects
    // pipelines.
    void update(const BackendState& s, uint32_t object, bool chooses) noexcept;
    // The draws in order.
    [[nodiscard]] std::span<const SurfaceStep> steps() noexcept;
    void drop(uint32_t object) noexcept;

    std::pmr::vector<DrawItem> drawItems;        // objects that draws show, by object
    std::pmr::vector<SurfaceStep> surfaceSteps;  // their draws, in order
    bool surfacesDirty = false;                  // `drawItems` changed since
    // As last recorded.
    VkBuffer drawVertices = VK_NULL_HANDLE, drawIndices = VK_NULL_HANDLE,
             drawShown = VK_NULL_HANDLE;

 private:
    std::span<DrawItem> itemsOf(uint32_t object) noexcept;
};

}  // namespace fw::gpu::vk
