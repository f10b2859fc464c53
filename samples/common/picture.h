// Pictures on disk: PNG, animated PNG (full colour, shown by browsers and GitHub), contact sheets.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace sample {

struct Picture {
    uint32_t width = 0, height = 0;  // pixels
    std::vector<uint8_t> rgba;       // display-referred, rows top first, tightly packed
};

// Creates the folder if necessary. Drops alpha. Throws Failure with the path.
void writePng(const std::filesystem::path& path, const Picture& picture);

// Scales a picture down by area averaging.
Picture resized(const Picture& picture, uint32_t width, uint32_t height);

// Arranges pictures of equal size in rows of `columns`, with `gap` near-black pixels between them.
Picture contactSheet(std::span<const Picture> pictures, uint32_t columns, uint32_t gap = 4);

// Writes an animated PNG. Each frame after the first stores only its changes, so a static camera
// costs little. close() writes the file.
class AnimationWriter {
 public:
    AnimationWriter(std::filesystem::path path, double framesPerSecond);
    void add(const Picture& picture);  // all of the same size
    // Writes the file and holds the last frame for `holdSeconds`. Writes nothing without frames.
    void close(double holdSeconds = 1.0);
    uint32_t frames() const { return frameCount_; }

 private:
    std::filesystem::path path_;
    double framesPerSecond_;
    uint32_t width_ = 0, height_ = 0, frameCount_ = 0, sequence_ = 0;
    std::vector<uint8_t> shown_;  // rgba that a viewer shows now
    std::vector<uint8_t> chunks_;
    size_t lastControl_ = 0;  // offset of the last frame's control chunk in chunks_
};

}  // namespace sample
