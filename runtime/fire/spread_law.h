// The spread law: converts a material's fields in m/s, s and kg to the integers of the front kernel
// (shared/front.h), for one object under one wind. The floats here make records; every backend gets
// the same record.
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
    float pace = 1;      // factor on spread and burnout, [0.1, 1000]
    float moisture = 0;  // kg/kg, added to the material's own
    bool heat = false;   // has heat per texel: damp fuel may dry, thick fuel burns out
};

struct FrontTiming {
    uint32_t window = 0;        // correction window under this drive, ticks
    uint32_t windowMax = 0;     // under any drive, ticks
    uint32_t substepShift = 0;  // log2 of the iterations per step, 0..3
    bool limited = false;       // needs more than 8 iterations: the front will lag
};

// Throws core::Error naming the field, the value and its limits.
void checkMaterial(const FwMaterialDef& def);

// Rothermel's damping of the spread rate by fuel moisture, 1 (dry) to 0 (moisture >= extinction).
float moistureFactor(float moisture, float extinctionMoisture) noexcept;
// Spread rate on a level sheet in still air, m/s; 0: cannot burn.
float baseRate(const FwMaterialDef& def, const SpreadFacts& facts) noexcept;
// Ticks of a front over one texel at the base rate: the wind filter's time constant.
uint32_t linkTicks(const FwMaterialDef& def, const SpreadFacts& facts) noexcept;

// `wind`: filtered, world space. windowMax is not filled: see frontTiming.
gpu::BurnMaterial burnMaterial(const FwMaterialDef& def, const SpreadFacts& facts,
                               const WindVector& wind) noexcept;
// A material that cannot burn.
gpu::BurnMaterial inertMaterial() noexcept;
// Returns the timing of an object with these materials, and sets windowMax of the records. winds[i]
// belongs to defs[i]; null defs are unused materials.
FrontTiming frontTiming(std::span<const FwMaterialDef* const> defs, const SpreadFacts& facts,
                        std::span<const WindVector> winds,
                        std::span<gpu::BurnMaterial> records) noexcept;

}  // namespace fw::fire
