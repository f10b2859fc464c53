#include "gpu/vk/pipelines.h"

#include "core/assert.h"
#include "core/error.h"
#include "gpu/vk/device_objects.h"
#include "gpu/vk/vk_backend.h"
#include "mesh/burn_domain.h"
#include "shared/appearance.h"
#include "shared/deform.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>
#include <string_view>

namespace fw::gpu::vk {
namespace {

VkFormat halfColorFor(VkFormat color, uint32_t encoding) noexcept {
    if (encoding == FW_OUTPUT_LINEAR || color == VK_FORMAT_R16G16B16A16_SFLOAT ||
        color == VK_FORMAT_R32G32B32A32_SFLOAT || color == VK_FORMAT_B10G11R11_UFLOAT_PACK32)
        return Pipelines::kHalfColors[0];
    return Pipelines::kHalfColors[encoding == FW_OUTPUT_SRGB_VIEW ? 1 : 2];
}

bool hasDepthAspect(VkFormat format) noexcept {
    return format == VK_FORMAT_D16_UNORM || format == VK_FORMAT_X8_D24_UNORM_PACK32 ||
           format == VK_FORMAT_D32_SFLOAT || (hasStencil(format) && format != VK_FORMAT_S8_UINT);
}

// Checks the host's target def against the info that made its render pass.
template <class Info>
void checkAgainst(const FwVulkanTargetDef& def, const Info& info) {
    const auto differs = [](const char* field, uint32_t given, const char* where, uint32_t has) {
        core::refuse(
            "FwVulkanTargetDef::%s is %u and the pass of renderPassInfo has %u %s; give %u, "
            "or the info of the pass in renderPass.",
            field, given, has, where, has);
    };
    if (def.subpass >= info.subpassCount)
        core::refuse(
            "FwVulkanTargetDef::subpass is %u and the pass of renderPassInfo has %u; it is "
            "below that.",
            def.subpass, info.subpassCount);
    const auto& subpass = info.pSubpasses[def.subpass];
    if (def.colorAttachmentCount != subpass.colorAttachmentCount)
        differs("colorAttachmentCount", def.colorAttachmentCount,
                "colour attachments in the subpass", subpass.colorAttachmentCount);
    const uint32_t color = subpass.pColorAttachments[0].attachment;
    if (color >= info.attachmentCount)
        core::refuse(
            "FwVulkanTargetDef::renderPassInfo: subpass %u does not use its first colour "
            "attachment, the one that we write.",
            def.subpass);
    const auto& image = info.pAttachments[color];
    if (def.colorFormat != image.format)
        differs("colorFormat", uint32_t(def.colorFormat), "as its first colour attachment's format",
                uint32_t(image.format));
    if (def.samples != uint32_t(image.samples))
        differs("samples", def.samples, "samples in its first colour attachment",
                uint32_t(image.samples));
    const uint32_t depth = subpass.pDepthStencilAttachment
                               ? subpass.pDepthStencilAttachment->attachment
                               : VK_ATTACHMENT_UNUSED;
    if (def.depthMode == FW_DEPTH_NONE || def.depthMode == FW_DEPTH_SAMPLED) return;
    if (depth >= info.attachmentCount)
        core::refuse(
            "FwVulkanTargetDef::depthMode is %u and subpass %u of renderPassInfo has no depth "
            "attachment; use FW_DEPTH_NONE (0) or FW_DEPTH_SAMPLED (3).",
            def.depthMode, def.subpass);
    if (def.depthFormat != info.pAttachments[depth].format)
        differs("depthFormat", uint32_t(def.depthFormat), "as its depth attachment's format",
                uint32_t(info.pAttachments[depth].format));
}

void checkAgainstPass(const FwVulkanTargetDef& def) {
    if (def.flags & FW_TARGET_COMPOSITE)
        core::refuse(
            "FwVulkanTargetDef::renderPassInfo is given with FW_TARGET_COMPOSITE; that pass is "
            "ours, it is null there.");
    VkStructureType type{};
    std::memcpy(&type, def.renderPassInfo, sizeof type);
    if (type == VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO)
        checkAgainst(def, *static_cast<const VkRenderPassCreateInfo*>(def.renderPassInfo));
    else if (type == VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO_2)
        checkAgainst(def, *static_cast<const VkRenderPassCreateInfo2*>(def.renderPassInfo));
    else
        core::refuse(
            "FwVulkanTargetDef::renderPassInfo has sType %d; it is a VkRenderPassCreateInfo "
            "(38) or a VkRenderPassCreateInfo2 (1000109004).",
            int(type));
}

[[noreturn]] void refuse(const char* name, unsigned value, const char* limit) {
    core::refuse("FwVulkanTargetDef::%s is %u; %s.", name, value, limit);
}

void checkFlags(const FwVulkanTargetDef& def) {
    const bool composite = (def.flags & FW_TARGET_COMPOSITE) != 0;
    if (def.flags & ~127u) refuse("flags", def.flags, "bits 0 to 6 are known");
    if ((def.flags & FW_TARGET_HAZE) && def.depthMode != FW_DEPTH_SAMPLED)
        refuse("flags", def.flags, "FW_TARGET_HAZE needs depthMode FW_DEPTH_SAMPLED");
    if ((def.flags & FW_TARGET_HALF_EFFECTS) && (def.depthMode != FW_DEPTH_SAMPLED || !composite))
        refuse("flags", def.flags,
               "FW_TARGET_HALF_EFFECTS needs FW_TARGET_COMPOSITE and FW_DEPTH_SAMPLED");
    if (composite && def.renderPass)
        core::refuse(
            "FwVulkanTargetDef::renderPass is given with FW_TARGET_COMPOSITE; that pass is "
            "ours, it is null there.");
    if (!composite && !def.renderPass)
        core::refuse("FwVulkanTargetDef::renderPass is null without FW_TARGET_COMPOSITE.");
}

void checkAttachments(const Device& device, const FwVulkanTargetDef& def) {
    const bool composite = (def.flags & FW_TARGET_COMPOSITE) != 0;
    if (def.colorAttachmentCount < 1 || def.colorAttachmentCount > 8)
        refuse("colorAttachmentCount", def.colorAttachmentCount, "the range is [1, 8]");
    if (def.colorAttachmentCount > 1 && !device.independentBlend)
        refuse("colorAttachmentCount", def.colorAttachmentCount,
               "more than 1 needs the feature independentBlend, which was not declared");
    if (composite && def.colorAttachmentCount != 1)
        refuse("colorAttachmentCount", def.colorAttachmentCount, "a composite target has one");
    if (def.viewMask) refuse("viewMask", def.viewMask, "multiview is not in this version: it is 0");
    if (def.samples == 0 || def.samples > 16 || (def.samples & (def.samples - 1)))
        refuse("samples", def.samples, "1, 2, 4, 8 or 16 are possible");
    if (def.encoding > FW_OUTPUT_AUTO) refuse("encoding", def.encoding, "the last one is 3");
    if (def.depthMode > FW_DEPTH_SAMPLED) refuse("depthMode", def.depthMode, "the last one is 3");
    if (def.reversedDepth > 1) refuse("reversedDepth", def.reversedDepth, "it is 0 or 1");
    if (def.depthMode == FW_DEPTH_NONE && def.depthFormat != VK_FORMAT_UNDEFINED && composite)
        refuse("depthFormat", def.depthFormat, "it is VK_FORMAT_UNDEFINED with FW_DEPTH_NONE");
    if (def.depthMode != FW_DEPTH_NONE && def.depthFormat == VK_FORMAT_UNDEFINED)
        core::refuse("FwVulkanTargetDef::depthFormat is VK_FORMAT_UNDEFINED but depthMode is %u.",
                     def.depthMode);
}

void checkFormats(const Device& device, const FwVulkanTargetDef& def, FwOutputEncoding encoding) {
    VkFormatProperties format{};
    device.table.GetPhysicalDeviceFormatProperties(device.physicalDevice, def.colorFormat, &format);
    if (!(format.optimalTilingFeatures & VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT))
        core::fail(FW_ERROR_UNSUPPORTED_DEVICE,
                   "FwVulkanTargetDef::colorFormat is %d; the device cannot blend into it.",
                   int(def.colorFormat));
    if (def.depthMode != FW_DEPTH_NONE) {
        device.table.GetPhysicalDeviceFormatProperties(device.physicalDevice, def.depthFormat,
                                                       &format);
        const bool samples = def.depthMode == FW_DEPTH_SAMPLED;
        const VkFormatFeatureFlags needs = samples ? VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT
                                                   : VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT;
        if (!(format.optimalTilingFeatures & needs))
            core::fail(FW_ERROR_UNSUPPORTED_DEVICE,
                       "FwVulkanTargetDef::depthFormat is %d; the device %s.", int(def.depthFormat),
                       samples ? "cannot sample it" : "has no such depth attachment");
    }
    if (encoding == FW_OUTPUT_AUTO)
        core::refuse(
            "FwVulkanTargetDef::encoding is FW_OUTPUT_AUTO (3) and colorFormat is %d, which is "
            "not known to be float, sRGB or UNORM; name the encoding: FW_OUTPUT_LINEAR (0), "
            "FW_OUTPUT_SRGB_VIEW (1) or FW_OUTPUT_DISPLAY_UNORM (2).",
            int(def.colorFormat));
    if (def.depthMode != FW_DEPTH_NONE && !hasDepthAspect(def.depthFormat))
        core::refuse(
            "FwVulkanTargetDef::depthFormat is %d, which has no depth; give a format with a "
            "depth aspect, as VK_FORMAT_D32_SFLOAT (126).",
            int(def.depthFormat));
}

void checkSamples(const Device& device, const FwVulkanTargetDef& def, uint32_t depthSamples) {
    const VkPhysicalDeviceLimits& limits = device.properties.limits;
    if (def.depthMode != FW_DEPTH_NONE && !(limits.framebufferDepthSampleCounts & def.samples))
        core::fail(FW_ERROR_UNSUPPORTED_DEVICE,
                   "FwVulkanTargetDef::samples is %u; the device's depth sample counts are 0x%x.",
                   def.samples, limits.framebufferDepthSampleCounts);
    if (def.renderPassInfo) checkAgainstPass(def);
    if (!(limits.framebufferColorSampleCounts & def.samples))
        core::fail(FW_ERROR_UNSUPPORTED_DEVICE,
                   "FwVulkanTargetDef::samples is %u; the device's colour sample counts are 0x%x.",
                   def.samples, limits.framebufferColorSampleCounts);
    if (def.depthMode == FW_DEPTH_SAMPLED && !(limits.sampledImageDepthSampleCounts & depthSamples))
        core::fail(FW_ERROR_UNSUPPORTED_DEVICE,
                   "FwVulkanTargetDef::depthSamples is %u; the device samples depth of the sample "
                   "counts 0x%x.",
                   depthSamples, limits.sampledImageDepthSampleCounts);
}

TargetKey checkedKey(const Device& device, const FwVulkanTargetDef& def) {
    TargetKey key;
    key.encoding = def.encoding == FW_OUTPUT_AUTO ? Context::encodingOf(def.colorFormat)
                                                  : FwOutputEncoding(def.encoding);
    const bool sampled = def.depthMode == FW_DEPTH_SAMPLED;
    if (sampled) key.depthSamples = def.depthSamples ? def.depthSamples : def.samples;
    checkFlags(def);
    checkAttachments(device, def);
    checkFormats(device, def, key.encoding);
    checkSamples(device, def, key.depthSamples);
    key.composite = (def.flags & FW_TARGET_COMPOSITE) != 0;
    key.asNeeded = (def.flags & FW_TARGET_AS_NEEDED) != 0;
    key.haze = (def.flags & FW_TARGET_HAZE) != 0;
    key.transparency = (def.flags & FW_TARGET_TRANSPARENCY) != 0;
    key.surfaces = !(def.flags & FW_TARGET_NO_SURFACES) && !sampled;
    key.flames = !(def.flags & FW_TARGET_NO_FLAMES);
    key.half = (def.flags & FW_TARGET_HALF_EFFECTS) && key.flames;
    if (key.half) key.halfColor = halfColorFor(def.colorFormat, uint32_t(key.encoding));
    key.color = def.colorFormat;
    key.depth = def.depthMode == FW_DEPTH_NONE ? VK_FORMAT_UNDEFINED : def.depthFormat;
    key.subpass = key.composite ? 0 : def.subpass;
    key.samples = def.samples;
    key.colorAttachments = def.colorAttachmentCount;
    key.depthMode = FwDepthMode(def.depthMode);
    key.reversedDepth = def.reversedDepth != 0;
    return key;
}

// Passes of which FW_TARGET_AS_NEEDED targets have a pipeline once an object needs it.
DrawPassSet waitingPasses() noexcept {
    DrawPassSet passes = 0;
    for (size_t i = 0; i < drawPasses().size(); ++i)
        if (drawPasses()[i].drawsSurfaces()) passes |= DrawPassSet(1) << i;
    return passes;
}

bool isDrawn(const DrawPass& pass, const TargetKey& key) noexcept {
    const bool atFull = pass.atHalf == AtHalf::same || pass.atHalf == AtHalf::soft;
    switch (pass.drawnIn) {
        case DrawnIn::surfaces:
            return key.surfaces;
        case DrawnIn::flames:
            return key.flames && (atFull || key.half);
        case DrawnIn::haze:
            return key.flames && key.haze;
        case DrawnIn::transparency:
            return key.transparency;
    }
    return false;
}

// The structures of a graphics pipeline, which point at each other. All but shader modules, layout
// and render pass.
struct DrawPipeline {
    DrawPipeline(const DrawPass& pass, const TargetKey& key);
    DrawPipeline(const DrawPipeline&) = delete;
    DrawPipeline& operator=(const DrawPipeline&) = delete;

