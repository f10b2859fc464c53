// Keys by the names on their caps, "Ctrl+Shift+S", and which command has them. Commands of
// different pages may share keys; two that can be meant at once may not.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace fwedit {

struct KeyPress {
    int code = 0;  // GLFW's number of the key
    bool ctrl = false, shift = false;
    bool operator==(const KeyPress&) const = default;
};

// Nothing: these are no keys, or keys that no command may have (Esc, Enter, modifiers alone).
std::optional<KeyPress> parseKeys(std::string_view words);
std::string printKeys(const KeyPress& keys);  // empty: the key has no name here

constexpr int kEveryPage = -2, kEveryPageOfAScene = -3;
struct KeyUse {
    std::string_view command;
    std::string_view keys;  // empty: none
    int page = kEveryPage;  // or the number of a page
};
// The command that already means these keys where `page` is seen, other than `command`. Null: none.
const KeyUse* keyConflict(std::span<const KeyUse> uses, std::string_view command,
                          const KeyPress& keys, int page);

}  // namespace fwedit
