// See widgets.h.
#include "shell/widgets.h"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "shell/icons.h"

namespace fwui {
namespace {

constexpr float kToolSide = 28, kTipDelay = 0.45f;

// The field being typed into and the field being dragged. There is only one mouse.
struct FieldState {
    ImGuiID typing = 0;
    bool fresh = false;
    char text[64] = "";
    float before = 0, pressX = 0;
    bool moved = false;
};
FieldState& fieldState() {
    static FieldState one;
    return one;
}

struct UnitScale {
    const char *typed, *unit;
    float factor;
};
constexpr UnitScale kUnits[] = {{"mm", "m", 0.001f}, {"cm", "m", 0.01f},       {"km", "m", 1000},
                                {"m", "cm", 100},    {"mm", "cm", 0.1f},       {"min", "s", 60},
                                {"ms", "s", 0.001f}, {"W", "kW", 0.001f},      {"MW", "kW", 1000},
                                {"m", "mm", 1000},   {"km/h", "m/s", 1 / 3.6f}};

// Parses a sum of products as far as possible.
struct Sum {
    const char* at;
    bool good = true;

    void skip() {
        while (*at == ' ') ++at;
    }
    double factor() {
        skip();
        if (*at == '(') {
            ++at;
            const double inner = sum();
            skip();
            if (*at == ')') ++at;
            return inner;
        }
        char* end = nullptr;
        const double value = std::strtod(at, &end);
        if (end == at) good = false;
        at = end;
        return value;
    }
    double product() {
        double value = factor();
        for (;;) {
            skip();
            if (*at == '*') {
                ++at;
                value *= factor();
            } else if (*at == '/') {
                ++at;
                value /= factor();
            } else {
                return value;
            }
        }
    }
    double sum() {
        double value = product();
        for (;;) {
            skip();
            if (*at == '+') {
                ++at;
                value += product();
            } else if (*at == '-') {
                ++at;
                value -= product();
            } else {
                return value;
            }
        }
    }
};

void setCursor(ImVec2 at) { ImGui::SetCursorScreenPos(at); }

ImU32 buttonFill(bool hovered, bool held) {
    return held ? colors::press : hovered ? colors::hover : colors::control;
}

Edit typeNumber(ImGuiID id, ImVec2 at, ImVec2 size, float& value, const NumberLook& look) {
    FieldState& state = fieldState();
    setCursor(at);
    ImGui::PushID(int(id));
    ImGui::PushItemWidth(size.x);
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding,
                        ImVec2(dp(6), (size.y - ImGui::GetFontSize()) * 0.5f));
    if (state.fresh) ImGui::SetKeyboardFocusHere();
    const bool entered =
        ImGui::InputText("##typed", state.text, sizeof state.text,
                         ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
    const bool left = !state.fresh && !ImGui::IsItemActive();
    const bool dropped = ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape));
    ImGui::GetWindowDrawList()->AddRect(at, at + size, colors::accent, dp(metrics::radius), 0,
                                        hairline());
    ImGui::PopStyleVar();
    ImGui::PopItemWidth();
    ImGui::PopID();
    state.fresh = false;
    if (!entered && !left) return Edit::kNone;
    state.typing = 0;
    float typed = 0;
    if (dropped || !parseNumber(state.text, look.unit, value, typed)) return Edit::kNone;
    if (look.most > look.least) {
        typed = std::clamp(typed, look.least, look.most);
    } else if (look.highest > look.lowest) {
        typed = std::clamp(typed, look.lowest, look.highest);
    }
    if (typed == value) return Edit::kNone;
    value = typed;
    return Edit::kTyped;
}

}  // namespace

ImDrawList* beginPanel(const char* name, const Rect& rect, ImU32 fill, bool scrolls, bool front) {
    ImGui::SetNextWindowPos(rect.low());
    ImGui::SetNextWindowSize(ImVec2(rect.width(), rect.height()));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2(1, 1));
    ImGui::PushStyleColor(ImGuiCol_WindowBg, fill);
    ImGuiWindowFlags flags = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                             ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings;
    if (!front) flags |= ImGuiWindowFlags_NoBringToFrontOnFocus;
    if (!scrolls) flags |= ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse;
    ImGui::Begin(name, nullptr, flags);
    ImGui::PopStyleColor();
    ImGui::PopStyleVar(2);
    return ImGui::GetWindowDrawList();
}

