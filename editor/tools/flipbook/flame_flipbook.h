// Bakes a custom flame into a looping flipbook. Independent of the runtime's headers.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace fwtools {

struct FlameFlipbookDef {
    uint32_t preset = 0;                // FwFirePreset, for its appearance
    float power = 60, diameter = 0.6f;  // kW, m
    std::span<const float> texels;      // profile as in FwFireProfileDef; empty: see cooked
    uint32_t width = 0, height = 0;     // size in texels
    std::span<const std::byte> cooked;  // a .fwprofile; empty: the preset's
    uint32_t frames = 32, side = 64;    // [2, 256]; texels, [8, 512]
    uint32_t seed = 1, samples = 2;     // rays per texel, [1, 16]
    float seconds = 1.6f;               // per loop
    uint32_t threads = 1;
};
// Returns the bytes of a .fwbook. `progress`: receives the share done, from one thread at a time;
// false cancels, with an empty `error`. On failure returns false with `error`.
bool bakeFlameFlipbook(const FlameFlipbookDef& def, const std::function<bool(float)>& progress,
                       std::vector<std::byte>& bytes, std::string& error);

}  // namespace fwtools
