#include "components/wind_zone.h"

#include "components/pose.h"
#include "core/assert.h"
#include "core/error.h"
#include "shared/burn.h"

#include <algorithm>
#include <cmath>

namespace fw::components {
namespace {

using Vector = std::array<int64_t, 3>;

constexpr int kOneBits = 14;
constexpr int64_t kOne = int64_t(1) << kOneBits;
constexpr float kMaxZoneSize = 1000;   // m
constexpr float kFarthestZone = 1e6f;  // m
constexpr int32_t kMaxZonePriority = 1000;
constexpr int64_t kMaxZoneWind = fire::kMaxWindUnits;
constexpr uint32_t kQuarter = 32;  // 1/128 m/s in 1/4 m/s

// Largest whole number whose square is not more than n.
int64_t root(uint64_t n) noexcept {
    uint64_t found = 0;
    for (uint64_t bit = uint64_t(1) << 31; bit != 0; bit >>= 1)
        if ((found | bit) * (found | bit) <= n) found |= bit;
    return int64_t(found);
}

int64_t lengthOf(const Vector& v) noexcept {
    return root(uint64_t(v[0] * v[0]) + uint64_t(v[1] * v[1]) + uint64_t(v[2] * v[2]));
}

int64_t dot(const Vector& a, const Vector& b) noexcept {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// Q14; zero for a vector without length.
Vector unit(const Vector& v) noexcept {
    const int64_t length = lengthOf(v);
    if (length == 0) return {};
    return {v[0] * kOne / length, v[1] * kOne / length, v[2] * kOne / length};
}

// Place between the zone's middle, 0, and its edge, 1; Q14.
int64_t depthOf(const WindZone& zone, const Vector& off) noexcept {
    FW_ASSERT(zone.size[0] > 0, "size %lld mm", static_cast<long long>(zone.size[0]));
    switch (zone.shape) {
        case FW_WIND_BOX: {
            int64_t most = 0;
            for (size_t i = 0; i < 3; ++i)
                most = std::max(most, std::abs(off[i]) * kOne / zone.size[i]);
            return most;
        }
        case FW_WIND_SPHERE:
            return lengthOf(off) * kOne / zone.size[0];
        default: {
            const int64_t along = dot(off, zone.axis) >> kOneBits;
            if (along < 0 || along > zone.size[0]) return kOne;
            Vector across;
            for (size_t i = 0; i < 3; ++i)
                across[i] = off[i] - ((zone.axis[i] * along) >> kOneBits);
            const int64_t wide = std::max<int64_t>(zone.size[1] * along / zone.size[0], 1);
            return std::max(along * kOne / zone.size[0], lengthOf(across) * kOne / wide);
        }
    }
}

Vector flowOf(const WindZone& zone, const Vector& off) noexcept {
    switch (zone.flow) {
        case FW_WIND_ALONG:
            return zone.axis;
        case FW_WIND_RADIAL:
            return unit(off);
        default: {  // right-handed about the axis
            const Vector& a = zone.axis;
            return unit({(a[1] * off[2] - a[2] * off[1]) >> kOneBits,
                         (a[2] * off[0] - a[0] * off[2]) >> kOneBits,
                         (a[0] * off[1] - a[1] * off[0]) >> kOneBits});
        }
    }
}

// Number of sizes in use: a sphere has one, a cone two, a box three.
unsigned sizesOf(uint32_t shape) noexcept {
    return shape == FW_WIND_SPHERE ? 1 : shape == FW_WIND_CONE ? 2 : 3;
}

void checkKind(uint32_t value, const char* name, uint32_t count) {
    if (value >= count)
        core::refuse("FwWindZoneDef::%s is %u; the limit is %u.", name, value, count - 1);
}

}  // namespace

WindZone makeWindZone(const FwWindZoneDef& def) {
    if (def.flags != 0 || def.reserved != 0)
        core::refuse("FwWindZoneDef::flags is 0x%x and reserved is %u; both are zero.", def.flags,
                     def.reserved);
    checkKind(def.shape, "shape", FW_WIND_SHAPE_COUNT);
    checkKind(def.flow, "flow", FW_WIND_FLOW_COUNT);
    checkKind(def.blend, "blend", FW_WIND_BLEND_COUNT);
    if (def.priority < -kMaxZonePriority || def.priority > kMaxZonePriority)
        core::refuse("FwWindZoneDef::priority is %d; the limits are [%d, %d].", def.priority,
                     -kMaxZonePriority, kMaxZonePriority);
    checkLengths(def.position, 3, "FwWindZoneDef::position", -kFarthestZone, kFarthestZone);
    checkValues(def.axis, 3, "FwWindZoneDef::axis", -kFarthestZone, kFarthestZone);
    const unsigned sizes = sizesOf(def.shape);
    checkLengths(def.size, sizes, "FwWindZoneDef::size", 0.01f, kMaxZoneSize);
    checkLength(def.speed, "FwWindZoneDef::speed", -fire::kMaxWind, fire::kMaxWind);
    checkValue(def.falloff, "FwWindZoneDef::falloff", 0.0f, 1.0f);
    WindZone zone;
    zone.shape = def.shape;
    zone.flow = def.flow;
    zone.blend = def.blend;
    zone.priority = def.priority;
    double square = 0;
    for (const float value : def.axis) square += double(value) * double(value);
    const double length = std::sqrt(square);
    if (!(length > 1e-6))
        core::refuse("FwWindZoneDef::axis has a length of %g; it is a direction.", length);
    for (size_t i = 0; i < 3; ++i) {
        zone.middle[i] = millimetres(def.position[i]);
        zone.axis[i] = std::llround(double(def.axis[i]) / length * double(kOne));
        zone.size[i] = i < sizes ? millimetres(def.size[i]) : 0;
    }
    zone.speed = std::llround(double(def.speed) * 128);
    zone.fades = std::llround(double(def.falloff) * double(kOne));
    return zone;
}

bool WindZone::plausible() const noexcept {
    const auto within = [](int64_t value, int64_t low, int64_t high) {
        return value >= low && value <= high;
    };
    const int64_t far = millimetres(kFarthestZone), most = millimetres(kMaxZoneSize);
    bool fine = shape < FW_WIND_SHAPE_COUNT && flow < FW_WIND_FLOW_COUNT &&
                blend < FW_WIND_BLEND_COUNT &&
                within(priority, -kMaxZonePriority, kMaxZonePriority) &&
                within(speed, -kMaxZoneWind, kMaxZoneWind) && within(fades, 0, kOne);
    for (size_t i = 0; i < 3; ++i)
        fine &= within(middle[i], -far, far) && within(axis[i], -kOne, kOne) &&
                within(size[i], i < sizesOf(shape) ? 1 : 0, most);
    return fine;
}

void sortWindZones(std::span<WindZone> zones) noexcept {
    for (size_t i = 1; i < zones.size(); ++i)  // few
        for (size_t k = i; k > 0 && zones[k].priority < zones[k - 1].priority; --k)
            std::swap(zones[k], zones[k - 1]);
}

int64_t millimetres(double metres) noexcept { return int64_t(std::floor(metres * 1000 + 0.5)); }
int wholePlace(double metres) noexcept { return int(millimetres(std::clamp(metres, -2e6, 2e6))); }

fire::WindVector windIn(std::span<const WindZone> zones, const fire::WindVector& wind,
                        const WindPlace& place) noexcept {
    FW_ASSERT(std::is_sorted(zones.begin(), zones.end(), [](const WindZone& a, const WindZone& b) {
        return a.priority < b.priority;
    }));
    Vector sum{wind[0], wind[1], wind[2]};
    const int64_t far = millimetres(2 * kMaxZoneSize);
    for (const WindZone& zone : zones) {
        const Vector off{place.x - zone.middle[0], place.y - zone.middle[1],
                         place.z - zone.middle[2]};
        // No zone reaches as far; the products below fit 64 bits.
        if (std::any_of(off.begin(), off.end(), [&](int64_t v) { return std::abs(v) > far; }))
            continue;
        const int64_t depth = depthOf(zone, off);
        if (depth >= kOne) continue;
        const int64_t part =
            zone.fades > 0 ? std::min((kOne - depth) * kOne / zone.fades, kOne) : kOne;
        FW_ASSERT(depth >= 0 && part >= 0 && part <= kOne, "part %lld",
                  static_cast<long long>(part));
        const Vector flow = flowOf(zone, off);
        for (size_t i = 0; i < 3; ++i) {
            const int64_t blows = flow[i] * zone.speed / kOne;
            sum[i] += (zone.blend == FW_WIND_ADD ? blows : blows - sum[i]) * part / kOne;
        }
    }
    fire::WindVector out;
    for (size_t i = 0; i < 3; ++i)
        out[i] = int32_t(std::clamp(sum[i], -kMaxZoneWind, kMaxZoneWind));
    return out;
}

uint32_t packWind(const fire::WindVector& wind) noexcept {
    uint32_t word = 0;
    bool any = false;
    for (size_t i = 0; i < 3; ++i) {
        const int64_t away = wind[i] < 0 ? -1 : 1;
        const int64_t part = (std::abs(int64_t(wind[i])) + kQuarter / 2) / kQuarter * away;
        const int64_t kept = std::clamp<int64_t>(part, -gpu::kMaxWind, gpu::kMaxWind);
        any |= kept != 0;
        word |= uint32_t(kept + gpu::kWindZero) << (i * gpu::kWindBits);
    }
    return any ? word : 0;
}

}  // namespace fw::components