void endPanel() {
    // Content that continues below the edge fades out there.
    const ImGuiWindow* window = ImGui::GetCurrentWindow();
    if (!(window->Flags & ImGuiWindowFlags_NoScrollbar) && window->Scroll.y < window->ScrollMax.y) {
        const ImU32 fill =
            ImGui::ColorConvertFloat4ToU32(ImGui::GetStyleColorVec4(ImGuiCol_WindowBg));
        const ImVec2 low = window->Pos, high = low + window->Size;
        const ImU32 body = (fill & IM_COL32_A_MASK) ? colors::panel : 0;
        window->DrawList->AddRectFilledMultiColor({low.x, high.y - dp(12)}, high, faded(body, 0),
                                                  faded(body, 0), body, body);
    }
    ImGui::End();
}

void splitter(const char* id, const SplitterRequest& request, float& size) {
    const auto [vertical, at, from, to, design, lowest, highest, sign] = request;
    const Rect rect =
        vertical ? Rect{at - dp(2), from, at + dp(4), to} : Rect{from, at - dp(2), to, at + dp(4)};
    ImDrawList* list = beginPanel(id, rect, 0, false, true);
    bool hovered = false, held = false;
    hit("grab", rect.low(), {rect.width(), rect.height()}, &hovered, &held);
    FieldState& state = fieldState();
    const float mouse = vertical ? ImGui::GetIO().MousePos.x : ImGui::GetIO().MousePos.y;
    if (ImGui::IsItemActivated()) {
        state.before = size;
        state.pressX = mouse;
    }
    if (hovered || held) {
        ImGui::SetMouseCursor(vertical ? ImGuiMouseCursor_ResizeEW : ImGuiMouseCursor_ResizeNS);
        const ImU32 color = held ? colors::accent : colors::edge;
        if (vertical) {
            list->AddRectFilled({at, from}, {at + dp(2), to}, color);
        } else {
            list->AddRectFilled({from, at}, {to, at + dp(2)}, color);
        }
    }
    if (hovered && ImGui::IsMouseDoubleClicked(0)) {
        size = design;
    } else if (held) {
        size = std::clamp(state.before + sign * (mouse - state.pressX) / theme().scale, lowest,
                          highest);
    }
    endPanel();
}

bool hit(const char* id, ImVec2 low, ImVec2 size, bool* hovered, bool* held) {
    setCursor(low);
    const bool pressed =
        ImGui::InvisibleButton(id, {std::max(1.0f, size.x), std::max(1.0f, size.y)});
    if (hovered) *hovered = ImGui::IsItemHovered();
    if (held) *held = ImGui::IsItemActive();
    if (GImGui->NavId == ImGui::GetItemID() && !GImGui->NavDisableHighlight &&
        ImGui::IsItemFocused()) {
        ImGui::GetForegroundDrawList()->AddRect(low - dp(2, 2), low + size + dp(2, 2),
                                                colors::accent, dp(metrics::radius + 2), 0, dp(2));
    }
    if (pressed && asking()) {
        asking() = false;
        return false;
    }
    return pressed;
}

bool& asking() {
    static bool on = false;  // global, since there is one mouse
    return on;
}

void tip(const char* name, const char* keys, const char* more) {
    if (!name || !ImGui::IsItemHovered() || (!asking() && GImGui->HoveredIdTimer < kTipDelay))
        return;
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    const float below = high.y + dp(8);
    ImGui::SetNextWindowPos(
        {std::min(low.x, screen.x - dp(260)), below + dp(40) > screen.y ? low.y - dp(40) : below});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, dp(10, 7));
    ImGui::BeginTooltip();
    ImGui::PushFont(fonts().semi);
    ImGui::TextUnformatted(name);
    ImGui::PopFont();
    if (keys && *keys) {
        ImGui::SameLine();
        ImGui::TextDisabled("%s", keys);
    }
    if (more) {
        ImGui::PushTextWrapPos(dp(240));
        ImGui::TextDisabled("%s", more);
        ImGui::PopTextWrapPos();
    }
    ImGui::EndTooltip();
    ImGui::PopStyleVar();
}

