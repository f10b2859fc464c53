// The sun's shadow map. Static casters are drawn once into their own map. Each frame copies it and
// draws the moving casters on top.
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <vector>

#include "common/stage.h"

namespace tower {

constexpr uint32_t kShadowSide = 1792;  // texels

class ShadowMap {
 public:
    // The vertex layout: location 0: position; 4 to 6: rows of the instance's frame.
    ShadowMap(const sample::VulkanHost& host,
              const std::vector<VkVertexInputBindingDescription>& bindings,
              const std::vector<VkVertexInputAttributeDescription>& attributes);
    ~ShadowMap();
    ShadowMap(const ShadowMap&) = delete;
    ShadowMap& operator=(const ShadowMap&) = delete;

    // Records outside any pass. `draw` binds the casters' buffers and draws the static or the
    // moving ones.
    void record(VkCommandBuffer commands, const glm::mat4& clip,
                const std::function<void(bool moving)>& draw);

    VkImageView view() const { return map_.view; }  // depth; readable between recordings
    VkSampler sampler() const { return sampler_; }

 private:
    struct Target {
        VkRenderPass pass = VK_NULL_HANDLE;
        VkFramebuffer framebuffer = VK_NULL_HANDLE;
    };
    Target makeTarget(const sample::Image& image, bool still) const;
    void makePipeline(const std::vector<VkVertexInputBindingDescription>& bindings,
                      const std::vector<VkVertexInputAttributeDescription>& attributes);
    void begin(VkCommandBuffer commands, const Target& target, const glm::mat4& clip) const;

    const sample::VulkanHost& host_;
    sample::Image still_, map_;
    Target stillTarget_, target_;
    VkSampler sampler_ = VK_NULL_HANDLE;
    VkPipelineLayout layout_ = VK_NULL_HANDLE;
    VkPipeline pipeline_ = VK_NULL_HANDLE;
    glm::mat4 stillClip_{0.0f};  // of the current static map
};

}  // namespace tower
