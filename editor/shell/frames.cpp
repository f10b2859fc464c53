// See frames.h.
#include "shell/frames.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace fwui {

using sample::checkVulkan;

Frames::Frames(const sample::VulkanHost& host, const char* title, VkExtent2D size)
    : host_(host), size_(size) {
    VkFormat format = VK_FORMAT_R8G8B8A8_UNORM;
    if (host.made.windowed) {
        window = std::make_unique<sample::Window>(host, title, size.width, size.height);
        format = window->format;
    }
    for (Slot& slot : slots_) {
        VkCommandPoolCreateInfo poolInfo{};
        poolInfo.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
        poolInfo.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
        poolInfo.queueFamilyIndex = host.queueFamily;
        checkVulkan(vkCreateCommandPool(host.device, &poolInfo, nullptr, &slot.pool),
                    "vkCreateCommandPool");
        VkCommandBufferAllocateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
        info.commandPool = slot.pool;
        info.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
        info.commandBufferCount = 1;
        checkVulkan(vkAllocateCommandBuffers(host.device, &info, &slot.commands),
                    "vkAllocateCommandBuffers");
        const VkFenceCreateInfo fence{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO, nullptr,
                                      VK_FENCE_CREATE_SIGNALED_BIT};
        checkVulkan(vkCreateFence(host.device, &fence, nullptr, &slot.fence), "vkCreateFence");
        const VkSemaphoreCreateInfo semaphore{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, nullptr, 0};
        checkVulkan(vkCreateSemaphore(host.device, &semaphore, nullptr, &slot.available),
                    "vkCreateSemaphore");
    }
    makePass(format);
    makeFramebuffers();
}

Frames::~Frames() {
    vkDeviceWaitIdle(host_.device);
    dropFramebuffers();
    host_.destroy(output_);
    host_.destroy(readback_);
    for (Slot& slot : slots_) {
        vkDestroyCommandPool(host_.device, slot.pool, nullptr);
        vkDestroyFence(host_.device, slot.fence, nullptr);
        vkDestroySemaphore(host_.device, slot.available, nullptr);
    }
    vkDestroyRenderPass(host_.device, outputPass, nullptr);
}