float toolButtonWidth(const ToolLook& look) {
    return dp(kToolSide) + (look.label ? textSize(fonts().body, look.label).x + dp(10) : 0) +
           (look.drops ? dp(14) : 0);
}

bool toolButton(const char* id, ImVec2 at, const ToolLook& look, const char* name,
                const char* keys) {
    const ImVec2 size(toolButtonWidth(look), dp(kToolSide));
    bool hovered = false, held = false;
    const bool pressed = hit(id, at, size, &hovered, &held);
    hovered &= look.enabled;
    held &= look.enabled;
    ImDrawList* list = ImGui::GetWindowDrawList();
    const ImU32 fill = look.active ? colors::accentFill
                       : held      ? colors::press
                       : hovered   ? colors::hover
                                   : 0;
    drawBox(list, at, at + size, fill);
    const ImU32 color = !look.enabled ? colors::off
                        : look.active ? colors::white
                        : hovered     ? colors::title
                                      : colors::text;
    drawIcon(list, fonts().icon20, at + dp(14, 14), color, look.icon, look.mirrored);
    if (look.label)
        drawText(list, fonts().body, at.x + dp(kToolSide + 1), at.y + dp(14), color, look.label);
    if (look.drops)
        drawIcon(list, fonts().icon17, at + ImVec2(size.x - dp(12), dp(14)), colors::dim,
                 icons::down);
    tip(name, keys);
    return pressed && look.enabled;
}

bool button(const char* id, ImVec2 at, ImVec2 size, const char* label, ButtonKind kind,
            const char* icon, const char* keys) {
    bool hovered = false, held = false;
    const bool pressed = hit(id, at, size, &hovered, &held);
    ImDrawList* list = ImGui::GetWindowDrawList();
    ImU32 fill = buttonFill(hovered, held);
    if (kind == ButtonKind::kPrimary) fill = hovered ? colors::accentHover : colors::accentFill;
    if (kind == ButtonKind::kGhost && !hovered && !held) fill = 0;
    drawBox(list, at, at + size, fill);
    const ImU32 color = kind == ButtonKind::kPrimary  ? colors::white
                        : kind == ButtonKind::kDanger ? colors::error
                                                      : colors::title;
    ImFont* font = kind == ButtonKind::kPrimary ? fonts().semi : fonts().body;
    const float iconWidth = icon ? dp(20) : 0, textWidth = textSize(font, label).x;
    const float keysWidth = keys ? textSize(fonts().small, keys).x + dp(8) : 0;
    float x = at.x + (size.x - iconWidth - textWidth - keysWidth) * 0.5f;
    const float y = at.y + size.y * 0.5f;
    if (icon) drawIcon(list, fonts().icon17, {x + dp(8), y}, color, icon);
    x += iconWidth;
    drawText(list, font, x, y, color, label);
    if (keys) drawText(list, fonts().small, x + textWidth + dp(8), y, faded(color, 0.65f), keys);
    return pressed;
}

bool iconButton(const char* id, ImVec2 centre, const char* icon, ImU32 color, const char* name) {
    const ImVec2 half = dp(11, 11);
    bool hovered = false, held = false;
    const bool pressed = hit(id, centre - half, half * 2, &hovered, &held);
    ImDrawList* list = ImGui::GetWindowDrawList();
    if (hovered || held)
        drawBox(list, centre - half, centre + half, held ? colors::press : colors::hover);
    drawIcon(list, fonts().icon17, centre, hovered ? colors::title : color, icon);
    tip(name);
    return pressed;
}

