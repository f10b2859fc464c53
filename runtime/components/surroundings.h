// Effects of fires on places around them: heat on a body, hot air, smoke. For a game's damage,
// sight and path finding. Cosmetic floats, from the host's view of the fires.
#pragma once
#include "components/heat_occlusion.h"
#include "volume/collide.h"

#include <cfloat>
#include <cstdint>
#include <span>

namespace fw::components {

using volume::vec3;

constexpr float kMaxHeatFlux = 150000.0f;  // W/m^2, of a full flame

struct FireSource {      // a fire, modelled as a pool fire
    vec3 base{0.0f};     // m
    float radius = 0;    // m
    float height = 0;    // m, of its flame (Heskestad)
    float power = 0;     // kW
    uint32_t id = 0;     // of its FwLight
    bool exact = false;  // a volumetric flame adds heat and temperature elsewhere
};
FireSource fireSource(vec3 base, float radius, float power, uint32_t id) noexcept;

struct SurroundingAir {
    vec3 up{0.0f, 1.0f, 0.0f}, wind{0.0f};    // unit; m/s
    std::span<const volume::Collider> walls;  // stop heat
    OcclusionView occlusion;                  // likewise
};

struct Surroundings {
    float heatFlux = 0;                  // W/m^2 on a small cold body
    float excess = 0;                    // K of the air above ambient
    float smoke = 0;                     // 1/m
    float nearest = FLT_MAX;             // m to the edge of the nearest fire
    const FireSource* source = nullptr;  // the nearest fire
};
Surroundings surroundingsOf(std::span<const FireSource> sources, const SurroundingAir& air,
                            vec3 point) noexcept;
// 1/m, sum over the plumes: 8.7 m^2/g of flaming smoke, 1.5 % of a wood fire's fuel.
float smokeAt(std::span<const FireSource> sources, const SurroundingAir& air, vec3 point) noexcept;
// Transmittance of the smoke between two points, [0, 1].
float sightThrough(std::span<const FireSource> sources, const SurroundingAir& air, vec3 from,
                   vec3 to) noexcept;
// Danger to people, [0, inf): 1 is 2.5 kW/m^2 (pain within half a minute), 60 C, or smoke of 1 1/m,
// a visibility of three metres (limits of ISO 13571).
float spreadRiskOf(const Surroundings& at) noexcept;

}  // namespace fw::components
