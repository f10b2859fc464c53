// Forms and ranges of the charring rate: Pirk et al. 2017 and Haedrich et al. 2021.
#include "fire/heat.h"

#include "core/assert.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fw::fire {
namespace {

constexpr double kMinSkin = 0.0002;  // m
constexpr float kSheet = 0.002f;     // m; up to it a sheet is evenly warm
constexpr double kKelvin = 16;       // units per K

}  // namespace

uint32_t fixed(double value, double unit, double most) noexcept {
    FW_ASSERT(most <= 4294967295.0 && !std::isnan(value), "%g of %g", value, most);
    return uint32_t(std::llround(std::clamp(value * unit, 0.0, most)));
}

gpu::HeatMaterial heatMaterial(const HeatFacts& facts, double seconds, float ambient) noexcept {
    const double volumetric = double(facts.density) * double(facts.specificHeat);  // J/m^3/K
    const double depth = double(facts.thickness);
    FW_ASSERT(seconds > 0 && depth > 0 && volumetric > 0, "%g s, %g m, %g J/m^3/K", seconds, depth,
              volumetric);
    gpu::HeatMaterial m{};
    m.absorbs = fixed(double(facts.absorptivity), 256, 256);
    m.radiates = fixed(double(facts.emissivity), 256, 256);
    m.convects = fixed(double(facts.convection), 256, 1 << 15);
    m.ownFlux = fixed(double(facts.ownFlux), 1, 200000);
    m.ambient = fixed(double(ambient), kKelvin, 16000);
    const bool deep = facts.thick || facts.deep;
    m.maxCapacity = fixed(volumetric * depth / seconds, 256, 1 << 30);
    m.minCapacity = m.maxCapacity;
    if (deep) {
        m.inertia = std::max(
            fixed(std::numbers::pi / 2 * double(facts.conductivity) * volumetric / seconds, 1), 1u);
        m.minCapacity = fixed(volumetric * std::min(kMinSkin, depth) / seconds, 256, 1 << 30);
    }
    if (facts.thick) {
        const double fuel = double(facts.density) * depth;  // kg/m^2
        m.burnRate = fixed(double(facts.pyrolysis) * seconds / fuel * 65536, 65536, 1u << 31);
        m.charSpan = fixed(
            double(facts.charResistance) * double(facts.charShare) * depth * std::numbers::log2e,
            65536);
        m.charFloor = fixed(double(facts.charFloor), 65536, 65536);
    }
    m.ignitesAt = fixed(double(facts.ignition), kKelvin, 65535);
    m.ignitesAlone = fixed(double(facts.autoIgnition), kKelvin, 65535);
    m.diesAt = fixed(double(facts.extinction), kKelvin, 65535);
    m.maxFilm = fixed(double(facts.maxFilm), 1, gpu::kMaxFilm);
    const double perGram = double(kLatentHeat) / 1000 / seconds;  // W/m^2
    m.filmFlux = std::max(fixed(perGram, 1, 1 << 22), 1u);
    const double wet = deep ? std::min(double(facts.moistDepth), depth) : depth;  // m
    m.moistFlux =
        std::max(fixed(double(facts.density) * wet * 1000 / 128 * perGram, 1, 1 << 26), 1u);
    m.moistDies = fixed(double(facts.extinctionMoisture), 128, gpu::kMaxMoist + 1);
    m.airDries = fixed(double(facts.airDrying) * seconds, 65536, 1 << 24);
    m.flags = (facts.burns ? gpu::kHeatBurns : 0u) | (facts.thick ? gpu::kHeatThick : 0u);
    return m;
}

HeatFacts heatFacts(const FwMaterialDef& def) noexcept {
    FW_ASSERT(def.charFloor > 0 && def.density > 0, "char floor %g, %g kg/m^3",
              double(def.charFloor), double(def.density));
    HeatFacts facts;
    facts.burns = def.spreadRate > 0;
    facts.thick = def.burnTime <= 0;
    facts.thickness = std::max(def.thickness, 1e-5f);
    facts.deep = facts.thickness > kSheet;
    facts.density = def.density;
    facts.conductivity = def.conductivity;
    facts.specificHeat = def.specificHeat;
    facts.ownFlux = def.flameFeedback;
    facts.charFloor = def.charFloor;
    facts.ignition = def.ignitionTemperature;
    facts.autoIgnition = std::max(def.autoIgnitionTemperature, def.ignitionTemperature);
    facts.extinction = def.ignitionTemperature - 50;
    facts.maxFilm = def.waterHeld;
    facts.extinctionMoisture = def.extinctionMoisture;
    // The mean of 1 / share over its depth: the factor by which char prolongs burning.
    const double span =
        double(facts.charResistance) * double(facts.charShare) * double(facts.thickness);
    const double floor = double(facts.charFloor);
    const double longer =
        (span + std::log(floor + (1 - floor) * std::exp(-span))) / std::max(floor * span, 1e-9);
    facts.pyrolysis = float(double(def.burningFlux) * longer);
    return facts;
}

float arealFuel(const FwMaterialDef& def) noexcept {
    return def.burnTime > 0 ? def.burningFlux * def.burnTime : def.density * def.thickness;
}

gpu::HeatMaterial heatMaterial(const FwMaterialDef& def, const HeatPlace& place) noexcept {
    const double step = double(gpu::kHeatSteps * gpu::kStepTicks) / gpu::kTicksPerSecond;
    const double seconds = step * double(place.pace);
    FW_ASSERT(seconds > 0 && place.texelArea >= 0, "%g s, %g m^2", seconds,
              double(place.texelArea));
    gpu::HeatMaterial m = heatMaterial(heatFacts(def), seconds, kAmbient);
    m.moistureAtRest = fixed(double(def.moisture) + double(place.moisture), 128, gpu::kMaxMoist);
    m.burnTicks = fixed(std::max(double(def.burnTime), 0.0) / double(place.pace),
                        gpu::kTicksPerSecond, 1u << 28);
    const double joules = double(def.heatOfCombustion) * double(arealFuel(def)) *
                          double(place.texelArea) / gpu::kFuelFull;  // of a unit
    m.energy = fixed(joules, 1048576);
    if (def.burnTime <= 0) m.watts = float(joules / seconds);
    return m;
}

uint32_t airGain(float wind) noexcept {
    const double z = std::clamp(double(wind) / 15, 0.0, 1.0);
    return fixed(1 + z * z * (3 - 2 * z), 256);
}

}  // namespace fw::fire
