// From rendered frames to a book: a loop is closed, motion that nobody knows is found, all of it
// becomes bytes. And what a book looks like, for people. No files.
#pragma once
#include "scene.h"

#include <functional>

namespace fwtools {

// Runs `work` for 0 .. count - 1 on as many threads as asked for.
void inParallel(uint32_t count, uint32_t threads, const std::function<void(uint32_t)>& work);

// The motion, uv per frame, that makes a frame the next: by blocks, coarse to fine. Of what is seen
// (hidden share and how hot); where nothing is it is that of what is near.
std::vector<vec2> findMotion(const Frame& now, const Frame& next, uint32_t width, uint32_t height,
                             uint32_t motionWidth, uint32_t motionHeight);

// `frames`: as many as the scene has. Of a loop those past its end fade into its beginning.
fw::book::Book finishBook(const fw::book::Facts& facts, std::vector<Frame>& frames,
                          uint32_t threads, std::pmr::memory_resource* memory);

// Pictures, sRGB bytes, top row first: eight moments of a book in a row, over dark grey or sky.
struct Picture {
    uint32_t width = 0, height = 0;
    std::vector<uint8_t> rgb;
};
Picture makeSheet(const std::vector<fw::book::Book>& books);

}  // namespace fwtools
