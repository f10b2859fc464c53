// See frames.h.
#include "shell/frames.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

namespace fwui {

using sample::checkVulkan;

Frames::Frames(const sample::VulkanHost& host, const char* title, VkExtent2D size)
    : host_(host), size_(size) {
    if (host.made.windowed) {
        window = std::make_unique<sample::Window>(host, title, size.width, size.height);
        if (!window->takesCopies)
            throw sample::Failure("pictures cannot be copied to this display's windows");
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
    makePass(window ? window->format : VK_FORMAT_R8G8B8A8_UNORM);
    makeOutput();
}

Frames::~Frames() {
    vkDeviceWaitIdle(host_.device);
    dropOutput();
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
    output.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
    output.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    output.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
    output.stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
    output.initialLayout = output.finalLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
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

void Frames::dropOutput() {
    vkDestroyFramebuffer(host_.device, framebuffer_, nullptr);
    framebuffer_ = VK_NULL_HANDLE;
    host_.destroy(output_);
}

void Frames::makeOutput() {
    checkVulkan(vkDeviceWaitIdle(host_.device), "vkDeviceWaitIdle");
    dropOutput();
    if (window) generation_ = window->generation;
    sample::ImageRequest request;
    request.width = extent().width;
    request.height = extent().height;
    if (window) request.format = window->format;
    request.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    output_ = host_.createImage(request);
    if (!window)
        readback_ = host_.createBuffer(VkDeviceSize{size_.width} * size_.height * 4,
                                       VK_BUFFER_USAGE_TRANSFER_DST_BIT, true);
    host_.runNow([&](VkCommandBuffer commands) {
        sample::imageBarrier(
            commands, output_.image, VK_IMAGE_LAYOUT_UNDEFINED,
            VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, 0,
            VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
            VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT);
    });
    fresh_ = true;
    VkFramebufferCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO;
    info.renderPass = outputPass;
    info.attachmentCount = 1;
    info.pAttachments = &output_.view;
    info.width = request.width;
    info.height = request.height;
    info.layers = 1;
    checkVulkan(vkCreateFramebuffer(host_.device, &info, nullptr, &framebuffer_),
                "vkCreateFramebuffer");
}

bool Frames::begin(Frame& frame) {
    Slot& slot = slots_[(index_ + 1) % kSlots];
    checkVulkan(vkWaitForFences(host_.device, 1, &slot.fence, VK_TRUE, ~0ull), "vkWaitForFences");
    completed_ = std::max(completed_, slot.index);
    if (window && !window->acquire(slot.available, imageIndex_)) return false;
    if (window && window->generation != generation_) makeOutput();
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

bool Frames::beginOutput(const Frame& frame) {
    VkRenderPassBeginInfo info{};
    info.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO;
    info.renderPass = outputPass;
    info.framebuffer = framebuffer_;
    info.renderArea = {{0, 0}, frame.extent};
    vkCmdBeginRenderPass(frame.commands, &info, VK_SUBPASS_CONTENTS_INLINE);
    return std::exchange(fresh_, false);
}

void Frames::copyToWindow(const Frame& frame) const {
    const VkImage to = window->images[imageIndex_];
    sample::imageBarrier(frame.commands, to, VK_IMAGE_LAYOUT_UNDEFINED,
                         VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_PIPELINE_STAGE_TRANSFER_BIT, 0,
                         VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT);
    VkImageCopy copy{};
    copy.srcSubresource = copy.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    copy.extent = {frame.extent.width, frame.extent.height, 1};
    vkCmdCopyImage(frame.commands, output_.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to,
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
    sample::imageBarrier(frame.commands, to, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                         VK_IMAGE_LAYOUT_PRESENT_SRC_KHR, VK_PIPELINE_STAGE_TRANSFER_BIT,
                         VK_ACCESS_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, 0);
}

void Frames::end(const Frame& frame) {
    vkCmdEndRenderPass(frame.commands);
    Slot& slot = slots_[frame.slot];
    if (window) {
        copyToWindow(frame);
    } else {
        VkBufferImageCopy region{};
        region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        region.imageExtent = {size_.width, size_.height, 1};
        // The previous frame's copy wrote the same buffer.
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
    const VkPipelineStageFlags stage = VK_PIPELINE_STAGE_TRANSFER_BIT;
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
