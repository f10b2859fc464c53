// Colours over the burn maps of meshes: laid on them in the viewport, over the finished picture so
// that they are those of the legend, and shown flat as the unwrap. What a texel's value looks like
// is the caller's palette.
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
// Values 0 to 254 along the map, 255 not at all.
Palette rampPalette(std::span<const fwui::MapStop> map, float opacity);

class MapOverlay {
 public:
    // `pass`: colour in display values and depth, as SceneTarget::overPass.
    MapOverlay(const sample::VulkanHost& host, fwui::UiRenderer& ui, VkRenderPass pass);
    ~MapOverlay();
    MapOverlay(const MapOverlay&) = delete;
    MapOverlay& operator=(const MapOverlay&) = delete;

    // Makes what a mesh's map needs before it is coloured, if it is not there.
    void prepare(fwedit::ObjectId mesh, const std::shared_ptr<const fwedit::PaintSurface>& surface);
    // Colours a part of a mesh's map by values over all of it; they are seen with the next frame.
    void color(fwedit::ObjectId mesh, const std::shared_ptr<const fwedit::PaintSurface>& surface,
               std::span<const uint8_t> values, const Palette& palette,
               const fwedit::PaintedArea& area);
    void clear();  // waits for the device
    // Nothing that was coloured is waiting for a frame.
    [[nodiscard]] bool settled() const;
    [[nodiscard]] void* texture(fwedit::ObjectId mesh) const;  // for ImGui; null: never coloured

    void upload(const fwui::Frame& frame);  // outside a pass
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
        // Texels beside the surface and the texel of it that they repeat, so that no border fades.
        std::vector<std::pair<uint32_t, uint32_t>> gutter;
        fwedit::PaintedArea fresh;  // that the image does not have yet
    };
    Map makeMap(const std::shared_ptr<const fwedit::PaintSurface>& surface);
    void destroy(Map& map);
    // Null: there is no room for another.
    Map* mapOf(fwedit::ObjectId mesh, const std::shared_ptr<const fwedit::PaintSurface>& surface);

    const sample::VulkanHost& host_;
    fwui::UiRenderer& ui_;
    PictureDrawing drawing_;
    VkPipeline pipeline_ = VK_NULL_HANDLE;
    std::map<fwedit::ObjectId, Map> maps_;
};

}  // namespace fwview
