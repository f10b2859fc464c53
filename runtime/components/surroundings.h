// What fire does to the places around it: heat on a body, hot air, smoke before the eyes. For a
// game's damage, its characters' eyes and their ways. Cosmetic floats, from fires as a host sees
// them.
#pragma once
#include "components/heat_shield.h"
#include "volume/collide.h"

#include <cfloat>
#include <cstdint>
#include <span>

namespace fw::components {

using volume::vec3;

constexpr float kMostHeatFlux = 150000.0f;  // W/m^2, of a full flame

struct FireSource {      // something that burns, as a pool fire
    vec3 base{0.0f};     // m
    float radius = 0;    // m
    float height = 0;    // m, of its flame (Heskestad)
    float power = 0;     // kW
    uint32_t id = 0;     // of its FwLight
    bool exact = false;  // heat and temperature come from the flame itself, elsewhere
};
FireSource fireSource(vec3 base, float radius, float power, uint32_t id) noexcept;

struct SurroundingAir {
    vec3 up{0.0f, 1.0f, 0.0f}, wind{0.0f};    // unit; m/s
    std::span<const volume::Collider> walls;  // that shade heat
    ShieldView shield;                        // as these
};

struct Surroundings {
    float heatFlux = 0;                  // W/m^2 on a small cold body
    float excess = 0;                    // K of the air above the ambient's
    float smoke = 0;                     // 1/m
    float nearest = FLT_MAX;             // m to the edge of the nearest
    const FireSource* source = nullptr;  // that
};
Surroundings surroundingsOf(std::span<const FireSource> sources, const SurroundingAir& air,
                            vec3 point) noexcept;
// 1/m, of the plumes of all: 8.7 m^2/g of flaming smoke, 1.5 % of a wood fire's fuel.
float smokeAt(std::span<const FireSource> sources, const SurroundingAir& air, vec3 point) noexcept;
// [0, 1]: how much of the light from one point reaches the other through smoke.
float sightThrough(std::span<const FireSource> sources, const SurroundingAir& air, vec3 from,
                   vec3 to) noexcept;
// Of what people bear: 1 is 2.5 kW/m^2 (pain within half a minute), 60 C, or smoke of 1 1/m, in
// which one sees three metres (ISO 13571's limits). 0 is no danger; without an upper end.
float dangerOf(const Surroundings& at) noexcept;

}  // namespace fw::components
