// An off-screen picture of a scene for the interface. Opaque objects are drawn in linear light with
// depth. Flames composite over them and fade at surfaces. Bloom, filmic curve and display encoding
// follow, as in the samples.
#pragma once

#include "common/stage.h"
#include "flamewright/flamewright_vulkan.h"
#include "shell/frames.h"
#include "shell/ui_renderer.h"
#include "viewport/picture_drawing.h"

namespace fwview {

class SceneTarget {
 public:
    SceneTarget(const sample::VulkanHost& host, fwui::UiRenderer& ui);
    ~SceneTarget();
    SceneTarget(const SceneTarget&) = delete;
    SceneTarget& operator=(const SceneTarget&) = delete;

    // Resizes to pixels; does nothing if the size is equal. Waits for the device.
    void resize(uint32_t width, uint32_t height);
    void begin(const fwui::Frame& frame);
    // After the opaque objects.
    void beginFlames(const fwui::Frame& frame);
    void end(const fwui::Frame& frame);
    // After end: keeps a copy of the picture, so that later frames can start from it.
    void keep(const fwui::Frame& frame);
    void restore(const fwui::Frame& frame);
    // After end or restore: begins a pass over the display values, with the scene's depth test.
    void beginOver(const fwui::Frame& frame);
    void endOver(const fwui::Frame& frame);
    [[nodiscard]] sample::ScenePass pass() const;
    // Target definitions to register: for the pass after begin, and after beginFlames.
    [[nodiscard]] FwVulkanTargetDef solids() const;
    [[nodiscard]] FwVulkanTargetDef flames() const;
    void setSampledDepth(FwVulkanFrame& frame) const;  // sets the depth for draws after beginFlames
    [[nodiscard]] VkRenderPass overPass() const { return overPass_; }
    [[nodiscard]] void* texture() const { return texture_; }  // for ImGui
    [[nodiscard]] VkImage shownImage() const {
        return shown_.image;
    }  // sampled layout outside passes
    [[nodiscard]] VkExtent2D extent() const { return extent_; }
    [[nodiscard]] VkViewport viewport() const {
        return {0, 0, float(extent_.width), float(extent_.height), 0, 1};
    }

    float bloom = 0.06f, vignette = 0.1f;

 private:
    enum class Depth { kNone, kWritten, kTested };
    struct PassRequest {
        VkFormat color;
        Depth depth;
        VkImageLayout before, after;  // of the colour; undefined before: drops the content
    };
    VkRenderPass makePass(const PassRequest& request) const;
    void beginPass(const fwui::Frame& frame, VkRenderPass pass, VkFramebuffer framebuffer) const;
    VkFramebuffer makeFramebuffer(VkRenderPass pass, std::initializer_list<VkImageView> views,
                                  uint32_t width, uint32_t height) const;
    void dropImages();
    void spreadLight(const fwui::Frame& frame);
    void copyPicture(const fwui::Frame& frame, const sample::Image& from, VkImageLayout before,
                     const sample::Image& to) const;
    void drawPost(const fwui::Frame& frame, VkPipeline pipeline, VkRenderPass pass,
                  VkFramebuffer framebuffer, VkExtent2D extent);

    const sample::VulkanHost& host_;
    fwui::UiRenderer& ui_;
    VkExtent2D extent_{};
    uint32_t mips_ = 1;
    VkFormat depthFormat_ = VK_FORMAT_UNDEFINED;
    sample::Image color_, depth_, spread_, shown_, kept_;
    VkRenderPass scenePass_ = VK_NULL_HANDLE, flamePass_ = VK_NULL_HANDLE,
                 spreadPass_ = VK_NULL_HANDLE, shownPass_ = VK_NULL_HANDLE,
                 overPass_ = VK_NULL_HANDLE;
    VkFramebuffer sceneFramebuffer_ = VK_NULL_HANDLE, flameFramebuffer_ = VK_NULL_HANDLE,
                  spreadFramebuffer_ = VK_NULL_HANDLE, shownFramebuffer_ = VK_NULL_HANDLE,
                  overFramebuffer_ = VK_NULL_HANDLE;
    PictureDrawing drawing_;
    VkDescriptorSet set_ = VK_NULL_HANDLE;
    VkPipeline shownPipeline_ = VK_NULL_HANDLE, spreadPipeline_ = VK_NULL_HANDLE;
    void* texture_ = nullptr;
};

}  // namespace fwview
