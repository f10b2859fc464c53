#include "fire/spread_law.h"

#include "core/assert.h"
#include "core/error.h"
#include "fire/heat.h"
#include "shared/front.h"

#include <algorithm>
#include <cmath>

namespace fw::fire {
namespace {

constexpr double kTicks = double(gpu::kTicksPerSecond);
constexpr double kNoiseFastest = 1.18;  // speed where slowness noise is least
constexpr uint32_t kMaxBurnTicks = 1u << 28;

struct Limit {
    const char* field;
    float FwMaterialDef::*value;
    float low, high;
};
constexpr Limit kLimits[] = {
    {"spreadRate", &FwMaterialDef::spreadRate, 0, 1},
    {"windGain", &FwMaterialDef::windGain, 0, 16},
    {"upGain", &FwMaterialDef::upGain, 0, 16},
    {"headGain", &FwMaterialDef::headGain, 0, 255},
    {"backGain", &FwMaterialDef::backGain, 0, 255},
    {"driveMax", &FwMaterialDef::driveMax, 0, 63},
    {"lengthToBreadth", &FwMaterialDef::lengthToBreadth, 1, 4},
    {"ceilingGain", &FwMaterialDef::ceilingGain, 0, 4},
    {"burnTime", &FwMaterialDef::burnTime, -1e6f, 1e6f},
    {"moisture", &FwMaterialDef::moisture, 0, 2},
    {"extinctionMoisture", &FwMaterialDef::extinctionMoisture, 1e-3f, 2},
    {"thickness", &FwMaterialDef::thickness, 0, 100},
    {"heatOfCombustion", &FwMaterialDef::heatOfCombustion, 0, 2e8f},
    {"burningFlux", &FwMaterialDef::burningFlux, 0, 10},
    {"baseRoughness", &FwMaterialDef::baseRoughness, 0, 1},
    {"density", &FwMaterialDef::density, 1, 20000},
    {"specificHeat", &FwMaterialDef::specificHeat, 100, 10000},
    {"conductivity", &FwMaterialDef::conductivity, 1e-3f, 500},
    {"ignitionTemperature", &FwMaterialDef::ignitionTemperature, 300, 2000},
    {"autoIgnitionTemperature", &FwMaterialDef::autoIgnitionTemperature, 300, 3000},
    {"flameFeedback", &FwMaterialDef::flameFeedback, 0, 200000},
    {"charFloor", &FwMaterialDef::charFloor, 0.01f, 1},
    {"waterHeld", &FwMaterialDef::waterHeld, 0, 1023},
    {"radiantFraction", &FwMaterialDef::radiantFraction, 0, 1},
    {"sootYield", &FwMaterialDef::sootYield, 0, 1},
    {"recede", &FwMaterialDef::recede, 0, 1},
    {"shrink", &FwMaterialDef::shrink, 0, 0.5f},
    {"curl", &FwMaterialDef::curl, 0, 200},
};

uint32_t durationTicks(double seconds) {
    return uint32_t(std::clamp(seconds * kTicks, 1.0, double(kMaxBurnTicks)));
}

// Largest head/back speed ratio of an ellipse of this length to breadth.
double headToBack(double lengthToBreadth) {
    FW_ASSERT(lengthToBreadth >= 1, "%g", lengthToBreadth);
    const double root = lengthToBreadth + std::sqrt(lengthToBreadth * lengthToBreadth - 1);
    return root * root;
}

struct Drive {
    double vector[3];  // object space
    double size;
};

Drive driveOf(const FwMaterialDef& def, const SpreadFacts& facts, const WindVector& wind) {
    double world[3];
    for (size_t i = 0; i < 3; ++i)
        world[i] = double(def.windGain) * wind[i] * double(kWindUnit) +
                   double(def.upGain) * double(facts.up[i]);
    Drive drive{};
    for (size_t i = 0; i < 3; ++i) {
        for (size_t j = 0; j < 3; ++j) drive.vector[i] += double(facts.rotation[j][i]) * world[j];
        drive.size += drive.vector[i] * drive.vector[i];
    }
    drive.size = std::sqrt(drive.size);
    const double limit = (gpu::kDriveLimit - 2) / 1024.0;
    if (drive.size > limit) {
        for (double& v : drive.vector) v *= limit / drive.size;
        drive.size = limit;
    }
    return drive;
}

// Correction window in links of the base rate: the delay after which neighbours may still correct a
// texel. It grows with the ellipse's length.
double windowLinks(double lengthToBreadth) {
    return lengthToBreadth <= 1.5 ? 0 : lengthToBreadth <= 2.0 ? 1 : 2;
}

}  // namespace

void checkMaterial(const FwMaterialDef& def) {
    for (const Limit& limit : kLimits) {
        const float value = def.*limit.value;
        if (!(value >= limit.low && value <= limit.high))
            core::refuse("FwMaterialDef::%s is %g; it must be within [%g, %g].", limit.field,
                         double(value), double(limit.low), double(limit.high));
    }
    for (int i = 0; i < 3; ++i)
        if (!(def.baseColor[i] >= 0 && def.baseColor[i] <= 1))
            core::refuse("FwMaterialDef::baseColor[%d] is %g; it must be within [0, 1].", i,
                         double(def.baseColor[i]));
    if (def.autoIgnitionTemperature < def.ignitionTemperature)
        core::refuse(
            "FwMaterialDef::autoIgnitionTemperature is %g; it is at least "
            "ignitionTemperature, which is %g.",
            double(def.autoIgnitionTemperature), double(def.ignitionTemperature));
    if (def.appearance >= FW_MATERIAL_PRESET_COUNT)
        core::refuse("FwMaterialDef::appearance is %u; it must be a FwMaterialPreset, below %d.",
                     def.appearance, int(FW_MATERIAL_PRESET_COUNT));
}

float moistureFactor(float moisture, float extinctionMoisture) noexcept {
    FW_ASSERT(extinctionMoisture > 0, "%g", double(extinctionMoisture));
    const float r = moisture >= extinctionMoisture ? 1.0f : moisture / extinctionMoisture;
    return r >= 1 ? 0.0f : 1.0f + r * (-2.59f + r * (5.11f - 3.52f * r));
}

float baseRate(const FwMaterialDef& def, const SpreadFacts& facts) noexcept {
    float factor = moistureFactor(def.moisture + facts.moisture, def.extinctionMoisture);
    if (factor <= 0 && facts.heat) factor = 1;  // its texels wait until heat dries them
    return def.spreadRate * factor * facts.pace;
}

uint32_t linkTicks(const FwMaterialDef& def, const SpreadFacts& facts) noexcept {
    const double rate = double(baseRate(def, facts));
    return rate > 0 ? durationTicks(double(facts.texelSide) * double(facts.scale) / rate)
                    : kMaxBurnTicks;
}

gpu::BurnMaterial inertMaterial() noexcept {
    gpu::BurnMaterial m{};
    m.sigma0 = 0xFFFFFFFFu;
    m.breadthMax = 256;
    m.burnTicks = gpu::kNoneTexel;
    m.flameTicks = 0;
    m.air = 256;
    m.timeScale = 1;
    return m;
}

gpu::BurnMaterial burnMaterial(const FwMaterialDef& def, const SpreadFacts& facts,
                               const WindVector& wind) noexcept {
    gpu::BurnMaterial m = inertMaterial();
    m.appearance = def.appearance;
    m.thickness = def.thickness;
    m.roughness = def.baseRoughness;
    m.baseColor = {def.baseColor[0], def.baseColor[1], def.baseColor[2], 1};
    m.timeScale = facts.pace;
    const double rate = double(baseRate(def, facts));
    if (!(rate > 0)) return m;

    m.flags = 1;
    const double unit = double(facts.quantum) * double(facts.scale) / 8;  // m per 1/8 unit
    FW_ASSERT(unit > 0 && facts.pace > 0, "%g m, pace %g", unit, double(facts.pace));
    m.sigma0 =
        uint32_t(std::clamp(std::round(kTicks / rate * unit * 4194304.0), 16.0, 4294967295.0));
    m.headGain = fixed(double(def.headGain), 256, 65280);
    m.backGain = fixed(double(def.backGain), 256, 65280);
    m.driveMax = fixed(double(def.driveMax), 1024, 64512);
    m.breadthMax = fixed(headToBack(std::clamp(double(def.lengthToBreadth), 1.0, 4.0)), 256, 65535);
    m.ceiling = fixed(double(def.ceilingGain), 256, 1024);
    const Drive drive = driveOf(def, facts, wind);
    m.driveX = int(std::lround(drive.vector[0] * 1024));
    m.driveY = int(std::lround(drive.vector[1] * 1024));
    m.driveZ = int(std::lround(drive.vector[2] * 1024));
    for (int i = 0; i < 3; ++i) {
        double up = 0;
        for (int j = 0; j < 3; ++j) up += double(facts.rotation[j][i]) * double(facts.up[j]);
        m.upCeiling[i] = uint32_t(int32_t(std::lround(up * 1024)));
    }

    if (def.burnTime > 0) {
        m.burnTicks = durationTicks(double(def.burnTime) / double(facts.pace));
        m.flameTicks = m.burnTicks;
    } else {  // thick: flames until consumed, a source for ever
        const double consumed =
            double(def.burningFlux) > 0 ? double(arealFuel(def)) / double(def.burningFlux) : 0;
        m.flameTicks =
            consumed > 0 ? durationTicks(consumed / double(facts.pace)) : gpu::kNoneTexel;
        // Heat decides the real duration; twice the nominal one bounds it.
        if (facts.heat && m.flameTicks < kMaxBurnTicks / 2) m.burnTicks = 2 * m.flameTicks;
    }
    m.powerPerArea = def.heatOfCombustion * def.burningFlux;
    const double speed = std::sqrt(double(wind[0]) * wind[0] + double(wind[1]) * wind[1] +
                                   double(wind[2]) * wind[2]);
    m.air = airGain(float(speed * double(kWindUnit)));
    return m;
}

FrontTiming frontTiming(std::span<const FwMaterialDef* const> defs, const SpreadFacts& facts,
                        std::span<const WindVector> winds,
                        std::span<gpu::BurnMaterial> records) noexcept {
    FW_ASSERT(winds.size() >= defs.size(), "%zu winds, %zu materials", winds.size(), defs.size());
    const double step = double(gpu::kStepTicks) / kTicks;
    double window = 4 * double(gpu::kStepTicks), windowMax = window, substeps = 1;
    for (size_t i = 0; i < defs.size(); ++i) {
        if (!defs[i]) continue;
        const FwMaterialDef& def = *defs[i];
        const double rate = double(baseRate(def, facts));
        if (!(rate > 0)) continue;
        const Drive drive = driveOf(def, facts, winds[i]);
        const double head = 1 + double(def.headGain) * std::min(drive.size, double(def.driveMax));
        const double back = 1 + double(def.backGain) * drive.size;
        const double most = std::clamp(double(def.lengthToBreadth), 1.0, 4.0);
        const double ratio = std::min(head * back, headToBack(most));
        const double breadth = (std::sqrt(ratio) + 1 / std::sqrt(ratio)) / 2;
        const double link = double(facts.texelSide) * double(facts.scale) / rate * kTicks;
        window = std::max(window, windowLinks(breadth - 1e-9) * link);
        windowMax = std::max(windowMax, windowLinks(most - 1e-9) * link);
        const double fastest = rate * head * (1 + double(def.ceilingGain)) * kNoiseFastest;
        FW_ASSERT(link > 0 && ratio >= 1, "links of %g ticks, ratio %g", link, ratio);
        const double links = step * fastest / (double(facts.linkShort) * double(facts.scale));
        substeps = std::max(substeps, breadth > 2 ? 2 * links : links);
    }
    FrontTiming timing;
    timing.window = uint32_t(std::min(window, double(kMaxBurnTicks)));
    timing.windowMax = uint32_t(std::min(windowMax, double(kMaxBurnTicks)));
    while (timing.substepShift < 3 && double(1u << timing.substepShift) < substeps)
        ++timing.substepShift;
    timing.limited = substeps > gpu::kMaxSubsteps;
    for (gpu::BurnMaterial& record : records) record.windowMax = timing.windowMax;
    return timing;
}

}  // namespace fw::fire
