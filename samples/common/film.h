// What a headless run leaves behind: every frame as PNG, an animated picture, a strip of moments.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/picture.h"

namespace sample {

struct FilmRequest {
    std::filesystem::path folder{};
    std::string name{};  // of the sample: begins the names of the joined pictures
    double framesPerSecond = 30.0;
    uint32_t frames = 1;            // how many will come
    uint32_t animationWidth = 480;  // pixels; the frames are scaled down to it
    uint32_t animationEvery = 1;    // takes each such frame into the animation
    uint32_t moments = 6;           // pictures in the strip
    uint32_t columns = 3;           // of the strip
    uint32_t stripWidth = 640;      // pixels of one picture in the strip
};

class Film {
 public:
    explicit Film(const FilmRequest& request);
    void add(uint32_t number, const Picture& picture);  // from 0, in order
    // Writes what is joined; returns lines for the summary.
    std::vector<std::string> close();

 private:
    FilmRequest made_;
    AnimationWriter animation_;
    std::vector<Picture> moments_;
    uint32_t count_ = 0;
};

}  // namespace sample
