// Converts rendered frames to a flipbook: closes the loop, estimates missing motion, encodes bytes.
// Also renders contact sheets. No files.
#pragma once
#include "scene.h"

#include <functional>

namespace fwtools {

// Runs `work` for 0 .. count - 1 on `threads` threads.
void inParallel(uint32_t count, uint32_t threads, const std::function<void(uint32_t)>& work);

// Estimates the motion to the next frame, uv per frame, by hierarchical block matching of the
// visible content (coverage and heat). Empty regions take the motion of their neighbours.
std::vector<vec2> findMotion(const Frame& now, const Frame& next, uint32_t width, uint32_t height,
                             uint32_t motionWidth, uint32_t motionHeight);

// `frames`: all frames of the scene. For a loop, those past its end fade into its start.
fw::flipbook::Flipbook finishFlipbook(const fw::flipbook::Facts& facts, std::vector<Frame>& frames,
                                      uint32_t threads, std::pmr::memory_resource* memory);

// Images, sRGB bytes, top row first: eight frames of a flipbook in a row, over dark grey or sky.
struct Picture {
    uint32_t width = 0, height = 0;
    std::vector<uint8_t> rgb;
};
Picture makeSheet(const std::vector<fw::flipbook::Flipbook>& flipbooks);

}  // namespace fwtools
