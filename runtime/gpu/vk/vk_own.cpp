// The own-device mode: our command buffer, our submits and waits, and pictures without a host. For
// tools, servers and first steps.
#include "core/error.h"
#include "gpu/vk/world_state.h"

#include <array>
#include <cstring>

namespace fw::gpu::vk {

void VkBackend::State::beginOwn() {
    failIfLost();
    if (!context.pipelines.ready()) context.pipelines.prepare();
    const Table& vk = device.table;
    if (!own.pool) {
        auto pool = typed<VkCommandPoolCreateInfo>(VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO);
        pool.queueFamilyIndex = device.queueFamily;
        device.check(
            vk.CreateCommandPool(device.handle, &pool, device.allocationCallbacks, &own.pool),
            "vkCreateCommandPool");
    }
    if (!own.commands) {
        auto allocate =
            typed<VkCommandBufferAllocateInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO);
        allocate.commandPool = own.pool;
        allocate.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
        allocate.commandBufferCount = 1;
        device.check(vk.AllocateCommandBuffers(device.handle, &allocate, &own.commands),
                     "vkAllocateCommandBuffers");
    }
    if (!own.fence) {
        auto fence = typed<VkFenceCreateInfo>(VK_STRUCTURE_TYPE_FENCE_CREATE_INFO);
        device.check(vk.CreateFence(device.handle, &fence, device.allocationCallbacks, &own.fence),
                     "vkCreateFence");
    }
    device.check(vk.ResetCommandPool(device.handle, own.pool, 0), "vkResetCommandPool");
    auto begin = typed<VkCommandBufferBeginInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO);
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    device.check(vk.BeginCommandBuffer(own.commands, &begin), "vkBeginCommandBuffer");
    FwVulkanFrame frame{};
    frame.commandBuffer = own.commands;
    frame.frameIndex = ring.newest() + 1;
    frame.completedFrameIndex = ring.completed();
    ring.pace(frame, true);
    retired.collect(ring.completed());
    openFrame(own.commands, frame.frameIndex);
}

void VkBackend::State::submitOwn() {
    const Table& vk = device.table;
    device.check(vk.EndCommandBuffer(own.commands), "vkEndCommandBuffer");
    auto submit = typed<VkSubmitInfo>(VK_STRUCTURE_TYPE_SUBMIT_INFO);
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &own.commands;
    device.check(vk.QueueSubmit(device.queue, 1, &submit, own.fence), "vkQueueSubmit");
    device.check(vk.WaitForFences(device.handle, 1, &own.fence, VK_TRUE, ~0ull), "vkWaitForFences");
    device.check(vk.ResetFences(device.handle, 1, &own.fence), "vkResetFences");
    ring.completeAll();
    retired.collect(ring.completed());
}

void VkBackend::State::dropOffscreen() noexcept {
    device.table.DestroyFramebuffer(device.handle, own.framebuffer, device.allocationCallbacks);
    own.framebuffer = VK_NULL_HANDLE;
    deviceMemory.destroy(own.color);
    deviceMemory.destroy(own.depth);
    deviceMemory.destroy(own.pixels);
    own.width = own.height = 0;
}

void VkBackend::State::makeOffscreen(uint32_t width, uint32_t height) {
    constexpr VkFormat kColor = VK_FORMAT_R8G8B8A8_SRGB;
    const Table& vk = device.table;
    if (!own.target.index1) {
        own.depthFormat = VK_FORMAT_D16_UNORM;  // always there
        VkFormatProperties properties{};
        vk.GetPhysicalDeviceFormatProperties(device.physicalDevice, VK_FORMAT_D32_SFLOAT,
                                             &properties);
        if (properties.optimalTilingFeatures & VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT)
            own.depthFormat = VK_FORMAT_D32_SFLOAT;
        FwVulkanTargetDef def{};
        def.flags = FW_TARGET_COMPOSITE | FW_TARGET_AS_NEEDED;
        def.colorFormat = kColor;
        def.depthFormat = own.depthFormat;
        def.samples = 1;
        def.colorAttachmentCount = 1;
        def.depthMode = FW_DEPTH_TEST;
        def.encoding = FW_OUTPUT_SRGB_VIEW;
        own.target = context.pipelines.registerTarget(def);
    }
    if (!own.clearPass) {  // compatible with the target's own pass (no dependencies), but it clears
        std::array<VkAttachmentDescription, 2> attachments{};
        for (size_t i = 0; i < attachments.size(); ++i) {
            attachments[i].format = i ? own.depthFormat : kColor;
            attachments[i].samples = VK_SAMPLE_COUNT_1_BIT;
            attachments[i].loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
            attachments[i].storeOp =
                i ? VK_ATTACHMENT_STORE_OP_DONT_CARE : VK_ATTACHMENT_STORE_OP_STORE;
            attachments[i].stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
            attachments[i].stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
            attachments[i].initialLayout = VK_IMAGE_LAYOUT_UNDEFINED;
            attachments[i].finalLayout = i ? VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL
                                           : VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
        }
        const VkAttachmentReference color{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
        const VkAttachmentReference depth{1, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};
        VkSubpassDescription subpass{};
        subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
        subpass.colorAttachmentCount = 1;
        subpass.pColorAttachments = &color;
        subpass.pDepthStencilAttachment = &depth;
        auto info = typed<VkRenderPassCreateInfo>(VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO);
        info.attachmentCount = uint32_t(attachments.size());
        info.pAttachments = attachments.data();
        info.subpassCount = 1;
        info.pSubpasses = &subpass;
        device.check(
            vk.CreateRenderPass(device.handle, &info, device.allocationCallbacks, &own.clearPass),
            "vkCreateRenderPass");
    }
    if (own.width == width && own.height == height) return;
    dropOffscreen();  // nothing is in flight: every own submit was waited for
    auto image = typed<VkImageCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO);
    image.imageType = VK_IMAGE_TYPE_2D;
    image.format = kColor;
    image.extent = {width, height, 1};
    image.mipLevels = image.arrayLayers = 1;
    image.samples = VK_SAMPLE_COUNT_1_BIT;
    image.tiling = VK_IMAGE_TILING_OPTIMAL;
    image.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    try {
        own.color = deviceMemory.createImage(image, VK_IMAGE_ASPECT_COLOR_BIT, kComponentTargets,
                                             "offscreen colour");
        image.format = own.depthFormat;
        image.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
        own.depth = deviceMemory.createImage(image, VK_IMAGE_ASPECT_DEPTH_BIT, kComponentTargets,
                                             "offscreen depth");
        own.pixels = deviceMemory.createBuffer(
            uint64_t(width) * height * 4, VK_BUFFER_USAGE_TRANSFER_DST_BIT, MemoryKind::readback,
            kComponentTargets, "offscreen pixels");
        const std::array<VkImageView, 2> attached{own.color.view, own.depth.view};
        auto info = typed<VkFramebufferCreateInfo>(VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO);
        info.renderPass = own.clearPass;
        info.attachmentCount = uint32_t(attached.size());
        info.pAttachments = attached.data();
        info.width = width;
        info.height = height;
        info.layers = 1;
        device.check(vk.CreateFramebuffer(device.handle, &info, device.allocationCallbacks,
                                          &own.framebuffer),
                     "vkCreateFramebuffer");
    } catch (...) {
        dropOffscreen();
        throw;
    }
    own.width = width;
    own.height = height;
}

