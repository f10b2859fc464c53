// See theme.h.
#include "shell/theme.h"

#include <imgui_freetype.h>

#include <algorithm>
#include <filesystem>

#include "shell/icons.h"

namespace fwui {
namespace {

// Latin, dashes and quotes, super- and subscripts, arrows, mathematical symbols.
constexpr ImWchar kText[] = {0x20,   0x17F,  0x2010, 0x2027, 0x2030, 0x203A, 0x2070,
                             0x209C, 0x2190, 0x2199, 0x2200, 0x2265, 0};

// Inter's digits differ in width. Equal widths keep a running number from jittering.
void makeDigitsEqual(ImFont* font) {
    float widest = 0;
    for (ImWchar digit = '0'; digit <= '9'; ++digit) {
        if (const ImFontGlyph* glyph = font->FindGlyph(digit))
            widest = std::max(widest, glyph->AdvanceX);
    }
    for (ImFontGlyph& glyph : font->Glyphs) {
        if (glyph.Codepoint < '0' || glyph.Codepoint > '9') continue;
        const float shift = std::floor((widest - glyph.AdvanceX) * 0.5f + 0.5f);
        glyph.X0 += shift;
        glyph.X1 += shift;
        glyph.AdvanceX = widest;
    }
    font->BuildLookupTable();
}

}  // namespace

Theme& theme() {
    static Theme one;
    return one;
}

ImU32 mix(ImU32 a, ImU32 b, float share) {
    return ImGui::ColorConvertFloat4ToU32(ImLerp(asFloats(a), asFloats(b), share));
}

bool loadFonts(std::string& error) {
    const std::filesystem::path inter = "/usr/share/fonts/opentype/inter";
    const std::filesystem::path icons =
        "/usr/share/fonts/truetype/material-design-icons-iconfont/MaterialIcons-Regular.ttf";
    for (const char* face :
         {"Inter-Regular.otf", "Inter-SemiBold.otf", "InterDisplay-SemiBold.otf"}) {
        if (std::filesystem::exists(inter / face)) continue;
        error = "The font " + (inter / face).string() + " is missing. Install fonts-inter.";
        return false;
    }
    if (!std::filesystem::exists(icons)) {
        error = "The font " + icons.string() +
                " is missing. Install fonts-material-design-icons-iconfont.";
        return false;
    }
    ImFontAtlas* atlas = ImGui::GetIO().Fonts;
    atlas->Clear();
    atlas->FontBuilderIO = ImGuiFreeType::GetBuilderForFreeType();
    atlas->FontBuilderFlags = ImGuiFreeTypeBuilderFlags_LightHinting;
    // FreeType sizes are ascent + descent: for Inter 1.21 em, so size 15 is an em of 12.4.
    auto text = [&](const char* face, float size) {
        ImFontConfig config;
        config.OversampleH = config.OversampleV = 1;
        config.PixelSnapH = theme().scale < 1.5f;
        return atlas->AddFontFromFileTTF((inter / face).c_str(), dp(size), &config, kText);
    };
    auto icon = [&](float size) {
        ImFontConfig config;
        config.PixelSnapH = true;
        return atlas->AddFontFromFileTTF(icons.c_str(), dp(size), &config, kIconRanges);
    };
    Fonts& made = theme().fonts;
    made.body = text("Inter-Regular.otf", 15);
    made.semi = text("Inter-SemiBold.otf", 15);
    made.small = text("Inter-Regular.otf", 13.5f);
    made.smallSemi = text("Inter-SemiBold.otf", 13.5f);
    made.heading = text("InterDisplay-SemiBold.otf", 19);
    made.title = text("InterDisplay-SemiBold.otf", 32);
    // A monospaced font for code. If it is missing, ImGui's own serves.
    const char* mono = "/usr/share/fonts/truetype/dejavu/DejaVuSansMono.ttf";
    ImFontConfig plain;
    plain.SizePixels = dp(13);
    made.mono = std::filesystem::exists(mono)
                    ? atlas->AddFontFromFileTTF(mono, dp(13.5f), &plain, kText)
                    : atlas->AddFontDefault(&plain);
    made.icon14 = icon(14);
    made.icon17 = icon(17);
    made.icon20 = icon(20);
    made.icon34 = icon(34);
    atlas->Build();
    for (ImFont* font :
         {made.body, made.semi, made.small, made.smallSemi, made.heading, made.title})
        makeDigitsEqual(font);
    return true;
}

void applyStyle() {
    ImGuiStyle style;
    style.WindowPadding = dp(metrics::pad, 8);
    style.FramePadding = dp(8, 4);
    style.ItemSpacing = dp(metrics::gap, metrics::gap);
    style.ItemInnerSpacing = dp(6, 4);
    style.IndentSpacing = dp(14);
    style.ScrollbarSize = dp(10);
    style.GrabMinSize = dp(10);
    style.WindowRounding = 0;
    style.ChildRounding = style.FrameRounding = style.GrabRounding = dp(metrics::radius);
    style.PopupRounding = dp(metrics::cardRadius);
    style.ScrollbarRounding = dp(5);
    style.WindowBorderSize = style.ChildBorderSize = style.FrameBorderSize = 0;
    style.PopupBorderSize = 1;
    auto set = [&](ImGuiCol which, ImU32 color) { style.Colors[which] = asFloats(color); };
    set(ImGuiCol_Text, colors::text);
    set(ImGuiCol_TextDisabled, colors::dim);
    set(ImGuiCol_WindowBg, colors::panel);
    set(ImGuiCol_ChildBg, 0);
    set(ImGuiCol_PopupBg, colors::raised);
    set(ImGuiCol_Border, colors::edge);
    for (ImGuiCol which : {ImGuiCol_FrameBg, ImGuiCol_FrameBgHovered, ImGuiCol_FrameBgActive})
        set(which, colors::well);
    set(ImGuiCol_Button, colors::control);
    set(ImGuiCol_ButtonHovered, colors::hover);
    set(ImGuiCol_ButtonActive, colors::press);
    set(ImGuiCol_Header, colors::accentSoft);
    set(ImGuiCol_HeaderHovered, colors::hover);
    set(ImGuiCol_HeaderActive, colors::accentSoft);
    set(ImGuiCol_Separator, colors::line);
    set(ImGuiCol_ScrollbarBg, 0);
    set(ImGuiCol_ScrollbarGrab, colors::control);
    set(ImGuiCol_ScrollbarGrabHovered, colors::hover);
    set(ImGuiCol_ScrollbarGrabActive, colors::press);
    set(ImGuiCol_TextSelectedBg, faded(colors::accent, 0.35f));
    set(ImGuiCol_NavHighlight, colors::accent);
    set(ImGuiCol_ModalWindowDimBg, hex(0x08090A, 158));
    ImGui::GetStyle() = style;
}

}  // namespace fwui
