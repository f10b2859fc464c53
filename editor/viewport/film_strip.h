// Thumbnails of the burn along its timeline, copied from the viewport during playback. Each
// interval keeps the picture nearest to its centre.
#pragma once

#include <imgui.h>

#include <array>

#include "shell/ui_renderer.h"
#include "viewport/scene_target.h"

namespace fwview {

class FilmStrip {
 public:
    static constexpr uint32_t kPictures = 16, kWidth = 192, kHeight = 108;  // px, per picture
    FilmStrip(const sample::VulkanHost& host, fwui::UiRenderer& ui);
    ~FilmStrip();
    FilmStrip(const FilmStrip&) = delete;
    FilmStrip& operator=(const FilmStrip&) = delete;

    void forget();
    // Copies the picture of `target` at `share` of the timeline, if it is nearest to its interval's
    // centre so far. Call it after SceneTarget::end.
    void take(const fwui::Frame& frame, const SceneTarget& target, float share);
    [[nodiscard]] bool has(uint32_t index) const { return distance_[index] < 1; }
    [[nodiscard]] bool empty() const;
    [[nodiscard]] void* texture() const { return texture_; }
    // Texture coordinates of a picture, cropped around its centre to `aspect`.
    void place(uint32_t index, float aspect, ImVec2& low, ImVec2& high) const;

 private:
    const sample::VulkanHost& host_;
    fwui::UiRenderer& ui_;
    sample::Image pictures_;
    void* texture_ = nullptr;
    std::array<float, kPictures> distance_{};  // from the centre, in intervals; 1: no picture
};

}  // namespace fwview
