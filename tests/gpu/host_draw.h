// The host of host_draw_test.cpp: its images, its pass, its drawing before and after the library's,
// and a burning ball in the middle of the picture.
#pragma once
#include <gmock/gmock.h>

#include <cmath>

#include "core/error.h"
#include "support/burn_scene.h"

namespace fw::test::host_draw {

constexpr uint32_t kWidth = 96, kHeight = 64;

struct Shot {  // how the host draws
    VkFormat color = VK_FORMAT_R8G8B8A8_SRGB;
    FwOutputEncoding encoding = FW_OUTPUT_SRGB_VIEW;
    uint32_t samples = 1;
    bool secondary = false, reversedDepth = false, composite = false, depth = true;
    FwDepthMode depthMode = FW_DEPTH_TEST;
    uint32_t flags = 0;         // FwTargetFlags beyond FW_TARGET_COMPOSITE
    uint32_t depthSamples = 0;  // of a sampled depth; 0: as the target
    float depthValue = -1;      // uniform value of a composite's or sampled depth; -1: by mode
    bool asNeeded = true;       // FW_TARGET_AS_NEEDED
    VkRect2D scissor{};         // FwVulkanFrame::scissor
    float transparency = 0;     // FwVulkanFrame::transparency, over the host's blue
    float shift[2] = {0, 0};    // px, offset within a pixel for a supersampled picture
    [[nodiscard]] bool attachesDepth() const { return depth && depthMode != FW_DEPTH_SAMPLED; }
    [[nodiscard]] bool samplesDepth() const { return depth && depthMode == FW_DEPTH_SAMPLED; }
};

struct Picture {
    std::vector<float> rgb;  // 0..1 as stored (floats unchanged), 3 per pixel
    [[nodiscard]] const float* at(uint32_t x, uint32_t y) const {
        return &rgb[(size_t(y) * kWidth + x) * 3];
    }
    // Pixels whose colour differs from (r, g, b).
    [[nodiscard]] uint32_t unlike(uint32_t x0, uint32_t x1, float r, float g, float b) const {
        uint32_t count = 0;
        for (uint32_t y = 0; y < kHeight; ++y) {
            for (uint32_t x = x0; x < x1; ++x) {
                const float* p = at(x, y);
                if (std::abs(p[0] - r) + std::abs(p[1] - g) + std::abs(p[2] - b) > 0.02f) ++count;
            }
        }
        return count;
    }
};

inline float halfToFloat(uint16_t h) {
    const int exponent = h >> 10 & 31;
    const float mantissa = float(h & 1023) / 1024.0f;
    const float value =
        exponent == 0 ? std::ldexp(mantissa, -14) : std::ldexp(1.0f + mantissa, exponent - 15);
    return h >> 15 ? -value : value;
}

class HostDraw : public GpuTest {
 protected:
    void SetUp() override {
        GpuTest::SetUp();
        if (!device_) return;
        gpu::vk::WorldLimits limits;
        limits.appearances = testAppearances();
        rig_ = std::make_unique<VkRig>(*device_, 2, 0, limits, countingEntry());
        // A ball that fills the middle of the picture.
        mesh::BakeInput input;
        const Mesh ball = makeCube(1.0, 6, true, false);
        input = ball.input(texelsPerMetre_, 1024);
        input.trustUvs = true;
        scene_.domains.push_back(mesh::bake(input, std::pmr::get_default_resource()));
        SceneObject object;
        for (auto& material : object.materials) {
            material = plainMaterial(scene_.domains[0], 0.05);
            material.appearance = look_;
            material.baseColor = {0.8f, 0.1f, 0.6f, 0};  // nothing else in the picture is purple
        }
        scene_.objects.push_back(object);
        scene_.create(rig_->backend);
        const float eye[3] = {0, 0, 3}, target[3] = {0, 0, 0};
        normal_ = testView(eye, target, 40, float(kWidth) / kHeight, false);
        reversed_ = testView(eye, target, 40, float(kWidth) / kHeight, true);
        burn();
    }
    void TearDown() override {
        for (const Kept& kept : targets_) rig_->context.unregisterTarget(kept.target);
        for (const auto& drop : cleanup_) drop();
        rig_.reset();
        GpuTest::TearDown();
    }

