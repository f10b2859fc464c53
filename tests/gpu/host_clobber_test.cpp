// A host draws or computes, calls the library, sets again only the state that
// plugin/docs/integration.md lists as changed, and continues. Its pixels and numbers equal those of
// a frame without the library.
#include "gpu/host_with_state.h"

#include <set>

namespace fw::test {
namespace {

#include "host.comp.inc"

// The published list of changed state. A host that omits one item sees a difference.
enum Published : uint32_t {
    kPipeline = 1,
    kSets = 2,
    kPush = 4,
    kVertex0 = 8,
    kVertex1 = 16,
    kIndices = 32,
    kViewport = 64,
    kScissor = 128,
    kOtherDynamic = 256,
    kAll = 511
};

class HostClobber : public HostWithState {
 protected:
    // Binds the listed state; vertex bindings 2 and 3 are bound once only.
    void bind(VkCommandBuffer commands, const Stage& stage, uint32_t what) const {
        const VkDeviceSize zero = 0;
        if (what & kPipeline)
            vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, stage.pipeline);
        if (what & kSets)
            vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_, 0, 2, sets_,
                                    0, nullptr);
        if (what & kPush) {
            const float push[5] = {1, 0.95f, 0.9f, 1, kHostDepth};
            vkCmdPushConstants(commands, layout_,
                               VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                               sizeof push, push);
        }
        if (what & kVertex0) vkCmdBindVertexBuffers(commands, 0, 1, &vertices_[0], &zero);
        if (what & kVertex1) vkCmdBindVertexBuffers(commands, 1, 1, &vertices_[1], &zero);
        if (what & kIndices) vkCmdBindIndexBuffer(commands, indices_, 0, VK_INDEX_TYPE_UINT16);
        if (what & kViewport) vkCmdSetViewport(commands, 0, 1, &kHostViewport);
        if (what & kScissor) vkCmdSetScissor(commands, 0, 1, &kScissorRect);
        if (what & kOtherDynamic) {
            const float constants[4] = {0.75f, 0.5f, 0.875f, 0.625f};
            vkCmdSetBlendConstants(commands, constants);
            vkCmdSetStencilCompareMask(commands, VK_STENCIL_FACE_FRONT_AND_BACK, 0x7F);
            vkCmdSetStencilWriteMask(commands, VK_STENCIL_FACE_FRONT_AND_BACK, 0x3F);
            vkCmdSetStencilReference(commands, VK_STENCIL_FACE_FRONT_AND_BACK, 2);
            vkCmdSetDepthBias(commands, stage.reversed ? 65536.0f : -65536.0f, 0, 0);
        }
    }
    void bindOnce(VkCommandBuffer commands) const {
        const VkDeviceSize zeros[2] = {0, 0};
        vkCmdBindVertexBuffers(commands, 2, 2, &vertices_[2], zeros);
    }

    struct Pictures {
        std::vector<uint32_t> alone, around, ours;  // the host alone, both, the library alone
    };
    // One frame with three passes. `rebound`: the listed state that the host sets again after the
    // library's call.
    Pictures shoot(const Stage& stage, bool secondary, uint32_t rebound = kAll) {
        VkCommandBuffer seconds[3]{};
        if (secondary) {
            VkCommandBufferAllocateInfo info{};
            info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
            info.commandPool = device_->pool;
            info.level = VK_COMMAND_BUFFER_LEVEL_SECONDARY;
            info.commandBufferCount = 3;
            FW_MUST(vkAllocateCommandBuffers(device_->device, &info, seconds));
        }
        const FwView& view = views_[stage.reversed];
        FwVulkanFrame frame = frames_->begin(0);
        const VkCommandBuffer commands = frame.commandBuffer;
        bindOnce(commands);
        EXPECT_EQ(fwWorld_RecordOutside(world_, &frame, &view), FW_OK);
        vkCmdResetQueryPool(commands, queries_, 0, 3);
        for (uint32_t k = 0; k < 3; ++k) {
            VkClearValue clears[2]{};
            clears[0].color = {{0.1f, 0.2f, 0.3f, 1}};
            clears[1].depthStencil = {stage.reversed ? 0.0f : 1.0f, 0};
            VkRenderPassBeginInfo begin{};
            begin.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO;
            begin.renderPass = stage.pass;
            begin.framebuffer = stage.framebuffer;
            begin.renderArea.extent = {kWidth, kHeight};
            begin.clearValueCount = 2;
            begin.pClearValues = clears;
            vkCmdBeginRenderPass(commands, &begin,
                                 secondary ? VK_SUBPASS_CONTENTS_SECONDARY_COMMAND_BUFFERS
                                           : VK_SUBPASS_CONTENTS_INLINE);
            FwVulkanFrame inside = frame;
            if (secondary) {
                VkCommandBufferInheritanceInfo inherit{};
                inherit.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_INHERITANCE_INFO;
                inherit.renderPass = stage.pass;
                VkCommandBufferBeginInfo info{};
                info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
                info.flags = VK_COMMAND_BUFFER_USAGE_RENDER_PASS_CONTINUE_BIT |
                             VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
                info.pInheritanceInfo = &inherit;
                FW_MUST(vkBeginCommandBuffer(seconds[k], &info));
                inside.commandBuffer = seconds[k];
                inside.flags |= FW_FRAME_SECONDARY;
                bindOnce(seconds[k]);
            }
            recordInside(inside, stage, view, k, rebound);
            if (secondary) {
                FW_MUST(vkEndCommandBuffer(seconds[k]));
                vkCmdExecuteCommands(commands, 1, &seconds[k]);
            }
            vkCmdEndRenderPass(commands);
            VkBufferImageCopy region{};
            region.bufferOffset = uint64_t(k) * kPixels * 4;
            region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
            region.imageExtent = {kWidth, kHeight, 1};
            vkCmdCopyImageToBuffer(commands, stage.resolved, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                                   pixels_.buffer, 1, &region);
        }
        toHost(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT);
        frames_->submit();
        frames_->waitAll();
        if (secondary) vkFreeCommandBuffers(device_->device, device_->pool, 3, seconds);

        uint64_t seen[3]{};  // queries that begin before the library's call and end after it
        FW_MUST(vkGetQueryPoolResults(device_->device, queries_, 0, 3, sizeof seen, seen, 8,
                                      VK_QUERY_RESULT_64_BIT));
        for (const uint64_t samples : seen) EXPECT_GT(samples, 0u);
        Pictures out;
        const auto* all = static_cast<const uint32_t*>(pixels_.mapped);
        out.alone.assign(all, all + kPixels);
        out.around.assign(all + kPixels, all + 2 * kPixels);
        out.ours.assign(all + 2 * kPixels, all + 3 * kPixels);
        return out;
    }

