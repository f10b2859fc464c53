// Shared resources for drawing textures: a sampler, descriptor sets, one layout, and its pipelines.
#pragma once

#include <vector>

#include "common/pipeline.h"

namespace fwview {

class PictureDrawing {
 public:
    // Sets of `pictures` each, 1 or 2; at most `sets` at a time. `push`: push constants of the
    // layout.
    PictureDrawing(const sample::VulkanHost& host, uint32_t sets, uint32_t pictures,
                   const VkPushConstantRange& push);
    ~PictureDrawing();
    PictureDrawing(const PictureDrawing&) = delete;
    PictureDrawing& operator=(const PictureDrawing&) = delete;

    // Creates a pipeline with this layout. This object owns it.
    VkPipeline pipeline(sample::PipelineRequest request);
    [[nodiscard]] VkDescriptorSet newSet() const;
    void freeSet(VkDescriptorSet set) const;
    void write(VkDescriptorSet set, uint32_t binding, VkImageView view) const;
    [[nodiscard]] VkPipelineLayout layout() const { return layout_; }

 private:
    const sample::VulkanHost& host_;
    VkSampler sampler_ = VK_NULL_HANDLE;
    VkDescriptorSetLayout setLayout_ = VK_NULL_HANDLE;
    VkDescriptorPool pool_ = VK_NULL_HANDLE;
    VkPipelineLayout layout_ = VK_NULL_HANDLE;
    std::vector<VkPipeline> pipelines_;
};

}  // namespace fwview
