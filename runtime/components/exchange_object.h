// An object's record for the exchange: pose and powers become integers here, so that every backend
// computes with the same numbers. ExchangeSystem finds neighbours.
#pragma once
#include "components/burnable_mesh.h"
#include "shared/exchange.h"

namespace fw::components {

struct Governance {         // limits of spread, for an object or a world
    float chance = 1;       // of each jump from object to object and of each ember, [0, 1]
    uint32_t hopsMost = 0;  // jumps after which a fire does not spread further; 0: no limit
    uint32_t maxTiles = 0;  // burning tiles of 8 x 8 texels; 0: no limit
    float life = 0;         // s that a front advances after the object's ignition; 0: no limit
};
[[nodiscard]] constexpr bool caps(const Governance& g) noexcept { return g.maxTiles != 0; }
[[nodiscard]] constexpr bool governs(const Governance& g) noexcept { return caps(g) || g.life > 0; }

// Rotation, place and box of a mesh in the world.
void placeExchangeObject(const Pose& pose, const mesh::BurnDomain& domain,
                         gpu::ExchangeObject& out) noexcept;
// Fills all other fields except neighbours and sources, which the world and its backend fill. `out`
// is placed.
void fillExchangeObject(const BurnableMesh& object, const mesh::BurnDomain& domain,
                        const Governance& governance, gpu::ExchangeObject& out) noexcept;
void placeHeatOccluder(const Pose& pose, const float halfSize[3], gpu::HeatOccluder& out) noexcept;

// mm within which a fire of the whole object may affect another one.
uint32_t exchangeReach(const BurnableMesh& object, const mesh::BurnDomain& domain,
                       const std::array<uint32_t, kMaterials>& texelsOf) noexcept;

uint32_t chanceOf(float chance) noexcept;  // of gpu::kChanceOne
uint32_t lifeTicksOf(float seconds) noexcept;
uint32_t limitOf(uint32_t most) noexcept;  // 0: none

}  // namespace fw::components
