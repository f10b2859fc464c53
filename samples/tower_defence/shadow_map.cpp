// See shadow_map.h.
#include "shadow_map.h"

#include <array>

#include "common/pipeline.h"

namespace tower {

namespace {

#include "shadow.vert.h"

using sample::checkVulkan;

constexpr VkFormat kFormat = VK_FORMAT_D32_SFLOAT;

// `still`: clears the map and ends as the copy source of the moving casters' pass.
VkRenderPass makePass(VkDevice device, bool still) {
    VkAttachmentDescription depth{};
    depth.format = kFormat;
    depth.samples = VK_SAMPLE_COUNT_1_BIT;
    depth.loadOp = still ? VK_ATTACHMENT_LOAD_OP_CLEAR : VK_ATTACHMENT_LOAD_OP_LOAD;
    depth.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    depth.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
    depth.stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
    depth.initialLayout = still ? VK_IMAGE_LAYOUT_UNDEFINED : VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    depth.finalLayout = still ? VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL
                              : VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL;
    const VkAttachmentReference reference{0, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};
    VkSubpassDescription subpass{};
    subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
    subpass.pDepthStencilAttachment = &reference;
    constexpr VkPipelineStageFlags kDepthStages =
        VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT;
    std::array<VkSubpassDependency, 2> dependencies{};
    dependencies[0] = {
        VK_SUBPASS_EXTERNAL,
        0,
        VK_PIPELINE_STAGE_TRANSFER_BIT,
        kDepthStages,
        VK_ACCESS_TRANSFER_WRITE_BIT,
        VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
        0};
    dependencies[1] = {0,
                       VK_SUBPASS_EXTERNAL,
                       kDepthStages,
                       VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT,
                       VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
                       VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_TRANSFER_READ_BIT,
                       0};
    VkRenderPassCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO;
    info.attachmentCount = 1;
    info.pAttachments = &depth;
    info.subpassCount = 1;
    info.pSubpasses = &subpass;
    info.dependencyCount = 2;
    info.pDependencies = dependencies.data();
    VkRenderPass pass = VK_NULL_HANDLE;
    checkVulkan(vkCreateRenderPass(device, &info, nullptr, &pass), "vkCreateRenderPass");
    return pass;
}

}  // namespace

ShadowMap::ShadowMap(const sample::VulkanHost& host,
                     const std::vector<VkVertexInputBindingDescription>& bindings,
                     const std::vector<VkVertexInputAttributeDescription>& attributes)
    : host_(host) {
    // Few devices can filter depth, so the sampler uses nearest.
    sampler_ = host.createSampler(VK_FILTER_NEAREST, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                  VK_SAMPLER_MIPMAP_MODE_NEAREST);
    sample::ImageRequest request;
    request.width = request.height = kShadowSide;
    request.format = kFormat;
    request.aspect = VK_IMAGE_ASPECT_DEPTH_BIT;
    request.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    still_ = host_.createImage(request);
    request.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                    VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    map_ = host_.createImage(request);
    stillTarget_ = makeTarget(still_, true);
    target_ = makeTarget(map_, false);
    layout_ = sample::makeLayout(host, {}, {VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof(glm::mat4)});
    makePipeline(bindings, attributes);
}

ShadowMap::~ShadowMap() {
    vkDestroyPipeline(host_.device, pipeline_, nullptr);
    vkDestroyPipelineLayout(host_.device, layout_, nullptr);
    for (const Target& target : {stillTarget_, target_}) {
        vkDestroyFramebuffer(host_.device, target.framebuffer, nullptr);
        vkDestroyRenderPass(host_.device, target.pass, nullptr);
    }
    host_.destroy(still_);
    host_.destroy(map_);
    vkDestroySampler(host_.device, sampler_, nullptr);
}

ShadowMap::Target ShadowMap::makeTarget(const sample::Image& image, bool still) const {
    Target target;
    target.pass = makePass(host_.device, still);
    VkFramebufferCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO;
    info.renderPass = target.pass;
    info.attachmentCount = 1;
    info.pAttachments = &image.view;
    info.width = info.height = kShadowSide;
    info.layers = 1;
    checkVulkan(vkCreateFramebuffer(host_.device, &info, nullptr, &target.framebuffer),
                "vkCreateFramebuffer");
    return target;
}

// A pipeline without colour, which makePipeline() of samples/common does not offer.
void ShadowMap::makePipeline(const std::vector<VkVertexInputBindingDescription>& bindings,
                             const std::vector<VkVertexInputAttributeDescription>& attributes) {
    sample::PipelineRequest request;
    request.pass = stillTarget_.pass;
    request.layout = layout_;
    request.vertex = host_.createShader(kShadowVert, sizeof kShadowVert);
    request.bindings = bindings;
    request.attributes = attributes;
    request.depthCompare = VK_COMPARE_OP_LESS;
    request.depthBias = 1.0f;
    request.depthBiasSlope = 1.5f;
    pipeline_ = sample::makePipeline(host_, request);
    vkDestroyShaderModule(host_.device, request.vertex, nullptr);
}

void ShadowMap::begin(VkCommandBuffer commands, const Target& target, const glm::mat4& clip) const {
    VkClearValue clear{};
    clear.depthStencil = {1.0f, 0};
    VkRenderPassBeginInfo info{};
    info.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO;
    info.renderPass = target.pass;
    info.framebuffer = target.framebuffer;
    info.renderArea = {{0, 0}, {kShadowSide, kShadowSide}};
    info.clearValueCount = 1;
    info.pClearValues = &clear;
    vkCmdBeginRenderPass(commands, &info, VK_SUBPASS_CONTENTS_INLINE);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline_);
    const float side = float(kShadowSide);
    const VkViewport viewport{0, 0, side, side, 0, 1};
    vkCmdSetViewport(commands, 0, 1, &viewport);
    vkCmdSetScissor(commands, 0, 1, &info.renderArea);
    vkCmdPushConstants(commands, layout_, VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof clip, &clip);
}

void ShadowMap::record(VkCommandBuffer commands, const glm::mat4& clip,
                       const std::function<void(bool moving)>& draw) {
    if (stillClip_ != clip) {
        begin(commands, stillTarget_, clip);
        draw(false);
        vkCmdEndRenderPass(commands);
        stillClip_ = clip;
    }
    // The barriers of samples/common cover colour only.
    VkImageMemoryBarrier barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER;
    barrier.dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
    barrier.newLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = map_.image;
    barrier.subresourceRange = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 1, 0, 1};
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT,
                         VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, nullptr, 0, nullptr, 1, &barrier);
    VkImageCopy copy{};
    copy.srcSubresource = copy.dstSubresource = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 0, 1};
    copy.extent = {kShadowSide, kShadowSide, 1};
    vkCmdCopyImage(commands, still_.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, map_.image,
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
    begin(commands, target_, clip);
    draw(true);
    vkCmdEndRenderPass(commands);
}

}  // namespace tower