    // Pass 0: the host alone; 1: the host, the library, the host; 2: the library alone.
    void recordInside(const FwVulkanFrame& frame, const Stage& stage, const FwView& view,
                      uint32_t number, uint32_t rebound) {
        const VkCommandBuffer commands = frame.commandBuffer;
        const bool hosts = number != 2, us = number != 0;
        vkCmdBeginQuery(commands, queries_, number, 0);
        // Both sides already have the host's depth: only its bias lets it draw there.
        VkClearAttachment clear{};
        clear.aspectMask = VK_IMAGE_ASPECT_DEPTH_BIT;
        clear.clearValue.depthStencil.depth = kHostDepth;
        const VkClearRect sides[] = {{{{0, 0}, {28, kHeight}}, 0, 1},
                                     {{{68, 0}, {28, kHeight}}, 0, 1}};
        vkCmdClearAttachments(commands, 1, &clear, 2, sides);
        constexpr uint32_t kFirst = 6 * std::size(kBefore), kSecond = 6 * std::size(kAfter);
        if (hosts) {
            bind(commands, stage, kAll);
            vkCmdDrawIndexed(commands, kFirst, 1, 0, 0, 0);
        }
        if (us) {
            const VkViewport viewport{0, 0, float(kWidth), float(kHeight), 0, 1};
            EXPECT_EQ(fwWorld_RecordInside(world_, &frame, stage.target, &view, &viewport), FW_OK);
        }
        if (hosts) {
            if (us) bind(commands, stage, rebound);
            vkCmdDrawIndexed(commands, kSecond, 1, kFirst, 0, 0);
        }
        vkCmdEndQuery(commands, queries_, number);
    }

    static void toHost(VkCommandBuffer commands, VkPipelineStageFlags stage, VkAccessFlags access) {
        VkMemoryBarrier barrier{};
        barrier.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
        barrier.srcAccessMask = access;
        barrier.dstAccessMask = VK_ACCESS_HOST_READ_BIT;
        vkCmdPipelineBarrier(commands, stage, VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &barrier, 0,
                             nullptr, 0, nullptr);
    }

    struct Verdict {
        uint32_t hosts = 0, fire = 0, overFire = 0;  // pixels
        uint32_t wrong =
            0;  // pixels of the host or of nobody that differ from the picture without the library
    };
    // A pixel is the library's where it draws alone and the nearer host does not.
    static Verdict judge(const Pictures& p) {
        Verdict out;
        const uint32_t clear = p.alone[kPixels - 1];  // outside the host's scissor
        for (size_t i = 0; i < kPixels; ++i) {
            const bool host = p.alone[i] != clear, fire = p.ours[i] != clear;
            out.hosts += host;
            out.fire += fire && !host;
            out.overFire += fire && host;
            if (fire && !host)
                out.wrong +=
                    p.around[i] != p.ours[i];  // the library's own pixels are unchanged too
            else
                out.wrong += p.around[i] != p.alone[i];
        }
        return out;
    }
};

