// Converts heat in W, K and kg to the integers of shared/heat.h. The front's speed along a surface
// is spread_law's.
#pragma once
#include "flamewright/flamewright.h"
#include "shared/heat.h"

namespace fw::fire {

struct HeatFacts {  // of a material; defaults: softwood
    bool burns = true;
    bool thick = true;           // chars through from the surface; false: burns evenly
    bool deep = false;           // thin fuel that heats from its surface, as thick fuel does
    float thickness = 0.05f;     // m, > 0
    float density = 450;         // kg/m^3
    float conductivity = 0.12f;  // W/m/K
    float specificHeat = 2500;   // J/kg/K
    float emissivity = 0.9f;     // [0, 1], of emitted radiation
    float absorptivity = 0.9f;   // [0, 1], of received radiation
    float convection = 15;       // W/m^2/K
    float ownFlux = 25000;       // W/m^2 from the flame to its surface; at 8000 a lone plank goes
                                 // out, as real ones do
    // Thick fuel's rate: pyrolysis * (charFloor + (1 - charFloor) * exp(-charResistance * depth of
    // its char)). With these defaults softwood chars 39 mm and hardwood (660 kg/m^3) 30 mm deep in
    // an hour (EN 1995-1-2: 0.65 and 0.50 mm/min).
    float pyrolysis = 0.0102f;        // kg/m^2/s of a hot bare surface
    float charFloor = 0.38f;          // [0, 1]
    float charResistance = 150;       // 1/m
    float charShare = 0.75f;          // depth of char left per depth of fuel burnt
    float ignition = 623;             // K, with a flame near
    float autoIgnition = 873;         // K, without a flame
    float extinction = 573;           // K; below it the flame dies
    float maxFilm = 200;              // g/m^2, most water on the surface, [0, 1023]
    float airDrying = 0.05f;          // g/m^2/s of that water that dries in cold air
    float moistDepth = 0.002f;        // m that must dry before it heats further; sheets: all
    float extinctionMoisture = 0.4f;  // kg/kg
};

constexpr float kLatentHeat = 2.26e6f;  // J/kg, of water

// `seconds`: physical length of a heat step (pace times the step). `ambient`: K.
gpu::HeatMaterial heatMaterial(const HeatFacts& facts, double seconds, float ambient) noexcept;

constexpr float kAmbient = 293;  // K

// A value in steps of 1 / unit, clamped to [0, most].
uint32_t fixed(double value, double unit, double most = 4294967295.0) noexcept;

struct HeatPlace {        // the object that a material is on
    float texelArea = 0;  // m^2, world
    float pace = 1;       // as SpreadFacts::pace
    float moisture = 0;   // kg/kg, added to the material's own
};

// A material's facts. Thick fuel's rate makes all of it, hot and in still air, last as long as at
// burningFlux.
HeatFacts heatFacts(const FwMaterialDef& def) noexcept;
// kg/m^2 of fuel.
float arealFuel(const FwMaterialDef& def) noexcept;
// The record of a material on an object, for heat steps of kHeatSteps steps.
gpu::HeatMaterial heatMaterial(const FwMaterialDef& def, const HeatPlace& place) noexcept;
// Factor on thick fuel's burning rate by the wind along the surface, m/s; Q8, 1 to 2 at 15 m/s.
uint32_t airGain(float wind) noexcept;

}  // namespace fw::fire
