// A flame's shape as a few points: its outline over the height, and temperatures from its edge to
// its core; and what they paint, as the texels of a fire profile.
#pragma once

#include <vector>

#include "document/scene.h"

namespace fwedit {

constexpr uint32_t kShapeWidth = 64, kShapeHeight = 128;  // texels
constexpr float kShapeReach = 1.25f;                      // radii that they are wide

struct FlameCurve {
    Keys outline;  // height, [0, 1] from base to tip: radius, [0, kShapeReach] of the flame's own
    Keys stops;    // [0, 1] from edge to core: degrees Celsius
    bool operator==(const FlameCurve&) const = default;
};
FlameCurve standardCurve();  // a camp fire's
[[nodiscard]] inline bool hasCurve(const Flame& flame) {
    return !flame.outline.empty() || !flame.stops.empty();
}
// Of a flame that has one; what it leaves empty is the standard's.
FlameCurve curveOf(const Flame& flame);

// Smooth through the points, between two of them never beyond both.
float radiusAt(const Keys& outline, float height);
// kShapeWidth x kShapeHeight pairs, base row first: K, soot; see FwFireProfileDef::texels.
std::vector<float> texelsOfCurve(const FlameCurve& curve);

}  // namespace fwedit
