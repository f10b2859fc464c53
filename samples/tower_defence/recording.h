// Records window input per frame into a file, and replays it without a window.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "common/stage.h"

namespace tower {

// Writes the file while the game runs.
class Recorder {
 public:
    Recorder(const std::filesystem::path& path, uint32_t seed);
    void frame(const sample::StageFrame& frame);
    void markPicture();  // marks the picture of the frame before the last for comparison

 private:
    std::ofstream file_;
};

// Loads a recording. Throws Failure if the file is not one, or has another seed.
class Recording {
 public:
    Recording(const std::filesystem::path& path, uint32_t seed);
    uint32_t frames() const { return uint32_t(frames_.size()); }
    // Copies the recorded input into a frame. Throws Failure if the frame has another size.
    void put(sample::StageFrame& frame) const;
    bool isMarked(uint32_t number) const { return frames_[number].isMarked; }

 private:
    struct Frame {
        float deltaTime = 0;
        uint32_t width = 0, height = 0;
        sample::Input input;
        bool isMarked = false;
    };
    std::vector<Frame> frames_;
};

}  // namespace tower