void Frames::makePass(VkFormat format) {
    VkAttachmentDescription output{};
    output.format = format;
    output.samples = VK_SAMPLE_COUNT_1_BIT;
    output.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    output.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    output.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
    output.stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
    output.finalLayout =
        window ? VK_IMAGE_LAYOUT_PRESENT_SRC_KHR : VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    const VkAttachmentReference reference{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    VkSubpassDescription subpass{};
    subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
    subpass.colorAttachmentCount = 1;
    subpass.pColorAttachments = &reference;
    std::array<VkSubpassDependency, 2> dependencies{};
    dependencies[0].srcSubpass = VK_SUBPASS_EXTERNAL;
    dependencies[0].srcStageMask =
        VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT;
    dependencies[0].srcAccessMask = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT;
    dependencies[0].dstStageMask = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
    dependencies[0].dstAccessMask =
        VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT;
    dependencies[1].dstSubpass = VK_SUBPASS_EXTERNAL;
    dependencies[1].srcStageMask = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
    dependencies[1].srcAccessMask = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT;
    dependencies[1].dstStageMask = VK_PIPELINE_STAGE_TRANSFER_BIT;
    dependencies[1].dstAccessMask = VK_ACCESS_TRANSFER_READ_BIT;
    VkRenderPassCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO;
    info.attachmentCount = 1;
    info.pAttachments = &output;
    info.subpassCount = 1;
    info.pSubpasses = &subpass;
    info.dependencyCount = uint32_t(dependencies.size());
    info.pDependencies = dependencies.data();
    checkVulkan(vkCreateRenderPass(host_.device, &info, nullptr, &outputPass),
                "vkCreateRenderPass");
}

void Frames::dropFramebuffers() {
    for (VkFramebuffer framebuffer : framebuffers_)
        vkDestroyFramebuffer(host_.device, framebuffer, nullptr);
    framebuffers_.clear();
}

void Frames::makeFramebuffers() {
    dropFramebuffers();
    std::vector<VkImageView> views;
    if (window) {
        views = window->views;
        generation_ = window->generation;
    } else {
        if (!output_.image) {
            sample::ImageRequest request;
            request.width = size_.width;
            request.height = size_.height;
            request.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
            output_ = host_.createImage(request);
            readback_ = host_.createBuffer(VkDeviceSize{size_.width} * size_.height * 4,
                                           VK_BUFFER_USAGE_TRANSFER_DST_BIT, true);
        }
        views.push_back(output_.view);
    }
    for (const VkImageView& view : views) {
        VkFramebufferCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO;
        info.renderPass = outputPass;
        info.attachmentCount = 1;
        info.pAttachments = &view;
        info.width = extent().width;
        info.height = extent().height;
        info.layers = 1;
        VkFramebuffer made = VK_NULL_HANDLE;
        checkVulkan(vkCreateFramebuffer(host_.device, &info, nullptr, &made),
                    "vkCreateFramebuffer");
        framebuffers_.push_back(made);
    }
}

bool Frames::begin(Frame& frame) {
    Slot& slot = slots_[(index_ + 1) % kSlots];
    checkVulkan(vkWaitForFences(host_.device, 1, &slot.fence, VK_TRUE, ~0ull), "vkWaitForFences");
    completed_ = std::max(completed_, slot.index);
    if (window && !window->acquire(slot.available, imageIndex_)) return false;
    if (window && window->generation != generation_) makeFramebuffers();
    checkVulkan(vkResetFences(host_.device, 1, &slot.fence), "vkResetFences");
    checkVulkan(vkResetCommandPool(host_.device, slot.pool, 0), "vkResetCommandPool");
    VkCommandBufferBeginInfo info{};
    info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    checkVulkan(vkBeginCommandBuffer(slot.commands, &info), "vkBeginCommandBuffer");
    slot.index = ++index_;
    frame.commands = slot.commands;
    frame.index = index_;
    frame.completed = completed_;
    frame.slot = uint32_t(index_ % kSlots);
    frame.extent = extent();
    return true;
}

void Frames::beginOutput(const Frame& frame) {
    VkClearValue clear{};
    clear.color.float32[3] = 1;
    VkRenderPassBeginInfo info{};
    info.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO;
    info.renderPass = outputPass;
    info.framebuffer = framebuffers_[window ? imageIndex_ : 0];
    info.renderArea = {{0, 0}, frame.extent};
    info.clearValueCount = 1;
    info.pClearValues = &clear;
    vkCmdBeginRenderPass(frame.commands, &info, VK_SUBPASS_CONTENTS_INLINE);
}

void Frames::end(const Frame& frame) {
    vkCmdEndRenderPass(frame.commands);
    Slot& slot = slots_[frame.slot];
    if (!window) {
        VkBufferImageCopy region{};
        region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        region.imageExtent = {size_.width, size_.height, 1};
        // The copy of the frame before wrote the same buffer.
        VkMemoryBarrier barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER, nullptr,
                                VK_ACCESS_TRANSFER_WRITE_BIT, VK_ACCESS_TRANSFER_WRITE_BIT};
        vkCmdPipelineBarrier(frame.commands, VK_PIPELINE_STAGE_TRANSFER_BIT,
                             VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 1, &barrier, 0, nullptr, 0,
                             nullptr);
        vkCmdCopyImageToBuffer(frame.commands, output_.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                               readback_.buffer, 1, &region);
        barrier.dstAccessMask = VK_ACCESS_HOST_READ_BIT;
        vkCmdPipelineBarrier(frame.commands, VK_PIPELINE_STAGE_TRANSFER_BIT,
                             VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &barrier, 0, nullptr, 0, nullptr);
    }
    checkVulkan(vkEndCommandBuffer(frame.commands), "vkEndCommandBuffer");
    VkSubmitInfo submit{};
    submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &slot.commands;
    const VkPipelineStageFlags stage = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
    VkSemaphore rendered = VK_NULL_HANDLE;
    if (window) {
        rendered = window->rendered(imageIndex_);
        submit.waitSemaphoreCount = 1;
        submit.pWaitSemaphores = &slot.available;
        submit.pWaitDstStageMask = &stage;
        submit.signalSemaphoreCount = 1;
        submit.pSignalSemaphores = &rendered;
    }
    checkVulkan(vkQueueSubmit(host_.queue, 1, &submit, slot.fence), "vkQueueSubmit");
    if (window) window->present(imageIndex_);
}

sample::Picture Frames::picture() {
    checkVulkan(vkDeviceWaitIdle(host_.device), "vkDeviceWaitIdle");
    sample::Picture picture;
    picture.width = size_.width;
    picture.height = size_.height;
    picture.rgba.resize(size_t(size_.width) * size_.height * 4);
    std::memcpy(picture.rgba.data(), readback_.mapped, picture.rgba.size());
    return picture;
}

}  // namespace fwui
