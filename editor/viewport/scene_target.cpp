// See scene_target.h.
#include "viewport/scene_target.h"

#include <algorithm>
#include <array>
#include <vector>

namespace fwview {
namespace {

#include "bloom.frag.h"
#include "post.frag.h"
#include "post.vert.h"

using sample::checkVulkan;

constexpr VkFormat kLight = VK_FORMAT_R16G16B16A16_SFLOAT, kDisplay = fwui::kUiFormat;

struct Push {  // push constants of post.frag
    float mode, exposure, bloom, vignette, aspect;
};

}  // namespace

SceneTarget::SceneTarget(const sample::VulkanHost& host, fwui::UiRenderer& ui)
    : host_(host),
      ui_(ui),
      depthFormat_(host.depthFormat()),
      drawing_(host, 1, 2, {VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof(Push)}) {
    constexpr VkImageLayout kDrawn = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                            kRead = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    scenePass_ = makePass({kLight, Depth::kWritten, VK_IMAGE_LAYOUT_UNDEFINED, kDrawn});
    flamePass_ = makePass({kLight, Depth::kNone, kDrawn, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL});
    spreadPass_ = makePass({kLight, Depth::kNone, VK_IMAGE_LAYOUT_UNDEFINED, kRead});
    shownPass_ = makePass({kDisplay, Depth::kNone, VK_IMAGE_LAYOUT_UNDEFINED, kRead});
    overPass_ = makePass({kDisplay, Depth::kTested, kRead, kRead});
    set_ = drawing_.newSet();

    sample::PipelineRequest request;
    request.depthTest = request.depthWrite = false;
    request.vertex = host.createShader(kPostVert, sizeof kPostVert);
    request.pass = shownPass_;
    request.fragment = host.createShader(kPostFrag, sizeof kPostFrag);
    shownPipeline_ = drawing_.pipeline(request);
    vkDestroyShaderModule(host.device, request.fragment, nullptr);
    request.pass = spreadPass_;
    request.fragment = host.createShader(kBloomFrag, sizeof kBloomFrag);
    spreadPipeline_ = drawing_.pipeline(request);
    vkDestroyShaderModule(host.device, request.fragment, nullptr);
    vkDestroyShaderModule(host.device, request.vertex, nullptr);
}

SceneTarget::~SceneTarget() {
    vkDeviceWaitIdle(host_.device);
    dropImages();
    for (VkRenderPass pass : {scenePass_, flamePass_, spreadPass_, shownPass_, overPass_})
        vkDestroyRenderPass(host_.device, pass, nullptr);
}

sample::ScenePass SceneTarget::pass() const {
    return {scenePass_, kLight, VK_SAMPLE_COUNT_1_BIT, VK_COMPARE_OP_LESS_OR_EQUAL,
            fwui::Frames::kSlots};
}

FwVulkanTargetDef SceneTarget::solids() const {
    FwVulkanTargetDef def = fwDefaultVulkanTargetDef();
    def.renderPass = scenePass_;
    def.colorFormat = kLight;
    def.depthFormat = depthFormat_;
    def.samples = 1;
    def.colorAttachmentCount = 1;
    def.depthMode = FW_DEPTH_TEST;
    def.flags = FW_TARGET_NO_FLAMES | FW_TARGET_AS_NEEDED;
    def.encoding = FW_OUTPUT_LINEAR;
    return def;
}

FwVulkanTargetDef SceneTarget::flames() const {
    FwVulkanTargetDef def = solids();
    def.renderPass = flamePass_;
    def.depthMode = FW_DEPTH_SAMPLED;
    def.flags = 0;
    return def;
}

void SceneTarget::setSampledDepth(FwVulkanFrame& frame) const {
    frame.sampledDepth = depth_.view;
    frame.sampledDepthLayout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL;
}

VkRenderPass SceneTarget::makePass(const PassRequest& request) const {
    constexpr VkImageLayout kReadDepth = VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL;
    const bool keeps = request.before != VK_IMAGE_LAYOUT_UNDEFINED,
               tests = request.depth == Depth::kTested, any = request.depth != Depth::kNone;
    std::array<VkAttachmentDescription, 2> attachments{};
    attachments[0].format = request.color;
    attachments[0].samples = VK_SAMPLE_COUNT_1_BIT;
    attachments[0].loadOp = keeps ? VK_ATTACHMENT_LOAD_OP_LOAD
                            : any ? VK_ATTACHMENT_LOAD_OP_CLEAR
                                  : VK_ATTACHMENT_LOAD_OP_DONT_CARE;
    attachments[0].storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    attachments[0].stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
    attachments[0].stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
    attachments[0].initialLayout = request.before;
    attachments[0].finalLayout = request.after;
    attachments[1] = attachments[0];
    attachments[1].format = depthFormat_;
    attachments[1].loadOp = tests ? VK_ATTACHMENT_LOAD_OP_LOAD : VK_ATTACHMENT_LOAD_OP_CLEAR;
    attachments[1].initialLayout = tests ? kReadDepth : VK_IMAGE_LAYOUT_UNDEFINED;
    attachments[1].finalLayout = kReadDepth;
    const VkAttachmentReference colorPlace{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    const VkAttachmentReference depthPlace{
        1, tests ? kReadDepth : VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};
    VkSubpassDescription subpass{};
    subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
    subpass.colorAttachmentCount = 1;
    subpass.pColorAttachments = &colorPlace;
    subpass.pDepthStencilAttachment = any ? &depthPlace : nullptr;
    constexpr VkPipelineStageFlags kWrites = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT |
                                             VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT |
                                             VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT;
    constexpr VkPipelineStageFlags kReads =
        VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT;
    constexpr VkAccessFlags kWritten =
        VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
    constexpr VkAccessFlags kTested =
        VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT;
    std::array<VkSubpassDependency, 2> dependencies{};
    dependencies[0].srcSubpass = VK_SUBPASS_EXTERNAL;
    dependencies[0].srcStageMask = kWrites | kReads;
    dependencies[0].srcAccessMask = kWritten;
    dependencies[0].dstStageMask = kWrites;
    dependencies[0].dstAccessMask = kWritten | kTested;
    dependencies[1].dstSubpass = VK_SUBPASS_EXTERNAL;
    dependencies[1].srcStageMask = kWrites;
    dependencies[1].srcAccessMask = kWritten;
    dependencies[1].dstStageMask = kWrites | kReads;
    dependencies[1].dstAccessMask =
        kWritten | kTested | VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_TRANSFER_READ_BIT;
    VkRenderPassCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO;
    info.attachmentCount = any ? 2 : 1;
    info.pAttachments = attachments.data();
    info.subpassCount = 1;
    info.pSubpasses = &subpass;
    info.dependencyCount = uint32_t(dependencies.size());
    info.pDependencies = dependencies.data();
    VkRenderPass made = VK_NULL_HANDLE;
    checkVulkan(vkCreateRenderPass(host_.device, &info, nullptr, &made), "vkCreateRenderPass");
    return made;
}

VkFramebuffer SceneTarget::makeFramebuffer(VkRenderPass pass,
                                           std::initializer_list<VkImageView> views, uint32_t width,
                                           uint32_t height) const {
    VkFramebufferCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO;
    info.renderPass = pass;
    info.attachmentCount = uint32_t(views.size());
    info.pAttachments = views.begin();
    info.width = width;
    info.height = height;
    info.layers = 1;
    VkFramebuffer made = VK_NULL_HANDLE;
    checkVulkan(vkCreateFramebuffer(host_.device, &info, nullptr, &made), "vkCreateFramebuffer");
    return made;
}

void SceneTarget::dropImages() {
    ui_.removeTexture(texture_);
    texture_ = nullptr;
    for (VkFramebuffer* framebuffer : {&sceneFramebuffer_, &flameFramebuffer_, &spreadFramebuffer_,
                                       &shownFramebuffer_, &overFramebuffer_}) {
        vkDestroyFramebuffer(host_.device, *framebuffer, nullptr);
        *framebuffer = VK_NULL_HANDLE;
    }
    for (sample::Image* image : {&color_, &depth_, &spread_, &shown_, &kept_})
        host_.destroy(*image);
}

void SceneTarget::resize(uint32_t width, uint32_t height) {
    width = std::clamp(width, 8u, 8192u);
    height = std::clamp(height, 8u, 8192u);
    if (width == extent_.width && height == extent_.height) return;
    checkVulkan(vkDeviceWaitIdle(host_.device), "vkDeviceWaitIdle");
    dropImages();
    extent_ = {width, height};
    mips_ = 1;
    while (mips_ < 5 && (std::min(width, height) >> mips_) >= 2) ++mips_;

    sample::ImageRequest request;
    request.width = width;
    request.height = height;
    request.mips = mips_;
    request.format = kLight;
    request.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                    VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    color_ = host_.createImage(request);
    request.mips = 1;
    request.format = kDisplay;
    request.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                    VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    shown_ = host_.createImage(request);
    kept_ = host_.createImage(request);
    request.format = depthFormat_;
    request.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    request.aspect = VK_IMAGE_ASPECT_DEPTH_BIT;
    depth_ = host_.createImage(request);
    sample::ImageRequest quarter;
    quarter.width = std::max(1u, width / 4);
    quarter.height = std::max(1u, height / 4);
    quarter.format = kLight;
    quarter.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    spread_ = host_.createImage(quarter);

    sceneFramebuffer_ = makeFramebuffer(scenePass_, {color_.firstMip, depth_.view}, width, height);
    flameFramebuffer_ = makeFramebuffer(flamePass_, {color_.firstMip}, width, height);
    spreadFramebuffer_ =
        makeFramebuffer(spreadPass_, {spread_.view}, quarter.width, quarter.height);
    shownFramebuffer_ = makeFramebuffer(shownPass_, {shown_.view}, width, height);
    overFramebuffer_ = makeFramebuffer(overPass_, {shown_.view, depth_.view}, width, height);
    drawing_.write(set_, 0, color_.view);
    drawing_.write(set_, 1, spread_.view);
    texture_ = ui_.addTexture(shown_.view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    // Black until the first frame, so that the texture has a readable layout.
    host_.runNow([&](VkCommandBuffer commands) {
        sample::imageBarrier(commands, shown_.image, VK_IMAGE_LAYOUT_UNDEFINED,
                             VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                             VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, 0,
                             VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, VK_ACCESS_SHADER_READ_BIT);
    });
}

void SceneTarget::beginPass(const fwui::Frame& frame, VkRenderPass pass,
                            VkFramebuffer framebuffer) const {
    std::array<VkClearValue, 2> clear{};
    clear[0].color = {{0.02f, 0.02f, 0.025f, 1.0f}};
    clear[1].depthStencil = {1.0f, 0};
    VkRenderPassBeginInfo info{};
    info.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO;
    info.renderPass = pass;
    info.framebuffer = framebuffer;
    info.renderArea = {{0, 0}, extent_};
    info.clearValueCount = uint32_t(clear.size());
    info.pClearValues = clear.data();
    vkCmdBeginRenderPass(frame.commands, &info, VK_SUBPASS_CONTENTS_INLINE);
    const VkViewport all = viewport();
    vkCmdSetViewport(frame.commands, 0, 1, &all);
    vkCmdSetScissor(frame.commands, 0, 1, &info.renderArea);
}

void SceneTarget::begin(const fwui::Frame& frame) {
    beginPass(frame, scenePass_, sceneFramebuffer_);
}

void SceneTarget::beginFlames(const fwui::Frame& frame) {
    vkCmdEndRenderPass(frame.commands);
    beginPass(frame, flamePass_, flameFramebuffer_);
}

void SceneTarget::end(const fwui::Frame& frame) {
    vkCmdEndRenderPass(frame.commands);
    const Push push{0, 1, bloom, vignette, float(extent_.width) / float(extent_.height)};
    vkCmdPushConstants(frame.commands, drawing_.layout(), VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                       sizeof push, &push);
    spreadLight(frame);
    drawPost(frame, spreadPipeline_, spreadPass_, spreadFramebuffer_,
             {spread_.made.width, spread_.made.height});
    drawPost(frame, shownPipeline_, shownPass_, shownFramebuffer_, extent_);
}

// `to` ends in the sampled layout, or in the copy layout if it is the kept picture.
void SceneTarget::copyPicture(const fwui::Frame& frame, const sample::Image& from,
                              VkImageLayout before, const sample::Image& to) const {
    const bool keeps = &to == &kept_;
    const VkImageLayout sampled = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    constexpr VkPipelineStageFlags kDrawn = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT |
                                            VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT |
                                            VK_PIPELINE_STAGE_TRANSFER_BIT;
    sample::imageBarrier(frame.commands, from.image, before, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                         kDrawn,
                         VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT,
                         VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_READ_BIT);
    sample::imageBarrier(frame.commands, to.image, VK_IMAGE_LAYOUT_UNDEFINED,
                         VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, kDrawn,
                         VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT,
                         VK_ACCESS_TRANSFER_WRITE_BIT);
    VkImageCopy copy{};
    copy.srcSubresource = copy.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    copy.extent = {extent_.width, extent_.height, 1};
    vkCmdCopyImage(frame.commands, from.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to.image,
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
    const sample::Image& shown = keeps ? from : to;
    constexpr VkPipelineStageFlags kUsed =
        VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT | VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT;
    sample::imageBarrier(
        frame.commands, shown.image,
        keeps ? VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL : VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
        sampled, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT, kUsed,
        VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_READ_BIT |
            VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT);
    if (!keeps) return;
    sample::imageBarrier(frame.commands, to.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                         VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_PIPELINE_STAGE_TRANSFER_BIT,
                         VK_ACCESS_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT,
                         VK_ACCESS_TRANSFER_READ_BIT);
}

void SceneTarget::keep(const fwui::Frame& frame) {
    copyPicture(frame, shown_, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, kept_);
}

void SceneTarget::restore(const fwui::Frame& frame) {
    copyPicture(frame, kept_, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, shown_);
}

void SceneTarget::beginOver(const fwui::Frame& frame) {
    beginPass(frame, overPass_, overFramebuffer_);
}

void SceneTarget::endOver(const fwui::Frame& frame) { vkCmdEndRenderPass(frame.commands); }

// Halves the scene repeatedly, for the bloom.
void SceneTarget::spreadLight(const fwui::Frame& frame) {
    auto side = [](uint32_t length, uint32_t mip) { return int32_t(std::max(1u, length >> mip)); };
    for (uint32_t mip = 1; mip < mips_; ++mip) {
        sample::imageBarrier(frame.commands, color_.image, VK_IMAGE_LAYOUT_UNDEFINED,
                             VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                             VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, 0,
                             VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT, mip, 1);
        VkImageBlit blit{};
        blit.srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, mip - 1, 0, 1};
        blit.srcOffsets[1] = {side(extent_.width, mip - 1), side(extent_.height, mip - 1), 1};
        blit.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, mip, 0, 1};
        blit.dstOffsets[1] = {side(extent_.width, mip), side(extent_.height, mip), 1};
        vkCmdBlitImage(frame.commands, color_.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                       color_.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &blit,
                       VK_FILTER_LINEAR);
        sample::imageBarrier(frame.commands, color_.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                             VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_PIPELINE_STAGE_TRANSFER_BIT,
                             VK_ACCESS_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT,
                             VK_ACCESS_TRANSFER_READ_BIT, mip, 1);
    }
    sample::imageBarrier(frame.commands, color_.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                         VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_PIPELINE_STAGE_TRANSFER_BIT,
                         VK_ACCESS_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT,
                         VK_ACCESS_SHADER_READ_BIT);
}

void SceneTarget::drawPost(const fwui::Frame& frame, VkPipeline pipeline, VkRenderPass pass,
                           VkFramebuffer framebuffer, VkExtent2D extent) {
    VkRenderPassBeginInfo info{};
    info.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO;
    info.renderPass = pass;
    info.framebuffer = framebuffer;
    info.renderArea = {{0, 0}, extent};
    vkCmdBeginRenderPass(frame.commands, &info, VK_SUBPASS_CONTENTS_INLINE);
    const VkViewport all{0, 0, float(extent.width), float(extent.height), 0, 1};
    vkCmdSetViewport(frame.commands, 0, 1, &all);
    vkCmdSetScissor(frame.commands, 0, 1, &info.renderArea);
    vkCmdBindPipeline(frame.commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    vkCmdBindDescriptorSets(frame.commands, VK_PIPELINE_BIND_POINT_GRAPHICS, drawing_.layout(), 0,
                            1, &set_, 0, nullptr);
    vkCmdDraw(frame.commands, 3, 1, 0, 0);
    vkCmdEndRenderPass(frame.commands);
}

}  // namespace fwview