void VkBackend::State::renderOffscreen(const FwOffscreenDef& def) {
    failIfLost();
    makeOffscreen(def.width, def.height);
    const Target& target = *context.pipelines.findTarget(own.target);
    beginOwn();
    uint64_t ringFrame = 0;
    bool recorded = false;
    try {
        // A frame without steps: brings what waits to the device, and what looks need for this
        // view.
        FramePlan plan;
        plan.frameIndex = 0;  // nobody waits for its readback
        plan.detail = detail;
        plan.endTick = simulation.shownTick;
        for (int i = 0; i < 3; ++i) plan.wind[i] = simulation.wind[i];
        plan.tickFraction = simulation.tickFraction;
        plan.switches = (refine.full ? kSwitchRefineFull : 0) | crossing;
        openViews({&def.view, 1});
        OutsideView& of = *open.views[0];
        of.march.screen = screenOf(target.key, {float(def.width), float(def.height)});
        of.height = float(def.height);
        look(def.view, of.height, open.ringFrame);
        run(plan);
        ringFrame = open.ringFrame;
        recorded = open.recording;
        closeFrame();
        const Table& vk = device.table;
        FrameInFlight& slot = ring.slotFor(ringFrame);
        std::array<VkClearValue, 2> clears{};
        std::memcpy(clears[0].color.float32, def.background, sizeof def.background);
        clears[1].depthStencil.depth = 1;
        auto begin = typed<VkRenderPassBeginInfo>(VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO);
        begin.renderPass = own.clearPass;
        begin.framebuffer = own.framebuffer;
        begin.renderArea.extent = {def.width, def.height};
        begin.clearValueCount = uint32_t(clears.size());
        begin.pClearValues = clears.data();
        vk.CmdBeginRenderPass(own.commands, &begin, VK_SUBPASS_CONTENTS_INLINE);
        const VkViewport viewport{0, 0, float(def.width), float(def.height), 0, 1};
        recordDraws(slot, own.commands, target, def.view, viewport, {});
        vk.CmdEndRenderPass(own.commands);
        auto toCopy = typed<VkImageMemoryBarrier>(VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER);
        toCopy.srcAccessMask = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT;
        toCopy.dstAccessMask = VK_ACCESS_TRANSFER_READ_BIT;
        toCopy.oldLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
        toCopy.newLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
        toCopy.srcQueueFamilyIndex = toCopy.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
        toCopy.image = own.color.handle;
        toCopy.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
        vk.CmdPipelineBarrier(own.commands, VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
                              VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, nullptr, 0, nullptr, 1,
                              &toCopy);
        VkBufferImageCopy region{};
        region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        region.imageExtent = {def.width, def.height, 1};
        vk.CmdCopyImageToBuffer(own.commands, own.color.handle,
                                VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, own.pixels.handle, 1,
                                &region);
        auto toHost = typed<VkMemoryBarrier>(VK_STRUCTURE_TYPE_MEMORY_BARRIER);
        toHost.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
        toHost.dstAccessMask = VK_ACCESS_HOST_READ_BIT;
        vk.CmdPipelineBarrier(own.commands, VK_PIPELINE_STAGE_TRANSFER_BIT,
                              VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &toHost, 0, nullptr, 0, nullptr);
    } catch (...) {
        open = {};
        ring.undoOutside();
        throw;
    }
    submitOwn();
    FrameInFlight& done = ring.slotFor(ringFrame);
    if (recorded) applyShown(done.layout, done.readback.mapped);
    done.timers.read(device, 0, results.times);
    results.pictureTime = std::max(sumOf(results.times, 0), 0.0f);
    std::memcpy(def.pixels, own.pixels.mapped, size_t(def.width) * def.height * 4);
}

}  // namespace fw::gpu::vk