    // Burns the visible side for `burnFrames_` eighths of a second.
    void burn() {
        uint32_t now = 4096;
        for (uint64_t f = 1; f <= burnFrames_; ++f) {
            std::vector<gpu::TexelEvent> events;
            if (f == 1) {
                std::pmr::vector<uint32_t> texels;
                const float point[3] = {0, 0, 0.6f};
                mesh::texelsNear(scene_.domains[0], point, litRadius_, texels);
                for (uint32_t texel : texels) events.push_back({0, texel, gpu::kEventIgnite, 4097});
                std::sort(events.begin(), events.end(),
                          [](const auto& a, const auto& b) { return a.texel < b.texel; });
            }
            gpu::StepPlan steps[4];
            for (gpu::StepPlan& step : steps) {
                step.now = now;
                step.reduce = &step == &steps[3];
                now += gpu::kStepTicks;
            }
            steps[0].events = events;
            gpu::FramePlan plan;
            plan.frameIndex = f;
            plan.steps = steps;
            plan.endTick = now;
            rig_->view = normal_;
            rig_->run(plan);
        }
        endTick_ = now;
    }

    // A texel that burn() lights.
    [[nodiscard]] uint32_t litTexel() const {
        std::pmr::vector<uint32_t> texels;
        const float point[3] = {0, 0, 0.6f};
        mesh::texelsNear(scene_.domains[0], point, 0.25f, texels);
        return texels[0];
    }

