// The host's wind on a grid of points: trilinear inside, without effect outside. Integers once the
// def is read, like zones. Solves nothing.
#pragma once
#include "components/wind_zone.h"

#include <memory_resource>
#include <vector>

namespace fw::components {

struct WindGridShape {  // places of the points; counts of 0: there is no grid
    uint32_t blend = 0;
    std::array<uint32_t, 3> counts{};
    std::array<int64_t, 3> origin{};  // mm, of the first point
    int64_t cell = 0, fade = 0;       // mm
    [[nodiscard]] uint32_t points() const noexcept { return counts[0] * counts[1] * counts[2]; }
    bool operator==(const WindGridShape&) const = default;

    template <class A>
    void serialize(A& a) {
        a(blend, counts, origin, cell, fade);
        a.require(plausible(), "wind grid");
    }
    [[nodiscard]] bool plausible() const noexcept;  // makeWindGridShape may have made it
};

using WindPoint = std::array<int16_t, 3>;  // 1/128 m/s

struct WindGrid {
    explicit WindGrid(std::pmr::memory_resource* memory) : points(memory) {}
    WindGridShape shape;
    std::pmr::vector<WindPoint> points;  // x runs fastest, then y, then z

    // Each axis is a plane; negative values are odd.
    template <class A>
    void serialize(A& a) {
        a(shape);
        if constexpr (A::kReads) points.assign(shape.points(), {});
        if (points.empty()) return;
        for (size_t axis = 0; axis < 3; ++axis)
            a.plane(
                "wind grid", points.size(), shape.counts[0], {}, 2 * uint32_t(fire::kMaxWindUnits),
                [&](size_t i) {
                    const int32_t units = points[i][axis];
                    return units < 0 ? uint32_t(-units - 1) * 2 + 1 : uint32_t(units) * 2;
                },
                [&](size_t i, uint32_t value) {
                    const auto half = int32_t(value / 2);
                    points[i][axis] = int16_t(value & 1u ? -half - 1 : half);
                });
    }
};

// Throw core::Error naming the field.
[[nodiscard]] WindGridShape makeWindGridShape(const FwWindGridDef& def);
void readWindPoints(const FwWindGridDef& def, std::pmr::vector<WindPoint>& points);
// velocity: m/s. point: its number, for the message.
[[nodiscard]] WindPoint makeWindPoint(const float velocity[3], uint32_t point);

// The wind at a place. `wind`: around the grid.
[[nodiscard]] fire::WindVector windOnGrid(const WindGrid& grid, const fire::WindVector& wind,
                                          const WindPlace& place) noexcept;

}  // namespace fw::components
