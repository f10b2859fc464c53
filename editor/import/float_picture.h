// A picture as numbers, from and to the files that painters and renderers write: PNG, EXR, TIFF and
// what else OpenImageIO knows. Data as much as colour: values are as the file has
// them, no colour space is undone, no alpha multiplied.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace fwimport {

struct FloatPicture {
    uint32_t width = 0, height = 0;  // pixels, [1, 16384]
    uint32_t channels = 0;           // [1, 16]
    // Its file stores whole numbers; values are then of its range, [0, 1].
    bool whole = false;
    std::vector<std::string> names;  // of the channels: "R", "G", ...
    std::vector<float> values;       // rows top first, channels beside each other

    [[nodiscard]] float at(uint32_t x, uint32_t y, uint32_t channel) const {
        return values[(size_t(y) * width + x) * channels + channel];
    }
    // Number of the channel of that name, or -1. Case does not matter.
    [[nodiscard]] int channel(const std::string& name) const;
};

constexpr uint32_t kMaxPictureSide = 16384;  // pixels
constexpr uint32_t kMaxPictureChannels = 16;

// False: `error` names the file, what is wrong with it and the limit; `picture` is untouched.
bool readPicture(const std::filesystem::path& path, FloatPicture& picture, std::string& error);
// In the format of the path's extension: 16 bits a channel where the picture is of whole numbers,
// else floats. False: `error` says why, and there is no such file or the old one.
bool writePicture(const std::filesystem::path& path, const FloatPicture& picture,
                  std::string& error);

}  // namespace fwimport
