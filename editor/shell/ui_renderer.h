// Draws Dear ImGui's lists with Vulkan: one pipeline, and a descriptor set per texture, which is an
// ImTextureID here. Draws only changes from the previous frame, since most of an interface is
// static while a scene moves. Independent of windows.
#pragma once

#include <imgui.h>

#include <vector>

#include "common/vulkan_host.h"

namespace fwui {

// The format of windows, for textures that are shown often. A single mip avoids mip selection.
constexpr VkFormat kUiFormat = VK_FORMAT_B8G8R8A8_UNORM;

class UiRenderer {
 public:
    // `pass`: one colour attachment with display values. `slots`: frames in flight.
    UiRenderer(const sample::VulkanHost& host, VkRenderPass pass, uint32_t slots);
    ~UiRenderer();
    UiRenderer(const UiRenderer&) = delete;
    UiRenderer& operator=(const UiRenderer&) = delete;

    // Uploads ImGui's atlas. Call it again after rebuilding fonts. Waits for the device.
    void uploadFonts();
    // Registers a texture for ImGui::Image and returns its ImTextureID. Linear filtering. Redrawn
    // every frame, because its content may change. Returns null if all 128 slots are in use.
    void* addTexture(VkImageView view, VkImageLayout layout);
    // The device must have finished all frames that show it.
    void removeTexture(void* texture);
    // Draws inside the pass and sets its own viewport and scissors. `whole`: the output is empty;
    // false: it holds the previous call's result.
    void draw(VkCommandBuffer commands, uint32_t slot, const ImDrawData& data, bool whole);
    // Draws everything over the pass's current content, for a game's overlay.
    void drawOver(VkCommandBuffer commands, uint32_t slot, const ImDrawData& data);

 private:
    struct Part {  // a rectangle of the output, in pixels
        int32_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    };
    struct List {  // copy of a frame's list
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
