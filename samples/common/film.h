// Output of a headless run: each frame as PNG, an animated picture, and a strip of stills.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/picture.h"

namespace sample {

struct FilmRequest {
    std::filesystem::path folder{};
    std::string name{};  // name of the sample; prefix of the combined pictures
    double framesPerSecond = 30.0;
    uint32_t frames = 1;            // total number of frames
    uint32_t animationWidth = 480;  // pixels; frames are scaled down to it
    uint32_t animationEvery = 1;    // one frame in so many enters the animation
    uint32_t stripCount = 6;        // pictures in the strip
    uint32_t columns = 3;           // of the strip
    uint32_t stripWidth = 640;      // pixels of one still in the strip
};

class Film {
 public:
    explicit Film(const FilmRequest& request);
    void add(uint32_t number, const Picture& picture);  // `number`: from 0, in order
    // Writes the combined pictures. Returns lines for the summary.
    std::vector<std::string> close();

 private:
    FilmRequest made_;
    AnimationWriter animation_;
    std::vector<Picture> strip_;
    uint32_t count_ = 0;
};

}  // namespace sample