bool segments(const char* id, ImVec2 at, ImVec2 size, std::initializer_list<const char*> names,
              int& chosen) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    drawBox(list, at, at + size, colors::well);
    const auto count = float(names.size());
    int i = 0;
    bool changed = false;
    ImGui::PushID(id);
    for (const char* name : names) {
        const float x0 = std::floor(at.x + size.x * float(i) / count);
        const float x1 = std::floor(at.x + size.x * float(i + 1) / count);
        bool hovered = false;
        ImGui::PushID(i);
        if (hit("segment", {x0, at.y}, {x1 - x0, size.y}, &hovered) && chosen != i) {
            chosen = i;
            changed = true;
        }
        ImGui::PopID();
        if (chosen == i)
            drawBox(list, ImVec2(x0, at.y) + dp(2, 2), ImVec2(x1, at.y + size.y) - dp(2, 2),
                    colors::press, 3);
        drawTextCentred(list, fonts().body, (x0 + x1) * 0.5f, at.y + size.y * 0.5f,
                        chosen == i ? colors::title
                        : hovered   ? colors::text
                                    : colors::dim,
                        name);
        ++i;
    }
    ImGui::PopID();
    return changed;
}

bool toggle(const char* id, ImVec2 at, bool& on) {
    bool hovered = false;
    const bool pressed = hit(id, at, dp(28, 16), &hovered);
    if (pressed) on = !on;
    ImDrawList* list = ImGui::GetWindowDrawList();
    drawBox(list, at, at + dp(28, 16),
            on        ? colors::accentFill
            : hovered ? colors::press
                      : colors::hover,
            8);
    list->AddCircleFilled(at + dp(on ? 20 : 8, 8), dp(6), on ? colors::white : colors::text, 24);
    return pressed;
}

bool dropdown(const char* id, ImVec2 at, ImVec2 size, const char* value, const char* icon) {
    bool hovered = false, held = false;
    const bool pressed = hit(id, at, size, &hovered, &held);
    ImDrawList* list = ImGui::GetWindowDrawList();
    drawBox(list, at, at + size, buttonFill(hovered, held));
    float x = at.x + dp(8);
    const float y = at.y + size.y * 0.5f;
    if (icon) {
        drawIcon(list, fonts().icon17, {x + dp(7), y}, colors::text, icon);
        x += dp(22);
    }
    drawTextFit(list, fonts().body, x, y, at.x + size.x - dp(20) - x, colors::title, value);
    drawIcon(list, fonts().icon17, {at.x + size.x - dp(11), y}, colors::dim, icons::down);
    if (pressed) ImGui::OpenPopup(id);
    return pressed;
}

bool beginMenu(const char* id, ImVec2 at, float width) {
    if (!ImGui::IsPopupOpen(id)) return false;
    ImGui::SetNextWindowPos(at);
    ImGui::SetNextWindowSizeConstraints({width, 0}, {FLT_MAX, ImGui::GetIO().DisplaySize.y * 0.8f});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, dp(4, 4));
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(0, 0));
    const bool open = ImGui::BeginPopup(id);
    if (!open) ImGui::PopStyleVar(2);
    return open;
}

void endMenu() {
    ImGui::EndPopup();
    ImGui::PopStyleVar(2);
}

bool menuItem(const char* label, const char* icon, const char* keys, bool enabled, bool chosen) {
    const float height = dp(26);
    const float wanted = dp(30) + textSize(fonts().body, label).x + dp(14) +
                         (keys && *keys ? textSize(fonts().small, keys).x + dp(20) : 0);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float width = std::max(wanted, ImGui::GetContentRegionAvail().x);
    ImGui::PushID(label);
    const bool pressed = ImGui::InvisibleButton("item", {width, height});
    ImGui::PopID();
    const bool hovered = enabled && ImGui::IsItemHovered();
    ImDrawList* list = ImGui::GetWindowDrawList();
    if (hovered) drawBox(list, at, at + ImVec2(width, height), colors::accentSoft);
    const ImU32 color = !enabled ? colors::off : hovered ? colors::title : colors::text;
    const float y = at.y + height * 0.5f;
    const char* sign = chosen ? icons::check : icon;
    if (sign)
        drawIcon(list, fonts().icon17, {at.x + dp(15), y}, chosen ? colors::accent : color, sign);
    drawText(list, fonts().body, at.x + dp(30), y, color, label);
    if (keys && *keys)
        drawTextRight(list, fonts().small, at.x + width - dp(10), y,
                      enabled ? colors::dim : colors::off, keys);
    if (!pressed || !enabled) return false;
    ImGui::CloseCurrentPopup();
    return true;
}

