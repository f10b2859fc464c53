#include "components/gusts.h"

#include "components/pose.h"
#include "core/assert.h"
#include "core/error.h"
#include "core/hash.h"
#include "shared/burn.h"

#include <algorithm>
#include <cmath>

namespace fw::components {
namespace {

constexpr int64_t kGustOne = int64_t(1) << 14;
constexpr float kMinGust = 0.5f, kMaxGust = 1000;  // m
constexpr int64_t kMaxGustWind = fire::kMaxWindUnits;
// Units of drift in a metre.
constexpr int64_t kDriftMetre = 128 * int64_t(gpu::kTicksPerSecond);
constexpr int64_t kMaxMoved = 1000000000;  // m that an origin may move, see moveGusts

int64_t floorDivide(int64_t a, int64_t b) noexcept { return a / b - (a % b < 0 ? 1 : 0); }

// Q14, [-1, 1], at a corner of the lattice.
int64_t corner(const std::array<int64_t, 3>& cell, uint32_t seed) noexcept {
    uint32_t hash = seed;
    for (const int64_t part : cell) hash = core::hash32(hash * 0x9E3779B9u + uint32_t(part));
    return int64_t(hash >> 17) - kGustOne;
}

// Q14, [-1, 1]; smooth between corners `size` mm apart.
int64_t noise(const std::array<int64_t, 3>& place, int64_t size, uint32_t seed) noexcept {
    FW_ASSERT(size > 0, "%lld mm", static_cast<long long>(size));
    std::array<int64_t, 3> cell;
    int64_t weight[3];
    for (size_t i = 0; i < 3; ++i) {
        cell[i] = floorDivide(place[i], size);
        const int64_t x = (place[i] - cell[i] * size) * kGustOne / size;
        weight[i] = x * x / kGustOne * (3 * kGustOne - 2 * x) / kGustOne;
    }
    int64_t sum = 0;
    for (uint32_t k = 0; k < 8; ++k) {
        std::array<int64_t, 3> at = cell;
        int64_t part = kGustOne;
        for (size_t i = 0; i < 3; ++i) {
            const bool far = (k >> i & 1) != 0;
            at[i] += far ? 1 : 0;
            part = part * (far ? weight[i] : kGustOne - weight[i]) / kGustOne;
        }
        sum += corner(at, seed) * part / kGustOne;
    }
    return sum;
}

}  // namespace

Gusts makeGusts(const FwGustDef& def, const Gusts& before) {
    if (def.flags != 0) core::refuse("FwGustDef::flags is 0x%x; it is zero.", def.flags);
    checkValue(def.strength, "FwGustDef::strength", 0.0f, 1.0f);
    checkLength(def.size, "FwGustDef::size", kMinGust, kMaxGust);
    Gusts gusts = before;
    gusts.strength = std::llround(double(def.strength) * double(kGustOne));
    gusts.size = millimetres(def.size);
    FW_ASSERT(plausible(gusts, gusts.since), "%lld mm", static_cast<long long>(gusts.size));
    return gusts;
}

bool plausible(const Gusts& gusts, uint64_t tick) noexcept {
    if (gusts.since > tick || gusts.strength < 0 || gusts.strength > kGustOne) return false;
    const int64_t most = kMaxGustWind * int64_t(gusts.since) + kMaxMoved * kDriftMetre;
    for (const int64_t drift : gusts.drift)
        if (drift < -most || drift > most) return false;
    return gusts.strength == 0 ||
           (gusts.size >= millimetres(kMinGust) && gusts.size <= millimetres(kMaxGust));
}

void windChanges(Gusts& gusts, const fire::WindVector& wind, uint64_t tick) noexcept {
    FW_ASSERT(tick >= gusts.since, "tick %llu, %u", static_cast<unsigned long long>(tick),
              gusts.since);
    const auto ticks = int64_t(tick - gusts.since);
    for (size_t i = 0; i < 3; ++i) gusts.drift[i] += wind[i] * ticks;
    gusts.since = uint32_t(tick);
}

void moveGusts(Gusts& gusts, const double by[3]) noexcept {
    for (size_t i = 0; i < 3; ++i) gusts.drift[i] += int64_t(by[i]) * kDriftMetre;
}

fire::WindVector gustOf(const Gusts& gusts, uint32_t seed, const fire::WindVector& wind,
                        const fire::WindVector& here, const WindPlace& place,
                        uint64_t tick) noexcept {
    if (gusts.strength == 0) return here;
    const int64_t ticks = int64_t(tick - tick % fire::kWindLatchTicks) - int64_t(gusts.since);
    std::array<int64_t, 3> off{place.x, place.y, place.z};
    for (size_t i = 0; i < 3; ++i)
        off[i] -= floorDivide((gusts.drift[i] + wind[i] * ticks) * 1000, kDriftMetre);
    FW_ASSERT(gusts.size >= 2, "%lld mm", static_cast<long long>(gusts.size));
    const int64_t both = (2 * noise(off, gusts.size, seed) + noise(off, gusts.size / 2, ~seed)) / 3;
    const int64_t gain = kGustOne + gusts.strength * both / kGustOne;
    fire::WindVector out;
    for (size_t i = 0; i < 3; ++i)
        out[i] = int32_t(std::clamp(here[i] * gain / kGustOne, -kMaxGustWind, kMaxGustWind));
    return out;
}

}  // namespace fw::components
