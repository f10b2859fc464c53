// Heat in W, K and kg becomes the integers that shared/heat.h runs on. Not the spread law: when the
// front crosses a surface is spread_law's.
#pragma once
#include "flamewright/flamewright.h"
#include "shared/heat.h"

namespace fw::fire {

struct HeatFacts {  // of a material; defaults: softwood
    bool burns = true;
    bool thick = true;           // chars through from the surface; false: burns evenly
    bool deep = false;           // what is not thick: heats from its surface, as thick fuel does
    float thickness = 0.05f;     // m, > 0
    float density = 450;         // kg/m^3
    float conductivity = 0.12f;  // W/m/K
    float specificHeat = 2500;   // J/kg/K
    float emissivity = 0.9f;     // [0, 1], of what is radiated
    float absorptivity = 0.9f;   // [0, 1], of what is received
    float convection = 15;       // W/m^2/K
    float ownFlux = 25000;       // W/m^2 that the flame gives back to its surface; 8000: a lone
                                 // plank goes out, as real ones do
    // Thick fuel's rate: pyrolysis * (charFloor + (1 - charFloor) * exp(-charResistance * depth of
    // its char)). With these defaults softwood chars 39 mm and hardwood (660 kg/m^3) 30 mm deep in
    // an hour (EN 1995-1-2: 0.65 and 0.50 mm/min).
    float pyrolysis = 0.0102f;        // kg/m^2/s of a hot bare surface
    float charFloor = 0.38f;          // [0, 1]
    float charResistance = 150;       // 1/m
    float charShare = 0.75f;          // depth of char left per depth of fuel burnt
    float ignition = 623;             // K, with a flame near
    float autoIgnition = 873;         // K, alone
    float extinction = 573;           // K: below, its flame dies
    float filmMost = 200;             // g/m^2 of water that stay on it, [0, 1023]
    float airDrying = 0.05f;          // g/m^2/s of film that go in cold air
    float moistDepth = 0.002f;        // m that must dry before it heats on; sheets: their thickness
    float extinctionMoisture = 0.4f;  // kg/kg
};

constexpr float kLatentHeat = 2.26e6f;  // J/kg, of water

// `seconds`: of a heat step, physical (pace times the step). `ambient`: K.
gpu::HeatMaterial heatMaterial(const HeatFacts& facts, double seconds, float ambient) noexcept;

constexpr float kAmbient = 293;  // K

// A value in steps of 1 / unit, from 0 to `most` of them.
uint32_t fixed(double value, double unit, double most = 4294967295.0) noexcept;

struct HeatPlace {        // what else decides of a material on one object
    float texelArea = 0;  // m^2, world
    float pace = 1;       // as SpreadFacts
    float moisture = 0;   // kg/kg, added to the material's own
};

// A material's facts. Thick fuel's rate is such that all of it, hot and in still air, lasts as long
// as it does at burningFlux.
HeatFacts heatFacts(const FwMaterialDef& def) noexcept;
// kg/m^2 that burn in all.
float arealFuel(const FwMaterialDef& def) noexcept;
// The record of a material on an object, for heat steps of kHeatSteps steps.
gpu::HeatMaterial heatMaterial(const FwMaterialDef& def, const HeatPlace& place) noexcept;
// A texel at rest. `moisture`: kg/kg.
gpu::HeatTexel heatAtRest(float ambient, float moisture) noexcept;
// Wind along the surface, m/s, to the gain of thick fuel's burning rate, Q8: 1 to 2 at 15 m/s.
uint32_t airGain(float wind) noexcept;

}  // namespace fw::fire
