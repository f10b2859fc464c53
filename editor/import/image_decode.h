// Decodes an image in memory by its magic bytes: PNG, JPEG, EXR, TIFF, HDR, DDS, WebP. Output:
// RGBA8, one level.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace fwimport {

struct DecodedImage {
    uint32_t width = 0, height = 0;  // pixels, [1, 8192]
    std::vector<uint8_t> rgba;       // as stored (sRGB for colour), rows from the top
};

constexpr uint32_t kMaxImageSide = 8192;  // pixels

// Memory that a file of `packed` bytes may unpack to, so that a small file cannot use up a
// machine's.
constexpr uint64_t mostUnpacked(uint64_t packed) {
    return std::max(uint64_t{240} << 20, 100 * packed);
}

// Inverse sRGB transfer function for values in [0, 1].
double toLinear(double stored);
double toSrgb(double linear);

// On failure returns false with `error`; `image` is then unchanged. `mostMemory`: a second limit of
// what decoding may take, in bytes.
bool decodeImage(std::span<const uint8_t> bytes, DecodedImage& image, std::string& error,
                 uint64_t mostMemory = UINT64_MAX);

}  // namespace fwimport
