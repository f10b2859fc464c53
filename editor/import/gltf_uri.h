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

// `field` is its name for messages: "images[0].uri". Throws Refusal: what it is, and what is read.
UriBytes readUri(const std::string& uri, const std::filesystem::path& folder,
                 const std::string& field);

// As glTF writes them: %41 is A; a percent sign without two digits stands for itself.
std::string decodePercent(const std::string& uri);

}  // namespace fwimport
