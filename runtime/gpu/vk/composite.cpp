// The draws in the host's own pass, or as a composite over the host's images; sets and framebuffers
// of these images.
#include "core/error.h"
#include "gpu/vk/backend_state.h"
#include "gpu/vk/device_objects.h"

#include <algorithm>
#include <array>

namespace fw::gpu::vk {
namespace {

bool isMixed(const FwVulkanFrame& frame) noexcept {
    return frame.transparency > 0.0f && frame.transparency < 1.0f;
}

// Haze is drawn where a frame gives its colour, so none is no fault.
void checkHostColor(const Target& target, const FwVulkanFrame& frame) {
    if (isMixed(frame) && !target.key.transparency)
        core::refuse(
            "FwVulkanFrame::transparency is %g and the target was registered without "
            "FW_TARGET_TRANSPARENCY (64); only 0 and 1 are drawn there.",
            double(frame.transparency));
    if (isMixed(frame) && !frame.sampledColor)
        core::refuse(
            "FwVulkanFrame::transparency is %g and sampledColor is null; between 0 and 1 a "
            "copy of what the target holds is needed. Give one in FwFrameInfo, or draw into "
            "a layer of "
            "your own and blend that.",
            double(frame.transparency));
    if ((!target.key.haze && !isMixed(frame)) || !frame.sampledColor ||
        frame.sampledColorLayout == VK_IMAGE_LAYOUT_GENERAL ||
        frame.sampledColorLayout == VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL)
        return;
    core::refuse(
        "FwVulkanFrame::sampledColorLayout is %d; our shaders read colour that is in "
        "GENERAL (1) or SHADER_READ_ONLY_OPTIMAL (5).",
        int(frame.sampledColorLayout));
}

constexpr VkAccessFlags kColorAccess =
    VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT;
constexpr VkAccessFlags kDepthAccess =
    VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
constexpr VkPipelineStageFlags kDepthStages =
    VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT;

// Hosts' views come and go: a set is written for each use, never kept with a view.
VkDescriptorSet hostSetFor(BackendState& s, FrameInFlight& slot, VkImageView view,
                           VkImageLayout layout) {
    constexpr uint32_t kSets = FrameInFlight::kHostSets;
    if (!slot.hostPool) {
        const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, kSets};
        std::array<VkDescriptorSetLayout, kSets> layouts{};
        layouts.fill(s.context.pipelines.imageSetLayout());
        slot.hostPool = makeSets(s.device, {&size, 1}, layouts, slot.hostSets);
    }
    if (slot.hostSetCount == kSets)
        core::refuse(
            "A frame is drawn more than %u times against a sampled depth; that is the limit.",
            FrameInFlight::kHostDraws);
    const VkDescriptorSet set = slot.hostSets[slot.hostSetCount++];
    writeImageSet(s.device, set, s.context.pipelines.depthSampler(), view, layout);
    return set;
}

// Sets of the host's images that the target's passes read. Throws where a frame has too many.
HostImages hostImagesFor(BackendState& s, FrameInFlight& slot, const Target& target,
                         const FwVulkanFrame& frame, VkImageView depth, VkImageLayout depthLayout) {
    HostImages host;
    if (target.key.samplesDepth()) host.depth = hostSetFor(s, slot, depth, depthLayout);
    if ((target.key.haze || isMixed(frame)) && frame.sampledColor)
        host.color = hostSetFor(s, slot, frame.sampledColor, frame.sampledColorLayout);
    return host;
}

// Of targets that are gone, and of `forget`; the device may still use them.
void dropFramebuffers(BackendState& s, FwTargetId forget) noexcept {
    for (KeptFramebuffer& one : s.targets.framebuffers) {
        const bool forgotten =
            one.target.index1 == forget.index1 && one.target.generation == forget.generation;
        if (!one.handle || (!forgotten && s.context.pipelines.isTarget(one.target))) continue;
        s.retired.push(one.lastFrame, {.framebuffer = one.handle});
        one = {};
    }
}

VkFramebuffer framebufferFor(BackendState& s, FrameInFlight& slot, const Target& target,
                             FwTargetId targetId, const FwVulkanComposite& composite) {
    const bool hasDepth = target.key.attachesDepth();
    const std::array<VkImageView, 2> attachments{composite.color.view,
                                                 hasDepth ? composite.depth.view : VK_NULL_HANDLE};
    const bool keep = (composite.flags & FW_COMPOSITE_KEEP) != 0;
    auto& kept = s.targets.framebuffers;
    KeptFramebuffer* room = nullptr;
    if (!keep) dropFramebuffers(s, targetId);
    for (KeptFramebuffer& one : kept) {
        if (!keep || one.target.index1 != targetId.index1 ||
            one.target.generation != targetId.generation || one.color != attachments[0] ||
            one.depth != attachments[1] || one.width != composite.width ||
            one.height != composite.height)
            continue;
        one.lastFrame = slot.frameIndex;
        return one.handle;
    }
    if (keep) {
        dropFramebuffers(s, {});
        const auto free = std::find_if(kept.begin(), kept.end(),
                                       [](const KeptFramebuffer& one) { return !one.handle; });
        if (free != kept.end()) room = &*free;
    }
    s.retired.promise(1);
    const VkFramebuffer framebuffer =
        makeFramebuffer(s.device, target.ownPass, std::span(attachments).first(hasDepth ? 2 : 1),
                        composite.width, composite.height);
    if (room)
        *room = {framebuffer,     targetId,         attachments[0], attachments[1],
                 composite.width, composite.height, slot.frameIndex};
    else  // more than are kept come and go with their frame
        s.retired.push(slot.frameIndex, {.framebuffer = framebuffer});
    return framebuffer;
}

void checkDepth(const FwVulkanFrame& frame, const VkViewport& viewport) {
    if (!frame.sampledDepth)
        core::refuse("FwVulkanFrame::sampledDepth is null but the target has FW_DEPTH_SAMPLED.");
    if (frame.sampledDepthLayout != VK_IMAGE_LAYOUT_GENERAL &&
        frame.sampledDepthLayout != VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL &&
        frame.sampledDepthLayout != VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL)
        core::refuse(
            "FwVulkanFrame::sampledDepthLayout is %d; our shaders read images that are in "
            "GENERAL (1), DEPTH_STENCIL_READ_ONLY_OPTIMAL (4) or SHADER_READ_ONLY_OPTIMAL "
            "(5).",
            int(frame.sampledDepthLayout));
    if (viewport.minDepth != 0.0f || viewport.maxDepth != 1.0f)
        core::refuse("viewport->minDepth is %g and maxDepth is %g; FW_DEPTH_SAMPLED needs 0 and 1.",
                     double(viewport.minDepth), double(viewport.maxDepth));
}

void checkImage(const FwVulkanImage& image, const char* name) {
    const auto refuse = [&](const char* field, uint32_t value, const char* why) {
        core::refuse("FwVulkanComposite::%s.%s is %u; %s.", name, field, value, why);
    };
    if (image.layoutAfter == VK_IMAGE_LAYOUT_UNDEFINED ||
        image.layoutAfter == VK_IMAGE_LAYOUT_PREINITIALIZED)
        refuse("layoutAfter", uint32_t(image.layoutAfter),
               "no image can be brought to that layout; name the one of its next use");
    if (image.stageBefore == 0)
        refuse("stageBefore", 0, "name the stages that used the image last, or TOP_OF_PIPE (1)");
    if (image.stageAfter == 0)
        refuse("stageAfter", 0,
               "name the stages that use the image next, or BOTTOM_OF_PIPE (8192)");
}

void checkComposite(const Device& device, const Target& target, const FwVulkanComposite& images) {
    const bool hasDepth = target.key.depthMode != FW_DEPTH_NONE;
    if (images.color.layoutBefore == VK_IMAGE_LAYOUT_UNDEFINED)
        core::refuse(
            "FwVulkanComposite::color.layoutBefore is VK_IMAGE_LAYOUT_UNDEFINED; the "
            "image would lose what the host drew.");
    if (hasDepth && (!images.depth.image || !images.depth.view))
        core::refuse("FwVulkanComposite::depth is null but the target has depth mode %u.",
                     uint32_t(target.key.depthMode));
    if (hasDepth && images.depth.layoutBefore == VK_IMAGE_LAYOUT_UNDEFINED)
        core::refuse(
            "FwVulkanComposite::depth.layoutBefore is VK_IMAGE_LAYOUT_UNDEFINED; the image "
            "would lose the depth that is to be tested or sampled.");
    checkImage(images.color, "color");
    if (hasDepth) checkImage(images.depth, "depth");
    const VkPhysicalDeviceLimits& limits = device.properties.limits;
    if (images.width > limits.maxFramebufferWidth || images.height > limits.maxFramebufferHeight)
        core::refuse(
            "FwVulkanComposite is %u x %u pixels; the device's largest framebuffer is %u x %u.",
            images.width, images.height, limits.maxFramebufferWidth, limits.maxFramebufferHeight);
}

// The barriers that bring a composite's images to our layouts, and back.
struct CompositeBarriers {
    CompositeBarriers(const Target& target, const FwVulkanComposite& images) {
        add(images.color, imageBarrier(images.color.image, VK_IMAGE_ASPECT_COLOR_BIT),
            VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT, kColorAccess,
            VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
        if (target.key.depthMode != FW_DEPTH_NONE) {
            const VkImageMemoryBarrier depth =
                imageBarrier(images.depth.image,
                             VK_IMAGE_ASPECT_DEPTH_BIT |
                                 (hasStencil(target.key.depth) ? VK_IMAGE_ASPECT_STENCIL_BIT : 0));
            if (target.key.samplesDepth())
                add(images.depth, depth, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT,
                    VK_ACCESS_SHADER_READ_BIT, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL);
            else
                add(images.depth, depth, kDepthStages, kDepthAccess,
                    VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL);
        }
    }
    void recordIn(const Table& vk, VkCommandBuffer commands) const noexcept {
        recordBarriers(vk, commands, before, ours, std::span(in).first(count));
    }
    void recordOut(const Table& vk, VkCommandBuffer commands) const noexcept {
        recordBarriers(vk, commands, ours, after, std::span(out).first(count));
    }

 private:
    void add(const FwVulkanImage& image, const VkImageMemoryBarrier& barrier,
             VkPipelineStageFlags stages, VkAccessFlags access, VkImageLayout layout) noexcept {
        VkImageMemoryBarrier &to = in[count], &back = out[count];
        ++count;
        to = back = barrier;
        to.srcAccessMask = image.accessBefore;
        to.dstAccessMask = back.srcAccessMask = access;
        to.oldLayout = image.layoutBefore;
        to.newLayout = back.oldLayout = layout;
        back.dstAccessMask = image.accessAfter;
        back.newLayout = image.layoutAfter;
        before |= image.stageBefore;
        after |= image.stageAfter;
        ours |= stages;
    }
    std::array<VkImageMemoryBarrier, 2> in{}, out{};
    uint32_t count = 0;
    VkPipelineStageFlags before = 0, after = 0, ours = 0;
};

}  // namespace

bool VkBackend::recordInside(const FwVulkanFrame& frame, FwTargetId targetId, const FwView& view,
                             const VkViewport& viewport) {
    BackendState& s = *state_;
    s.device.failIfLost();
    if (!s.context.pipelines.ready()) return false;
    const Target& target = *s.context.pipelines.findTarget(targetId);
    if (target.key.composite)
        core::refuse(
            "The target was registered with FW_TARGET_COMPOSITE; it is for "
            "fwWorld_RecordComposite.");
    if (target.key.samplesDepth()) checkDepth(frame, viewport);
    checkHostColor(target, frame);
    const VkPhysicalDeviceLimits& limits = s.device.properties.limits;
    if (viewport.width > float(limits.maxViewportDimensions[0]) ||
        viewport.height > float(limits.maxViewportDimensions[1]))
        core::refuse("viewport is %g x %g pixels; the device's maxViewportDimensions are %u x %u.",
                     double(viewport.width), double(viewport.height),
                     limits.maxViewportDimensions[0], limits.maxViewportDimensions[1]);
    s.ring.pace(frame, false);
    FrameInFlight& slot = s.ring.slotFor(frame.frameIndex);
    s.targets.scissor = frame.scissor;
    s.targets.transparency = frame.transparency;
    recordDraws(
        s, slot, frame.commandBuffer, target, view, viewport,
        hostImagesFor(s, slot, target, frame, frame.sampledDepth, frame.sampledDepthLayout));
    return true;
}

bool VkBackend::recordComposite(const FwVulkanFrame& frame, FwTargetId targetId, const FwView& view,
                                const FwVulkanComposite& images) {
    BackendState& s = *state_;
    s.device.failIfLost();
    if (!s.context.pipelines.ready()) return false;
    const Target& target = *s.context.pipelines.findTarget(targetId);
    if (!target.key.composite)
        core::refuse(
            "The target was registered without FW_TARGET_COMPOSITE; it is for "
            "fwWorld_RecordInside.");
    checkComposite(s.device, target, images);
    checkHostColor(target, frame);
    if (images.width == 0 || images.height == 0) return true;
    s.ring.pace(frame, false);
    FrameInFlight& slot = s.ring.slotFor(frame.frameIndex);
    HostImages host = hostImagesFor(s, slot, target, frame, images.depth.view,
                                    VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL);
    const VkFramebuffer framebuffer = framebufferFor(s, slot, target, targetId, images);
    s.targets.scissor = frame.scissor;
    s.targets.transparency = frame.transparency;

    const Table& vk = s.device.table;
    const VkCommandBuffer commands = frame.commandBuffer;
    const CompositeBarriers barriers(target, images);
    barriers.recordIn(vk, commands);
    const VkViewport viewport{0, 0, float(images.width), float(images.height), 0, 1};
    if (target.key.half) host.half = recordHalf(s, slot, commands, target, view, viewport, host);
    beginPass(vk, commands, target.ownPass, framebuffer, {images.width, images.height}, {});
    recordDraws(s, slot, commands, target, view, viewport, host,
                target.key.half ? DrawPart::over : DrawPart::all);
    vk.CmdEndRenderPass(commands);
    barriers.recordOut(vk, commands);
    return true;
}

}  // namespace fw::gpu::vk
