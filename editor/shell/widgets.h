// The editor's controls, placed by hand on a panel's draw list: buttons, choices, numbers, rows of
// an inspector, splitters. Each takes the mouse and the keyboard; none knows the document.
#pragma once

#include <initializer_list>
#include <span>
#include <string>

#include "shell/draw.h"

namespace fwui {

// A borderless window that fills `rect`. `front`: may come before the others.
ImDrawList* beginPanel(const char* name, const Rect& rect, ImU32 fill = colors::panel,
                       bool scrolls = false, bool front = false);
void endPanel();
// The gap between two panels as a handle: 6 of grab, 2 of line; a double click brings `design`
// back.
struct SplitterRequest {
    bool vertical = true;
    float at = 0, from = 0, to = 0;             // pixels
    float design = 0, lowest = 0, highest = 0;  // design pixels
    float sign = 1;                             // of the size against the mouse
};
void splitter(const char* id, const SplitterRequest& request, float& size);

// The button without a look. Draws the ring of keyboard focus.
bool hit(const char* id, ImVec2 low, ImVec2 size, bool* hovered = nullptr, bool* held = nullptr);
// While true the mouse asks: what it points at is explained at once, and clicks end the asking.
bool& asking();
// Of the item made last: after the mouse has rested there.
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
// One choice of up to five, all visible.
bool segments(const char* id, ImVec2 at, ImVec2 size, std::initializer_list<const char*> names,
              int& chosen);
bool toggle(const char* id, ImVec2 at, bool& on);
// The closed face of a list; opens the popup "id" when it is clicked.
bool dropdown(const char* id, ImVec2 at, ImVec2 size, const char* value,
              const char* icon = nullptr);
// Begin and end around menuItem()s, below the item of that id; false: closed.
bool beginMenu(const char* id, ImVec2 at, float width);
void endMenu();
bool menuItem(const char* label, const char* icon = nullptr, const char* keys = nullptr,
              bool enabled = true, bool chosen = false);
void menuLine();
// A choice from a list of any length, face and menu together.
bool choice(const char* id, ImVec2 at, ImVec2 size, std::span<const char* const> names, int& chosen,
            const char* icon = nullptr);

// How a change of a number goes into undo: one step from press to release.
enum class Edit { kNone, kDragging, kDone, kTyped };
struct NumberLook {
    const char* unit = nullptr;
    const char* format = "%.2f";
    float lowest = 0, highest = 0;  // equal: any number, and no fill
    float step = 0.01f;             // a pixel's worth where there is no range
    float snap = 0;                 // with Ctrl; 0: none
    float least = 0, most = 0;      // of what is typed; equal: as the range
    ImU32 fill = 0;
    const char* zero = nullptr;    // said instead of 0, where that stands for something else
    const char* letter = nullptr;  // of an axis
    ImU32 letterColor = 0;
};
// Drag (Shift: a tenth, Ctrl: snap), double click or Enter types ("12 cm", "1/3", "+5"), right
// click resets to `standard`. Escape puts the old value back.
Edit number(const char* id, ImVec2 at, ImVec2 size, float& value, const NumberLook& look,
            const float* standard = nullptr);
// What a number field makes of a typed text: sums, products, units of `unit`'s kind; "+5" and "-5"
// after another value are relative only with a leading sign doubled ("++5"). False: not a number.
bool parseNumber(const std::string& text, const char* unit, float old, float& value);
std::string formatNumber(float value, const char* format);  // with a true minus, never "-0.00"

// A line of text in a well. Returns true when Enter or a click elsewhere ends it.
bool textField(const char* id, ImVec2 at, ImVec2 size, std::string& text, const char* hint,
               const char* icon = nullptr, bool focus = false);

// Rows of an inspector, downwards; all fields share one left and one right edge.
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
// Three numbers with the letters of their axes. `which`: of them changed.
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
