// A flame's shape by points: an outline over the height and temperatures from edge to core.
// Converts them to the texels of a fire profile.
#pragma once

#include <vector>

#include "document/scene.h"

namespace fwedit {

constexpr uint32_t kShapeWidth = 64, kShapeHeight = 128;  // texels
constexpr float kShapeReach = 1.25f;                      // width in radii of the flame

struct FlameCurve {
    Keys outline;  // height, [0, 1] from base to tip: radius, [0, kShapeReach] of the flame's
                   // radius
    Keys stops;    // [0, 1] from edge to core: degrees Celsius
    bool operator==(const FlameCurve&) const = default;
};
FlameCurve standardCurve();  // shape of a camp fire
[[nodiscard]] inline bool hasCurve(const Flame& flame) {
    return !flame.outline.empty() || !flame.stops.empty();
}
// Returns the shape of a flame. The standard curve fills empty parts.
FlameCurve curveOf(const Flame& flame);

// Interpolates smoothly and monotonically between the points.
float radiusAt(const Keys& outline, float height);
// Returns kShapeWidth x kShapeHeight pairs, base row first: K, soot; see FwFireProfileDef::texels.
std::vector<float> texelsOfCurve(const FlameCurve& curve);

}  // namespace fwedit
