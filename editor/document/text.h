// Words and numbers of the document's files and commands.
#pragma once

#include <string>
#include <string_view>

#include "document/scene.h"

namespace fwedit {

template <typename... Parts>
std::string join(const Parts&... parts) {
    std::string text;
    ((text += parts), ...);
    return text;
}

// Returns the shortest decimal that parses to the same float.
std::string printNumber(double value);
// Checks the number of words against [least, most]. On failure returns false with the expected form
// in `error`.
bool need(const std::vector<std::string>& words, size_t least, size_t most, const char* form,
          std::string& error);
std::string inQuotes(std::string_view text);
std::string shortened(const std::string& text);  // for undo: at most 40 characters (not bytes)
// Returns valid UTF-8 of at most `most` bytes, without control characters.
std::string cleanText(std::string_view text, size_t most);
// Resolves a target: a name, or #id. Returns 0 if there is none.
ObjectId findByWord(const Scene& scene, std::string_view word);

}  // namespace fwedit
