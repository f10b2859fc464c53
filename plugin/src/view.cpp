// Checks of FwView.
#include "edge.h"

#include <cmath>

namespace fw::edge {
namespace {

void checkRange(const float* values, unsigned count, const char* name, const char* field, float low,
                float high) {
    for (unsigned i = 0; i < count; ++i) {
        if (values[i] >= low && values[i] <= high) continue;
        if (count == 1)
            core::refuse("%s.%s is %g; the limits are [%g, %g].", name, field, double(values[i]),
                         double(low), double(high));
        core::refuse("%s.%s[%u] is %g; the limits are [%g, %g].", name, field, i, double(values[i]),
                     double(low), double(high));
    }
}

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
    checkRange(view.view, 16, name, "view", -1e9f, 1e9f);
    checkRange(view.projection, 16, name, "projection", -1e9f, 1e9f);
    checkMatrices(view, name);
    checkRange(view.sunDirection, 3, name, "sunDirection", -1.001f, 1.001f);
    const float* sun = view.sunDirection;
    const float length = std::sqrt(sun[0] * sun[0] + sun[1] * sun[1] + sun[2] * sun[2]);
    if (std::fabs(length - 1.0f) > 1e-2f)
        core::refuse("%s.sunDirection has length %g; it is a unit vector within 0.01.", name,
                     double(length));
    checkRange(view.sunColor, 3, name, "sunColor", 0.0f, 1e6f);
    checkRange(view.ambientSky, 3, name, "ambientSky", 0.0f, 1e6f);
    checkRange(view.ambientGround, 3, name, "ambientGround", 0.0f, 1e6f);
    checkRange(&view.exposure, 1, name, "exposure", 1e-6f, 1e6f);
    checkRange(&view.emissionScale, 1, name, "emissionScale", 0.0f, 1e6f);
    checkRange(&view.time, 1, name, "time", -1e9f, 1e9f);
    checkRange(&view.haze, 1, name, "haze", 0.0f, 8.0f);
    checkRange(&view.reserved, 1, name, "reserved", 0.0f, 0.0f);
    toMetres(unit, view);
}

}  // namespace fw::edge
