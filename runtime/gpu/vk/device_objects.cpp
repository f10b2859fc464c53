#include "gpu/vk/device_objects.h"

#include "core/assert.h"

#include <array>

namespace fw::gpu::vk {

bool hasStencil(VkFormat format) noexcept {
    return format == VK_FORMAT_D16_UNORM_S8_UINT || format == VK_FORMAT_D24_UNORM_S8_UINT ||
           format == VK_FORMAT_D32_SFLOAT_S8_UINT || format == VK_FORMAT_S8_UINT;
}

VkImageCreateInfo imageInfo(VkFormat format, uint32_t width, uint32_t height,
                            VkImageUsageFlags usage) noexcept {
    FW_ASSERT(width > 0 && height > 0, "%u x %u pixels", width, height);
    Typed<VkImageCreateInfo> info;
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = format;
    info.extent = {width, height, 1};
    info.mipLevels = info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.tiling = VK_IMAGE_TILING_OPTIMAL;
    info.usage = usage;
    info.initialLayout = VK_IMAGE_LAYOUT_UNDEFINED;
    return info;
}

VkImageMemoryBarrier imageBarrier(VkImage image, VkImageAspectFlags aspect) noexcept {
    Typed<VkImageMemoryBarrier> barrier;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image;
    barrier.subresourceRange = {aspect, 0, 1, 0, 1};
    return barrier;
}

void recordBarriers(const Table& vk, VkCommandBuffer commands, VkPipelineStageFlags before,
                    VkPipelineStageFlags after,
                    std::span<const VkImageMemoryBarrier> barriers) noexcept {
    vk.CmdPipelineBarrier(commands, before, after, 0, 0, nullptr, 0, nullptr,
                          uint32_t(barriers.size()), barriers.data());
}

void beginPass(const Table& vk, VkCommandBuffer commands, VkRenderPass pass,
               VkFramebuffer framebuffer, VkExtent2D extent,
               std::span<const VkClearValue> clears) noexcept {
    FW_ASSERT(pass && framebuffer);
    Typed<VkRenderPassBeginInfo> begin;
    begin.renderPass = pass;
    begin.framebuffer = framebuffer;
    begin.renderArea.extent = extent;
    begin.clearValueCount = uint32_t(clears.size());
    begin.pClearValues = clears.data();
    vk.CmdBeginRenderPass(commands, &begin, VK_SUBPASS_CONTENTS_INLINE);
}

VkRenderPass makeRenderPass(Device& device, std::span<const AttachmentUse> attachments,
                            std::span<const VkSubpassDependency> waits) {
    std::array<VkAttachmentDescription, 2> images{};
    FW_ASSERT(!attachments.empty() && attachments.size() <= images.size(), "%zu attachments",
              attachments.size());
    for (size_t i = 0; i < attachments.size(); ++i) {
        const AttachmentUse& use = attachments[i];
        images[i].format = use.format;
        images[i].samples = VkSampleCountFlagBits(use.samples);
        images[i].loadOp = use.load;
        images[i].storeOp = use.store;
        images[i].stencilLoadOp = use.stencil ? use.load : VK_ATTACHMENT_LOAD_OP_DONT_CARE;
        images[i].stencilStoreOp = use.stencil ? use.store : VK_ATTACHMENT_STORE_OP_DONT_CARE;
        images[i].initialLayout = use.before;
        images[i].finalLayout = use.after;
    }
    const VkAttachmentReference color{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    const VkAttachmentReference depth{1, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};
    VkSubpassDescription subpass{};
    subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
    subpass.colorAttachmentCount = 1;
    subpass.pColorAttachments = &color;
    if (attachments.size() > 1) subpass.pDepthStencilAttachment = &depth;
    Typed<VkRenderPassCreateInfo> info;
    info.attachmentCount = uint32_t(attachments.size());
    info.pAttachments = images.data();
    info.subpassCount = 1;
    info.pSubpasses = &subpass;
    info.dependencyCount = uint32_t(waits.size());
    info.pDependencies = waits.data();
    return device.create(device.table.CreateRenderPass, info, "vkCreateRenderPass");
}

VkFramebuffer makeFramebuffer(Device& device, VkRenderPass pass,
                              std::span<const VkImageView> attachments, uint32_t width,
                              uint32_t height) {
    Typed<VkFramebufferCreateInfo> info;
    info.renderPass = pass;
    info.attachmentCount = uint32_t(attachments.size());
    info.pAttachments = attachments.data();
    info.width = width;
    info.height = height;
    info.layers = 1;
    return device.create(device.table.CreateFramebuffer, info, "vkCreateFramebuffer");
}

VkDescriptorPool makeSets(Device& device, std::span<const VkDescriptorPoolSize> sizes,
                          std::span<const VkDescriptorSetLayout> layouts,
                          std::span<VkDescriptorSet> sets) {
    FW_ASSERT(layouts.size() == sets.size(), "%zu layouts, %zu sets", layouts.size(), sets.size());
    Typed<VkDescriptorPoolCreateInfo> info;
    info.maxSets = uint32_t(layouts.size());
    info.poolSizeCount = uint32_t(sizes.size());
    info.pPoolSizes = sizes.data();
    VkDescriptorPool pool =
        device.create(device.table.CreateDescriptorPool, info, "vkCreateDescriptorPool");
    Typed<VkDescriptorSetAllocateInfo> allocate;
    allocate.descriptorPool = pool;
    allocate.descriptorSetCount = uint32_t(layouts.size());
    allocate.pSetLayouts = layouts.data();
    const VkResult result =
        device.table.AllocateDescriptorSets(device.handle, &allocate, sets.data());
    if (result != VK_SUCCESS) {
        device.destroy(device.table.DestroyDescriptorPool, pool);
        device.check(result, "vkAllocateDescriptorSets");
    }
    return pool;
}

void writeImageSet(const Device& device, VkDescriptorSet set, VkSampler sampler, VkImageView view,
                   VkImageLayout layout) noexcept {
    const VkDescriptorImageInfo image{sampler, view, layout};
    Typed<VkWriteDescriptorSet> write;
    write.dstSet = set;
    write.descriptorCount = 1;
    write.descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    write.pImageInfo = &image;
    device.table.UpdateDescriptorSets(device.handle, 1, &write, 0, nullptr);
}

}  // namespace fw::gpu::vk