void menuLine() {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x;
    drawRow(ImGui::GetWindowDrawList(), at.x + dp(4), at.x + width - dp(4), at.y + dp(3),
            colors::edge);
    ImGui::Dummy({1, dp(7)});
}

bool choice(const char* id, ImVec2 at, ImVec2 size, std::span<const char* const> names, int& chosen,
            const char* icon) {
    const bool known = chosen >= 0 && size_t(chosen) < names.size();
    dropdown(id, at, size, known ? names[size_t(chosen)] : "", icon);
    bool changed = false;
    if (!beginMenu(id, at + ImVec2(0, size.y + dp(2)), size.x)) return false;
    for (int i = 0; i < int(names.size()); ++i) {
        if (!menuItem(names[size_t(i)], nullptr, nullptr, true, i == chosen)) continue;
        changed = i != chosen;
        chosen = i;
    }
    endMenu();
    return changed;
}

bool parseNumber(const std::string& text, const char* unit, float old, float& value) {
    std::string clean;
    for (size_t i = 0; i < text.size(); ++i) {
        if (text.compare(i, 3, "−") == 0) {
            clean += '-';
            i += 2;
        } else {
            clean += text[i] == ',' ? '.' : text[i];
        }
    }
    size_t start = clean.find_first_not_of(' ');
    if (start == std::string::npos) return false;
    const bool relative = clean[start] == '+';
    if (relative) ++start;
    Sum sum{clean.c_str() + start};
    double result = sum.sum();
    sum.skip();
    if (!sum.good || !std::isfinite(result)) return false;
    std::string tail(sum.at);
    while (!tail.empty() && tail.back() == ' ') tail.pop_back();
    if (!tail.empty() && (!unit || tail != unit)) {
        const auto* found =
            std::find_if(std::begin(kUnits), std::end(kUnits), [&](const UnitScale& scale) {
                return unit && tail == scale.typed && !std::strcmp(unit, scale.unit);
            });
        if (found == std::end(kUnits)) return false;
        result *= found->factor;
    }
    value = float(relative ? double(old) + result : result);
    return std::isfinite(value);
}

std::string formatNumber(float value, const char* format) {
    char text[48];
    std::snprintf(text, sizeof text, format, double(std::fabs(value)));
    return (value < 0 && std::strpbrk(text, "123456789") ? "−" : "") + std::string(text);
}

Edit number(const char* id, ImVec2 at, ImVec2 size, float& value, const NumberLook& look,
            const float* standard) {
    const ImGuiID own = ImGui::GetID(id);
    FieldState& state = fieldState();
    if (state.typing == own) return typeNumber(own, at, size, value, look);

    bool hovered = false, held = false;
    hit(id, at, size, &hovered, &held);
    const bool ranged = look.highest > look.lowest;
    auto startTyping = [&] {
        state.typing = own;
        state.fresh = true;
        std::snprintf(state.text, sizeof state.text, look.format, double(value));
        ImGui::ClearActiveID();
    };
    if (hovered) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
    const bool enter =
        ImGui::IsItemFocused() && ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Enter), false);
    if ((hovered && ImGui::IsMouseDoubleClicked(0)) || enter) {
        startTyping();
        return Edit::kNone;
    }
    Edit edit = Edit::kNone;
    if (standard && hovered && ImGui::IsMouseClicked(1) && value != *standard) {
        value = *standard;
        edit = Edit::kTyped;
    }
    // Measured from the press instead of summed up, which is exact at any frame rate.
    const ImGuiIO& io = ImGui::GetIO();
    if (ImGui::IsItemActivated()) {
        state.before = value;
        state.pressX = io.MousePos.x;
        state.moved = false;
    }
    const float dragged = io.MousePos.x - state.pressX;
    if (held && (state.moved || std::fabs(dragged) > dp(3))) {
        state.moved = true;
        const float worth =
            ranged ? (look.highest - look.lowest) / size.x : look.step / theme().scale;
        float wanted = state.before + dragged * worth * (io.KeyShift ? 0.1f : 1.0f);
        if (io.KeyCtrl && look.snap > 0) wanted = std::round(wanted / look.snap) * look.snap;
        if (ranged) wanted = std::clamp(wanted, look.lowest, look.highest);
        if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape)) || io.MouseDown[1]) {
            wanted = state.before;
            ImGui::ClearActiveID();
        }
        if (wanted != value) edit = Edit::kDragging;
        value = wanted;
    }
    if (ImGui::IsItemDeactivated() && state.moved) {
        edit = Edit::kDone;
        state.moved = false;
    }

    ImDrawList* list = ImGui::GetWindowDrawList();
    drawBox(list, at, at + size, colors::well, metrics::radius,
            held      ? colors::accent
            : hovered ? colors::edge
                      : 0);
    if (ranged) {
        const float share =
            std::clamp((value - look.lowest) / (look.highest - look.lowest), 0.0f, 1.0f);
        if (share > 0) {
            list->PushClipRect(at, at + ImVec2(std::max(dp(3), size.x * share), size.y), true);
            drawBox(list, at, at + size,
                    look.fill ? mix(colors::well, look.fill, 0.42f) : hex(0x3A3F4A));
            list->PopClipRect();
        }
    }
    const float y = at.y + size.y * 0.5f;
    if (look.letter)
        drawText(list, fonts().smallSemi, at.x + dp(6), y, look.letterColor, look.letter);
    float x = at.x + size.x - dp(7);
    if (look.unit && *look.unit && !(look.zero && value == 0 && !held)) {
        drawTextRight(list, fonts().small, x, y, colors::dim, look.unit);
        x -= textSize(fonts().small, look.unit).x + dp(4);
    }
    if (look.zero && value == 0 && !held)
        drawTextRight(list, fonts().body, at.x + size.x - dp(7), y, colors::dim, look.zero);
    else
        drawTextRight(list, fonts().body, x, y, colors::title,
                      formatNumber(value, look.format).c_str());
    return edit;
}

