// Shortcuts for Vulkan's longest structures: one kind of graphics pipeline and its descriptor sets.
// The caller owns and destroys the handles.
#pragma once

#include <initializer_list>
#include <vector>

#include "common/vulkan_host.h"

namespace sample {

// A triangle pipeline with dynamic viewport and scissor and at most one colour attachment.
struct PipelineRequest {
    VkRenderPass pass = VK_NULL_HANDLE;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    VkShaderModule vertex = VK_NULL_HANDLE;
    VkShaderModule fragment = VK_NULL_HANDLE;  // null: depth only; the pass then has no colour
    VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
    std::vector<VkVertexInputBindingDescription> bindings;
    std::vector<VkVertexInputAttributeDescription> attributes;
    VkCullModeFlags cull = VK_CULL_MODE_NONE;
    VkFrontFace frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE;
    bool depthTest = true, depthWrite = true;
    VkCompareOp depthCompare = VK_COMPARE_OP_LESS_OR_EQUAL;
    float depthBias = 0, depthBiasSlope = 0;
    bool blend = false;  // premultiplied alpha
    bool additive = false;
    const VkSpecializationInfo* specialization = nullptr;  // for both stages
};
VkPipeline makePipeline(const VulkanHost& host, const PipelineRequest& request);

// Bindings 0, 1, ... with one descriptor each, visible to both stages.
VkDescriptorSetLayout makeSetLayout(const VulkanHost& host,
                                    std::initializer_list<VkDescriptorType> types);
VkPipelineLayout makeLayout(const VulkanHost& host,
                            std::initializer_list<VkDescriptorSetLayout> sets,
                            const VkPushConstantRange& push);
// Capacity: sets, uniform buffers and sampled images in total.
VkDescriptorPool makeSetPool(const VulkanHost& host, uint32_t sets, uint32_t buffers,
                             uint32_t images);
VkDescriptorSet makeSet(const VulkanHost& host, VkDescriptorPool pool,
                        VkDescriptorSetLayout layout);
void writeBuffer(const VulkanHost& host, VkDescriptorSet set, uint32_t binding, VkBuffer buffer);
void writeImage(const VulkanHost& host, VkDescriptorSet set, uint32_t binding, VkSampler sampler,
                VkImageView view, VkImageLayout layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);

}  // namespace sample
