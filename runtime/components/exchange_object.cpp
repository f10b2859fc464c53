#include "components/exchange_object.h"

#include "components/wind_zone.h"

#include "core/assert.h"

#include <algorithm>
#include <cmath>

namespace fw::components {
namespace {

constexpr double kMillimetres = 1000;
constexpr double kWeakest = 1000;  // W/m^2, least flux that counts: nothing ignites below 4300
constexpr double kCoolest = 40;    // K, least excess of a plume that counts

int whole(double value) noexcept { return int(std::lround(std::clamp(value, -2.0e9, 2.0e9))); }

void turn(const Pose& pose, gpu::ivec4 (&rows)[3]) noexcept {
    for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c)
            rows[r][c] = whole(double(pose.rotation[r][c]) * (pose.stretch[c] < 0 ? -4096 : 4096));
}

double powerOf(const FwMaterialDef& def) noexcept {
    return double(def.heatOfCombustion) * double(def.burningFlux);
}

}  // namespace

void placeExchangeObject(const Pose& pose, const mesh::BurnDomain& domain,
                         gpu::ExchangeObject& out) noexcept {
    // Three products of 16 bits of position and a row must stay below 2^31.
    const double unit = double(domain.quantum) * double(pose.scale) * kMillimetres;
    FW_ASSERT(unit > 0, "%g mm", unit);
    out.shift = 0;
    double longest = 0;
    for (const float s : pose.stretch) longest = std::max(longest, std::fabs(double(s)));
    while (out.shift < 24 && unit * longest * double(2u << out.shift) * 3 * 65536 < 2147483647.0)
        ++out.shift;
    gpu::ivec4* rows[3] = {&out.row0, &out.row1, &out.row2};
    gpu::ivec4* rotations[3] = {&out.rotation0, &out.rotation1, &out.rotation2};
    gpu::ivec4 turned[3]{};
    turn(pose, turned);
    double origin[3];
    toWorld(pose, domain.origin, origin);
    uint16_t low[3], high[3];
    for (int i = 0; i < 3; ++i) {
        const auto units = [&](float value) {
            const double u =
                double(value - domain.origin[i]) / std::max(double(domain.quantum), 1e-12);
            return uint16_t(std::clamp(std::lround(u), 0l, 65535l));
        };
        low[i] = units(domain.boundsLow[i]);
        high[i] = units(domain.boundsHigh[i]);
        for (int c = 0; c < 3; ++c)
            (*rows[i])[c] = whole(double(pose.rotation[i][c]) * double(pose.stretch[c]) * unit *
                                  double(1u << out.shift));
        (*rows[i])[3] = wholePlace(origin[i]);
        *rotations[i] = turned[i];
    }
    gpu::ivec3 boxLow(2000000000), boxHigh(-2000000000);
    for (uint32_t corner = 0; corner < 8; ++corner) {
        const gpu::ivec3 at = gpu::toWorldMm(
            out, gpu::ivec3((corner & 1 ? high : low)[0], (corner & 2 ? high : low)[1],
                            (corner & 4 ? high : low)[2]));
        boxLow = glm::min(boxLow, at);
        boxHigh = glm::max(boxHigh, at + 1);
    }
    for (int i = 0; i < 3; ++i) {
        FW_ASSERT(boxLow[i] < boxHigh[i], "axis %d: %d to %d mm", i, boxLow[i], boxHigh[i]);
        (*rotations[i])[3] = boxLow[i];
        out.high[i] = boxHigh[i];
    }
    out.high[3] = 0;
}

void fillExchangeObject(const BurnableMesh& object, const mesh::BurnDomain& domain,
                        const Governance& governance, gpu::ExchangeObject& out) noexcept {
    const double scale = double(object.pose.scale);
    const double area = domain.texelArea() * scale * scale;
    FW_ASSERT(area > 0, "%g m^2", area);
    out.texelArea = uint32_t(std::clamp(area * 1e6, 1.0, 4e9));
    double damping = 0;
    for (uint32_t i = 0; i < kMaterials; ++i) {
        const bool lit = burns(object, i);
        const double watts = lit ? powerOf(object.materials[i]) * area : 0;
        (i < 4 ? out.power0 : out.power1)[int(i % 4)] =
            uint32_t(std::clamp(std::round(watts * 16), 0.0, 1e8));
        if (lit)
            damping = std::max(
                damping, double(fire::moistureFactor(object.materials[i].moisture + object.moisture,
                                                     object.materials[i].extinctionMoisture)));
    }
    out.catches = uint32_t(std::lround(std::clamp(damping, 0.0, 1.0) * 256));
    out.flags = gpu::kExchangeLive;
    if (!(object.flags & FW_BURNABLE_NO_SPREAD)) out.flags |= gpu::kExchangeGives;
    if (object.flags & FW_BURNABLE_TWO_SIDED) out.flags |= gpu::kExchangeTwoSided;
    out.chance = chanceOf(governance.chance);
    out.hopsMost = limitOf(governance.hopsMost);
    out.maxTiles = limitOf(governance.maxTiles);
    out.lifeTicks = lifeTicksOf(governance.life);
}

void placeHeatOccluder(const Pose& pose, const float halfSize[3], gpu::HeatOccluder& out) noexcept {
    gpu::ivec4* rotations[3] = {&out.rotation0, &out.rotation1, &out.rotation2};
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c)  // transposed: world to box
            (*rotations[r])[c] = whole(double(pose.rotation[c][r]) * 4096);
        (*rotations[r])[3] = wholePlace(pose.translation[r]);
        out.size[r] = uint32_t(std::clamp(double(halfSize[r]) * double(pose.scale) *
                                              std::fabs(double(pose.stretch[r])) * kMillimetres,
                                          0.0, 30000.0));
    }
    out.size[3] = 1;
}

uint32_t exchangeReach(const BurnableMesh& object, const mesh::BurnDomain& domain,
                       const std::array<uint32_t, kMaterials>& texelsOf) noexcept {
    const double scale = double(object.pose.scale);
    const double area = domain.texelArea() * scale * scale;
    double watts = 0;
    for (uint32_t i = 0; i < kMaterials; ++i)
        if (burns(object, i)) watts += powerOf(object.materials[i]) * area * double(texelsOf[i]);
    FW_ASSERT(watts >= 0, "%g W", watts);
    const double radiant = std::sqrt(0.33 * watts / (12.566 * kWeakest));
    const double plume = std::pow(21.6 / kCoolest, 0.6) * std::pow(watts / 1000, 0.4);
    const double reach = std::max({radiant, plume, 0.1}) * kMillimetres;
    return uint32_t(std::min(reach, double(gpu::kExchangeFar)));
}

uint32_t chanceOf(float chance) noexcept {
    return uint32_t(std::lround(std::clamp(double(chance), 0.0, 1.0) * gpu::kChanceOne));
}
uint32_t lifeTicksOf(float seconds) noexcept {
    return seconds > 0 ? uint32_t(std::clamp(double(seconds) * gpu::kTicksPerSecond, 1.0, 4.0e9))
                       : gpu::kNoneTexel;
}
uint32_t limitOf(uint32_t most) noexcept { return most == 0 ? gpu::kNoneTexel : most; }

}  // namespace fw::components
