// The own-device mode: our command buffer, our submits and waits, and pictures without a host. For
// tools, servers and first steps.
#pragma once
#include "gpu/vk/memory.h"

namespace fw::gpu::vk {

struct BackendState;

struct OwnDevice {
    VkCommandPool pool = VK_NULL_HANDLE;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    VkFence fence = VK_NULL_HANDLE;
    Image color, depth;  // of pictures
    Buffer pixels;
    VkRenderPass clearPass = VK_NULL_HANDLE;
    VkFramebuffer framebuffer = VK_NULL_HANDLE;
    FwTargetId target{};
    VkFormat depthFormat = VK_FORMAT_UNDEFINED;
    uint32_t width = 0, height = 0;
};

void destroyOwn(BackendState& s) noexcept;

}  // namespace fw::gpu::vk
