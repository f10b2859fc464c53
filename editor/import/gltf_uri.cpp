// See gltf_uri.h.
#include "import/gltf_uri.h"

#include <algorithm>
#include <cctype>
#include <fstream>

#include "import/gltf_import.h"
#include "import/gltf_json.h"

namespace fwimport {
namespace {

namespace fs = std::filesystem;

int hexDigit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    const char low = static_cast<char>(c | 0x20);
    return low >= 'a' && low <= 'f' ? low - 'a' + 10 : -1;
}

int base64Digit(char c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    if (c == '+' || c == '-') return 62;
    return c == '/' || c == '_' ? 63 : -1;
}

std::vector<uint8_t> decodeBase64(std::string_view words, const std::string& field) {
    std::vector<uint8_t> bytes;
    bytes.reserve(words.size() / 4 * 3 + 3);
    uint32_t bits = 0;
    int count = 0;
    for (size_t i = 0; i < words.size(); ++i) {
        const char c = words[i];
        if (c == '=') break;
        if (std::isspace(static_cast<unsigned char>(c))) continue;
        const int digit = base64Digit(c);
        if (digit < 0)
            refuse(field, ": character ", i, " of its base64 is none of A-Z, a-z, 0-9, + and /");
        bits = bits << 6 | static_cast<uint32_t>(digit);
        if ((count += 6) < 8) continue;
        count -= 8;
        bytes.push_back(static_cast<uint8_t>(bits >> count));
    }
    return bytes;
}

// Returns the length of the scheme; 0: none. A single letter is a drive.
size_t schemeLength(const std::string& uri) {
    for (size_t i = 0; i < uri.size(); ++i) {
        const auto c = static_cast<unsigned char>(uri[i]);
        if (c == ':') return i;
        if (!std::isalpha(c) && (i == 0 || (!std::isdigit(c) && c != '+' && c != '-' && c != '.')))
            break;
    }
    return 0;
}

// Compares without case; `lower` is in lower case.
bool isSame(std::string_view words, std::string_view lower) {
    return std::equal(words.begin(), words.end(), lower.begin(), lower.end(), [](char a, char b) {
        return std::tolower(static_cast<unsigned char>(a)) == b;
    });
}

bool isData(const std::string& uri) { return isSame(std::string_view(uri).substr(0, 5), "data:"); }

std::vector<uint8_t> readData(const std::string& uri, const std::string& field) {
    const size_t comma = uri.find(',');
    if (comma == std::string::npos) refuse(field, " is a data URI without a comma");
    const std::string_view kind(uri.data(), comma);
    const std::string words = decodePercent(uri.substr(comma + 1));
    static constexpr std::string_view kBase64 = ";base64";
    if (kind.size() >= kBase64.size() && isSame(kind.substr(kind.size() - kBase64.size()), kBase64))
        return decodeBase64(words, field);
    return {words.begin(), words.end()};
}

std::vector<uint8_t> readFile(const fs::path& path, const std::string& said) {
    std::error_code code;
    const fs::file_status status = fs::status(path, code);
    if (fs::is_directory(status)) refuse(said, " is a folder; it takes a file");
    if (!fs::is_regular_file(status)) refuse(said, " is no regular file");
    const uint64_t size = fs::file_size(path, code);
    if (code) refuse(said, " cannot be read: ", code.message());
    if (size > kMaxFileBytes) refuse(said, " has ", size, " bytes; the limit is ", kMaxFileBytes);
    std::vector<uint8_t> bytes(size);
    std::ifstream file(path, std::ios::binary);
    if (size && !file.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(size)))
        refuse(said, " cannot be read");
    return bytes;
}

}  // namespace

std::string decodePercent(const std::string& uri) {
    std::string result;
    result.reserve(uri.size());
    for (size_t i = 0; i < uri.size(); ++i) {
        const bool code = uri[i] == '%' && i + 2 < uri.size() && hexDigit(uri[i + 1]) >= 0 &&
                          hexDigit(uri[i + 2]) >= 0;
        result +=
            code ? static_cast<char>(hexDigit(uri[i + 1]) * 16 + hexDigit(uri[i + 2])) : uri[i];
        if (code) i += 2;
    }
    return result;
}

UriBytes readUri(const std::string& uri, const fs::path& folder, const std::string& field) {
    if (isData(uri)) return {readData(uri, field), false};
    const std::string said = text(field, " \"", uri.substr(0, 80), "\"");
    if (uri.empty()) refuse(field, " is empty");
    // First reading per the standard: ? and # end the path. Then the readings for writers that do
    // not encode ?, #, % and \ in names.
    std::string decoded = decodePercent(uri);
    const std::string strict = decodePercent(uri.substr(0, uri.find_first_of("?#")));
    std::string turned = strict;
    std::replace(turned.begin(), turned.end(), '\\', '/');
    if (decoded.find('\0') != std::string::npos) refuse(said, " holds a zero byte");
    std::error_code code;
    for (const std::string& reading : {strict, decoded, uri, turned}) {
        if (reading.empty() || fs::path(reading).is_absolute()) continue;
        const fs::path path = folder / fs::path(reading);
        if (!fs::exists(path, code)) continue;
        const fs::path inner = fs::path(reading).lexically_normal();
        return {readFile(path, said), *inner.begin() == ".."};
    }
    if (uri[0] == '/' || uri[0] == '\\' || schemeLength(uri))
        refuse(said, " is absolute; paths relative to the file and data: URIs are read");
    refuse(said, " does not exist", folder.empty() ? "" : " in " + folder.string());
}

}  // namespace fwimport
