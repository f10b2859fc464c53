// Images as numbers, from and to PNG, EXR, TIFF and other formats of OpenImageIO. Values are stored
// as they are in the file: no colour conversion, no alpha multiplication.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace fwimport {

struct FloatPicture {
    uint32_t width = 0, height = 0;  // pixels, [1, 16384]
    uint32_t channels = 0;           // [1, 16]
    // The file stores integers; values are scaled to [0, 1].
    bool whole = false;
    std::vector<std::string> names;  // channel names: "R", "G", ...
    std::vector<float> values;       // rows from the top, channels interleaved

    [[nodiscard]] float at(uint32_t x, uint32_t y, uint32_t channel) const {
        return values[(size_t(y) * width + x) * channels + channel];
    }
    // Returns the index of the named channel, or -1. Ignores case.
    [[nodiscard]] int channel(const std::string& name) const;
};

constexpr uint32_t kMaxPictureSide = 16384;  // pixels
constexpr uint32_t kMaxPictureChannels = 16;

// On failure returns false; `error` has the file, the problem and the limit. `picture` is then
// unchanged.
bool readPicture(const std::filesystem::path& path, FloatPicture& picture, std::string& error);
// Writes in the format of the extension: 16 bits per channel for integer images, otherwise floats.
// On failure returns false with `error`; an old file stays intact.
bool writePicture(const std::filesystem::path& path, const FloatPicture& picture,
                  std::string& error);

}  // namespace fwimport
