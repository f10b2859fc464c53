#include "common/pipeline.h"

namespace sample {

VkPipeline makePipeline(const VulkanHost& host, const PipelineRequest& request) {
    VkPipelineShaderStageCreateInfo stages[2]{};
    stages[0].sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    stages[0].stage = VK_SHADER_STAGE_VERTEX_BIT;
    stages[0].module = request.vertex;
    stages[0].pName = "main";
    stages[0].pSpecializationInfo = request.specialization;
    stages[1] = stages[0];
    stages[1].stage = VK_SHADER_STAGE_FRAGMENT_BIT;
    stages[1].module = request.fragment;
    VkPipelineVertexInputStateCreateInfo vertexInput{};
    vertexInput.sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO;
    vertexInput.vertexBindingDescriptionCount = static_cast<uint32_t>(request.bindings.size());
    vertexInput.pVertexBindingDescriptions = request.bindings.data();
    vertexInput.vertexAttributeDescriptionCount = static_cast<uint32_t>(request.attributes.size());
    vertexInput.pVertexAttributeDescriptions = request.attributes.data();
    VkPipelineInputAssemblyStateCreateInfo assembly{};
    assembly.sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO;
    assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    VkPipelineViewportStateCreateInfo viewport{};
    viewport.sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO;
    viewport.viewportCount = 1;
    viewport.scissorCount = 1;
    VkPipelineRasterizationStateCreateInfo raster{};
    raster.sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO;
    raster.polygonMode = VK_POLYGON_MODE_FILL;
    raster.cullMode = request.cull;
    raster.frontFace = request.frontFace;
    raster.lineWidth = 1.0f;
    raster.depthBiasEnable = request.depthBias != 0 || request.depthBiasSlope != 0;
    raster.depthBiasConstantFactor = request.depthBias;
    raster.depthBiasSlopeFactor = request.depthBiasSlope;
    VkPipelineMultisampleStateCreateInfo multisample{};
    multisample.sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO;
    multisample.rasterizationSamples = request.samples;
    VkPipelineDepthStencilStateCreateInfo depth{};
    depth.sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO;
    depth.depthTestEnable = request.depthTest;
    depth.depthWriteEnable = request.depthWrite;
    depth.depthCompareOp = request.depthCompare;
    VkPipelineColorBlendAttachmentState attachment{};
    attachment.colorWriteMask = 0xf;
    if (request.blend || request.additive) {
        attachment.blendEnable = VK_TRUE;
        attachment.srcColorBlendFactor = VK_BLEND_FACTOR_ONE;
        attachment.dstColorBlendFactor =
            request.additive ? VK_BLEND_FACTOR_ONE : VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
        attachment.srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
        attachment.dstAlphaBlendFactor = attachment.dstColorBlendFactor;
    }
    VkPipelineColorBlendStateCreateInfo blend{};
    blend.sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO;
    blend.attachmentCount = request.fragment ? 1 : 0;
    blend.pAttachments = &attachment;
    const VkDynamicState dynamics[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    VkPipelineDynamicStateCreateInfo dynamic{};
    dynamic.sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO;
    dynamic.dynamicStateCount = 2;
    dynamic.pDynamicStates = dynamics;
    VkGraphicsPipelineCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO;
    info.stageCount = request.fragment ? 2 : 1;
    info.pStages = stages;
    info.pVertexInputState = &vertexInput;
    info.pInputAssemblyState = &assembly;
    info.pViewportState = &viewport;
    info.pRasterizationState = &raster;
    info.pMultisampleState = &multisample;
    info.pDepthStencilState = &depth;
    info.pColorBlendState = &blend;
    info.pDynamicState = &dynamic;
    info.layout = request.layout;
    info.renderPass = request.pass;
    VkPipeline pipeline = VK_NULL_HANDLE;
    checkVulkan(
        vkCreateGraphicsPipelines(host.device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline),
        "vkCreateGraphicsPipelines");
    return pipeline;
}

VkDescriptorSetLayout makeSetLayout(const VulkanHost& host,
                                    std::initializer_list<VkDescriptorType> types) {
    std::vector<VkDescriptorSetLayoutBinding> bindings;
    for (const VkDescriptorType type : types)
        bindings.push_back({static_cast<uint32_t>(bindings.size()), type, 1,
                            VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, nullptr});
    VkDescriptorSetLayoutCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
    info.bindingCount = static_cast<uint32_t>(bindings.size());
    info.pBindings = bindings.data();
    VkDescriptorSetLayout layout = VK_NULL_HANDLE;
    checkVulkan(vkCreateDescriptorSetLayout(host.device, &info, nullptr, &layout),
                "vkCreateDescriptorSetLayout");
    return layout;
}

VkPipelineLayout makeLayout(const VulkanHost& host,
                            std::initializer_list<VkDescriptorSetLayout> sets,
                            const VkPushConstantRange& push) {
    VkPipelineLayoutCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
    info.setLayoutCount = static_cast<uint32_t>(sets.size());
    info.pSetLayouts = sets.begin();
    info.pushConstantRangeCount = 1;
    info.pPushConstantRanges = &push;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    checkVulkan(vkCreatePipelineLayout(host.device, &info, nullptr, &layout),
                "vkCreatePipelineLayout");
    return layout;
}

VkDescriptorPool makeSetPool(const VulkanHost& host, uint32_t sets, uint32_t buffers,
                             uint32_t images) {
    std::vector<VkDescriptorPoolSize> sizes;
    if (buffers) sizes.push_back({VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, buffers});
    if (images) sizes.push_back({VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, images});
    VkDescriptorPoolCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
    info.maxSets = sets;
    info.poolSizeCount = static_cast<uint32_t>(sizes.size());
    info.pPoolSizes = sizes.data();
    VkDescriptorPool pool = VK_NULL_HANDLE;
    checkVulkan(vkCreateDescriptorPool(host.device, &info, nullptr, &pool),
                "vkCreateDescriptorPool");
    return pool;
}

VkDescriptorSet makeSet(const VulkanHost& host, VkDescriptorPool pool,
                        VkDescriptorSetLayout layout) {
    VkDescriptorSetAllocateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
    info.descriptorPool = pool;
    info.descriptorSetCount = 1;
    info.pSetLayouts = &layout;
    VkDescriptorSet set = VK_NULL_HANDLE;
    checkVulkan(vkAllocateDescriptorSets(host.device, &info, &set), "vkAllocateDescriptorSets");
    return set;
}

void writeBuffer(const VulkanHost& host, VkDescriptorSet set, uint32_t binding, VkBuffer buffer) {
    const VkDescriptorBufferInfo whole{buffer, 0, VK_WHOLE_SIZE};
    VkWriteDescriptorSet write{};
    write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
    write.dstSet = set;
    write.dstBinding = binding;
    write.descriptorCount = 1;
    write.descriptorType = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    write.pBufferInfo = &whole;
    vkUpdateDescriptorSets(host.device, 1, &write, 0, nullptr);
}

void writeImage(const VulkanHost& host, VkDescriptorSet set, uint32_t binding, VkSampler sampler,
                VkImageView view, VkImageLayout layout) {
    const VkDescriptorImageInfo image{sampler, view, layout};
    VkWriteDescriptorSet write{};
    write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
    write.dstSet = set;
    write.dstBinding = binding;
    write.descriptorCount = 1;
    write.descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    write.pImageInfo = &image;
    vkUpdateDescriptorSets(host.device, 1, &write, 0, nullptr);
}

}  // namespace sample
