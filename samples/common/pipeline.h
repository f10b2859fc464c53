// What a sample makes of Vulkan's longest structures: one kind of pipeline, and the descriptor sets
// it reads. Not a wrapper: the handles are the caller's, to destroy too.
#pragma once

#include <initializer_list>
#include <vector>

#include "common/vulkan_host.h"

namespace sample {

// The usual pipeline of a sample: triangles, dynamic viewport and scissor, at most one colour
// attachment.
struct PipelineRequest {
    VkRenderPass pass = VK_NULL_HANDLE;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    VkShaderModule vertex = VK_NULL_HANDLE;
    VkShaderModule fragment = VK_NULL_HANDLE;  // none: depth only, and the pass has no colour
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
    const VkSpecializationInfo* specialization = nullptr;  // of both stages
};
VkPipeline makePipeline(const VulkanHost& host, const PipelineRequest& request);

// Bindings 0, 1, ... of one descriptor each, for both stages.
VkDescriptorSetLayout makeSetLayout(const VulkanHost& host,
                                    std::initializer_list<VkDescriptorType> types);
VkPipelineLayout makeLayout(const VulkanHost& host,
                            std::initializer_list<VkDescriptorSetLayout> sets,
                            const VkPushConstantRange& push);
// Room for so many sets, uniform buffers and sampled images in all.
VkDescriptorPool makeSetPool(const VulkanHost& host, uint32_t sets, uint32_t buffers,
                             uint32_t images);
VkDescriptorSet makeSet(const VulkanHost& host, VkDescriptorPool pool,
                        VkDescriptorSetLayout layout);
void writeBuffer(const VulkanHost& host, VkDescriptorSet set, uint32_t binding, VkBuffer buffer);
void writeImage(const VulkanHost& host, VkDescriptorSet set, uint32_t binding, VkSampler sampler,
                VkImageView view, VkImageLayout layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);

}  // namespace sample
