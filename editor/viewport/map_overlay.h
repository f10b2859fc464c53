// Colours over the burn maps of meshes: drawn over the tone-mapped picture, so that they match the
// legend, and flat as the unwrap. The caller's palette maps values to colours.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "document/paint.h"
#include "shell/draw.h"
#include "shell/frames.h"
#include "shell/ui_renderer.h"
#include "viewport/picture_drawing.h"

namespace fwview {

using Palette = std::array<uint32_t, 256>;  // RGBA8 by value, display values, premultiplied
constexpr float kOverlayOpacity = 0.72f;
uint32_t premultiplied(ImU32 color, float opacity);
// Maps values 0 to 254 along the ramp; 255 is transparent.
Palette rampPalette(std::span<const fwui::MapStop> map, float opacity);

class MapOverlay {
 public:
    // `pass`: colour in display values and depth, as SceneTarget::overPass.
    MapOverlay(const sample::VulkanHost& host, fwui::UiRenderer& ui, VkRenderPass pass);
    ~MapOverlay();
    MapOverlay(const MapOverlay&) = delete;
    MapOverlay& operator=(const MapOverlay&) = delete;

    // Creates the resources of a mesh's map, if missing.
    void prepare(fwedit::ObjectId mesh, const std::shared_ptr<const fwedit::PaintSurface>& surface);
    // Colours a part of a mesh's map from values for the whole map. Shows with the next frame.
    void color(fwedit::ObjectId mesh, const std::shared_ptr<const fwedit::PaintSurface>& surface,
               std::span<const uint8_t> values, const Palette& palette,
               const fwedit::PaintedArea& area);
    void clear();  // waits for the device
    // No coloured part waits for a frame.
    [[nodiscard]] bool isSettled() const;
    [[nodiscard]] void* texture(fwedit::ObjectId mesh) const;  // for ImGui; null: not coloured yet

    void upload(const fwui::Frame& frame);  // call it outside a pass
    void draw(const fwui::Frame& frame, fwedit::ObjectId mesh, const glm::mat4& clip,
              float opacity) const;

 private:
    struct Map {
        std::shared_ptr<const fwedit::PaintSurface> surface;
        sample::Buffer corners;
        sample::Image image;
        std::array<sample::Buffer, fwui::Frames::kSlots> staging;
        VkDescriptorSet set = VK_NULL_HANDLE;
        void* texture = nullptr;
        std::vector<uint32_t> pixels;
        // Texels beside the surface, with the surface texel that they repeat, so that borders do
        // not fade.
        std::vector<std::pair<uint32_t, uint32_t>> gutter;
        fwedit::PaintedArea fresh;  // not uploaded yet
    };
    Map makeMap(const std::shared_ptr<const fwedit::PaintSurface>& surface);
    void destroy(Map& map);
    // Returns null if all places are taken.
    Map* mapOf(fwedit::ObjectId mesh, const std::shared_ptr<const fwedit::PaintSurface>& surface);

    const sample::VulkanHost& host_;
    fwui::UiRenderer& ui_;
    PictureDrawing drawing_;
    VkPipeline pipeline_ = VK_NULL_HANDLE;
    std::map<fwedit::ObjectId, Map> maps_;
};

}  // namespace fwview
