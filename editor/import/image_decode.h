// Decodes a picture in memory, by its first bytes: PNG, JPEG, EXR, TIFF, HDR, DDS, WebP.
// Not a texture: eight bits per channel, RGBA, one level.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace fwimport {

struct DecodedImage {
    uint32_t width = 0, height = 0;  // pixels, [1, 8192]
    std::vector<uint8_t> rgba;       // as stored (sRGB for colour), rows top first
};

constexpr uint32_t kMaxImageSide = 8192;  // pixels

// The curve of sRGB, of values in [0, 1].
double toLinear(double stored);
double toSrgb(double linear);

// False: `error` says why and `image` is untouched.
bool decodeImage(std::span<const uint8_t> bytes, DecodedImage& image, std::string& error);

}  // namespace fwimport
