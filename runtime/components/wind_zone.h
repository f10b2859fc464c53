// Wind of a place's own: zones that the host puts around it, each with a shape and a flow. Integers
// once the def is read, so that every machine's fire leans alike. Not what wind does to anything.
#pragma once
#include "fire/wind_filter.h"
#include "flamewright/flamewright.h"

#include <span>

namespace fw::components {

constexpr uint32_t kMaxWindZones = 64;

struct WindPlace {  // mm, world
    int64_t x = 0, y = 0, z = 0;
};

struct WindZone;
// Whether makeWindZone may have made it.
[[nodiscard]] bool plausible(const WindZone& zone) noexcept;

struct WindZone {
    uint32_t shape = 0, flow = 0, blend = 0;  // FwWindShape, FwWindFlow, FwWindBlend
    int32_t priority = 0;
    std::array<int64_t, 3> middle{};  // mm; of a cone its tip
    std::array<int64_t, 3> axis{};    // Q14, unit
    std::array<int64_t, 3> size{};    // mm; half sides; a radius; length and radius at its end
    int64_t speed = 0;                // 1/128 m/s
    int64_t fades = 0;                // Q14 of the way from its middle to its edge
    bool operator==(const WindZone&) const = default;

    template <class A>
    void serialize(A& a) {
        a(shape, flow, blend, priority, middle, axis, size, speed, fades);
        a.require(plausible(*this), "wind zone");
    }
};

// Throws core::Error naming the field.
[[nodiscard]] WindZone makeWindZone(const FwWindZoneDef& def);

// In the order in which they count: of one priority they stay as they are.
void sortWindZones(std::span<WindZone> zones) noexcept;

// m to mm.
// The nearest; halves go up everywhere, so that what moves by whole metres moves exactly.
[[nodiscard]] int64_t millimetres(double metres) noexcept;
[[nodiscard]] WindPlace windPlace(const float place[3]) noexcept;
[[nodiscard]] WindPlace windPlace(const double place[3]) noexcept;

// What blows at a place where `wind` blows around all zones; these are in the order in which they
// count. Within +-120 m/s along each axis.
[[nodiscard]] fire::WindVector windIn(std::span<const WindZone> zones, const fire::WindVector& wind,
                                      const WindPlace& place) noexcept;

// As records of objects hold it: three times 10 bits of 1/4 m/s; 0: none.
[[nodiscard]] uint32_t packWind(const fire::WindVector& wind) noexcept;

}  // namespace fw::components
