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

// Shortest decimal that reads back as the same float.
std::string printNumber(double value);
// "a \"b\"": in quotes, with \" and \\ within them.
// False, and what it takes in `error`, unless a line has at least and at most so many words.
bool need(const std::vector<std::string>& words, size_t least, size_t most, const char* form,
          std::string& error);
std::string inQuotes(std::string_view text);
std::string shortened(const std::string& text);  // for undo: at most 40 characters, not bytes
// Without control characters, as valid UTF-8, of at most `most` bytes.
std::string cleanText(std::string_view text, size_t most);
// A target's word: a name, or #id. 0: there is none.
ObjectId findByWord(const Scene& scene, std::string_view word);

}  // namespace fwedit
