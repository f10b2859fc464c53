// What is soft of a view at half resolution: images for it, by size, and their passes.
#include "core/error.h"
#include "gpu/vk/world_state.h"

#include <algorithm>
#include <array>
#include <utility>

namespace fw::gpu::vk {
namespace {

constexpr uint64_t kHalfKept = 60;  // frames from when a size was last drawn

VkFramebuffer makeFramebuffer(Device& device, VkRenderPass pass, VkImageView view, uint32_t width,
                              uint32_t height) {
    auto info = typed<VkFramebufferCreateInfo>(VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO);
    info.renderPass = pass;
    info.attachmentCount = 1;
    info.pAttachments = &view;
    info.width = width;
    info.height = height;
    info.layers = 1;
    VkFramebuffer framebuffer = VK_NULL_HANDLE;
    device.check(device.table.CreateFramebuffer(device.handle, &info, device.allocationCallbacks,
                                                &framebuffer),
                 "vkCreateFramebuffer");
    return framebuffer;
}

}  // namespace

void VkBackend::State::dropHalf(HalfImages& half) noexcept {
    retired.push(half.lastFrame, half.color);
    retired.push(half.lastFrame, half.depth);
    retired.push(half.lastFrame, half.colorSet.pool);
    retired.push(half.lastFrame, half.depthSet.pool);
    retired.pushFramebuffer(half.lastFrame, half.colorBuffer);
    retired.pushFramebuffer(half.lastFrame, half.depthBuffer);
    half = {};
}

void VkBackend::State::makeHalf(HalfImages& half, VkFormat format, uint32_t width,
                                uint32_t height) {
    constexpr size_t kPieces = 6;
    retired.promise(kPieces);
    half.format = format;
    half.width = width;
    half.height = height;
    half.tilesY = (height + kHalfTile - 1) / kHalfTile;
    auto info = typed<VkImageCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO);
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = format;
    info.extent = {width, height, 1};
    info.mipLevels = info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.tiling = VK_IMAGE_TILING_OPTIMAL;
    info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
    info.initialLayout = VK_IMAGE_LAYOUT_UNDEFINED;
    const Pipelines& pipelines = context.pipelines;
    try {
        half.color = deviceMemory.createImage(info, VK_IMAGE_ASPECT_COLOR_BIT, kComponentTargets,
                                              "half resolution");
        info.format = Pipelines::kHalfDepth;
        info.extent.height = height + half.tilesY;
        half.depth = deviceMemory.createImage(info, VK_IMAGE_ASPECT_COLOR_BIT, kComponentTargets,
                                              "half resolution, depth");
        // Read texel by texel.
        half.colorSet = makeImageSet(device, pipelines, half.color.view, pipelines.depthSampler());
        half.depthSet = makeImageSet(device, pipelines, half.depth.view, pipelines.depthSampler());
        half.colorBuffer =
            makeFramebuffer(device, pipelines.halfPass(format), half.color.view, width, height);
        half.depthBuffer = makeFramebuffer(device, pipelines.halfDepthPass(), half.depth.view,
                                           width, info.extent.height);
    } catch (...) {
        dropHalf(half);
        throw;
    }
}

HalfImages& VkBackend::State::halfFor(VkFormat format, uint32_t width, uint32_t height,
                                      uint64_t frame) {
    HalfImages* found = nullptr;
    for (HalfImages& one : surfaces.halves)
        if (one.format == format && one.width == width && one.height == height) found = &one;
    if (!found) {
        // Sizes that the host has left behind go, and where all are in use that of longest ago.
        for (HalfImages& one : surfaces.halves)
            if (one.width && one.lastFrame + kHalfKept < frame) dropHalf(one);
        found = &*std::min_element(
            surfaces.halves.begin(), surfaces.halves.end(),
            [](const auto& a, const auto& b) { return a.lastFrame < b.lastFrame; });
        if (found->width) dropHalf(*found);
        makeHalf(*found, format, width, height);
    }
    found->lastFrame = frame;
    return *found;
}

HalfImages* VkBackend::State::recordHalf(FrameInFlight& slot, VkCommandBuffer commands,
                                         const Target& target, const FwView& view,
                                         const VkViewport& viewport, const HostImages& host) {
    const bool shows = !simulation.burnEmpty || showsEmitters() ||
                       !particleFields.fieldDraws.empty() || !flames.volumes.empty();
    if (!showsAnything() || !shows) return nullptr;
    const HalfPush push = halfPushFor(viewport);
    const VkRect2D clip =
        std::exchange(surfaces.scissor, {});  // of the picture that this goes over
    HalfImages& half = halfFor(target.key.halfColor, push.texelsX, push.texelsY, slot.frameIndex);
    const Table& vk = device.table;
    if (half.fresh) {
        auto barrier = typed<VkImageMemoryBarrier>(VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER);
        barrier.newLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
        barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
        barrier.image = half.depth.handle;
        barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
        vk.CmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT,
                              VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT, 0, 0, nullptr, 0,
                              nullptr, 1, &barrier);
        half.fresh = false;
    }
    auto begin = typed<VkRenderPassBeginInfo>(VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO);
    const VkClearValue nothing{};
    const auto into = [&](VkRenderPass pass, VkFramebuffer framebuffer, uint32_t height) {
        begin.renderPass = pass;
        begin.framebuffer = framebuffer;
        begin.renderArea.extent = {half.width, height};
        begin.clearValueCount = 1;
        begin.pClearValues = &nothing;
        vk.CmdBeginRenderPass(commands, &begin, VK_SUBPASS_CONTENTS_INLINE);
    };
    // All of a part of the image, with one set.
    const auto fill = [&](draw::Number number, uint32_t place, VkDescriptorSet set,
                          const VkViewport& part) {
        const VkPipelineLayout layout = context.pipelines.draw(number).layout;
        into(context.pipelines.halfDepthPass(), half.depthBuffer, half.height + half.tilesY);
        slot.timers.begin(device, commands, drawPasses()[number].name);
        setViewport(commands, part);
        vk.CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, target.pipelines[number]);
        vk.CmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout, place, 1, &set,
                                 0, nullptr);
        vk.CmdPushConstants(commands, layout,
                            VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                            sizeof push, &push);
        vk.CmdDraw(commands, 6, 1, 0, 0);
        slot.timers.end(device, commands);
        vk.CmdEndRenderPass(commands);
    };
    fill(draw::half_depth, 3, host.depth, {0, 0, float(half.width), float(half.height), 0, 1});

    into(context.pipelines.halfPass(half.format), half.colorBuffer, half.height);
    const VkViewport halved{0, 0, 0.5f * viewport.width, 0.5f * viewport.height, 0, 1};
    recordDraws(slot, commands, target, view, halved, {half.depthSet.set, VK_NULL_HANDLE},
                DrawPart::half);
    vk.CmdEndRenderPass(commands);

    fill(draw::half_tiles, 1, half.colorSet.set,
         {0, float(half.height), float(push.tilesX), float(push.tilesY), 0, 1});
    surfaces.scissor = clip;
    return &half;
}

HalfPush VkBackend::State::halfPushFor(const VkViewport& viewport) const noexcept {
    return halfPush(seen, int(viewport.x), int(viewport.y), uint32_t(viewport.width),
                    uint32_t(viewport.height));
}

}  // namespace fw::gpu::vk
