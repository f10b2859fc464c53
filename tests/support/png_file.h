// Pictures as PNG files, through libpng.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace fw::test {

struct Picture {
    uint32_t width = 0, height = 0;
    std::vector<uint8_t> rgb;  // sRGB, rows top first
};

bool readPng(const std::string& path, Picture& picture);
bool writePng(const std::string& path, const Picture& picture);

}  // namespace fw::test
