// Draws Dear ImGui's lists with Vulkan: one pipeline, and a descriptor set for each picture, which
// is what an ImTextureID is here. Knows no window.
#pragma once

#include <vector>

#include "common/vulkan_host.h"

struct ImDrawData;

namespace fwui {

class UiRenderer {
 public:
    // `pass`: one colour attachment of display values. `slots`: frames in flight.
    UiRenderer(const sample::VulkanHost& host, VkRenderPass pass, uint32_t slots);
    ~UiRenderer();
    UiRenderer(const UiRenderer&) = delete;
    UiRenderer& operator=(const UiRenderer&) = delete;

    // Uploads ImGui's atlas; again after fonts were built anew. Waits for the device.
    void uploadFonts();
    // A picture for ImGui::Image: an ImTextureID. Drawn with linear filtering. Null: all 128 are
    // taken.
    void* addTexture(VkImageView view, VkImageLayout layout);
    // The device is done with what showed it.
    void removeTexture(void* texture);
    // In the pass, outside nothing: sets its own viewport and scissors.
    void draw(VkCommandBuffer commands, uint32_t slot, const ImDrawData& data);

 private:
    void reserve(sample::Buffer& buffer, VkDeviceSize size, VkBufferUsageFlags usage);

    struct Slot {
        sample::Buffer vertices, indices;
    };
    const sample::VulkanHost& host_;
    std::vector<Slot> slots_;
    VkSampler sampler_ = VK_NULL_HANDLE;
    VkDescriptorSetLayout setLayout_ = VK_NULL_HANDLE;
    VkDescriptorPool pool_ = VK_NULL_HANDLE;
    VkPipelineLayout layout_ = VK_NULL_HANDLE;
    VkPipeline pipeline_ = VK_NULL_HANDLE;
    std::vector<VkDescriptorSet> free_;
    sample::Image fonts_;
    void* fontTexture_ = nullptr;
};

}  // namespace fwui
