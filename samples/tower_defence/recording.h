// What a hand did in a window, frame by frame, in a file; and the same again without a window.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "common/stage.h"

namespace tower {

// Writes while it is played.
class Recorder {
 public:
    Recorder(const std::filesystem::path& path, uint32_t seed);
    void frame(const sample::StageFrame& frame);
    void moment();  // the picture of the frame before the last is one to compare

 private:
    std::ofstream file_;
};

// Reads all of it. Throws Failure where the file is none, or of another seed.
class Recording {
 public:
    Recording(const std::filesystem::path& path, uint32_t seed);
    uint32_t frames() const { return uint32_t(frames_.size()); }
    // Puts what there was into a frame; throws Failure where that had another size.
    void put(sample::StageFrame& frame) const;
    bool isMoment(uint32_t number) const { return frames_[number].moment; }

 private:
    struct Frame {
        float deltaTime = 0;
        uint32_t width = 0, height = 0;
        sample::Input input;
        bool moment = false;
    };
    std::vector<Frame> frames_;
};

}  // namespace tower