bool textField(const char* id, ImVec2 at, ImVec2 size, std::string& text, const char* hint,
               const char* icon, bool focus) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    drawBox(list, at, at + size, colors::well);
    float x = at.x;
    if (icon) {
        drawIcon(list, fonts().icon17, {at.x + dp(13), at.y + size.y * 0.5f}, colors::dim, icon);
        x += dp(20);
    }
    setCursor({x, at.y});
    ImGui::PushItemWidth(at.x + size.x - x);
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding,
                        ImVec2(dp(6), (size.y - ImGui::GetFontSize()) * 0.5f));
    ImGui::PushStyleColor(ImGuiCol_FrameBg, 0);
    if (focus) ImGui::SetKeyboardFocusHere();
    char buffer[512];
    std::snprintf(buffer, sizeof buffer, "%s", text.c_str());
    const std::string hidden = std::string("##") + id;
    const bool entered = ImGui::InputTextWithHint(hidden.c_str(), hint, buffer, sizeof buffer,
                                                  ImGuiInputTextFlags_EnterReturnsTrue);
    text = buffer;
    if (ImGui::IsItemActive())
        list->AddRect(at, at + size, colors::accent, dp(metrics::radius), 0, hairline());
    const bool done = entered || ImGui::IsItemDeactivatedAfterEdit();
    ImGui::PopStyleColor();
    ImGui::PopStyleVar();
    ImGui::PopItemWidth();
    return done;
}

void Rows::label(const char* text) const {
    drawTextFit(list, fonts().body, x0, midY(), dp(labelWidth) - dp(6), colors::dim, text);
}

bool section(Rows& rows, const char* name, bool& open, const char* right) {
    const float height = dp(26);
    const ImVec2 low(rows.x0 - dp(metrics::pad), rows.y);
    const ImVec2 high(rows.x1 + dp(metrics::pad), rows.y + height);
    bool hovered = false;
    if (hit(name, low, high - low, &hovered)) open = !open;
    drawRow(rows.list, low.x, high.x, low.y, colors::gap);
    rows.list->AddRectFilled(low + ImVec2(0, dp(1)), high,
                             hovered ? colors::control : colors::header);
    const float y = rows.y + height * 0.5f;
    drawIcon(rows.list, fonts().icon17, {rows.x0 + dp(4), y}, colors::dim,
             open ? icons::down : icons::right);
    drawText(rows.list, fonts().semi, rows.x0 + dp(16), y, colors::title, name);
    if (right) drawTextRight(rows.list, fonts().small, rows.x1, y, colors::dim, right);
    rows.y = high.y + (open ? dp(8) : 0);
    return open;
}

