#include "gpu/vk/own_device.h"

#include "core/error.h"
#include "gpu/vk/backend_state.h"
#include "gpu/vk/device_objects.h"

#include <array>
#include <cstring>

namespace fw::gpu::vk {
namespace {

constexpr VkFormat kColor = VK_FORMAT_R8G8B8A8_SRGB;

void dropOffscreen(BackendState& s) noexcept {
    OwnDevice& own = s.own;
    s.device.destroy(s.device.table.DestroyFramebuffer, own.framebuffer);
    s.deviceMemory.destroy(own.color);
    s.deviceMemory.destroy(own.depth);
    s.deviceMemory.destroy(own.pixels);
    own.width = own.height = 0;
}

void registerOwnTarget(BackendState& s) {
    OwnDevice& own = s.own;
    own.depthFormat = VK_FORMAT_D16_UNORM;  // always there
    VkFormatProperties properties{};
    s.device.table.GetPhysicalDeviceFormatProperties(s.device.physicalDevice, VK_FORMAT_D32_SFLOAT,
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
    own.target = s.context.pipelines.registerTarget(def);
}

void makeOffscreen(BackendState& s, uint32_t width, uint32_t height) {
    OwnDevice& own = s.own;
    if (!own.target.index1) registerOwnTarget(s);
    if (!own.clearPass) {  // compatible with the target's own pass (no dependencies), but it clears
        const AttachmentUse attachments[] = {
            {.format = kColor,
             .load = VK_ATTACHMENT_LOAD_OP_CLEAR,
             .after = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL},
            {.format = own.depthFormat,
             .load = VK_ATTACHMENT_LOAD_OP_CLEAR,
             .store = VK_ATTACHMENT_STORE_OP_DONT_CARE,
             .after = VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL}};
        own.clearPass = makeRenderPass(s.device, attachments);
    }
    if (own.width == width && own.height == height) return;
    dropOffscreen(s);  // nothing is in flight: every own submit was waited for
    try {
        own.color = s.deviceMemory.createImage(
            imageInfo(kColor, width, height,
                      VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT),
            VK_IMAGE_ASPECT_COLOR_BIT, kComponentTargets, "offscreen colour");
        own.depth = s.deviceMemory.createImage(
            imageInfo(own.depthFormat, width, height, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT),
            VK_IMAGE_ASPECT_DEPTH_BIT, kComponentTargets, "offscreen depth");
        own.pixels = s.deviceMemory.createBuffer(
            uint64_t(width) * height * 4, VK_BUFFER_USAGE_TRANSFER_DST_BIT, MemoryKind::readback,
            kComponentTargets, "offscreen pixels");
        const std::array<VkImageView, 2> attached{own.color.view, own.depth.view};
        own.framebuffer = makeFramebuffer(s.device, own.clearPass, attached, width, height);
    } catch (...) {
        dropOffscreen(s);
        throw;
    }
    own.width = width;
    own.height = height;
}

// Ends the command buffer, submits it and waits.
void submitOwn(BackendState& s) {
    Device& device = s.device;
    const Table& vk = device.table;
    device.check(vk.EndCommandBuffer(s.own.commands), "vkEndCommandBuffer");
    Typed<VkSubmitInfo> submit;
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &s.own.commands;
    device.check(vk.QueueSubmit(device.queue, 1, &submit, s.own.fence), "vkQueueSubmit");
    device.check(vk.WaitForFences(device.handle, 1, &s.own.fence, VK_TRUE, ~0ull),
                 "vkWaitForFences");
    device.check(vk.ResetFences(device.handle, 1, &s.own.fence), "vkResetFences");
    s.ring.completeAll();
    s.retired.collect(s.ring.completed());
}

void openOwn(BackendState& s) {
    Device& device = s.device;
    OwnDevice& own = s.own;
    device.failIfLost();
    if (!s.context.pipelines.ready()) s.context.pipelines.prepare();
    const Table& vk = device.table;
    if (!own.pool) {
        Typed<VkCommandPoolCreateInfo> pool;
        pool.queueFamilyIndex = device.queueFamily;
        own.pool = device.create(vk.CreateCommandPool, pool, "vkCreateCommandPool");
    }
    if (!own.commands) {
        Typed<VkCommandBufferAllocateInfo> allocate;
        allocate.commandPool = own.pool;
        allocate.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
        allocate.commandBufferCount = 1;
        device.check(vk.AllocateCommandBuffers(device.handle, &allocate, &own.commands),
                     "vkAllocateCommandBuffers");
    }
    if (!own.fence) {
        const Typed<VkFenceCreateInfo> fence;
        own.fence = device.create(vk.CreateFence, fence, "vkCreateFence");
    }
    device.check(vk.ResetCommandPool(device.handle, own.pool, 0), "vkResetCommandPool");
    Typed<VkCommandBufferBeginInfo> begin;
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    device.check(vk.BeginCommandBuffer(own.commands, &begin), "vkBeginCommandBuffer");
    FwVulkanFrame frame{};
    frame.commandBuffer = own.commands;
    frame.frameIndex = s.ring.newest() + 1;
    frame.completedFrameIndex = s.ring.completed();
    s.ring.pace(frame, true);
    s.retired.collect(s.ring.completed());
    s.openFrame(own.commands, frame.frameIndex);
}

void recordPicture(BackendState& s, const FwOffscreenDef& def, const Target& target,
                   FrameInFlight& slot) {
    const Table& vk = s.device.table;
    const OwnDevice& own = s.own;
    std::array<VkClearValue, 2> clears{};
    std::memcpy(clears[0].color.float32, def.background, sizeof def.background);
    clears[1].depthStencil.depth = 1;
    beginPass(vk, own.commands, own.clearPass, own.framebuffer, {def.width, def.height}, clears);
    const VkViewport viewport{0, 0, float(def.width), float(def.height), 0, 1};
    recordDraws(s, slot, own.commands, target, def.view, viewport, {});
    vk.CmdEndRenderPass(own.commands);
    VkImageMemoryBarrier toCopy = imageBarrier(own.color.handle, VK_IMAGE_ASPECT_COLOR_BIT);
    toCopy.srcAccessMask = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT;
    toCopy.dstAccessMask = VK_ACCESS_TRANSFER_READ_BIT;
    toCopy.oldLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    toCopy.newLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    recordBarriers(vk, own.commands, VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
                   VK_PIPELINE_STAGE_TRANSFER_BIT, {&toCopy, 1});
    VkBufferImageCopy region{};
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.imageExtent = {def.width, def.height, 1};
    vk.CmdCopyImageToBuffer(own.commands, own.color.handle, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                            own.pixels.handle, 1, &region);
    Typed<VkMemoryBarrier> toHost;
    toHost.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
    toHost.dstAccessMask = VK_ACCESS_HOST_READ_BIT;
    vk.CmdPipelineBarrier(own.commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_HOST_BIT,
                          0, 1, &toHost, 0, nullptr, 0, nullptr);
}

}  // namespace

void destroyOwn(BackendState& s) noexcept {
    dropOffscreen(s);
    s.device.destroy(s.device.table.DestroyRenderPass, s.own.clearPass);
    s.device.destroy(s.device.table.DestroyFence, s.own.fence);
    s.device.destroy(s.device.table.DestroyCommandPool, s.own.pool);
}

void VkBackend::beginOwn() {
    openOwn(*state_);
    state_->open.unseen = true;  // pictures are frames of their own
}

void VkBackend::endOwn() {
    endOutside();
    submitOwn(*state_);
}

void VkBackend::renderOffscreen(const FwOffscreenDef& def) {
    BackendState& s = *state_;
    s.device.failIfLost();
    makeOffscreen(s, def.width, def.height);
    const Target& target = *s.context.pipelines.findTarget(s.own.target);
    openOwn(s);
    uint64_t ringFrame = 0;
    bool recorded = false;
    try {
        // A frame without steps: uploads pending changes, and records the effects of this view.
        FramePlan plan;
        plan.frameIndex = 0;  // nobody waits for its readback
        plan.detail = s.detail;
        plan.endTick = s.simulation.shownTick;
        std::copy(std::begin(s.simulation.wind), std::end(s.simulation.wind), plan.wind);
        plan.tickFraction = s.simulation.tickFraction;
        plan.switches = (s.refine.full ? kSwitchRefineFull : 0) | s.crossing;
        s.outsideViews.open(s, {&def.view, 1});
        OutsideView& of = *s.open.views[0];
        of.march.screen = s.flames.screenOf(s, target.key, {float(def.width), float(def.height)});
        of.height = float(def.height);
        markVisible(s, def.view, of.height, s.open.ringFrame);
        run(plan);
        ringFrame = s.open.ringFrame;
        recorded = s.open.recording;
        endOutside();
        recordPicture(s, def, target, s.ring.slotFor(ringFrame));
    } catch (...) {
        s.open = {};
        s.ring.undoOutside();
        throw;
    }
    submitOwn(s);
    FrameInFlight& done = s.ring.slotFor(ringFrame);
    if (recorded) applyShown(s, done.layout, done.readback.mapped);
    done.timers.read(s.device, 0, s.results.times);
    s.results.pictureTime = std::max(sumOf(s.results.times, 0), 0.0f);
    std::memcpy(def.pixels, s.own.pixels.mapped, size_t(def.width) * def.height * 4);
}

}  // namespace fw::gpu::vk
