// See text.h.
#include "document/text.h"

#include <charconv>

namespace fwedit {
namespace {

// Returns the byte count of the UTF-8 character at the start of `text`; 0: invalid.
size_t characterBytes(std::string_view text) {
    const auto byte = [&](size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned char first = byte(0);
    if (first < 0x80) return 1;
    const size_t bytes = first >= 0xf0 && first < 0xf5   ? 4
                         : first >= 0xe0 && first < 0xf0 ? 3
                         : first >= 0xc2 && first < 0xe0 ? 2
                                                         : 0;
    if (bytes == 0 || bytes > text.size()) return 0;
    for (size_t i = 1; i < bytes; ++i)
        if ((byte(i) & 0xc0) != 0x80) return 0;
    // Overlong forms, surrogates, values beyond the last plane.
    if ((first == 0xe0 && byte(1) < 0xa0) || (first == 0xed && byte(1) >= 0xa0) ||
        (first == 0xf0 && byte(1) < 0x90) || (first == 0xf4 && byte(1) >= 0x90))
        return 0;
    return bytes;
}

}  // namespace

std::string printNumber(double value) {
    char text[64];
    const auto result = std::to_chars(text, text + sizeof text, static_cast<float>(value) + 0.0f);
    return {text, result.ptr};
}

bool need(const std::vector<std::string>& words, size_t least, size_t most, const char* form,
          std::string& error) {
    if (words.size() >= least && words.size() <= most) return true;
    error = std::string("it takes: ") + form;
    return false;
}

std::string inQuotes(std::string_view text) {
    std::string result = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') result += '\\';
        result += c;
    }
    return result + '"';
}

std::string cleanText(std::string_view text, size_t most) {
    std::string result;
    while (!text.empty()) {
        const size_t bytes = characterBytes(text);
        if (result.size() + std::max<size_t>(bytes, 1) > most) break;
        if (bytes == 0)
            result += '?';
        else if (bytes == 1 && (static_cast<unsigned char>(text[0]) < 0x20 || text[0] == 0x7f))
            result += ' ';
        else
            result += text.substr(0, bytes);
        text.remove_prefix(bytes == 0 ? 1 : bytes);
    }
    return result;
}

ObjectId findByWord(const Scene& scene, std::string_view word) {
    if (!word.empty() && word[0] == '#') {
        ObjectId id = 0;
        const char* end = word.data() + word.size();
        const auto [at, code] = std::from_chars(word.data() + 1, end, id);
        if (code == std::errc{} && at == end) return findObject(scene, id) ? id : 0;
    }
    ObjectId found = 0;
    forEachList(scene, [&](Kind, const auto& list) {
        for (const auto& object : list)
            if (found == 0 && object.name == word) found = object.id;
    });
    return found;
}

std::string shortened(const std::string& text) {
    size_t characters = 0;
    for (size_t i = 0; i < text.size(); ++i) {
        if ((static_cast<unsigned char>(text[i]) & 0xc0) == 0x80) continue;
        if (++characters == 40) {
            size_t left = 0;
            for (size_t j = i; j < text.size(); ++j)
                left += (static_cast<unsigned char>(text[j]) & 0xc0) != 0x80;
            return left > 1 ? text.substr(0, i) + "…" : text;
        }
    }
    return text;
}

}  // namespace fwedit
