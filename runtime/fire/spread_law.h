// The spread law: a material's fields in m/s, s and kg become the integers that the front kernel
// runs on (shared/front.h), for one object under one wind. Floats here decide records, not fire:
// every backend gets the same record.
#pragma once
#include "fire/wind_filter.h"
#include "flamewright/flamewright.h"
#include "shared/burn.h"

#include <span>

namespace fw::fire {

struct SpreadFacts {      // of an object, its mesh and its world
    float quantum = 0;    // m per position unit, object space (BurnDomain::quantum)
    float texelSide = 0;  // m, object space
    float linkShort = 0;  // m, object space
    float scale = 1;      // world m per object m
    float rotation[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};  // rows: object to world, unit
    float up[3] = {0, 1, 0};                                   // world, unit
    float pace = 1;      // fires spread and burn out this much faster, [0.1, 1000]
    float moisture = 0;  // kg/kg, added to the material's own
    bool heat = false;   // has a heat plane: what is too damp to burn may dry, thick fuel ends
};

struct FrontTiming {
    uint32_t window = 0;        // correction window under this drive, ticks
    uint32_t windowMax = 0;     // under any drive, ticks
    uint32_t substepShift = 0;  // log2 of the iterations per step, 0..3
    bool limited = false;       // more than 8 iterations would be needed: the front will lag
};

// Throws core::Error: FwMaterialDef::field, the value and its limits.
void checkMaterial(const FwMaterialDef& def);

// Rothermel's damping of the spread rate by fuel moisture, 1 (dry) to 0 (moisture >= extinction).
float moistureFactor(float moisture, float extinctionMoisture) noexcept;
// Spread rate on a level sheet in still air, m/s; 0: it cannot burn.
float baseRate(const FwMaterialDef& def, const SpreadFacts& facts) noexcept;
// Ticks that a front takes over one texel at the base rate: the wind filter's time constant.
uint32_t linkTicks(const FwMaterialDef& def, const SpreadFacts& facts) noexcept;

// `wind`: filtered, world space. windowMax is not filled: see frontTiming.
gpu::BurnMaterial burnMaterial(const FwMaterialDef& def, const SpreadFacts& facts,
                               const WindVector& wind) noexcept;
// A material that cannot burn.
gpu::BurnMaterial inertMaterial() noexcept;
// Timing of an object with these materials, and fills windowMax of the records. winds[i] belongs to
// defs[i]; null defs are materials that the object has not.
FrontTiming frontTiming(std::span<const FwMaterialDef* const> defs, const SpreadFacts& facts,
                        std::span<const WindVector> winds,
                        std::span<gpu::BurnMaterial> records) noexcept;

}  // namespace fw::fire
