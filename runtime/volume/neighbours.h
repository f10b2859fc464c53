// Flames side by side: they draw in each other's air, lean together, and merge where they are
// taller than the gap between them. Smooth in every distance: nothing pops.
#pragma once
#include "volume/curve.h"

#include <cstdint>
#include <span>

namespace fw::volume {

struct NeighbourFlame {
    vec3 base{0.0f};        // m
    float power = 0.0f;     // kW
    float diameter = 0.0f;  // m
    float height = 0.0f;    // m, alone
};

struct Neighbourhood {
    vec3 pull{0.0f};      // m/s, at the visible height, across `up`
    float height = 0.0f;  // m, with the others
    float merged = 0.0f;  // [0, 1], 1: one flame with others
};

// Speed of air towards a fire at a distance, m/s. Entrainment: 0.12 of the plume's speed, falling
// as 1/d.
float inflow(float power, float diameter, float distance) noexcept;
// O(n^2) over at most a few hundred. `out` is as long as `flames`.
void updateNeighbours(std::span<const NeighbourFlame> flames, vec3 up,
                      std::span<Neighbourhood> out) noexcept;

}  // namespace fw::volume
