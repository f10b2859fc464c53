// See draw.h.
#include "shell/draw.h"

#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

#include "shell/icons.h"

namespace fwui {
namespace {

constexpr MapStop kHeat[] = {{0, hex(0x140605)},     {0.16f, hex(0x5A1205)}, {0.36f, hex(0xC63A0A)},
                             {0.56f, hex(0xFB8A22)}, {0.76f, hex(0xFFCB6A)}, {1, hex(0xFFF4DA)}};
constexpr MapStop kTime[] = {{0, hex(0xFDE725)},    {0.2f, hex(0x7AD151)}, {0.4f, hex(0x22A884)},
                             {0.6f, hex(0x2A788E)}, {0.8f, hex(0x414487)}, {1, hex(0x440154)}};

// The icon font has no eraser.
void drawEraser(ImDrawList* list, float size, ImVec2 centre, ImU32 color) {
    const float k = size / 20;
    const ImVec2 along(0.72f, -0.69f), across(0.69f, 0.72f);
    auto place = [&](float x, float y) {
        return ImVec2(centre.x + (along.x * x + across.x * y) * k,
                      centre.y + (along.y * x + across.y * y) * k);
    };
    const ImVec2 whole[4] = {place(-7, -4), place(7, -4), place(7, 4), place(-7, 4)};
    const ImVec2 tip[4] = {place(-1, -4), place(7, -4), place(7, 4), place(-1, 4)};
    list->AddConvexPolyFilled(tip, 4, color);
    list->AddPolyline(whole, 4, color, ImDrawFlags_Closed, 1.6f * k);
    list->AddLine(centre + ImVec2(-k, 8 * k), centre + ImVec2(8 * k, 8 * k), color, 1.6f * k);
}

float capWidth(const std::string& key) {
    return std::max(dp(18), textSize(fonts().small, key.c_str()).x + dp(10));
}

void drawCap(ImDrawList* list, float x, float y, const std::string& key) {
    const ImVec2 size(capWidth(key), dp(18)), low(x, std::floor(y - size.y * 0.5f));
    drawBox(list, low, low + size, colors::control);
    list->AddRectFilled(low + ImVec2(dp(1), size.y - dp(2)), low + size - ImVec2(dp(1), 0),
                        colors::gap, dp(4), ImDrawFlags_RoundCornersBottom);
    drawTextCentred(list, fonts().small, x + size.x * 0.5f, y - dp(0.5f), colors::text,
                    key.c_str());
}

}  // namespace

const std::span<const MapStop> kHeatMap = kHeat;
const std::span<const MapStop> kTimeMap = kTime;

ImVec2 textSize(ImFont* font, const char* text, const char* end) {
    return font->CalcTextSizeA(font->FontSize, FLT_MAX, 0, text, end);
}

float drawText(ImDrawList* list, ImFont* font, float x, float y, ImU32 color, const char* text) {
    const ImVec2 at(std::floor(x), std::floor(y - font->FontSize * 0.5f - 0.5f));
    list->AddText(font, font->FontSize, at, color, text);
    return textSize(font, text).x;
}

void drawTextRight(ImDrawList* list, ImFont* font, float x, float y, ImU32 color,
                   const char* text) {
    drawText(list, font, x - textSize(font, text).x, y, color, text);
}

void drawTextCentred(ImDrawList* list, ImFont* font, float x, float y, ImU32 color,
                     const char* text) {
    drawText(list, font, x - textSize(font, text).x * 0.5f, y, color, text);
}

void drawTextFit(ImDrawList* list, ImFont* font, float x, float y, float width, ImU32 color,
                 const char* text) {
    if (textSize(font, text).x <= width) {
        drawText(list, font, x, y, color, text);
        return;
    }
    const float dots = textSize(font, "…").x;
    if (width < dots) return;
    const char* end = text;
    font->CalcTextSizeA(font->FontSize, width - dots, 0, text, nullptr, &end);
    drawText(list, font, x, y, color, (std::string(text, end) + "…").c_str());
}

float drawTextWrapped(ImDrawList* list, ImFont* font, ImVec2 at, float width, ImU32 color,
                      const char* text) {
    const float lead = std::floor(font->FontSize * 1.28f);
    float y = at.y;
    std::string line;
    auto flush = [&] {
        if (list)
            list->AddText(font, font->FontSize, {std::floor(at.x), std::floor(y)}, color,
                          line.c_str());
        y += lead;
        line.clear();
    };
    while (*text) {
        const char* end = text + std::strcspn(text, " \n");
        const std::string word(text, end);
        if (!line.empty() && textSize(font, (line + " " + word).c_str()).x > width) flush();
        line += (line.empty() ? "" : " ") + word;
        if (*end == '\n') flush();
        text = *end ? end + 1 : end;
    }
    if (!line.empty()) flush();
    return y - at.y;
}

void drawIcon(ImDrawList* list, ImFont* font, ImVec2 centre, ImU32 color, const char* icon,
              bool mirrored) {
    if (!std::strcmp(icon, icons::erase)) {
        drawEraser(list, font->FontSize, centre, color);
        return;
    }
    unsigned code = 0, symmetric = 0;
    ImTextCharFromUtf8(&code, icon, nullptr);
    ImTextCharFromUtf8(&symmetric, icons::frame, nullptr);
    const ImFontGlyph* glyph = font->FindGlyph(ImWchar(code));
    const ImFontGlyph* box = font->FindGlyph(ImWchar(symmetric));
    const ImVec2 origin(std::floor(centre.x - (box->X0 + box->X1) * 0.5f + 0.5f),
                        std::floor(centre.y - (box->Y0 + box->Y1) * 0.5f + 0.5f));
    ImVec2 uv0(glyph->U0, glyph->V0), uv1(glyph->U1, glyph->V1);
    if (mirrored) std::swap(uv0.x, uv1.x);
    list->PrimReserve(6, 4);
    list->PrimRectUV(origin + ImVec2(glyph->X0, glyph->Y0), origin + ImVec2(glyph->X1, glyph->Y1),
                     uv0, uv1, color);
}

void drawBox(ImDrawList* list, ImVec2 low, ImVec2 high, ImU32 fill, float radius, ImU32 outline) {
    if (fill) list->AddRectFilled(low, high, fill, dp(radius));
    if (outline) list->AddRect(low, high, outline, dp(radius), 0, hairline());
}

void drawRow(ImDrawList* list, float x0, float x1, float y, ImU32 color) {
    list->AddRectFilled({x0, y}, {x1, y + hairline()}, color);
}

void drawColumn(ImDrawList* list, float x, float y0, float y1, ImU32 color) {
    list->AddRectFilled({x, y0}, {x + hairline(), y1}, color);
}

void drawCard(ImDrawList* list, ImVec2 low, ImVec2 high) {
    for (int i = 6; i >= 1; --i) {
        const auto step = float(i);
        list->AddRectFilled(low - dp(step * 2, step * 1.4f), high + dp(step * 2, step * 2.8f),
                            IM_COL32(0, 0, 0, 15), dp(metrics::cardRadius + step * 2));
    }
    drawBox(list, low, high, colors::raised, metrics::cardRadius, colors::edge);
}

float drawKeys(ImDrawList* list, float x, float y, const char* keys, bool toTheLeft) {
    std::vector<std::pair<std::string, bool>> caps;  // a key, and whether an alternative starts
                                                     // here
    std::string key;
    bool fresh = false;
    for (const char* at = keys;; ++at) {
        const bool plus = *at == '+' && at != keys && at[1] && at[1] != '|';
        const bool either = *at == '|' && at != keys;
        if (*at && !plus && !either) {
            key += *at;
            continue;
        }
        caps.emplace_back(key, fresh);
        key.clear();
        fresh = either;
        if (!*at) break;
    }
    float width = -dp(3);
    for (const auto& [name, apart] : caps) width += capWidth(name) + dp(apart ? 7 : 3);
    if (toTheLeft) x -= width;
    for (const auto& [name, apart] : caps) {
        if (apart) x += dp(4);
        drawCap(list, x, y, name);
        x += capWidth(name) + dp(3);
    }
    return width;
}

float drawChip(ImDrawList* list, ImVec2 centre, const char* text) {
    const float width = textSize(fonts().small, text).x + dp(14);
    drawBox(list, centre - ImVec2(width * 0.5f, dp(10)), centre + ImVec2(width * 0.5f, dp(10)),
            hex(0x151618, 226), 10);
    drawTextCentred(list, fonts().small, centre.x, centre.y, colors::title, text);
    return width;
}

ImU32 sampleMap(std::span<const MapStop> map, float at) {
    at = std::clamp(at, 0.0f, 1.0f);
    for (size_t i = 1; i < map.size(); ++i) {
        if (at > map[i].at) continue;
        return mix(map[i - 1].color, map[i].color,
                   (at - map[i - 1].at) / (map[i].at - map[i - 1].at));
    }
    return map.back().color;
}

void drawMap(ImDrawList* list, ImVec2 low, ImVec2 high, std::span<const MapStop> map) {
    for (size_t i = 1; i < map.size(); ++i) {
        const float x0 = low.x + (high.x - low.x) * map[i - 1].at;
        const float x1 = low.x + (high.x - low.x) * map[i].at;
        list->AddRectFilledMultiColor({x0, low.y}, {x1, high.y}, map[i - 1].color, map[i].color,
                                      map[i].color, map[i - 1].color);
    }
}

}  // namespace fwui