    // Colour, and depth, and a resolve with several samples; final layouts fit the next use.
    VkRenderPass makePass(const Shot& shot) {
        std::vector<VkAttachmentDescription> attachments;
        const auto add = [&](VkFormat format, uint32_t samples, VkAttachmentLoadOp load,
                             VkImageLayout final) {
            VkAttachmentDescription one{};
            one.format = format;
            one.samples = VkSampleCountFlagBits(samples);
            one.loadOp = load;
            one.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
            one.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
            one.stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
            one.finalLayout = final;
            attachments.push_back(one);
        };
        const bool resolves = shot.samples > 1;
        add(shot.color, shot.samples, VK_ATTACHMENT_LOAD_OP_CLEAR,
            resolves ? VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL
                     : VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
        if (shot.attachesDepth())
            add(VK_FORMAT_D32_SFLOAT, shot.samples, VK_ATTACHMENT_LOAD_OP_CLEAR,
                VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL);
        if (resolves)
            add(shot.color, 1, VK_ATTACHMENT_LOAD_OP_DONT_CARE,
                VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
        const VkAttachmentReference color{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
        const VkAttachmentReference depth{1, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};
        const VkAttachmentReference resolve{uint32_t(attachments.size() - 1),
                                            VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
        VkSubpassDescription subpass{};
        subpass.colorAttachmentCount = 1;
        subpass.pColorAttachments = &color;
        if (shot.attachesDepth()) subpass.pDepthStencilAttachment = &depth;
        if (resolves) subpass.pResolveAttachments = &resolve;
        VkSubpassDependency out{};
        out.dstSubpass = VK_SUBPASS_EXTERNAL;
        out.srcStageMask = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
        out.srcAccessMask = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT;
        out.dstStageMask = VK_PIPELINE_STAGE_TRANSFER_BIT;
        out.dstAccessMask = VK_ACCESS_TRANSFER_READ_BIT;
        VkRenderPassCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO;
        info.attachmentCount = uint32_t(attachments.size());
        info.pAttachments = attachments.data();
        info.subpassCount = 1;
        info.pSubpasses = &subpass;
        info.dependencyCount = 1;
        info.pDependencies = &out;
        VkRenderPass pass = VK_NULL_HANDLE;
        EXPECT_EQ(vkCreateRenderPass(device_->device, &info, nullptr, &pass), VK_SUCCESS);
        const VkDevice device = device_->device;
        cleanup_.emplace_back([device, pass] { vkDestroyRenderPass(device, pass, nullptr); });
        return pass;
    }

    FwTargetId registerTarget(const Shot& shot, VkRenderPass pass) {
        FwVulkanTargetDef def = fwDefaultVulkanTargetDef();
        def.renderPass = pass;
        def.flags = shot.flags | (shot.composite ? FW_TARGET_COMPOSITE : 0) |
                    (shot.asNeeded ? FW_TARGET_AS_NEEDED : 0);
        def.depthSamples = shot.depthSamples;
        def.colorFormat = shot.color;
        def.depthFormat = shot.depth ? VK_FORMAT_D32_SFLOAT : VK_FORMAT_UNDEFINED;
        def.samples = shot.samples;
        def.depthMode = shot.depth ? shot.depthMode : FW_DEPTH_NONE;
        def.reversedDepth = shot.reversedDepth;
        def.encoding = shot.encoding;
        return rig_->context.registerTarget(def);
    }

    // One target for all shots of a kind: pipelines are built per target, which is slow.
    std::pair<VkRenderPass, FwTargetId> targetFor(const Shot& shot) {
        for (const Kept& kept : targets_)
            if (kept.shot.color == shot.color && kept.shot.encoding == shot.encoding &&
                kept.shot.samples == shot.samples && kept.shot.composite == shot.composite &&
                kept.shot.reversedDepth == shot.reversedDepth && kept.shot.depth == shot.depth &&
                kept.shot.depthMode == shot.depthMode && kept.shot.flags == shot.flags &&
                kept.shot.depthSamples == shot.depthSamples && kept.shot.asNeeded == shot.asNeeded)
                return {kept.pass, kept.target};
        const VkRenderPass pass = shot.composite ? VK_NULL_HANDLE : makePass(shot);
        targets_.push_back({shot, pass, registerTarget(shot, pass)});
        return {pass, targets_.back().target};
    }

    // The host's pixels: a strip on the left before, one on the right after, and an occluder at the
    // nearest depth over the left half.
    static void clearRect(VkCommandBuffer commands, VkClearColorValue color, int32_t x0,
                          int32_t x1) {
        VkClearAttachment clear{};
        clear.aspectMask = VK_IMAGE_ASPECT_COLOR_BIT;
        clear.clearValue.color = color;
        const VkClearRect rect{{{x0, 0}, {uint32_t(x1 - x0), kHeight}}, 0, 1};
        vkCmdClearAttachments(commands, 1, &clear, 1, &rect);
    }

    Picture shoot(const Shot& shot) {
        const VkImageUsageFlags colorUsage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
                                             VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                                             VK_IMAGE_USAGE_TRANSFER_DST_BIT;
        const TestImage color = device_->makeImage(
            shot.color, {kWidth, kHeight}, shot.samples,
            shot.samples > 1 ? VkImageUsageFlags(VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT) : colorUsage);
        TestImage depth, resolved = color;
        if (shot.depth)
            depth = device_->makeImage(VK_FORMAT_D32_SFLOAT, {kWidth, kHeight},
                                       shot.depthSamples ? shot.depthSamples : shot.samples,
                                       VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT |
                                           VK_IMAGE_USAGE_TRANSFER_DST_BIT |
                                           VK_IMAGE_USAGE_SAMPLED_BIT);
        if (shot.samples > 1)
            resolved = device_->makeImage(shot.color, {kWidth, kHeight}, 1, colorUsage);
        TestImage before;
        if (shot.transparency > 0 && shot.transparency < 1)
            before =
                device_->makeImage(shot.color, {kWidth, kHeight}, 1,
                                   VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT);
        const uint32_t pixelBytes = shot.color == VK_FORMAT_R16G16B16A16_SFLOAT ? 8 : 4;

        const TestBuffer read = device_->makeBuffer(uint64_t(kWidth) * kHeight * pixelBytes,
                                                    VK_BUFFER_USAGE_TRANSFER_DST_BIT);

        const std::pair<VkRenderPass, FwTargetId> into = targetFor(shot);
        const VkRenderPass pass = into.first;
        const FwTargetId target = into.second;
        VkFramebuffer framebuffer = VK_NULL_HANDLE;
        if (pass) {
            std::vector<VkImageView> views{color.view};
            if (shot.attachesDepth()) views.push_back(depth.view);
            if (shot.samples > 1) views.push_back(resolved.view);
            VkFramebufferCreateInfo info{};
            info.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO;
            info.renderPass = pass;
            info.attachmentCount = uint32_t(views.size());
            info.pAttachments = views.data();
            info.width = kWidth;
            info.height = kHeight;
            info.layers = 1;
            EXPECT_EQ(vkCreateFramebuffer(device_->device, &info, nullptr, &framebuffer),
                      VK_SUCCESS);
            const VkDevice device = device_->device;
            cleanup_.emplace_back(
                [device, framebuffer] { vkDestroyFramebuffer(device, framebuffer, nullptr); });
        }
        VkCommandBuffer second = VK_NULL_HANDLE;
        if (shot.secondary) {
            VkCommandBufferAllocateInfo info{};
            info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
            info.commandPool = device_->pool;
            info.level = VK_COMMAND_BUFFER_LEVEL_SECONDARY;
            info.commandBufferCount = 1;
            vkAllocateCommandBuffers(device_->device, &info, &second);
        }

        const FwView& view = shot.reversedDepth ? reversed_ : normal_;
        const float nearest = shot.reversedDepth ? 1.0f : 0.0f;
        const float farthest = 1.0f - nearest;
        const VkViewport viewport{
            -shot.shift[0], -shot.shift[1], float(kWidth), float(kHeight), 0, 1};
        VulkanCounts inside;
        rig_->alsoRecord = [&](const FwVulkanFrame& frame) {
            const VkCommandBuffer commands = frame.commandBuffer;
            FwVulkanFrame ours = frame;
            ours.scissor = shot.scissor;
            ours.transparency = shot.transparency;
            if (before.image) {
                showBlue(commands, before);
                ours.sampledColor = before.view;
                ours.sampledColorLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
            }
            if (shot.composite) {
                recordComposite(shot, ours, target, view, color, depth, nearest, farthest);
            } else {
                VkClearValue clears[2]{};
                clears[0].color = {{0, 0, 1, 1}};
                clears[1].depthStencil.depth = farthest;
                VkRenderPassBeginInfo begin{};
                begin.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO;
                begin.renderPass = pass;
                begin.framebuffer = framebuffer;
                begin.renderArea.extent = {kWidth, kHeight};
                begin.clearValueCount = shot.attachesDepth() ? 2 : 1;
                begin.pClearValues = clears;
                if (shot.samplesDepth()) showDepth(commands, depth, shot.depthValue);
                vkCmdBeginRenderPass(commands, &begin,
                                     second ? VK_SUBPASS_CONTENTS_SECONDARY_COMMAND_BUFFERS
                                            : VK_SUBPASS_CONTENTS_INLINE);
                if (shot.samplesDepth()) {
                    ours.sampledDepth = depth.view;
                    ours.sampledDepthLayout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL;
                }
                if (second) {
                    VkCommandBufferInheritanceInfo inherit{};
                    inherit.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_INHERITANCE_INFO;
                    inherit.renderPass = pass;
                    VkCommandBufferBeginInfo info{};
                    info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
                    info.flags = VK_COMMAND_BUFFER_USAGE_RENDER_PASS_CONTINUE_BIT |
                                 VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
                    info.pInheritanceInfo = &inherit;
                    vkBeginCommandBuffer(second, &info);
                    ours.commandBuffer = second;
                    ours.flags = FW_FRAME_SECONDARY;
                }
                clearRect(ours.commandBuffer, {{1, 0, 0, 1}}, 0, 8);
                if (shot.attachesDepth()) occlude(ours.commandBuffer, nearest);
                (void)takeCounts();
                EXPECT_TRUE(rig_->backend.recordInside(ours, target, view, viewport));
                inside = takeCounts();
                clearRect(ours.commandBuffer, {{0, 1, 0, 1}}, kWidth - 8, kWidth);
                if (second) {
                    vkEndCommandBuffer(second);
                    vkCmdExecuteCommands(commands, 1, &second);
                }
                vkCmdEndRenderPass(commands);
                EXPECT_EQ(inside.draws > 0, shot.transparency < 1);
                EXPECT_EQ(inside.work + inside.barriers + inside.passes, 0u);
                if (!shot.samplesDepth() && !before.image) {
                    EXPECT_EQ(inside.total(), 0u);
                }
            }
            VkBufferImageCopy region{};
            region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
            region.imageExtent = {kWidth, kHeight, 1};
            vkCmdCopyImageToBuffer(commands, resolved.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                                   read.buffer, 1, &region);
            VkMemoryBarrier toHost{};
            toHost.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
            toHost.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
            toHost.dstAccessMask = VK_ACCESS_HOST_READ_BIT;
            vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT,
                                 VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &toHost, 0, nullptr, 0, nullptr);
        };
        gpu::FramePlan plan;
        plan.frameIndex = burnFrames_ + 84;
        plan.endTick = endTick_;
        rig_->view = view;
        rig_->run(plan);
        rig_->alsoRecord = nullptr;
        rig_->frames.waitAll();

        Picture picture;
        picture.rgb.resize(size_t(kWidth) * kHeight * 3);
        for (size_t i = 0; i < size_t(kWidth) * kHeight; ++i) {
            for (size_t c = 0; c < 3; ++c) {
                picture.rgb[i * 3 + c] =
                    pixelBytes == 8
                        ? halfToFloat(static_cast<const uint16_t*>(read.mapped)[i * 4 + c])
                        : float(static_cast<const uint8_t*>(read.mapped)[i * 4 + c]) / 255.0f;
            }
        }
        return picture;
    }

    // The host's depth: `value` everywhere, then readable by fragment shaders.
    static void showDepth(VkCommandBuffer commands, const TestImage& depth, float value) {
        VkImageMemoryBarrier barrier{};
        barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER;
        barrier.dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
        barrier.newLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
        barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
        barrier.image = depth.image;
        barrier.subresourceRange = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 1, 0, 1};
        vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT,
                             VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, nullptr, 0, nullptr, 1,
                             &barrier);
        const VkClearDepthStencilValue clear{value, 0};
        vkCmdClearDepthStencilImage(commands, depth.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                                    &clear, 1, &barrier.subresourceRange);
        barrier.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
        barrier.dstAccessMask = VK_ACCESS_SHADER_READ_BIT;
        barrier.oldLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
        barrier.newLayout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL;
        vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT,
                             VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, 0, 0, nullptr, 0, nullptr, 1,
                             &barrier);
    }