    bool colors;  // else positions are all it reads
    std::array<VkPipelineShaderStageCreateInfo, 2> stages{};
    Typed<VkGraphicsPipelineCreateInfo> info;

 private:
    void setConstants(const DrawPass& pass, const TargetKey& key);
    void setVertices(const DrawPass& pass);
    void setRaster(const DrawPass& pass, const TargetKey& key);
    void setBlend(const DrawPass& pass, const TargetKey& key);

    uint32_t constants_[5];
    VkSpecializationInfo special_{};
    Typed<VkPipelineVertexInputStateCreateInfo> input_;
    Typed<VkPipelineInputAssemblyStateCreateInfo> assembly_;
    Typed<VkPipelineViewportStateCreateInfo> viewport_;
    Typed<VkPipelineRasterizationStateCreateInfo> raster_;
    Typed<VkPipelineMultisampleStateCreateInfo> multisample_;
    Typed<VkPipelineDepthStencilStateCreateInfo> depth_;
    std::array<VkPipelineColorBlendAttachmentState, 8> blends_{};
    Typed<VkPipelineColorBlendStateCreateInfo> blend_;
    Typed<VkPipelineDynamicStateCreateInfo> dynamic_;
};

DrawPipeline::DrawPipeline(const DrawPass& pass, const TargetKey& key)
    : colors(pass.blend != Blend::depthAlone) {
    setConstants(pass, key);
    setVertices(pass);
    setRaster(pass, key);
    setBlend(pass, key);
    info.stageCount = colors ? 2 : 1;
    info.pStages = stages.data();
    info.pVertexInputState = &input_;
    info.pInputAssemblyState = &assembly_;
    info.pViewportState = &viewport_;
    info.pRasterizationState = &raster_;
    info.pMultisampleState = &multisample_;
    info.pDepthStencilState = &depth_;
    info.pColorBlendState = &blend_;
    info.pDynamicState = &dynamic_;
    info.subpass = key.subpass;
}

void DrawPipeline::setConstants(const DrawPass& pass, const TargetKey& key) {
    static constexpr std::array<VkSpecializationMapEntry, 5> kEntries{
        {{0, 0, 4}, {1, 4, 4}, {2, 8, 4}, {3, 12, 4}, {4, 16, 4}}};
    constants_[0] = uint32_t(key.encoding);
    constants_[1] = key.reversedDepth ? 1 : 0;
    constants_[2] = pass.variant;
    constants_[3] = pass.atHalf == AtHalf::sparks             ? kPartSparks
                    : key.half && pass.atHalf == AtHalf::soft ? kPartSoft
                                                              : kPartAll;
    constants_[4] = key.samples;
    special_ = {uint32_t(kEntries.size()), kEntries.data(), sizeof constants_, constants_};
    for (VkPipelineShaderStageCreateInfo& stage : stages) {
        stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
        stage.pName = "main";
        stage.pSpecializationInfo = &special_;
    }
    stages[0].stage = VK_SHADER_STAGE_VERTEX_BIT;
    stages[1].stage = VK_SHADER_STAGE_FRAGMENT_BIT;
}

void DrawPipeline::setVertices(const DrawPass& pass) {
    using mesh::RenderVertex;
    // Binding 1 is the object's own shown vertices, or the mesh's again: the same record where it
    // matters, and a material index is no time at all.
    static_assert(sizeof(RenderVertex) == sizeof(ShownVertex) &&
                  offsetof(RenderVertex, position) == offsetof(ShownVertex, x) &&
                  offsetof(RenderVertex, normal) == offsetof(ShownVertex, normal) &&
                  offsetof(RenderVertex, material) == offsetof(ShownVertex, burnThrough));
    static constexpr std::array<VkVertexInputBindingDescription, 2> kBindings{
        {{0, sizeof(RenderVertex), VK_VERTEX_INPUT_RATE_VERTEX},
         {1, sizeof(ShownVertex), VK_VERTEX_INPUT_RATE_VERTEX}}};
    static constexpr std::array<VkVertexInputAttributeDescription, 9> kAttributes{{
        {0, 1, VK_FORMAT_R32G32B32_SFLOAT, offsetof(ShownVertex, x)},
        {1, 1, VK_FORMAT_R32_UINT, offsetof(ShownVertex, normal)},
        {8, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(RenderVertex, position)},
        {7, 1, VK_FORMAT_R32_SFLOAT, offsetof(ShownVertex, burnThrough)},
        {2, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(RenderVertex, atlasUv)},
        {3, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(RenderVertex, textureUv)},
        {4, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(RenderVertex, detail)},
        {5, 0, VK_FORMAT_R8G8B8A8_UNORM, offsetof(RenderVertex, tint)},
        {6, 0, VK_FORMAT_R32_UINT, offsetof(RenderVertex, material)},
    }};
    assembly_.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    if (pass.vertexInput != VertexInput::mesh) return;
    input_.vertexBindingDescriptionCount = uint32_t(kBindings.size());
    input_.pVertexBindingDescriptions = kBindings.data();
    input_.vertexAttributeDescriptionCount = colors ? uint32_t(kAttributes.size()) : 1;
    input_.pVertexAttributeDescriptions = kAttributes.data();
}

void DrawPipeline::setRaster(const DrawPass& pass, const TargetKey& key) {
    viewport_.viewportCount = viewport_.scissorCount = 1;
    raster_.polygonMode = VK_POLYGON_MODE_FILL;
    raster_.cullMode = pass.cull == Cull::none   ? VkCullModeFlags(VK_CULL_MODE_NONE)
                       : pass.cull == Cull::back ? VkCullModeFlags(VK_CULL_MODE_BACK_BIT)
                                                 : VkCullModeFlags(VK_CULL_MODE_FRONT_BIT);
    raster_.frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE;
    raster_.lineWidth = 1;
    raster_.depthBiasEnable = pass.behind;
    raster_.depthBiasConstantFactor = key.reversedDepth ? -2.0f : 2.0f;
    multisample_.rasterizationSamples = VkSampleCountFlagBits(key.samples);
    depth_.depthTestEnable = key.attachesDepth() && pass.blend != Blend::constant;
    depth_.depthWriteEnable = key.depthMode == FW_DEPTH_TEST && pass.writeDepth;
    depth_.depthCompareOp =
        key.reversedDepth ? (pass.strict ? VK_COMPARE_OP_GREATER : VK_COMPARE_OP_GREATER_OR_EQUAL)
                          : (pass.strict ? VK_COMPARE_OP_LESS : VK_COMPARE_OP_LESS_OR_EQUAL);
}

void DrawPipeline::setBlend(const DrawPass& pass, const TargetKey& key) {
    FW_ASSERT(key.colorAttachments <= blends_.size(), "%u attachments", key.colorAttachments);
    const bool mixes = pass.blend == Blend::constant;
    VkPipelineColorBlendAttachmentState& first = blends_[0];
    first.blendEnable = colors && pass.blend != Blend::opaque;
    first.srcColorBlendFactor = mixes ? VK_BLEND_FACTOR_CONSTANT_ALPHA : VK_BLEND_FACTOR_ONE;
    first.dstColorBlendFactor = mixes ? VK_BLEND_FACTOR_ONE_MINUS_CONSTANT_ALPHA
                                : pass.blend == Blend::premultiplied
                                    ? VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA
                                    : VK_BLEND_FACTOR_ONE;
    first.srcAlphaBlendFactor =
        pass.blend == Blend::additive ? VK_BLEND_FACTOR_ZERO : first.srcColorBlendFactor;
    first.dstAlphaBlendFactor = first.dstColorBlendFactor;
    if (colors)
        first.colorWriteMask = VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT |
                               VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT;
    blend_.attachmentCount = key.colorAttachments;
    blend_.pAttachments = blends_.data();
    static constexpr std::array<VkDynamicState, 3> kDynamics{
        VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR, VK_DYNAMIC_STATE_BLEND_CONSTANTS};
    dynamic_.dynamicStateCount = mixes ? 3 : 2;
    dynamic_.pDynamicStates = kDynamics.data();
}

}  // namespace

Pipelines::Pipelines(Device& device, std::pmr::memory_resource* memory)
    : device_(device), memory_(memory), passes_(memory), targets_("Target", memory) {
    try {
        makeLayouts();
    } catch (...) {
        destroy();
        throw;
    }
}

Pipelines::~Pipelines() { destroy(); }

void Pipelines::destroy() noexcept {
    const Table& vk = device_.table;
    for (uint32_t i = 0; i < targets_.slotCount(); ++i) {
        if (auto* target = targets_.at(i)) destroyTarget(**target);
    }
    for (PassObjects& pass : passes_) {
        device_.destroy(vk.DestroyPipeline, pass.pipeline);
        device_.destroy(vk.DestroyPipelineLayout, pass.layout);
        device_.destroy(vk.DestroyDescriptorSetLayout, pass.setLayout);
    }
    device_.destroy(vk.DestroyDescriptorSetLayout, imageLayout_);
    device_.destroy(vk.DestroySampler, imageSampler_);
    device_.destroy(vk.DestroySampler, depthSampler_);
    for (VkRenderPass& pass : halfPasses_) device_.destroy(vk.DestroyRenderPass, pass);
    device_.destroy(vk.DestroyRenderPass, halfDepthPass_);
}

void Pipelines::makeLayouts() {
    const Table& vk = device_.table;
    Typed<VkSamplerCreateInfo> sampler;
    sampler.magFilter = sampler.minFilter = VK_FILTER_LINEAR;
    sampler.mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR;
    sampler.addressModeU = sampler.addressModeV = sampler.addressModeW =
        VK_SAMPLER_ADDRESS_MODE_REPEAT;
    sampler.maxLod = VK_LOD_CLAMP_NONE;
    imageSampler_ = device_.create(vk.CreateSampler, sampler, "vkCreateSampler");
    sampler.magFilter = sampler.minFilter = VK_FILTER_NEAREST;  // depth need not be filterable
    sampler.mipmapMode = VK_SAMPLER_MIPMAP_MODE_NEAREST;
    sampler.addressModeU = sampler.addressModeV = sampler.addressModeW =
        VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    depthSampler_ = device_.create(vk.CreateSampler, sampler, "vkCreateSampler");

    for (size_t i = 0; i < kHalfColors.size(); ++i)
        halfPasses_[i] = makeHalfPass(kHalfColors[i], true);
    halfDepthPass_ = makeHalfPass(kHalfDepth, false);

    const auto setLayout = [&](std::span<const VkDescriptorSetLayoutBinding> bindings) {
        Typed<VkDescriptorSetLayoutCreateInfo> info;
        info.bindingCount = uint32_t(bindings.size());
        info.pBindings = bindings.data();
        return device_.create(vk.CreateDescriptorSetLayout, info, "vkCreateDescriptorSetLayout");
    };
    const VkDescriptorSetLayoutBinding image{
        0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1,
        VK_SHADER_STAGE_FRAGMENT_BIT | VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_COMPUTE_BIT,
        nullptr};
    imageLayout_ = setLayout({&image, 1});
    const auto make = [&](PassObjects& objects, uint32_t pushBytes, VkShaderStageFlags stages,
                          uint32_t setCount) {
        std::array<VkDescriptorSetLayoutBinding, ShaderInterface::kMost> bindings{};
        uint32_t count = 0;
        for (const Use& use : objects.declared.uses()) {
            const DescriptorSlot slot = descriptorSlot(use);
            bindings[count++] = {slot.binding, slot.type, 1, stages, nullptr};
        }
        objects.setLayout = setLayout(std::span(bindings).first(count));
        const VkPushConstantRange range{stages, 0, pushBytes};
        const VkDescriptorSetLayout sets[4] = {objects.setLayout, imageLayout_, imageLayout_,
                                               imageLayout_};
        FW_ASSERT(setCount <= std::size(sets) && pushBytes <= 128, "%u sets, %u bytes", setCount,
                  pushBytes);
        Typed<VkPipelineLayoutCreateInfo> layout;
        layout.setLayoutCount = setCount;
        layout.pSetLayouts = sets;
        layout.pushConstantRangeCount = pushBytes ? 1 : 0;
        layout.pPushConstantRanges = &range;
        objects.layout = device_.create(vk.CreatePipelineLayout, layout, "vkCreatePipelineLayout");
    };
    passes_.resize(computePasses().size() + drawPasses().size());
    PassObjects* objects = passes_.data();
    for (const ComputePass& pass : computePasses()) {
        objects->declared = interfaceOf(pass, device_.texels, memory_);
        make(*objects, pass.pushBytes, VK_SHADER_STAGE_COMPUTE_BIT, objects->declared.sets());
        ++objects;
    }
    for (const DrawPass& pass : drawPasses()) {
        objects->declared = interfaceOf(pass, device_.texels, memory_);
        make(*objects, pass.pushBytes, VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT,
             pass.softShader ? 4 : 3);
        ++objects;
    }
}

VkShaderModule Pipelines::module(std::span<const uint32_t> code) const {
    Typed<VkShaderModuleCreateInfo> info;
    info.codeSize = code.size_bytes();
    info.pCode = code.data();
    return device_.create(device_.table.CreateShaderModule, info, "vkCreateShaderModule");
}

// A module per shader while a target's pipelines are made: `surface` has a pipeline per variant.
class Pipelines::Modules {
 public:
    explicit Modules(const Pipelines& pipelines)
        : pipelines_(pipelines), made_(pipelines.memory_) {}
    ~Modules() {
        const Device& device = pipelines_.device_;
        for (Made& made : made_) device.destroy(device.table.DestroyShaderModule, made.module);
    }
    Modules(const Modules&) = delete;
    Modules& operator=(const Modules&) = delete;

