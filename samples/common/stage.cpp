// See stage.h.
#include "common/stage.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>

#include "common/pipeline.h"

namespace sample {
namespace {

#include "bloom.frag.h"
#include "post.frag.h"
#include "post.vert.h"

struct PostPush {
    float mode, exposure, bloom, vignette, aspect;
};

double clockSeconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

}  // namespace

Stage::Stage(const VulkanHost& host, const Options& options, const StageRequest& request,
             uint32_t frames)
    : made(request), host_(host), fps_(options.fps), frameLimit_(frames) {
    depthFormat = host.depthFormat();
    extent_ = {options.width, options.height};
    if (host.made.windowed) {
        window_ = std::make_unique<Window>(host, made.title, options.width, options.height);
        outputFormat_ = window_->format;
        extent_ = window_->extent;
        windowGeneration_ = window_->generation;
    }
    slots_.resize(std::clamp(made.framesInFlight, 1u, 4u));
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
        VkFenceCreateInfo fenceInfo{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO, nullptr,
                                    VK_FENCE_CREATE_SIGNALED_BIT};
        checkVulkan(vkCreateFence(host.device, &fenceInfo, nullptr, &slot.fence), "vkCreateFence");
        VkSemaphoreCreateInfo semaphoreInfo{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, nullptr, 0};
        checkVulkan(vkCreateSemaphore(host.device, &semaphoreInfo, nullptr, &slot.available),
                    "vkCreateSemaphore");
    }
    sampler_ = host.createSampler(VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                  VK_SAMPLER_MIPMAP_MODE_NEAREST);
    makePasses();
    createPostPass();
    makeTargets();
    lastClock_ = clockSeconds();
}

Stage::~Stage() {
    vkDeviceWaitIdle(host_.device);
    destroyTargets();
    for (Slot& slot : slots_) {
        vkDestroyCommandPool(host_.device, slot.pool, nullptr);
        vkDestroyFence(host_.device, slot.fence, nullptr);
        vkDestroySemaphore(host_.device, slot.available, nullptr);
    }
    vkDestroyPipeline(host_.device, postPipeline_, nullptr);
    vkDestroyPipeline(host_.device, bloomPipeline_, nullptr);
    vkDestroyPipelineLayout(host_.device, postLayout_, nullptr);
    vkDestroyDescriptorPool(host_.device, descriptorPool_, nullptr);
    vkDestroyDescriptorSetLayout(host_.device, postSetLayout_, nullptr);
    vkDestroySampler(host_.device, sampler_, nullptr);
    vkDestroyRenderPass(host_.device, postPass_, nullptr);
    vkDestroyRenderPass(host_.device, bloomPass_, nullptr);
    vkDestroyRenderPass(host_.device, scenePass, nullptr);
}

