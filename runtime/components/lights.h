// Lights that a host can afford, of all fires there are. What burns stays as bright: a fire without
// a light of its own shines from another one's.
#pragma once
#include "flamewright/flamewright.h"

#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

namespace fw::components {

constexpr uint32_t kMostLights = 64;
constexpr float kLightShare = 0.3f;         // of a fire's power leaves as light and heat
constexpr float kSphere = 12.56637f;        // sr
constexpr double kFlickerStep = 0.07 * 60;  // 1/s: how fast a steady fire's light changes at most

// Relative brightness of a fire at a time (s), 1 on the mean: three sines that never meet again, so
// that nothing repeats and no two fires of different phase (rad) flicker alike.
float flicker(double now, double phase) noexcept;
// Of a light's id, rad.
double flickerPhase(uint32_t id) noexcept;

// Chooses at most `most` of `sources` and lets them shine for the others too: `out` holds as much
// intensity and power as `sources`, strongest first. Those whose id is among `kept` count 1.6
// times, so that two that flicker do not take turns. Returns how many; `out` has room for
// `most`, which is at most kMostLights. `taken` is scratch.
uint32_t gatherLights(std::span<const FwLight> sources, std::span<const uint32_t> kept,
                      uint32_t most, std::span<FwLight> out, std::pmr::vector<uint8_t>& taken);

// Moves what is shown towards what is known, by its id, as one filter of 0.1 s for all: new ones
// grow, those that went fade (at most `most` in all), and the sum changes as that of `known` does.
void followLights(std::pmr::vector<FwLight>& shown, std::span<const FwLight> known, float seconds,
                  uint32_t most);

}  // namespace fw::components
