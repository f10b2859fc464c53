// The draws of a view: inside the host's pass, or as a composite over the host's images. They only
// read; the outside part of the frame made all that they show.
#pragma once
#include "gpu/passes/draw.h"
#include "gpu/vk/descriptors.h"
#include "gpu/vk/frame_ring.h"

namespace fw::gpu::vk {

struct BackendState;

struct HalfImage {
    Image image;
    ImageSet set;
    VkFramebuffer buffer = VK_NULL_HANDLE;
};

// Images of half resolution, for targets with FW_TARGET_HALF_EFFECTS of one size and kind.
struct HalfImages {
    VkFormat format = VK_FORMAT_UNDEFINED;       // of colour
    uint32_t width = 0, height = 0, tilesY = 0;  // texels; 0: none
    HalfImage color;         // soft effects of a view, premultiplied, encoded as its target
    HalfImage depth;         // the host's, and below it by tile whether it shows anything
    uint64_t lastFrame = 0;  // that used it
    bool fresh = true;       // depth has no layout yet
};

// Which of a view's draws: all; or first the soft effects, at half resolution, then the rest, with
// those over it.
enum class DrawPart : uint8_t { all, half, over };

// Sets with images that a view's draws read, or null.
struct HostImages {
    VkDescriptorSet depth = VK_NULL_HANDLE;  // the host's, of half resolution where they draw there
    VkDescriptorSet color = VK_NULL_HANDLE;  // a copy of the host's target
    const HalfImages* half = nullptr;        // the soft effects that were drawn at half resolution
};

// A composite's framebuffer over images that the host keeps (FW_COMPOSITE_KEEP).
struct KeptFramebuffer {
    VkFramebuffer handle = VK_NULL_HANDLE;
    FwTargetId target{};
    VkImageView color = VK_NULL_HANDLE, depth = VK_NULL_HANDLE;
    uint32_t width = 0, height = 0;
    uint64_t lastFrame = 0;  // that may use it
};

// Draws that are recorded: where, and into which images.
struct DrawTargets {
    std::array<KeptFramebuffer, 16> framebuffers{};
    static constexpr size_t kHalfSizes = 4;  // of targets that a world draws into round-robin
    std::array<HalfImages, kHalfSizes> halves{};
    // Of the call that is recorded.
    uint32_t drawnView = 0;  // OutsideView::number
    float transparency = 0;
    VkRect2D scissor{};  // px of the host's target; no extent: none
};

void recordDraws(BackendState& s, FrameInFlight& slot, VkCommandBuffer commands,
                 const Target& target, const FwView& view, const VkViewport& viewport,
                 const HostImages& host, DrawPart part = DrawPart::all);
void setViewport(const BackendState& s, VkCommandBuffer commands,
                 const VkViewport& viewport) noexcept;

// half_resolution.cpp
// Outside any pass: a view's soft effects, into images of half resolution. Null: there are none.
HalfImages* recordHalf(BackendState& s, FrameInFlight& slot, VkCommandBuffer commands,
                       const Target& target, const FwView& view, const VkViewport& viewport,
                       const HostImages& host);
// For the view that was last pushed.
[[nodiscard]] HalfPush halfPushFor(const BackendState& s, const VkViewport& viewport) noexcept;
void dropHalf(BackendState& s, HalfImages& half) noexcept;  // once its last frame is done

}  // namespace fw::gpu::vk