void Stage::makePasses() {
    const bool multisampled = made.samples != VK_SAMPLE_COUNT_1_BIT;
    const bool scenic = made.colorFormat == VK_FORMAT_R16G16B16A16_SFLOAT;
    const VkImageLayout afterScene =
        scenic ? VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    // Attachments: 0 the render target, 1 depth, 2 the resolved colour when multisampled.
    std::array<VkAttachmentDescription, 3> attachments{};
    attachments[0].format = made.colorFormat;
    attachments[0].samples = made.samples;
    attachments[0].loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    attachments[0].storeOp =
        multisampled ? VK_ATTACHMENT_STORE_OP_DONT_CARE : VK_ATTACHMENT_STORE_OP_STORE;
    attachments[0].stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
    attachments[0].stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
    attachments[0].finalLayout =
        multisampled ? VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL : afterScene;
    attachments[1] = attachments[0];
    attachments[1].format = depthFormat;
    attachments[1].storeOp =
        made.capturesScene ? VK_ATTACHMENT_STORE_OP_STORE : VK_ATTACHMENT_STORE_OP_DONT_CARE;
    attachments[1].finalLayout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL;
    attachments[2] = attachments[0];
    attachments[2].samples = VK_SAMPLE_COUNT_1_BIT;
    attachments[2].loadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
    attachments[2].storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    attachments[2].finalLayout = afterScene;
    const VkAttachmentReference color{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    const VkAttachmentReference depth{1, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};
    const VkAttachmentReference resolve{2, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    VkSubpassDescription subpass{};
    subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
    subpass.colorAttachmentCount = 1;
    subpass.pColorAttachments = &color;
    subpass.pDepthStencilAttachment = &depth;
    subpass.pResolveAttachments = multisampled ? &resolve : nullptr;
    constexpr VkPipelineStageFlags kDepthStages =
        VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT;
    std::array<VkSubpassDependency, 2> dependencies{};
    dependencies[0].srcSubpass = VK_SUBPASS_EXTERNAL;
    dependencies[0].srcStageMask = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT | kDepthStages |
                                   VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT |
                                   VK_PIPELINE_STAGE_TRANSFER_BIT;
    dependencies[0].srcAccessMask =
        VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
    dependencies[0].dstStageMask = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT | kDepthStages;
    dependencies[0].dstAccessMask =
        VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT |
        VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
    dependencies[1].dstSubpass = VK_SUBPASS_EXTERNAL;
    dependencies[1].srcStageMask = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
    dependencies[1].srcAccessMask = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT;
    dependencies[1].dstStageMask =
        VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT;
    dependencies[1].dstAccessMask = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_TRANSFER_READ_BIT;
    VkRenderPassCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO;
    info.attachmentCount = multisampled ? 3 : 2;
    info.pAttachments = attachments.data();
    info.subpassCount = 1;
    info.pSubpasses = &subpass;
    info.dependencyCount = static_cast<uint32_t>(dependencies.size());
    info.pDependencies = dependencies.data();
    checkVulkan(vkCreateRenderPass(host_.device, &info, nullptr, &scenePass), "vkCreateRenderPass");

    VkAttachmentDescription output{};
    output.format = outputFormat_;
    output.samples = VK_SAMPLE_COUNT_1_BIT;
    output.loadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
    output.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    output.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
    output.stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
    output.finalLayout =
        window_ ? VK_IMAGE_LAYOUT_PRESENT_SRC_KHR : VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    subpass.pDepthStencilAttachment = nullptr;
    subpass.pResolveAttachments = nullptr;
    dependencies[0].srcStageMask =
        VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT;
    dependencies[0].srcAccessMask = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT;
    dependencies[0].dstStageMask = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
    dependencies[0].dstAccessMask = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT;
    dependencies[1].dstStageMask = VK_PIPELINE_STAGE_TRANSFER_BIT;
    dependencies[1].dstAccessMask = VK_ACCESS_TRANSFER_READ_BIT;
    info.attachmentCount = 1;
    info.pAttachments = &output;
    checkVulkan(vkCreateRenderPass(host_.device, &info, nullptr, &postPass_), "vkCreateRenderPass");

    output.format = VK_FORMAT_R16G16B16A16_SFLOAT;
    output.finalLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    dependencies[0].srcStageMask =
        VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT | VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT;
    dependencies[1].dstStageMask = VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT;
    dependencies[1].dstAccessMask = VK_ACCESS_SHADER_READ_BIT;
    checkVulkan(vkCreateRenderPass(host_.device, &info, nullptr, &bloomPass_),
                "vkCreateRenderPass");
}

void Stage::createPostPass() {
    constexpr VkDescriptorType kImage = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    postSetLayout_ = makeSetLayout(host_, {kImage, kImage});  // the scene and its bloom
    descriptorPool_ = makeSetPool(host_, 1, 0, 2);
    postSet_ = makeSet(host_, descriptorPool_, postSetLayout_);
    postLayout_ =
        makeLayout(host_, {postSetLayout_}, {VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof(PostPush)});
    PipelineRequest request;
    request.pass = postPass_;
    request.layout = postLayout_;
    request.vertex = host_.createShader(kPostVert, sizeof kPostVert);
    request.fragment = host_.createShader(kPostFrag, sizeof kPostFrag);
    request.depthTest = request.depthWrite = false;
    postPipeline_ = makePipeline(host_, request);
    vkDestroyShaderModule(host_.device, request.fragment, nullptr);
    request.pass = bloomPass_;
    request.fragment = host_.createShader(kBloomFrag, sizeof kBloomFrag);
    bloomPipeline_ = makePipeline(host_, request);
    vkDestroyShaderModule(host_.device, request.vertex, nullptr);
    vkDestroyShaderModule(host_.device, request.fragment, nullptr);
}

void StageRequest::applyOptions(const Options& options) {
    capturesScene = options.compositeEffects || options.halfEffects;
    halfEffects = options.halfEffects;
    if (capturesScene) samples = VK_SAMPLE_COUNT_1_BIT;
}

void Stage::makeTargets() {
    const bool scenic = made.colorFormat == VK_FORMAT_R16G16B16A16_SFLOAT;
    const bool multisampled = made.samples != VK_SAMPLE_COUNT_1_BIT;
    sceneMips_ = 1;
    if (scenic && made.bloom > 0) {
        while (sceneMips_ < 5 && (std::min(extent_.width, extent_.height) >> sceneMips_) >= 2) {
            ++sceneMips_;
        }
    }
    ImageRequest request;
    request.width = extent_.width;
    request.height = extent_.height;
    request.mips = sceneMips_;
    request.format = made.colorFormat;
    request.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                    VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    color_ = host_.createImage(request);
    request.mips = 1;
    request.samples = made.samples;
    if (multisampled) {
        request.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
        multisampled_ = host_.createImage(request);
    }
    if (made.capturesScene) {
        request.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
        copy_ = host_.createImage(request);
    }
    request.format = depthFormat;
    request.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
    if (made.capturesScene) request.usage |= VK_IMAGE_USAGE_SAMPLED_BIT;
    request.aspect = VK_IMAGE_ASPECT_DEPTH_BIT;
    if (depthFormat == VK_FORMAT_D24_UNORM_S8_UINT && !made.capturesScene)
        request.aspect |= VK_IMAGE_ASPECT_STENCIL_BIT;
    depth_ = host_.createImage(request);

    const std::array<VkImageView, 3> views = {
        multisampled ? multisampled_.firstMip : color_.firstMip, depth_.view, color_.firstMip};
    VkFramebufferCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO;
    info.renderPass = scenePass;
    info.attachmentCount = multisampled ? 3 : 2;
    info.pAttachments = views.data();
    info.width = extent_.width;
    info.height = extent_.height;
    info.layers = 1;
    checkVulkan(vkCreateFramebuffer(host_.device, &info, nullptr, &sceneFramebuffer_),
                "vkCreateFramebuffer");

    ImageRequest small;
    small.width = std::max(1u, extent_.width / 4);
    small.height = std::max(1u, extent_.height / 4);
    small.format = VK_FORMAT_R16G16B16A16_SFLOAT;
    small.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                  VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    bloom_ = host_.createImage(small);
    info.renderPass = bloomPass_;
    info.attachmentCount = 1;
    info.pAttachments = &bloom_.view;
    info.width = small.width;
    info.height = small.height;
    checkVulkan(vkCreateFramebuffer(host_.device, &info, nullptr, &bloomFramebuffer_),
                "vkCreateFramebuffer");
    // The post pass always binds it, so it needs its layout even when nothing draws to it.
    host_.runNow([&](VkCommandBuffer commands) {
        imageBarrier(commands, bloom_.image, VK_IMAGE_LAYOUT_UNDEFINED,
                     VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, 0,
                     VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, VK_ACCESS_SHADER_READ_BIT);
    });
    info.width = extent_.width;
    info.height = extent_.height;

    std::vector<VkImageView> outputs;
    if (window_) {
        outputs = window_->views;
    } else {
        ImageRequest output;
        output.width = extent_.width;
        output.height = extent_.height;
        output.format = outputFormat_;
        output.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
        output_ = host_.createImage(output);
        outputs = {output_.view};
        for (Slot& slot : slots_) {
            slot.readback = host_.createBuffer(VkDeviceSize{extent_.width} * extent_.height * 4,
                                               VK_BUFFER_USAGE_TRANSFER_DST_BIT, true);
        }
    }
    info.renderPass = postPass_;
    info.attachmentCount = 1;
    for (VkImageView view : outputs) {
        info.pAttachments = &view;
        VkFramebuffer framebuffer = VK_NULL_HANDLE;
        checkVulkan(vkCreateFramebuffer(host_.device, &info, nullptr, &framebuffer),
                    "vkCreateFramebuffer");
        outputFramebuffers_.push_back(framebuffer);
    }
    writeImage(host_, postSet_, 0, sampler_, color_.view);
    writeImage(host_, postSet_, 1, sampler_, bloom_.view);
}

void Stage::destroyTargets() {
    for (VkFramebuffer framebuffer : outputFramebuffers_) {
        vkDestroyFramebuffer(host_.device, framebuffer, nullptr);
    }
    outputFramebuffers_.clear();
    vkDestroyFramebuffer(host_.device, sceneFramebuffer_, nullptr);
    vkDestroyFramebuffer(host_.device, bloomFramebuffer_, nullptr);
    for (Image* image : {&color_, &multisampled_, &depth_, &copy_, &bloom_, &output_}) {
        host_.destroy(*image);
    }
    for (Slot& slot : slots_) host_.destroy(slot.readback);
}

void Stage::collect(Slot& slot) {
    if (!slot.pending) return;
    slot.pending = false;
    if (!onPicture || window_) return;
    Picture picture{extent_.width, extent_.height, {}};
    const auto* bytes = static_cast<const uint8_t*>(slot.readback.mapped);
    picture.rgba.assign(bytes, bytes + size_t{extent_.width} * extent_.height * 4);
    onPicture(slot.number, std::move(picture));
}

bool Stage::next(StageFrame& frame) {
    frame.input = {};
    bool over = frameLimit_ != 0 && number_ >= frameLimit_;
    if (!over && window_) over = !window_->poll(frame.input);
    if (over) {
        // Deliver the outstanding pictures, oldest first.
        for (size_t i = 0; i < slots_.size(); ++i) {
            Slot& slot = slots_[(frameIndex_ + i) % slots_.size()];
            checkVulkan(vkWaitForFences(host_.device, 1, &slot.fence, VK_TRUE, ~0ull),
                        "vkWaitForFences");
            collect(slot);
        }
        return false;
    }
    Slot& slot = slots_[frameIndex_ % slots_.size()];
    checkVulkan(vkWaitForFences(host_.device, 1, &slot.fence, VK_TRUE, ~0ull), "vkWaitForFences");
    completed_ = std::max(completed_, slot.frameIndex);
    collect(slot);
    if (window_) {
        window_->limitRate(fps_);
        while (!window_->acquire(slot.available, imageIndex_)) {
            window_->limitRate(20.0);
            if (!window_->poll(frame.input)) {
                checkVulkan(vkDeviceWaitIdle(host_.device), "vkDeviceWaitIdle");
                return false;
            }
        }
        if (window_->generation != windowGeneration_) {
            windowGeneration_ = window_->generation;
            checkVulkan(vkDeviceWaitIdle(host_.device), "vkDeviceWaitIdle");
            destroyTargets();
            extent_ = window_->extent;
            makeTargets();
        }
    }
    checkVulkan(vkResetFences(host_.device, 1, &slot.fence), "vkResetFences");
    checkVulkan(vkResetCommandPool(host_.device, slot.pool, 0), "vkResetCommandPool");
    slot.secondariesUsed = 0;
    VkCommandBufferBeginInfo begin{};
    begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    checkVulkan(vkBeginCommandBuffer(slot.commands, &begin), "vkBeginCommandBuffer");

    const double now = clockSeconds();
    frame.deltaTime = window_ ? static_cast<float>(std::clamp(now - lastClock_, 0.0, 0.1))
                              : static_cast<float>(1.0 / fps_);
    lastClock_ = now;
    frame.time = time_;
    time_ += frame.deltaTime;
    frame.commands = slot.commands;
    frame.slot = static_cast<uint32_t>(frameIndex_ % slots_.size());
    frame.framesInFlight = static_cast<uint32_t>(slots_.size());
    frame.frameIndex = ++frameIndex_;
    frame.completedFrameIndex = completed_;
    frame.number = number_++;
    frame.extent = extent_;
    frame.viewport = {0, 0, static_cast<float>(extent_.width), static_cast<float>(extent_.height),
                      0, 1};
    slot.frameIndex = frame.frameIndex;
    slot.number = frame.number;
    return true;
}

void Stage::beginScene(const StageFrame& frame, bool secondaries) {
    std::array<VkClearValue, 2> clear{};
    std::memcpy(clear[0].color.float32, made.clearColor, sizeof made.clearColor);
    clear[1].depthStencil = {made.reversedDepth ? 0.0f : 1.0f, 0};
    VkRenderPassBeginInfo info{};
    info.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO;
    info.renderPass = scenePass;
    info.framebuffer = sceneFramebuffer_;
    info.renderArea = {{0, 0}, extent_};
    info.clearValueCount = static_cast<uint32_t>(clear.size());
    info.pClearValues = clear.data();
    vkCmdBeginRenderPass(
        frame.commands, &info,
        secondaries ? VK_SUBPASS_CONTENTS_SECONDARY_COMMAND_BUFFERS : VK_SUBPASS_CONTENTS_INLINE);
    if (secondaries) return;
    const VkRect2D scissor{{0, 0}, extent_};
    vkCmdSetViewport(frame.commands, 0, 1, &frame.viewport);
    vkCmdSetScissor(frame.commands, 0, 1, &scissor);
}

void Stage::endScene(const StageFrame& frame) { vkCmdEndRenderPass(frame.commands); }

CapturedScene Stage::captureScene(const StageFrame& frame) {
    imageBarrier(frame.commands, copy_.image, VK_IMAGE_LAYOUT_UNDEFINED,
                 VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, 0,
                 VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT);
    VkImageCopy region{};
    region.srcSubresource = region.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.extent = {extent_.width, extent_.height, 1};
    vkCmdCopyImage(frame.commands, color_.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, copy_.image,
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
    imageBarrier(frame.commands, copy_.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                 VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_PIPELINE_STAGE_TRANSFER_BIT,
                 VK_ACCESS_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT,
                 VK_ACCESS_SHADER_READ_BIT);
    return {color_.image, color_.firstMip, depth_.image, depth_.view, copy_.view};
}

// Halves the scene repeatedly. The last pass adds the small mips back as bloom.
void Stage::downsampleBloom(const StageFrame& frame) {
    for (uint32_t mip = 1; mip < sceneMips_; ++mip) {
        imageBarrier(frame.commands, color_.image, VK_IMAGE_LAYOUT_UNDEFINED,
                     VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, 0,
                     VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT, mip, 1);
        VkImageBlit blit{};
        blit.srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, mip - 1, 0, 1};
        blit.srcOffsets[1] = {static_cast<int32_t>(std::max(1u, extent_.width >> (mip - 1))),
                              static_cast<int32_t>(std::max(1u, extent_.height >> (mip - 1))), 1};
        blit.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, mip, 0, 1};
        blit.dstOffsets[1] = {static_cast<int32_t>(std::max(1u, extent_.width >> mip)),
                              static_cast<int32_t>(std::max(1u, extent_.height >> mip)), 1};
        vkCmdBlitImage(frame.commands, color_.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                       color_.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &blit,
                       VK_FILTER_LINEAR);
        imageBarrier(frame.commands, color_.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                     VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_PIPELINE_STAGE_TRANSFER_BIT,
                     VK_ACCESS_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT,
                     VK_ACCESS_TRANSFER_READ_BIT, mip, 1);
    }
    imageBarrier(frame.commands, color_.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                 VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_PIPELINE_STAGE_TRANSFER_BIT,
                 VK_ACCESS_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT,
                 VK_ACCESS_SHADER_READ_BIT);
    if (made.bloom <= 0) return;
    drawPost(frame, bloomPipeline_, bloomPass_, bloomFramebuffer_,
             {bloom_.made.width, bloom_.made.height});
}

void Stage::drawPost(const StageFrame& frame, VkPipeline pipeline, VkRenderPass pass,
                     VkFramebuffer framebuffer, VkExtent2D extent,
                     const std::function<void(VkCommandBuffer)>& over) {
    VkRenderPassBeginInfo info{};
    info.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO;
    info.renderPass = pass;
    info.framebuffer = framebuffer;
    info.renderArea = {{0, 0}, extent};
    vkCmdBeginRenderPass(frame.commands, &info, VK_SUBPASS_CONTENTS_INLINE);
    const VkViewport viewport{
        0, 0, static_cast<float>(extent.width), static_cast<float>(extent.height), 0, 1};
    vkCmdSetViewport(frame.commands, 0, 1, &viewport);
    vkCmdSetScissor(frame.commands, 0, 1, &info.renderArea);
    vkCmdBindPipeline(frame.commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    vkCmdBindDescriptorSets(frame.commands, VK_PIPELINE_BIND_POINT_GRAPHICS, postLayout_, 0, 1,
                            &postSet_, 0, nullptr);
    vkCmdDraw(frame.commands, 3, 1, 0, 0);
    if (over) over(frame.commands);
    vkCmdEndRenderPass(frame.commands);
}

void Stage::finish(const StageFrame& frame) {
    Slot& slot = slots_[frame.slot];
    const bool scenic = made.colorFormat == VK_FORMAT_R16G16B16A16_SFLOAT;
    const bool srgb =
        made.colorFormat == VK_FORMAT_R8G8B8A8_SRGB || made.colorFormat == VK_FORMAT_B8G8R8A8_SRGB;
    const PostPush push{scenic ? 0.0f
                        : srgb ? 1.0f
                               : 2.0f,
                        made.exposure, made.bloom, made.vignette,
                        static_cast<float>(extent_.width) / static_cast<float>(extent_.height)};
    vkCmdPushConstants(frame.commands, postLayout_, VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof push,
                       &push);
    if (scenic) downsampleBloom(frame);
    drawPost(frame, postPipeline_, postPass_, outputFramebuffers_[window_ ? imageIndex_ : 0],
             extent_, overlay);
    if (!window_) {
        VkBufferImageCopy region{};
        region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        region.imageExtent = {extent_.width, extent_.height, 1};
        vkCmdCopyImageToBuffer(frame.commands, output_.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                               slot.readback.buffer, 1, &region);
        VkMemoryBarrier barrier{};
        barrier.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
        barrier.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
        barrier.dstAccessMask = VK_ACCESS_HOST_READ_BIT;
        vkCmdPipelineBarrier(frame.commands, VK_PIPELINE_STAGE_TRANSFER_BIT,
                             VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &barrier, 0, nullptr, 0, nullptr);
    }
    checkVulkan(vkEndCommandBuffer(frame.commands), "vkEndCommandBuffer");

    VkSubmitInfo submit{};
    submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &frame.commands;
    const VkPipelineStageFlags waitStage = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
    VkSemaphore rendered = VK_NULL_HANDLE;
    if (window_) {
        rendered = window_->rendered(imageIndex_);
        submit.waitSemaphoreCount = 1;
        submit.pWaitSemaphores = &slot.available;
        submit.pWaitDstStageMask = &waitStage;
        submit.signalSemaphoreCount = 1;
        submit.pSignalSemaphores = &rendered;
    }
    checkVulkan(vkQueueSubmit(host_.queue, 1, &submit, slot.fence), "vkQueueSubmit");
    slot.pending = true;
    if (window_) window_->present(imageIndex_);
}

VkCommandBuffer Stage::beginSecondary(const StageFrame& frame, bool insideScene) {
    Slot& slot = slots_[frame.slot];
    if (slot.secondariesUsed == slot.secondaries.size()) {
        VkCommandBufferAllocateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
        info.commandPool = slot.pool;
        info.level = VK_COMMAND_BUFFER_LEVEL_SECONDARY;
        info.commandBufferCount = 1;
        VkCommandBuffer commands = VK_NULL_HANDLE;
        checkVulkan(vkAllocateCommandBuffers(host_.device, &info, &commands),
                    "vkAllocateCommandBuffers");
        slot.secondaries.push_back(commands);
    }
    VkCommandBuffer commands = slot.secondaries[slot.secondariesUsed++];
    VkCommandBufferInheritanceInfo inheritance{};
    inheritance.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_INHERITANCE_INFO;
    VkCommandBufferBeginInfo begin{};
    begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    begin.pInheritanceInfo = &inheritance;
    if (insideScene) {
        inheritance.renderPass = scenePass;
        inheritance.framebuffer = sceneFramebuffer_;
        begin.flags |= VK_COMMAND_BUFFER_USAGE_RENDER_PASS_CONTINUE_BIT;
    }
    checkVulkan(vkBeginCommandBuffer(commands, &begin), "vkBeginCommandBuffer");
    if (insideScene) {
        const VkRect2D scissor{{0, 0}, extent_};
        vkCmdSetViewport(commands, 0, 1, &frame.viewport);
        vkCmdSetScissor(commands, 0, 1, &scissor);
    }
    return commands;
}

void Stage::executeSecondary(const StageFrame& frame, VkCommandBuffer commands) {
    checkVulkan(vkEndCommandBuffer(commands), "vkEndCommandBuffer");
    vkCmdExecuteCommands(frame.commands, 1, &commands);
}

}  // namespace sample
