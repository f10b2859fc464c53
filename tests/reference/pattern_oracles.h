// Rules of the refinement pattern by single points and triangles: what its sweeps are compared
// with.
#pragma once
#include "reference/pattern.h"

namespace fw::reference {

// The finest triangles with a corner nearer than `radius` (in 1/64) to (x, y) are eligible.
void markPatternCircle(std::span<const PatternTriangle> pattern, float x, float y, float radius,
                       std::span<uint8_t> eligible);
// Is any point of the triangle's barycentric lattice of 2^depth steps inside? Theta of each point,
// in [0, 2), is drawn from `seed`.
bool isPatternEligible(const PatternHeat& heat, const glm::vec3 corner[3], uint32_t depth,
                       uint32_t seed);
// The rule for what lies behind the fire: hide a triangle when two or more of its children, being
// of SetLevel 5 or finer, have a higher burn level (consumed triangles) than itself.
bool isPatternHidden(std::span<const PatternTriangle> pattern, std::span<const uint32_t> burnLevel,
                     uint32_t triangle) noexcept;

}  // namespace fw::reference
