// The editor's controls, placed manually on a panel's draw list: buttons, choices, numbers,
// inspector rows, splitters. They handle mouse and keyboard and do not depend on the document.
#pragma once

#include <initializer_list>
#include <span>
#include <string>

#include "shell/draw.h"

namespace fwui {

// A borderless window that fills `rect`. `front`: may be raised above others.
ImDrawList* beginPanel(const char* name, const Rect& rect, ImU32 fill = colors::panel,
                       bool scrolls = false, bool front = false);
void endPanel();
// A draggable gap between two panels: 6 wide to grab, 2 wide to see. A double click restores
// `design`.
struct SplitterRequest {
    bool vertical = true;
    float at = 0, from = 0, to = 0;             // pixels
    float design = 0, lowest = 0, highest = 0;  // design pixels
    float sign = 1;                             // sign of the size relative to mouse motion
};
void splitter(const char* id, const SplitterRequest& request, float& size);

// An invisible button. Draws the keyboard focus ring.
bool hit(const char* id, ImVec2 low, ImVec2 size, bool* hovered = nullptr, bool* held = nullptr);
// Help mode: pointing explains an item at once, and a click ends the mode.
bool& asking();
// Tooltip of the last item, after the mouse has rested on it.
void tip(const char* name, const char* keys = nullptr, const char* more = nullptr);

struct ToolLook {
    const char* icon = "";
    const char* label = nullptr;
    bool active = false, enabled = true, mirrored = false, drops = false;
};
bool toolButton(const char* id, ImVec2 at, const ToolLook& look, const char* name,
                const char* keys = nullptr);
float toolButtonWidth(const ToolLook& look);

enum class ButtonKind { kPlain, kPrimary, kGhost, kDanger };
bool button(const char* id, ImVec2 at, ImVec2 size, const char* label,
            ButtonKind kind = ButtonKind::kPlain, const char* icon = nullptr,
            const char* keys = nullptr);
bool iconButton(const char* id, ImVec2 centre, const char* icon, ImU32 color, const char* name);
// A choice of up to five options, all visible.
bool segments(const char* id, ImVec2 at, ImVec2 size, std::initializer_list<const char*> names,
              int& chosen);
bool toggle(const char* id, ImVec2 at, bool& on);
// The closed face of a list. A click opens the popup `id`.
bool dropdown(const char* id, ImVec2 at, ImVec2 size, const char* value,
              const char* icon = nullptr);
// Enclose menuItem() calls, below the item `id`. Returns false while closed.
bool beginMenu(const char* id, ImVec2 at, float width);
void endMenu();
bool menuItem(const char* label, const char* icon = nullptr, const char* keys = nullptr,
              bool enabled = true, bool chosen = false);
void menuLine();
// A choice from a list of any length, with face and menu.
bool choice(const char* id, ImVec2 at, ImVec2 size, std::span<const char* const> names, int& chosen,
            const char* icon = nullptr);

// State of a number edit for undo: one step from press to release.
enum class Edit { kNone, kDragging, kDone, kTyped };
struct NumberLook {
    const char* unit = nullptr;
    const char* format = "%.2f";
    float lowest = 0, highest = 0;  // equal: any number, no fill
    float step = 0.01f;             // change per pixel without a range
    float snap = 0;                 // with Ctrl; 0: none
    float least = 0, most = 0;      // limits for typed values; equal: as the range
    ImU32 fill = 0;
    const char* zero = nullptr;    // text instead of 0, where 0 has a special meaning
    const char* letter = nullptr;  // letter of an axis
    ImU32 letterColor = 0;
};
// Drag (Shift: a tenth, Ctrl: snap); double click or Enter to type ("12 cm", "1/3", "+5"); right
// click resets to `standard`; Escape restores the old value.
Edit number(const char* id, ImVec2 at, ImVec2 size, float& value, const NumberLook& look,
            const float* standard = nullptr);
// Parses typed text: sums, products, units compatible with `unit`. "++5" and "--5" are relative to
// the old value. Returns false if it is not a number.
bool parseNumber(const std::string& text, const char* unit, float old, float& value);
std::string formatNumber(float value, const char* format);  // with a real minus sign, never "-0.00"

// A text field. Returns true when Enter or a click elsewhere ends the edit.
bool textField(const char* id, ImVec2 at, ImVec2 size, std::string& text, const char* hint,
               const char* icon = nullptr, bool focus = false);

// Inspector rows, top down. All fields share one left and one right edge.
struct Rows {
    ImDrawList* list;
    float x0, x1, y;
    float labelWidth = metrics::label;
    float fieldX() const { return x0 + dp(labelWidth); }
    float fieldWidth() const { return x1 - fieldX(); }
    float midY() const { return y + dp(metrics::row) * 0.5f; }
    void label(const char* text) const;
    void next(float extra = 0) { y += dp(metrics::row) + dp(4) + dp(extra); }
};
bool section(Rows& rows, const char* name, bool& open, const char* right = nullptr);
Edit numberRow(Rows& rows, const char* label, float& value, const NumberLook& look,
               const float* standard = nullptr);
// Three numbers with axis letters. `which`: the changed one.
Edit vectorRow(Rows& rows, const char* label, float* values, const NumberLook& look);

struct ListRow {
    bool clicked = false, hovered = false, opened = false;  // opened: double-clicked
    float midY = 0;
};
ListRow listRow(const char* id, float x0, float x1, float y, bool selected, float height = 24);
void panelTabs(ImDrawList* list, const Rect& rect, std::initializer_list<const char*> names,
               int& chosen);
void progressBar(ImDrawList* list, ImVec2 at, float width, float height, float share, ImU32 color);

}  // namespace fwui
