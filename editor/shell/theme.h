// The editor's theme: one scale, one set of colours, sizes and fonts. All lengths are design pixels
// of a 1280 x 720 window; dp() converts them to whole screen pixels.
#pragma once

#define IMGUI_DEFINE_MATH_OPERATORS
#include <imgui.h>
#include <imgui_internal.h>

#include <cmath>
#include <string>

namespace fwui {

struct Fonts {
    ImFont *body, *semi, *small, *smallSemi, *heading, *title, *mono;
    ImFont *icon14, *icon17, *icon20, *icon34;
};

struct Theme {
    float scale = 1;  // screen pixels per design pixel, [0.75, 4]
    Fonts fonts{};
};
Theme& theme();
inline const Fonts& fonts() { return theme().fonts; }

inline float dp(float length) { return std::floor(length * theme().scale + 0.5f); }
inline ImVec2 dp(float x, float y) { return {dp(x), dp(y)}; }
inline float hairline() { return std::fmax(1.0f, std::floor(theme().scale)); }

constexpr ImU32 hex(unsigned rgb, unsigned opacity = 255) {
    return IM_COL32((rgb >> 16) & 255, (rgb >> 8) & 255, rgb & 255, opacity);
}
inline ImVec4 asFloats(ImU32 color) { return ImGui::ColorConvertU32ToFloat4(color); }
inline ImU32 faded(ImU32 color, float share) {
    return (color & 0x00FFFFFFu) | (ImU32(float(color >> 24) * share + 0.5f) << 24);
}
ImU32 mix(ImU32 a, ImU32 b, float share);

// Neutral greys, so that the interface does not bias the view of the picture. Blue: selected or
// active. Orange: heat only.
namespace colors {
constexpr ImU32 gap = hex(0x111214);      // between panels
constexpr ImU32 well = hex(0x151618);     // fields, canvases, tracks
constexpr ImU32 panel = hex(0x1E1F22);    // panel bodies
constexpr ImU32 header = hex(0x26272B);   // panel headers, toolbars
constexpr ImU32 raised = hex(0x2A2C31);   // cards, menus, dialogs
constexpr ImU32 control = hex(0x32343A);  // buttons
constexpr ImU32 hover = hex(0x3D4047);
constexpr ImU32 press = hex(0x494D55);
constexpr ImU32 line = hex(0x35373D);  // hairlines in a panel
constexpr ImU32 edge = hex(0x4A4D55);  // outlines of cards
constexpr ImU32 title = hex(0xF2F3F5);
constexpr ImU32 text = hex(0xD3D5DA);
constexpr ImU32 dim = hex(0x9DA1AA);          // labels, units, hints
constexpr ImU32 off = hex(0x666A73);          // disabled
constexpr ImU32 accent = hex(0x62ABFF);       // outline of the selection, links
constexpr ImU32 accentFill = hex(0x2A69B0);   // the primary button, the active tool
constexpr ImU32 accentHover = hex(0x3479C6);  // accentFill when hovered
constexpr ImU32 accentSoft = hex(0x62ABFF, 46);
constexpr ImU32 heat = hex(0xFF9445);
constexpr ImU32 wet = hex(0x46B4D8);
constexpr ImU32 ok = hex(0x58C58F);
constexpr ImU32 warn = hex(0xF0BC52);
constexpr ImU32 error = hex(0xFF7468);
constexpr ImU32 white = hex(0xFFFFFF);
constexpr ImU32 axis[3] = {hex(0xF0606A), hex(0x86C84A), hex(0x5B9BFF)};
}  // namespace colors

namespace metrics {  // design pixels
constexpr float row = 22, gap = 6, pad = 10, label = 96;
constexpr float radius = 4, cardRadius = 8;
constexpr float topBar = 36, toolBar = 38, status = 24;
constexpr float timeline = 144, left = 216, right = 296;
}  // namespace metrics

// Loads the fonts of the Debian packages fonts-inter and fonts-material-design-icons-iconfont at
// the theme's scale and builds ImGui's atlas. On failure returns false; `error` has the file and
// the package.
bool loadFonts(std::string& error);
// Sets ImGui's colours and sizes. Call it again after a change of scale.
void applyStyle();

}  // namespace fwui