Edit numberRow(Rows& rows, const char* label, float& value, const NumberLook& look,
               const float* standard) {
    rows.label(label);
    const Edit edit = number(label, {rows.fieldX(), rows.y}, {rows.fieldWidth(), dp(metrics::row)},
                             value, look, standard);
    if (asking()) {
        char range[96] = "";
        if (look.highest > look.lowest)
            std::snprintf(range, sizeof range, "%s to %s %s. ",
                          formatNumber(look.lowest, look.format).c_str(),
                          formatNumber(look.highest, look.format).c_str(),
                          look.unit ? look.unit : "");
        const std::string how = std::string(range) +
                                "Drag it, finely with Shift; double click to type, sums and units "
                                "too; right click puts it back.";
        tip(label, nullptr, how.c_str());
    }
    rows.next();
    return edit;
}

Edit vectorRow(Rows& rows, const char* label, float* values, const NumberLook& look) {
    const float labelWidth =
        drawText(rows.list, fonts().body, rows.x0, rows.midY(), colors::dim, label);
    if (look.unit)
        drawText(rows.list, fonts().small, rows.x0 + labelWidth + dp(4), rows.midY(), colors::dim,
                 look.unit);
    const float x = rows.x0 + dp(78), gap = dp(4);
    const float width = std::floor((rows.x1 - x - 2 * gap) / 3);
    constexpr const char* kLetters[3] = {"X", "Y", "Z"};
    Edit edit = Edit::kNone;
    ImGui::PushID(label);
    for (int i = 0; i < 3; ++i) {
        NumberLook one = look;
        one.unit = nullptr;
        one.letter = kLetters[i];
        one.letterColor = colors::axis[i];
        const ImVec2 at(x + float(i) * (width + gap), rows.y);
        const Edit changed = number(kLetters[i], at, {width, dp(metrics::row)}, values[i], one);
        if (changed != Edit::kNone) edit = changed;
    }
    ImGui::PopID();
    rows.next();
    return edit;
}

ListRow listRow(const char* id, float x0, float x1, float y, bool selected, float height) {
    ListRow row;
    const ImVec2 low(x0, y), high(x1, y + dp(height));
    row.clicked = hit(id, low, high - low, &row.hovered);
    row.opened = row.hovered && ImGui::IsMouseDoubleClicked(0);
    row.midY = (low.y + high.y) * 0.5f;
    ImGui::SetItemAllowOverlap();
    ImDrawList* list = ImGui::GetWindowDrawList();
    if (selected) {
        list->AddRectFilled(low, high, colors::accentSoft);
        list->AddRectFilled(low, {x0 + dp(2), high.y}, colors::accent);
    } else if (row.hovered) {
        list->AddRectFilled(low, high, hex(0xFFFFFF, 12));
    }
    return row;
}

void panelTabs(ImDrawList* list, const Rect& rect, std::initializer_list<const char*> names,
               int& chosen) {
    list->AddRectFilled(rect.low(), rect.high(), colors::header);
    float x = rect.x0 + dp(metrics::pad);
    int i = 0;
    for (const char* name : names) {
        const float width = textSize(fonts().semi, name).x;
        bool hovered = false;
        if (hit(name, {x - dp(6), rect.y0}, {width + dp(12), rect.height()}, &hovered)) chosen = i;
        drawText(list, fonts().semi, x, rect.midY(),
                 i == chosen ? colors::title
                 : hovered   ? colors::text
                             : colors::dim,
                 name);
        if (i == chosen && names.size() > 1)
            list->AddRectFilled({x, rect.y1 - dp(2)}, {x + width, rect.y1}, colors::accent);
        x += width + dp(18);
        ++i;
    }
}

void progressBar(ImDrawList* list, ImVec2 at, float width, float height, float share, ImU32 color) {
    drawBox(list, at, at + ImVec2(width, height), colors::well, 3);
    if (share <= 0) return;
    drawBox(list, at, at + ImVec2(std::max(height, width * std::clamp(share, 0.0f, 1.0f)), height),
            color, 3);
}

}  // namespace fwui
