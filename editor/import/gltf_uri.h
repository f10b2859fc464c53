// Resolves a URI of a glTF file: bytes in the URI itself, or a file beside the glTF file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace fwimport {

struct UriBytes {
    std::vector<uint8_t> bytes;
    bool outside = false;  // the file lies outside the folder
};

// `field`: for messages, such as "images[0].uri". Throws Refusal with the problem and the supported
// forms.
UriBytes readUri(const std::string& uri, const std::filesystem::path& folder,
                 const std::string& field);

// Percent-decodes: %41 is A. A percent sign without two digits stays.
std::string decodePercent(const std::string& uri);

}  // namespace fwimport