TEST_F(HostClobber, HostPixelsAreUnchangedByOurCalls) {
    if (!device_) return;
    for (const uint32_t samples : {1u, 4u}) {
        for (const bool reversed : {false, true}) {
            for (const bool srgb : {false, true}) {
                // Half of the eight combinations: all four of every two settings.
                if (((samples > 1) != reversed) != srgb) continue;
                const Stage stage = makeStage({samples, reversed, srgb});
                for (const bool secondary : {false, true}) {
                    SCOPED_TRACE(std::to_string(samples) + (samples > 1 ? " samples" : " sample") +
                                 (reversed ? ", reversed" : ", normal") +
                                 (srgb ? ", sRGB" : ", UNORM") +
                                 (secondary ? ", secondary" : ", primary"));
                    const Pictures pictures = shoot(stage, secondary);
                    const Verdict verdict = judge(pictures);
                    EXPECT_EQ(verdict.wrong, 0u);
                    EXPECT_GT(verdict.hosts, 1500u);
                    EXPECT_GT(verdict.fire, 300u);
                    EXPECT_GT(verdict.overFire, 200u) << "drawn over and under the library";
                    // Every rectangle of the host is visible, so that each of its states matters.
                    const std::set<uint32_t> colors(pictures.alone.begin(), pictures.alone.end());
                    EXPECT_GT(colors.size(), 20u);
                }
            }
        }
    }
}

// The same host omits one item of the list: the picture shows each. Validation may only report the
// dynamic state that our pipelines hold fixed.
TEST_F(HostClobber, EachOmittedStateIsVisible) {
    if (!device_) return;
    const Stage stage = makeStage({1, false, false});
    for (const auto& [left, name] : {std::pair{kVertex0, "vertex binding 0"},
                                     {kIndices, "index buffer"},
                                     {kViewport, "viewport"},
                                     {kScissor, "scissor"}}) {
        const Verdict verdict = judge(shoot(stage, false, kAll & ~uint32_t(left)));
        EXPECT_GT(verdict.wrong, 0u) << name;
    }
    for (const std::string& message : device_->takeMessages()) ADD_FAILURE() << message;
    const Verdict verdict = judge(shoot(stage, false, kAll & ~uint32_t(kOtherDynamic)));
    EXPECT_GT(verdict.wrong, 0u) << "other dynamic state";
    for (const std::string& message : device_->takeMessages()) {
        if (message.find("state not set") == std::string::npos) ADD_FAILURE() << message;
    }
}

TEST_F(HostClobber, HostComputeIsUnchangedByOurCalls) {
    if (!device_) return;
    constexpr uint32_t kCount = 4096;
    std::vector<uint32_t> in(kCount), want(kCount);
    for (uint32_t i = 0; i < kCount; ++i) {
        in[i] = i * 2654435761u;
        want[i] = i ^ 0x5A5A;
    }
    const TestBuffer buffers[2] = {makeBuffer(VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, in),
                                   makeBuffer(VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, want)};
    VkDescriptorSet sets[2]{};
    const VkPipelineLayout layout = makeLayout(VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                               VK_SHADER_STAGE_COMPUTE_BIT, 4, buffers, sets);
    VkComputePipelineCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
    info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    info.stage.module = makeModule(kHostComp, sizeof kHostComp);
    info.stage.pName = "main";
    info.layout = layout;
    VkPipeline pipeline = VK_NULL_HANDLE;
    FW_MUST(
        vkCreateComputePipelines(device_->device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline));
    cleanup_.emplace_back(
        [device = device_->device, pipeline] { vkDestroyPipeline(device, pipeline, nullptr); });

    for (uint32_t f = 0; f < 8; ++f) {
        const FwVulkanFrame frame = frames_->begin(0.0625f);  // two steps
        const VkCommandBuffer commands = frame.commandBuffer;
        for (const bool before : {true, false}) {
            const uint32_t add = before ? 7 : 1000003 * (f + 1);
            VkMemoryBarrier barrier{};
            barrier.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
            barrier.srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT;
            barrier.dstAccessMask = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT;
            vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                                 VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, 0, 1, &barrier, 0, nullptr,
                                 0, nullptr);
            vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
            vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, 2, sets, 0,
                                    nullptr);
            vkCmdPushConstants(commands, layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, 4, &add);
            vkCmdDispatch(commands, kCount / 64, 1, 1);
            if (before) {
                EXPECT_EQ(fwWorld_RecordOutside(world_, &frame, views_.data()), FW_OK);
            }
            for (uint32_t i = 0; i < kCount; ++i) want[i] = want[i] * 3 + in[i] + add;
        }
        toHost(commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT);
        frames_->submit();
    }
    frames_->waitAll();
    EXPECT_EQ(std::memcmp(buffers[0].mapped, in.data(), kCount * 4), 0);
    EXPECT_EQ(std::memcmp(buffers[1].mapped, want.data(), kCount * 4), 0);
}

}  // namespace
}  // namespace fw::test
