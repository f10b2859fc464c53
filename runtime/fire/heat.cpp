// Forms and ranges of the charring rate: Pirk et al. 2017 and Haedrich et al. 2021.
#include "fire/heat.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fw::fire {
namespace {

constexpr double kLeastSkin = 0.0002;  // m
constexpr double kKelvin = 16;         // units per K

uint32_t fixed(double value, double unit, double most = 4294967295.0) {
    return uint32_t(std::llround(std::clamp(value * unit, 0.0, most)));
}

}  // namespace

gpu::HeatMaterial heatMaterial(const HeatFacts& facts, double seconds, float ambient) noexcept {
    const double volumetric = double(facts.density) * double(facts.specificHeat);  // J/m^3/K
    const double depth = double(facts.thickness);
    gpu::HeatMaterial m{};
    m.absorbs = fixed(double(facts.absorptivity), 256, 256);
    m.radiates = fixed(double(facts.emissivity), 256, 256);
    m.convects = fixed(double(facts.convection), 256, 1 << 15);
    m.ownFlux = fixed(double(facts.ownFlux), 1, 200000);
    m.ambient = fixed(double(ambient), kKelvin, 16000);
    if (facts.thick) {
        m.inertia = std::max(
            fixed(std::numbers::pi / 2 * double(facts.conductivity) * volumetric / seconds, 1), 1u);
        m.capacityLeast = fixed(volumetric * std::min(kLeastSkin, depth) / seconds, 256, 1 << 30);
        m.capacityMost = fixed(volumetric * depth / seconds, 256, 1 << 30);
        const double fuel = double(facts.density) * depth;  // kg/m^2
        m.burnRate = fixed(double(facts.pyrolysis) * seconds / fuel * 65536, 65536, 1u << 31);
        m.charSpan = fixed(
            double(facts.charResistance) * double(facts.charShare) * depth * std::numbers::log2e,
            65536);
        m.charFloor = fixed(double(facts.charFloor), 65536, 65536);
    } else {
        m.capacityLeast = m.capacityMost = fixed(volumetric * depth / seconds, 256, 1 << 30);
    }
    m.ignitesAt = fixed(double(facts.ignition), kKelvin, 65535);
    m.ignitesAlone = fixed(double(facts.autoIgnition), kKelvin, 65535);
    m.diesAt = fixed(double(facts.extinction), kKelvin, 65535);
    m.filmMost = fixed(double(facts.filmMost), 1, gpu::kFilmMost);
    const double perGram = double(kLatentHeat) / 1000 / seconds;  // W/m^2
    m.filmFlux = std::max(fixed(perGram, 1, 1 << 22), 1u);
    const double wet = facts.thick ? std::min(double(facts.moistDepth), depth) : depth;  // m
    m.moistFlux =
        std::max(fixed(double(facts.density) * wet * 1000 / 128 * perGram, 1, 1 << 26), 1u);
    m.moistDies = fixed(double(facts.extinctionMoisture), 128, gpu::kMoistMost + 1);
    m.airDries = fixed(double(facts.airDrying) * seconds, 65536, 1 << 24);
    m.flags = (facts.burns ? gpu::kHeatBurns : 0u) | (facts.thick ? gpu::kHeatThick : 0u);
    return m;
}

gpu::HeatTexel heatAtRest(float ambient, float moisture) noexcept {
    gpu::HeatTexel x{};
    x.fuel = gpu::kFuelFull;
    x.heat = fixed(double(ambient), kKelvin, 16000);
    x.moist = fixed(double(moisture), 128, gpu::kMoistMost);
    return x;
}

uint32_t airGain(float wind) noexcept {
    const double z = std::clamp(double(wind) / 15, 0.0, 1.0);
    return fixed(1 + z * z * (3 - 2 * z), 256);
}

}  // namespace fw::fire
