// The host's wind on a grid of points: trilinear inside, without effect outside. Integers once the
// def is read, like zones. Solves nothing.
#pragma once
#include "components/wind_zone.h"

#include <memory_resource>
#include <vector>

namespace fw::components {

constexpr uint32_t kMostGridPoints = 32768, kMostGridSide = 64;

struct WindGridShape {  // places of the points; counts of 0: there is no grid
    uint32_t blend = 0;
    std::array<uint32_t, 3> counts{};
    std::array<int64_t, 3> origin{};  // mm, of the first point
    int64_t cell = 0, fade = 0;       // mm
    [[nodiscard]] uint32_t points() const noexcept { return counts[0] * counts[1] * counts[2]; }
    bool operator==(const WindGridShape&) const = default;
};

using WindPoint = std::array<int16_t, 3>;  // 1/128 m/s

struct WindGrid {
    explicit WindGrid(std::pmr::memory_resource* memory) : points(memory) {}
    WindGridShape shape;
    std::pmr::vector<WindPoint> points;  // x runs fastest, then y, then z
};

// Throw core::Error naming the field.
[[nodiscard]] WindGridShape makeWindGridShape(const FwWindGridDef& def);
void readWindPoints(const FwWindGridDef& def, std::pmr::vector<WindPoint>& points);
// velocity: m/s. point: its number, for the message.
[[nodiscard]] WindPoint makeWindPoint(const float velocity[3], uint32_t point);

// Whether makeWindGridShape may have made it.
[[nodiscard]] bool plausible(const WindGridShape& shape) noexcept;

// The wind at a place. `wind`: around the grid.
[[nodiscard]] fire::WindVector windOnGrid(const WindGrid& grid, const fire::WindVector& wind,
                                          const WindPlace& place) noexcept;

}  // namespace fw::components
