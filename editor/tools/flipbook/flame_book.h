// A flame of an artist's as a flipbook: of any size and shape, a loop. Names nothing of the
// runtime.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace fwtools {

struct FlameBookDef {
    uint32_t preset = 0;                // FwFirePreset, of its looks
    float power = 60, diameter = 0.6f;  // kW, m
    std::span<const float> texels;      // of its profile, as FwFireProfileDef's; none: see cooked
    uint32_t width = 0, height = 0;     // of texels
    std::span<const std::byte> cooked;  // a .fwprofile; none: the preset's
    uint32_t frames = 32, side = 64;    // [2, 256]; texels, [8, 512]
    uint32_t seed = 1, samples = 2;     // rays per texel, [1, 16]
    float seconds = 1.6f;               // a turn
    uint32_t threads = 1;
};
// The bytes of a .fwbook. `progress`: its share, from any one thread at a time; false stops, and
// `error` is then empty. False else: `error`.
bool bakeFlameBook(const FlameBookDef& def, const std::function<bool(float)>& progress,
                   std::vector<std::byte>& bytes, std::string& error);

}  // namespace fwtools
