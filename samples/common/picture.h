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

// Creates the folder if need be. Throws Failure with the path. Alpha is not written.
void writePng(const std::filesystem::path& path, const Picture& picture);

// Area-averaged; for making a picture smaller.
Picture resized(const Picture& picture, uint32_t width, uint32_t height);

// Pictures of equal size in rows of `columns`, `gap` pixels of near-black between them.
Picture contactSheet(std::span<const Picture> pictures, uint32_t columns, uint32_t gap = 4);

// An animated PNG. Each frame after the first stores only what changed, so that a still camera
// costs little. Nothing is written before close().
class AnimationWriter {
 public:
    AnimationWriter(std::filesystem::path path, double framesPerSecond);
    void add(const Picture& picture);  // all of one size
    // Writes the file, holding the last frame for `holdSeconds`. Without frames: nothing.
    void close(double holdSeconds = 1.0);
    uint32_t frames() const { return frameCount_; }

 private:
    std::filesystem::path path_;
    double framesPerSecond_;
    uint32_t width_ = 0, height_ = 0, frameCount_ = 0, sequence_ = 0;
    std::vector<uint8_t> shown_;  // what a viewer has on screen now, rgba
    std::vector<uint8_t> chunks_;
    size_t lastControl_ = 0;  // where the last frame's control chunk begins in chunks_
};

}  // namespace sample
