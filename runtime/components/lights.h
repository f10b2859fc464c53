// A limited number of lights for all fires. Total brightness stays: a fire without its own light
// shines from another one's.
#pragma once
#include "flamewright/flamewright.h"

#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

namespace fw::components {

constexpr float kLightShare = 0.3f;   // radiated share of a fire's power
constexpr float kSphere = 12.56637f;  // sr

// Relative brightness of a fire at a time (s), mean 1: three sines without a common period, so that
// the flicker never repeats. `phase`: rad, different for each fire.
float flicker(double now, double phase) noexcept;
// rad, from a light's id.
double flickerPhase(uint32_t id) noexcept;

// Chooses at most `most` of `sources`, which take over the intensity and power of the others.
// `out`: strongest first. Ids in `kept` count 1.6 times, so that two flickering lights do not
// alternate. Returns the count. `out` holds `most`, at most limits::kLights. `taken` is scratch.
uint32_t gatherLights(std::span<const FwLight> sources, std::span<const uint32_t> kept,
                      uint32_t most, std::span<FwLight> out, std::pmr::vector<uint8_t>& taken);

// Moves `shown` towards `known`, by id, with one filter of 0.1 s: new lights grow, missing ones
// fade (at most `most` in all), and the sum follows the sum of `known`.
void followLights(std::pmr::vector<FwLight>& shown, std::span<const FwLight> known, float seconds,
                  uint32_t most);

}  // namespace fw::components
