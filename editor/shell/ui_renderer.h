// Draws Dear ImGui's lists with Vulkan: one pipeline, and a descriptor set for each picture, which
// is what an ImTextureID is here. Draws what differs from the frame before: most of an interface
// stands still while a scene moves. Knows no window.
#pragma once

#include <imgui.h>

#include <vector>

#include "common/vulkan_host.h"

namespace fwui {

// Of pictures that are shown often: as windows have it. With one mip no level is looked for.
constexpr VkFormat kUiFormat = VK_FORMAT_B8G8R8A8_UNORM;

class UiRenderer {
 public:
    // `pass`: one colour attachment of display values. `slots`: frames in flight.
    UiRenderer(const sample::VulkanHost& host, VkRenderPass pass, uint32_t slots);
    ~UiRenderer();
    UiRenderer(const UiRenderer&) = delete;
    UiRenderer& operator=(const UiRenderer&) = delete;

    // Uploads ImGui's atlas; again after fonts were built anew. Waits for the device.
    void uploadFonts();
    // A picture for ImGui::Image: an ImTextureID. Drawn with linear filtering, and anew in each
    // frame, as what is in it may be another. Null: all 128 are taken.
    void* addTexture(VkImageView view, VkImageLayout layout);
    // The device is done with what showed it.
    void removeTexture(void* texture);
    // In the pass, outside nothing: sets its own viewport and scissors. `whole`: the output holds
    // nothing yet; else it is as the last call left it.
    void draw(VkCommandBuffer commands, uint32_t slot, const ImDrawData& data, bool whole);
    // The same, all of it, over what the pass has drawn so far: a game's.
    void drawOver(VkCommandBuffer commands, uint32_t slot, const ImDrawData& data);

 private:
    struct Part {  // of the output, in pixels
        int32_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    };
    struct List {  // of a frame, kept
        std::vector<ImDrawVert> vertices;
        std::vector<ImDrawIdx> indices;
        std::vector<ImDrawCmd> commands;
    };
    void reserve(sample::Buffer& buffer, VkDeviceSize size, VkBufferUsageFlags usage);
    void findChanges(const ImDrawData& data, bool whole);
    void compare(const ImDrawList& list, const List& before);
    void addCommand(const ImDrawCmd& command, const ImDrawVert* vertices, const ImDrawIdx* indices);
    void addChange(Part part);
    [[nodiscard]] Part boundsOf(const ImDrawCmd& command, const ImVec2& a, const ImVec2& b,
                                const ImVec2& c) const;
    void drawChanges(VkCommandBuffer commands, uint32_t slot, const ImDrawData& data, bool clears);
    void drawPart(VkCommandBuffer commands, const ImDrawData& data, uint32_t number, bool clears);

    struct Slot {
        sample::Buffer vertices, indices;
    };
    const sample::VulkanHost& host_;
    std::vector<Slot> slots_;
    VkSampler sampler_ = VK_NULL_HANDLE;
    VkDescriptorSetLayout setLayout_ = VK_NULL_HANDLE;
    VkDescriptorPool pool_ = VK_NULL_HANDLE;
    VkPipelineLayout layout_ = VK_NULL_HANDLE;
    VkPipeline pipeline_ = VK_NULL_HANDLE, solidPipeline_ = VK_NULL_HANDLE;
    std::vector<VkDescriptorSet> free_;
    sample::Image fonts_;
    void* fontTexture_ = nullptr;
    std::vector<List> before_;
    ImVec2 sizeBefore_{0, 0};
    std::vector<Part> changes_;
};

}  // namespace fwui
