#include "components/wind_grid.h"

#include "components/pose.h"
#include "core/assert.h"
#include "core/error.h"
#include "host_limits.h"

#include <algorithm>
#include <cmath>

namespace fw::components {
namespace {

constexpr int64_t kWhole = int64_t(1) << 14;
constexpr float kMinGridCell = 0.01f, kMaxGridCell = 1000;  // m
constexpr float kMaxGridFade = 1000;                        // m
constexpr float kFarthestGrid = 1e6f;                       // m

}  // namespace

WindGridShape makeWindGridShape(const FwWindGridDef& def) {
    WindGridShape shape;
    if (def.flags != 0 || def.reserved != 0)
        core::refuse("FwWindGridDef::flags is 0x%x and reserved is %u; both are zero.", def.flags,
                     def.reserved);
    if (def.blend >= FW_WIND_BLEND_COUNT)
        core::refuse("FwWindGridDef::blend is %u; the limit is %u.", def.blend,
                     FW_WIND_BLEND_COUNT - 1);
    for (uint32_t i = 0; i < 3; ++i)
        if (def.counts[i] < 2 || def.counts[i] > limits::kWindGridSide)
            core::refuse("FwWindGridDef::counts[%u] is %u; the limits are [2, %u].", i,
                         def.counts[i], limits::kWindGridSide);
    shape.blend = def.blend;
    std::copy_n(def.counts, 3, shape.counts.begin());
    if (shape.points() > limits::kWindGridPoints)
        core::refuse("FwWindGridDef::counts makes %u x %u x %u = %u points; the limit is %u.",
                     def.counts[0], def.counts[1], def.counts[2], shape.points(),
                     limits::kWindGridPoints);
    checkLengths(def.origin, 3, "FwWindGridDef::origin", -kFarthestGrid, kFarthestGrid);
    checkLength(def.cellSize, "FwWindGridDef::cellSize", kMinGridCell, kMaxGridCell);
    checkLength(def.fade, "FwWindGridDef::fade", 0.0f, kMaxGridFade);
    for (size_t i = 0; i < 3; ++i) shape.origin[i] = millimetres(def.origin[i]);
    shape.cell = millimetres(def.cellSize);
    shape.fade = millimetres(def.fade);
    return shape;
}

WindPoint makeWindPoint(const float velocity[3], uint32_t point) {
    for (uint32_t i = 0; i < 3; ++i)
        if (!(std::abs(velocity[i]) <= fire::kMaxWind))
            core::refuse("FwWindGridDef::velocities[%u] is " FW_LENGTH " " FW_LENGTH_UNIT
                         "/s; the limits are [" FW_LENGTH ", " FW_LENGTH "].",
                         3 * point + i, double(velocity[i]), double(-fire::kMaxWind),
                         double(fire::kMaxWind));
    const fire::WindVector units = fire::windUnits(velocity);
    return {int16_t(units[0]), int16_t(units[1]), int16_t(units[2])};
}

void readWindPoints(const FwWindGridDef& def, std::pmr::vector<WindPoint>& points) {
    if (!def.velocities) core::refuse("FwWindGridDef::velocities is null.");
    const uint32_t count = def.counts[0] * def.counts[1] * def.counts[2];
    points.clear();
    points.reserve(count);
    for (uint32_t i = 0; i < count; ++i)
        points.push_back(makeWindPoint(def.velocities + 3 * size_t{i}, i));
}

bool WindGridShape::plausible() const noexcept {
    if (*this == WindGridShape{}) return true;
    bool fine = blend < FW_WIND_BLEND_COUNT && cell >= millimetres(kMinGridCell) &&
                cell <= millimetres(kMaxGridCell) && fade >= 0 && fade <= millimetres(kMaxGridFade);
    const int64_t far = millimetres(kFarthestGrid);
    for (size_t i = 0; i < 3; ++i)
        fine = fine && counts[i] >= 2 && counts[i] <= limits::kWindGridSide && origin[i] >= -far &&
               origin[i] <= far;
    return fine && points() <= limits::kWindGridPoints;
}

fire::WindVector windOnGrid(const WindGrid& grid, const fire::WindVector& wind,
                            const WindPlace& place) noexcept {
    const WindGridShape& shape = grid.shape;
    if (shape.points() == 0) return wind;
    FW_ASSERT(grid.points.size() == shape.points() && shape.cell > 0, "%zu of %u points",
              grid.points.size(), shape.points());
    const int64_t at[3] = {place.x, place.y, place.z};
    uint32_t corner[3];
    int64_t share[3];  // of the distance to the next point, Q14
    int64_t depth = INT64_MAX;
    for (size_t i = 0; i < 3; ++i) {
        const int64_t off = at[i] - shape.origin[i], size = (shape.counts[i] - 1) * shape.cell;
        if (off < 0 || off > size) return wind;
        corner[i] = std::min(uint32_t(off / shape.cell), shape.counts[i] - 2);
        share[i] = (off - corner[i] * shape.cell) * kWhole / shape.cell;
        depth = std::min({depth, off, size - off});
    }
    const int64_t part = shape.fade > 0 ? std::min(depth * kWhole / shape.fade, kWhole) : kWhole;
    fire::WindVector out;
    for (size_t axis = 0; axis < 3; ++axis) {
        const auto pointAt = [&](uint32_t x, uint32_t y, uint32_t z) -> int64_t {
            const uint32_t row = (corner[2] + z) * shape.counts[1] + corner[1] + y;
            FW_ASSERT(corner[0] + x < shape.counts[0] && corner[1] + y < shape.counts[1] &&
                      corner[2] + z < shape.counts[2]);
            return grid.points[size_t{row} * shape.counts[0] + corner[0] + x][axis];
        };
        const auto between = [&](int64_t a, int64_t b, size_t along) {
            return a * kWhole + (b - a) * share[along];  // Q14 more
        };
        int64_t plane[2];
        for (uint32_t z = 0; z < 2; ++z)
            plane[z] = between(between(pointAt(0, 0, z), pointAt(1, 0, z), 0) / kWhole,
                               between(pointAt(0, 1, z), pointAt(1, 1, z), 0) / kWhole, 1) /
                       kWhole;
        const int64_t blows = between(plane[0], plane[1], 2) / kWhole;
        const int64_t gains = shape.blend == FW_WIND_ADD ? blows : blows - wind[axis];
        out[axis] = int32_t(wind[axis] + gains * part / kWhole);
    }
    return out;
}

}  // namespace fw::components
