// Vulkan objects that several files make alike: render passes, framebuffers, descriptor sets of
// images, and the structures that describe images.
#pragma once
#include "gpu/vk/device.h"

#include <span>

namespace fw::gpu::vk {

[[nodiscard]] bool hasStencil(VkFormat format) noexcept;

[[nodiscard]] VkImageCreateInfo imageInfo(VkFormat format, uint32_t width, uint32_t height,
                                          VkImageUsageFlags usage) noexcept;

// A barrier of mip 0 and layer 0, without accesses and layouts.
[[nodiscard]] VkImageMemoryBarrier imageBarrier(VkImage image, VkImageAspectFlags aspect) noexcept;

// Between `before` and `after`, for images alone.
void recordBarriers(const Table& vk, VkCommandBuffer commands, VkPipelineStageFlags before,
                    VkPipelineStageFlags after,
                    std::span<const VkImageMemoryBarrier> barriers) noexcept;

// How a pass finds and leaves an attachment. `stencil`: its stencil is loaded and stored, too.
struct AttachmentUse {
    VkFormat format = VK_FORMAT_UNDEFINED;
    uint32_t samples = 1;
    VkAttachmentLoadOp load = VK_ATTACHMENT_LOAD_OP_LOAD;
    VkAttachmentStoreOp store = VK_ATTACHMENT_STORE_OP_STORE;
    VkImageLayout before = VK_IMAGE_LAYOUT_UNDEFINED, after = VK_IMAGE_LAYOUT_UNDEFINED;
    bool stencil = false;
};
// One subpass that draws into a colour attachment and, where there are two, a depth attachment.
[[nodiscard]] VkRenderPass makeRenderPass(Device& device,
                                          std::span<const AttachmentUse> attachments,
                                          std::span<const VkSubpassDependency> waits = {});

[[nodiscard]] VkFramebuffer makeFramebuffer(Device& device, VkRenderPass pass,
                                            std::span<const VkImageView> attachments,
                                            uint32_t width, uint32_t height);

void beginPass(const Table& vk, VkCommandBuffer commands, VkRenderPass pass,
               VkFramebuffer framebuffer, VkExtent2D extent,
               std::span<const VkClearValue> clears) noexcept;

// A pool with one set of each layout; `sets` receives them.
[[nodiscard]] VkDescriptorPool makeSets(Device& device, std::span<const VkDescriptorPoolSize> sizes,
                                        std::span<const VkDescriptorSetLayout> layouts,
                                        std::span<VkDescriptorSet> sets);

// Writes binding 0 of a set of one combined image sampler.
void writeImageSet(const Device& device, VkDescriptorSet set, VkSampler sampler, VkImageView view,
                   VkImageLayout layout) noexcept;

}  // namespace fw::gpu::vk
