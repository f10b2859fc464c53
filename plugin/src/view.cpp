// Checks of FwView.
#include "components/pose.h"
#include "edge.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <span>

namespace fw::edge {
namespace {

// A row-major view or an empty projection would show nothing.
void checkMatrices(const FwView& view, const char* name) {
    static constexpr unsigned kLastRow[4] = {3, 7, 11, 15};
    for (unsigned i = 0; i < 4; ++i) {
        const float wanted = i == 3 ? 1.0f : 0.0f, value = view.view[kLastRow[i]];
        if (std::fabs(value - wanted) > 1e-3f)
            core::refuse(
                "%s.view[%u] is %g; the last row of a view matrix is 0 0 0 1, elements 3, 7, 11 "
                "and 15. Matrices are column-major.",
                name, kLastRow[i], double(value));
    }
    const auto at = [&](unsigned column, unsigned row) {
        return double(view.view[column * 4 + row]);
    };
    const double determinant = at(0, 0) * (at(1, 1) * at(2, 2) - at(2, 1) * at(1, 2)) -
                               at(1, 0) * (at(0, 1) * at(2, 2) - at(2, 1) * at(0, 2)) +
                               at(2, 0) * (at(0, 1) * at(1, 2) - at(1, 1) * at(0, 2));
    if (std::fabs(determinant) < 1e-12)
        core::refuse(
            "%s.view has determinant %g; a view turns and moves the world, it does not flatten "
            "it.",
            name, determinant);
    for (unsigned row : {0u, 1u, 3u}) {
        bool empty = true;
        for (unsigned column = 0; column < 4; ++column)
            empty &= view.projection[column * 4 + row] == 0.0f;
        if (empty)
            core::refuse(
                "%s.projection has zeros in all of row %u; nothing would show. Matrices are "
                "column-major.",
                name, row);
    }
}

}  // namespace

void validatedView(const Unit& unit, FwView& view, const char* name) {
    if (view.flags != 0) core::refuse("%s.flags is 0x%x; it is zero.", name, view.flags);
    const auto check = [&](std::span<const float> values, const char* field, float low,
                           float high) {
        // Views come with every frame: the field's full name is made for an error alone.
        if (std::ranges::all_of(values, [&](float v) { return v >= low && v <= high; })) return;
        char full[96];
        std::snprintf(full, sizeof full, "%s.%s", name, field);
        if (values.size() == 1)
            components::checkValue(values[0], full, low, high);
        else
            components::checkValues(values.data(), unsigned(values.size()), full, low, high);
    };
    check(view.view, "view", -1e9f, 1e9f);
    check(view.projection, "projection", -1e9f, 1e9f);
    checkMatrices(view, name);
    check(view.sunDirection, "sunDirection", -1.001f, 1.001f);
    const float* sun = view.sunDirection;
    const float length = std::sqrt(sun[0] * sun[0] + sun[1] * sun[1] + sun[2] * sun[2]);
    if (std::fabs(length - 1.0f) > 1e-2f)
        core::refuse("%s.sunDirection has length %g; it is a unit vector within 0.01.", name,
                     double(length));
    check(view.sunColor, "sunColor", 0.0f, 1e6f);
    check(view.ambientSky, "ambientSky", 0.0f, 1e6f);
    check(view.ambientGround, "ambientGround", 0.0f, 1e6f);
    check({&view.exposure, 1}, "exposure", 1e-6f, 1e6f);
    check({&view.emissionScale, 1}, "emissionScale", 0.0f, 1e6f);
    check({&view.time, 1}, "time", -1e9f, 1e9f);
    check({&view.haze, 1}, "haze", 0.0f, 8.0f);
    check({&view.reserved, 1}, "reserved", 0.0f, 0.0f);
    toMetres(unit, view);
}

}  // namespace fw::edge
