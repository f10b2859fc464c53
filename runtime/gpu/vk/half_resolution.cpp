// Soft effects of a view at half resolution: images for them, by size, and their passes.
#include "gpu/vk/backend_state.h"
#include "gpu/vk/device_objects.h"

#include <algorithm>
#include <array>
#include <utility>

namespace fw::gpu::vk {
namespace {

constexpr uint64_t kHalfKept = 60;  // frames from when a size was last drawn

void makeHalf(BackendState& s, HalfImages& half, VkFormat format, uint32_t width, uint32_t height) {
    constexpr size_t kPieces = 2;
    s.retired.promise(kPieces);
    half.format = format;
    half.width = width;
    half.height = height;
    half.tilesY = (height + kHalfTile - 1) / kHalfTile;
    const Pipelines& pipelines = s.context.pipelines;
    const auto make = [&](HalfImage& one, VkFormat of, VkRenderPass pass, uint32_t rows,
                          const char* name) {
        one.image = s.deviceMemory.createImage(
            imageInfo(of, width, rows,
                      VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT),
            VK_IMAGE_ASPECT_COLOR_BIT, kComponentTargets, name);
        // Read texel by texel.
        one.set = makeImageSet(s.device, pipelines, one.image.view, pipelines.depthSampler());
        one.buffer = makeFramebuffer(s.device, pass, {&one.image.view, 1}, width, rows);
    };
    try {
        make(half.color, format, pipelines.halfPass(format), height, "half resolution");
        make(half.depth, Pipelines::kHalfDepth, pipelines.halfDepthPass(), height + half.tilesY,
             "half resolution, depth");
    } catch (...) {
        dropHalf(s, half);
        throw;
    }
}

HalfImages& halfFor(BackendState& s, VkFormat format, uint32_t width, uint32_t height,
                    uint64_t frame) {
    auto& halves = s.targets.halves;
    auto found = std::find_if(halves.begin(), halves.end(), [&](const HalfImages& one) {
        return one.format == format && one.width == width && one.height == height;
    });
    if (found == halves.end()) {
        // Sizes that the host has left behind go, and where all are in use that of longest ago.
        for (HalfImages& one : halves)
            if (one.width && one.lastFrame + kHalfKept < frame) dropHalf(s, one);
        found = std::min_element(halves.begin(), halves.end(), [](const auto& a, const auto& b) {
            return a.lastFrame < b.lastFrame;
        });
        if (found->width) dropHalf(s, *found);
        makeHalf(s, *found, format, width, height);
    }
    found->lastFrame = frame;
    return *found;
}

}  // namespace

void dropHalf(BackendState& s, HalfImages& half) noexcept {
    for (const HalfImage& one : {half.color, half.depth})
        s.retired.push(half.lastFrame,
                       {.image = one.image, .pool = one.set.pool, .framebuffer = one.buffer});
    half = {};
}

HalfImages* recordHalf(BackendState& s, FrameInFlight& slot, VkCommandBuffer commands,
                       const Target& target, const FwView& view, const VkViewport& viewport,
                       const HostImages& host) {
    const bool shows =
        s.showsQuads() || !s.particleFields.fieldDraws.empty() || !s.flames.volumes.empty();
    if (!s.showsAnything() || !shows) return nullptr;
    const HalfPush push = halfPushFor(s, viewport);
    const VkRect2D clip =
        std::exchange(s.targets.scissor, {});  // of the picture that this goes over
    HalfImages& half =
        halfFor(s, target.key.halfColor, push.texelsX, push.texelsY, slot.frameIndex);
    const Table& vk = s.device.table;
    if (half.fresh) {
        VkImageMemoryBarrier barrier =
            imageBarrier(half.depth.image.handle, VK_IMAGE_ASPECT_COLOR_BIT);
        barrier.newLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
        recordBarriers(vk, commands, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT,
                       VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT, {&barrier, 1});
        half.fresh = false;
    }
    const VkClearValue nothing{};
    // All of a part of the image, with one set.
    const auto fill = [&](draw::Number number, uint32_t place, VkDescriptorSet set,
                          const VkViewport& part) {
        const VkPipelineLayout layout = s.context.pipelines.draw(number).layout;
        beginPass(vk, commands, s.context.pipelines.halfDepthPass(), half.depth.buffer,
                  {half.width, half.height + half.tilesY}, {&nothing, 1});
        slot.timers.begin(s.device, commands, drawPasses()[number].name);
        setViewport(s, commands, part);
        vk.CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, target.pipelines[number]);
        vk.CmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout, place, 1, &set,
                                 0, nullptr);
        vk.CmdPushConstants(commands, layout,
                            VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                            sizeof push, &push);
        vk.CmdDraw(commands, 6, 1, 0, 0);
        slot.timers.end(s.device, commands);
        vk.CmdEndRenderPass(commands);
    };
    fill(draw::half_depth, 3, host.depth, {0, 0, float(half.width), float(half.height), 0, 1});

    beginPass(vk, commands, s.context.pipelines.halfPass(half.format), half.color.buffer,
              {half.width, half.height}, {&nothing, 1});
    const VkViewport halved{0, 0, 0.5f * viewport.width, 0.5f * viewport.height, 0, 1};
    recordDraws(s, slot, commands, target, view, halved, {half.depth.set.set, VK_NULL_HANDLE},
                DrawPart::half);
    vk.CmdEndRenderPass(commands);

    fill(draw::half_tiles, 1, half.color.set.set,
         {0, float(half.height), float(push.tilesX), float(push.tilesY), 0, 1});
    s.targets.scissor = clip;
    return &half;
}

HalfPush halfPushFor(const BackendState& s, const VkViewport& viewport) noexcept {
    const auto parts = [](uint32_t all, uint32_t each) { return (all + each - 1) / each; };
    HalfPush push{};
    push.clip = volumeClip(s.seen);
    push.left = int(viewport.x);
    push.top = int(viewport.y);
    push.width = uint32_t(viewport.width);
    push.height = uint32_t(viewport.height);
    push.texelsX = parts(push.width, 2);
    push.texelsY = parts(push.height, 2);
    push.tilesX = parts(push.texelsX, kHalfTile);
    push.tilesY = parts(push.texelsY, kHalfTile);
    return push;
}

}  // namespace fw::gpu::vk