    VkShaderModule get(const char* shader) {
        for (const Made& made : made_)
            if (made.shader == shader) return made.module;
        made_.push_back({shader, VK_NULL_HANDLE});
        return made_.back().module = pipelines_.module(shaderCode(shader));
    }

 private:
    struct Made {
        std::string_view shader;
        VkShaderModule module;
    };
    const Pipelines& pipelines_;
    std::pmr::vector<Made> made_;
};

void Pipelines::prepare() {
    const std::lock_guard lock(prepares_);
    if (ready()) return;
    const Table& vk = device_.table;
    for (size_t i = 0; i < computePasses().size(); ++i) {
        PassObjects& objects = passes_[i];
        if (objects.pipeline) continue;
        const ComputePass& pass = computePasses()[i];
        Typed<VkComputePipelineCreateInfo> info;
        info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
        info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
        info.stage.module = module(codeOf(pass, device_.texels));
        info.stage.pName = "main";
        info.layout = objects.layout;
        const VkResult result =
            vk.CreateComputePipelines(device_.handle, device_.pipelineCache, 1, &info,
                                      device_.allocationCallbacks, &objects.pipeline);
        device_.destroy(vk.DestroyShaderModule, info.stage.module);
        if (result != VK_SUCCESS) objects.pipeline = VK_NULL_HANDLE;
        device_.check(result, "vkCreateComputePipelines");
        device_.name(VK_OBJECT_TYPE_PIPELINE, uint64_t(objects.pipeline), pass.name);
        ++computeMade_;
    }
    ready_.store(true, std::memory_order_release);
}

// Layouts of use: the composite's own barriers bring the images there and away.
VkRenderPass Pipelines::makePass(const TargetKey& key) const {
    AttachmentUse color{.format = key.color, .samples = key.samples};
    color.before = color.after = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    AttachmentUse depth{
        .format = key.depth, .samples = key.samples, .stencil = hasStencil(key.depth)};
    depth.before = depth.after = VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL;
    const AttachmentUse uses[] = {color, depth};
    return makeRenderPass(device_, std::span(uses).first(key.attachesDepth() ? 2 : 1));
}

VkRenderPass Pipelines::halfPass(VkFormat color) const {
    for (size_t i = 0; i < kHalfColors.size(); ++i)
        if (kHalfColors[i] == color) return halfPasses_[i];
    return VK_NULL_HANDLE;
}

VkRenderPass Pipelines::makeHalfPass(VkFormat format, bool clears) const {
    // Previous readers, of the frame before or of another view, have finished; later ones wait.
    constexpr VkPipelineStageFlags kDraws = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
    constexpr VkPipelineStageFlags kReads =
        VK_PIPELINE_STAGE_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT;
    constexpr VkAccessFlags kAccess =
        VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT;
    std::array<VkSubpassDependency, 2> waits{};
    waits[0].srcSubpass = waits[1].dstSubpass = VK_SUBPASS_EXTERNAL;
    waits[0].srcStageMask = kReads | kDraws;
    waits[0].srcAccessMask = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT;
    waits[0].dstStageMask = waits[1].srcStageMask = kDraws;
    waits[0].dstAccessMask = kAccess;
    waits[1].srcAccessMask = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT;
    waits[1].dstStageMask = kReads;
    waits[1].dstAccessMask = VK_ACCESS_SHADER_READ_BIT;
    constexpr VkImageLayout kAfter = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    const AttachmentUse image{
        .format = format,
        .load = clears ? VK_ATTACHMENT_LOAD_OP_CLEAR : VK_ATTACHMENT_LOAD_OP_LOAD,
        .before = clears ? VK_IMAGE_LAYOUT_UNDEFINED : kAfter,
        .after = kAfter};
    return makeRenderPass(device_, {&image, 1}, waits);
}

VkPipeline Pipelines::makeDraw(size_t number, const TargetKey& key, VkRenderPass renderPass,
                               Modules& modules) const {
    const DrawPass& pass = drawPasses()[number];
    DrawPipeline state(pass, key);
    state.info.layout = draw(number).layout;
    state.info.renderPass = renderPass;
    const bool several = key.samples > 1 && pass.multisampledVertex;
    state.stages[0].module = modules.get(several ? pass.multisampledVertex : pass.vertexShader);
    if (state.colors) {
        const char* const words[3] = {several ? pass.multisampledFragment : pass.fragmentShader,
                                      pass.softShader, pass.softShaderMultisampled};
        const char* const* shaders =
            device_.texels && pass.texelShaders ? pass.texelShaders : words;
        const int depth = !key.samplesDepth() ? 0 : key.depthSamples > 1 ? 2 : 1;
        FW_ASSERT(shaders[depth], "pass %s has no shader for this depth", pass.name);
        state.stages[1].module = modules.get(shaders[depth]);
    }
    VkPipeline pipeline = VK_NULL_HANDLE;
    device_.check(
        device_.table.CreateGraphicsPipelines(device_.handle, device_.pipelineCache, 1, &state.info,
                                              device_.allocationCallbacks, &pipeline),
        "vkCreateGraphicsPipelines");
    device_.name(VK_OBJECT_TYPE_PIPELINE, uint64_t(pipeline), pass.name);
    return pipeline;
}

// Makes the missing pipelines of `passes` that the target draws.
void Pipelines::makePipelines(Target& target, DrawPassSet passes) {
    const TargetKey& key = target.key;
    const VkRenderPass renderPass = key.composite ? target.ownPass : target.hostPass;
    DrawPassSet due = 0;
    for (size_t pass = 0; pass < drawPasses().size(); ++pass) {
        if (!(passes >> pass & 1) || target.pipelines[pass].load()) continue;
        if (isDrawn(drawPasses()[pass], key)) due |= DrawPassSet(1) << pass;
    }
    const auto count = uint32_t(std::popcount(due));
    const uint32_t before = target.made;
    target.total = before + count;
    drawTotal_ += count;
    Modules modules(*this);
    try {
        makeDue(target, due, renderPass, modules);
    } catch (...) {  // pipelines that were made stay and count
        drawTotal_ -= before + count - target.made;
        target.total = target.made.load();
        throw;
    }
}

void Pipelines::makeDue(Target& target, DrawPassSet due, VkRenderPass renderPass,
                        Modules& modules) {
    const TargetKey& key = target.key;
    for (size_t pass = 0; pass < drawPasses().size(); ++pass) {
        if (!(due >> pass & 1)) continue;
        const AtHalf atHalf = drawPasses()[pass].atHalf;
        TargetKey drawnOn = key;
        VkRenderPass in = renderPass;
        if (key.half && (atHalf == AtHalf::soft || atHalf == AtHalf::depth)) {
            drawnOn.samples = drawnOn.colorAttachments = 1;
            if (atHalf == AtHalf::soft) drawnOn.depthSamples = 1;
            drawnOn.subpass = 0;
            in = atHalf == AtHalf::soft ? halfPass(key.halfColor) : halfDepthPass_;
        }
        target.pipelines[pass] = makeDraw(pass, drawnOn, in, modules);
        ++target.made;
        ++drawMade_;
    }
}

FwTargetId Pipelines::registerTarget(const FwVulkanTargetDef& def) {
    const TargetKey key = checkedKey(device_, def);
    auto target = core::Owned<Target>::make(memory_, drawPasses().size(), memory_);
    target->key = key;
    target->hostPass = def.renderPass;
    try {
        if (key.composite) target->ownPass = makePass(key);
        // Without the lock, so that others may register meanwhile.
        makePipelines(*target, key.asNeeded ? ~waitingPasses() | needed_ : ~DrawPassSet(0));
        const std::lock_guard making(makes_);
        makePipelines(*target, needed_);
        const std::lock_guard lock(mutex_);
        return targets_.create(std::move(target));
    } catch (...) {
        if (target) destroyTarget(*target);
        throw;
    }
}

void Pipelines::need(DrawPassSet passes) {
    if ((passes & ~needed_) == 0) return;
    // No target is made or destroyed under this lock, and look-ups do not wait for it.
    const std::lock_guard making(makes_);
    for (uint32_t i = 0; i < targets_.slotCount(); ++i) {
        if (auto* target = targets_.at(i)) makePipelines(**target, passes);
    }
    needed_ |= passes;
}

void Pipelines::destroyTarget(Target& target) noexcept {
    for (std::atomic<VkPipeline>& pipeline : target.pipelines) {
        VkPipeline made = pipeline.exchange(VK_NULL_HANDLE);
        device_.destroy(device_.table.DestroyPipeline, made);
    }
    drawMade_ -= target.made;
    drawTotal_ -= target.total;
    target.made = target.total = 0;
    device_.destroy(device_.table.DestroyRenderPass, target.ownPass);
}

void Pipelines::unregisterTarget(FwTargetId id) {
    const std::lock_guard making(makes_);
    const std::lock_guard lock(mutex_);
    destroyTarget(*targets_.get(id));
    targets_.destroy(id);
}

bool Pipelines::targetReady(FwTargetId id, FwPipelineProgress& progress) {
    uint32_t made = drawMade_, total = drawTotal_;
    if (id.index1 != 0 || id.generation != 0) {
        const std::lock_guard lock(mutex_);
        const Target& target = *targets_.get(id);
        made = target.made;
        total = target.total;
    }
    progress.made = made + computeMade_;
    progress.total = std::max(progress.made, total + uint32_t(computePasses().size()));
    return ready() && made >= total;
}

const Target* Pipelines::findTarget(FwTargetId id) {
    const std::lock_guard lock(mutex_);
    return targets_.get(id).get();
}

}  // namespace fw::gpu::vk