    // A copy of the host's picture without its strips, readable by fragment shaders.
    static void showBlue(VkCommandBuffer commands, const TestImage& image) {
        VkImageMemoryBarrier barrier{};
        barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER;
        barrier.dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
        barrier.newLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
        barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
        barrier.image = image.image;
        barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
        vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT,
                             VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, nullptr, 0, nullptr, 1,
                             &barrier);
        const VkClearColorValue blue{{0, 0, 1, 1}};
        vkCmdClearColorImage(commands, image.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &blue, 1,
                             &barrier.subresourceRange);
        barrier.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
        barrier.dstAccessMask = VK_ACCESS_SHADER_READ_BIT;
        barrier.oldLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
        barrier.newLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
        vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT,
                             VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, 0, 0, nullptr, 0, nullptr, 1,
                             &barrier);
    }

    // Nearest depth over the left half by a clear in the pass.
    static void occlude(VkCommandBuffer commands, float nearest) {
        VkClearAttachment clear{};
        clear.aspectMask = VK_IMAGE_ASPECT_DEPTH_BIT;
        clear.clearValue.depthStencil.depth = nearest;
        const VkClearRect rect{{{0, 0}, {kWidth / 2, kHeight}}, 0, 1};
        vkCmdClearAttachments(commands, 1, &clear, 1, &rect);
    }

    void recordComposite(const Shot& shot, const FwVulkanFrame& frame, FwTargetId target,
                         const FwView& view, const TestImage& color, const TestImage& depth,
                         float nearest, float farthest, uint32_t flags = 0) {
        const VkCommandBuffer commands = frame.commandBuffer;
        std::vector<VkImageMemoryBarrier> barriers(shot.depth ? 2 : 1);
        for (size_t i = 0; i < barriers.size(); ++i) {
            VkImageMemoryBarrier& barrier = barriers[i];
            barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER;
            barrier.dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
            barrier.newLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
            barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
            barrier.image = i ? depth.image : color.image;
            barrier.subresourceRange = {
                VkImageAspectFlags(i ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT), 0, 1,
                0, 1};
        }
        vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT,
                             VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, nullptr, 0, nullptr,
                             uint32_t(barriers.size()), barriers.data());
        const VkClearColorValue blue{{0, 0, 1, 1}};
        vkCmdClearColorImage(commands, color.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &blue, 1,
                             &barriers[0].subresourceRange);
        if (shot.depth) {
            const VkClearDepthStencilValue value{shot.depthValue >= 0 ? shot.depthValue
                                                 : shot.depthMode == FW_DEPTH_TEST_ONLY ? nearest
                                                                                        : farthest,
                                                 0};
            vkCmdClearDepthStencilImage(commands, depth.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                                        &value, 1, &barriers[1].subresourceRange);
        }
        FwVulkanComposite images = fwDefaultVulkanComposite();
        images.flags = flags;
        images.width = kWidth;
        images.height = kHeight;
        images.color = {color.image,
                        color.view,
                        VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                        VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                        VK_PIPELINE_STAGE_TRANSFER_BIT,
                        VK_PIPELINE_STAGE_TRANSFER_BIT,
                        VK_ACCESS_TRANSFER_WRITE_BIT,
                        VK_ACCESS_TRANSFER_READ_BIT};
        if (shot.depth)
            images.depth = {depth.image,
                            depth.view,
                            VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                            VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL,
                            VK_PIPELINE_STAGE_TRANSFER_BIT,
                            VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT,
                            VK_ACCESS_TRANSFER_WRITE_BIT,
                            VK_ACCESS_SHADER_READ_BIT};
        EXPECT_TRUE(rig_->backend.recordComposite(frame, target, view, images));
    }

    void expectHostsPixels(const Picture& picture, const Shot& shot) {
        EXPECT_EQ(picture.unlike(0, 8, 1, 0, 0), 0u) << "drawn before the library";
        EXPECT_EQ(picture.unlike(kWidth - 8, kWidth, 0, 1, 0), 0u) << "drawn after the library";
        const uint32_t left = picture.unlike(8, kWidth / 2 - 1, 0, 0, 1);
        const uint32_t right = picture.unlike(kWidth / 2 + 1, kWidth - 8, 0, 0, 1);
        if (shot.depth)
            EXPECT_EQ(left, 0u) << "behind the host's occluder";
        else
            EXPECT_GT(left, 300u) << "no depth hides the fire";
        EXPECT_GT(right, 300u) << "the library drew";
        EXPECT_LT(right, 2600u) << "and left the background unchanged";
    }

    struct Kept {
        Shot shot;
        VkRenderPass pass;
        FwTargetId target;
    };
    uint32_t look_ = FW_MATERIAL_PINE;
    uint32_t burnFrames_ = 16;
    float texelsPerMetre_ = 48;
    float litRadius_ = 0.25f;  // m
    std::vector<Kept> targets_;
    std::unique_ptr<VkRig> rig_;
    BurnScene scene_;
    FwView normal_{}, reversed_{};
    uint32_t endTick_ = 0;
    std::vector<std::function<void()>> cleanup_;
};

}  // namespace fw::test::host_draw
