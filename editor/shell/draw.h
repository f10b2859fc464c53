// Drawing helpers of the panels: text aligned by its middle, icons by their box, boxes and lines on
// whole pixels, colour maps. No input handling.
#pragma once

#include <span>
#include <string>

#include "shell/theme.h"

namespace fwui {

ImVec2 textSize(ImFont* font, const char* text, const char* end = nullptr);
// `y`: middle of the line. Returns the width.
float drawText(ImDrawList* list, ImFont* font, float x, float y, ImU32 color, const char* text);
void drawTextRight(ImDrawList* list, ImFont* font, float x, float y, ImU32 color, const char* text);
void drawTextCentred(ImDrawList* list, ImFont* font, float x, float y, ImU32 color,
                     const char* text);
// Truncates with an ellipsis at `width`.
void drawTextFit(ImDrawList* list, ImFont* font, float x, float y, float width, ImU32 color,
                 const char* text);
// Wraps at spaces and line ends only, so that 65,535 stays whole. `at`: top left. Returns the
// height. `list` may be null to measure only.
float drawTextWrapped(ImDrawList* list, ImFont* font, ImVec2 at, float width, ImU32 color,
                      const char* text);
// Centres by the box that all icons share, not by ascent and descent.
void drawIcon(ImDrawList* list, ImFont* font, ImVec2 centre, ImU32 color, const char* icon,
              bool mirrored = false);
void drawBox(ImDrawList* list, ImVec2 low, ImVec2 high, ImU32 fill, float radius = metrics::radius,
             ImU32 outline = 0);
void drawRow(ImDrawList* list, float x0, float x1, float y, ImU32 color);  // a horizontal hairline
void drawColumn(ImDrawList* list, float x, float y0, float y1, ImU32 color);  // a vertical hairline
void drawCard(ImDrawList* list, ImVec2 low, ImVec2 high);  // raised, with a shadow
// Draws "Ctrl+Shift+S" as key caps; "|" separates alternatives. Returns the width.
float drawKeys(ImDrawList* list, float x, float y, const char* keys, bool toTheLeft = false);
float drawChip(ImDrawList* list, ImVec2 centre, const char* text);  // a value over the picture

struct Rect {
    float x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    float width() const { return x1 - x0; }
    float height() const { return y1 - y0; }
    float midX() const { return (x0 + x1) * 0.5f; }
    float midY() const { return (y0 + y1) * 0.5f; }
    ImVec2 low() const { return {x0, y0}; }
    ImVec2 high() const { return {x1, y1}; }
    bool holds(ImVec2 p) const { return p.x >= x0 && p.x < x1 && p.y >= y0 && p.y < y1; }
    Rect inset(float m) const { return {x0 + m, y0 + m, x1 - m, y1 - m}; }
    // Cuts a strip off and returns it.
    Rect cutTop(float h) { return {x0, y0, x1, y0 += h}; }
    Rect cutBottom(float h) { return {x0, y1 -= h, x1, y1 + h}; }
    Rect cutLeft(float w) { return {x0, y0, x0 += w, y1}; }
    Rect cutRight(float w) { return {x1 -= w, y0, x1 + w, y1}; }
};

struct MapStop {
    float at;  // [0, 1]
    ImU32 color;
};
ImU32 sampleMap(std::span<const MapStop> map, float at);
void drawMap(ImDrawList* list, ImVec2 low, ImVec2 high, std::span<const MapStop> map);
// Glow of a flame, 330 to 1930 degrees Celsius. Lightness is monotonic.
extern const std::span<const MapStop> kHeatMap;
// Early is bright, late is dark.
extern const std::span<const MapStop> kTimeMap;

}  // namespace fwui
