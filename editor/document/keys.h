// Key combinations by name, such as "Ctrl+Shift+S", and their commands. Commands on different pages
// may share keys. Commands that are active together may not.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace fwedit {

struct KeyPress {
    int code = 0;  // GLFW key code
    bool ctrl = false, shift = false;
    bool operator==(const KeyPress&) const = default;
};

// Returns nothing for unknown keys and for reserved ones (Esc, Enter, modifiers alone).
std::optional<KeyPress> parseKeys(std::string_view words);
std::string printKeys(const KeyPress& keys);  // empty: the key has no name

constexpr int kEveryPage = -2, kEveryPageOfAScene = -3;
struct KeyUse {
    std::string_view command;
    std::string_view keys;  // empty: none
    int page = kEveryPage;  // or the index of a page
};
// Returns the command, other than `command`, that already uses these keys on `page`; null: none.
const KeyUse* keyConflict(std::span<const KeyUse> uses, std::string_view command,
                          const KeyPress& keys, int page);

}  // namespace fwedit
