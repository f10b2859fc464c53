// Wind zones: local wind with a shape and a flow. Integers once the def is read, so that fire leans
// equally on every machine.
#pragma once
#include "fire/wind_filter.h"
#include "flamewright/flamewright.h"

#include <span>

namespace fw::components {

struct WindPlace {  // mm, world
    int64_t x = 0, y = 0, z = 0;
};

struct WindZone {
    uint32_t shape = 0, flow = 0, blend = 0;  // FwWindShape, FwWindFlow, FwWindBlend
    int32_t priority = 0;
    std::array<int64_t, 3> middle{};  // mm; the tip of a cone
    std::array<int64_t, 3> axis{};    // Q14, unit
    std::array<int64_t, 3> size{};    // mm; half sides; a radius; a cone's length and end radius
    int64_t speed = 0;                // 1/128 m/s
    int64_t fades = 0;                // Q14 of the distance from its middle to its edge
    bool operator==(const WindZone&) const = default;

    template <class A>
    void serialize(A& a) {
        a(shape, flow, blend, priority, middle, axis, size, speed, fades);
        a.require(plausible(), "wind zone");
    }
    [[nodiscard]] bool plausible() const noexcept;  // makeWindZone may have made it
};

// Throws core::Error naming the field.
[[nodiscard]] WindZone makeWindZone(const FwWindZoneDef& def);

// Sorts zones into their order of effect: by priority; zones of one priority keep their order.
void sortWindZones(std::span<WindZone> zones) noexcept;

// m to the nearest mm. Halves round up everywhere, so that moves by whole metres are exact.
[[nodiscard]] int64_t millimetres(double metres) noexcept;
// The same of a place: poses end at 1e6 m, boxes and rays a little later.
[[nodiscard]] int wholePlace(double metres) noexcept;
template <class Number>
[[nodiscard]] WindPlace windPlace(const Number* place) noexcept {
    return {millimetres(place[0]), millimetres(place[1]), millimetres(place[2])};
}

// The wind at a place, within +-120 m/s along each axis. `wind`: around all zones. `zones`: sorted.
[[nodiscard]] fire::WindVector windIn(std::span<const WindZone> zones, const fire::WindVector& wind,
                                      const WindPlace& place) noexcept;

// Packed for object records: three times 10 bits of 1/4 m/s; 0: no wind.
[[nodiscard]] uint32_t packWind(const fire::WindVector& wind) noexcept;

}  // namespace fw::components
