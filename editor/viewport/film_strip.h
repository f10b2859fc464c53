// Small pictures of the burn along its timeline, taken from the viewport as it runs by: for each
// stretch of time the one nearest to its middle.
#pragma once

#include <imgui.h>

#include <array>

#include "shell/ui_renderer.h"
#include "viewport/scene_target.h"

namespace fwview {

class FilmStrip {
 public:
    static constexpr uint32_t kPictures = 16, kWidth = 192, kHeight = 108;  // px, of each
    FilmStrip(const sample::VulkanHost& host, fwui::UiRenderer& ui);
    ~FilmStrip();
    FilmStrip(const FilmStrip&) = delete;
    FilmStrip& operator=(const FilmStrip&) = delete;

    void forget();
    // What `target` shows, of a moment at `share` of the timeline, if none is nearer to the middle
    // of its stretch. After SceneTarget::end.
    void take(const fwui::Frame& frame, const SceneTarget& target, float share);
    [[nodiscard]] bool has(uint32_t index) const { return distance_[index] < 1; }
    [[nodiscard]] bool empty() const;
    [[nodiscard]] void* texture() const { return texture_; }
    // Of a picture in the texture, cut to that width over height about its middle.
    void place(uint32_t index, float aspect, ImVec2& low, ImVec2& high) const;

 private:
    const sample::VulkanHost& host_;
    fwui::UiRenderer& ui_;
    sample::Image pictures_;
    void* texture_ = nullptr;
    std::array<float, kPictures> distance_{};  // from the middle, in stretches; 1: none is there
};

}  // namespace fwview
