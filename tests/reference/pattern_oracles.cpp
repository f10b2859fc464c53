#include "reference/pattern_oracles.h"

#include "core/hash.h"

#include <cmath>

namespace fw::reference {

void markPatternCircle(std::span<const PatternTriangle> pattern, float x, float y, float radius,
                       std::span<uint8_t> eligible) {
    const uint8_t finest = pattern.back().setLevel;
    for (size_t i = 0; i < pattern.size(); ++i) {
        eligible[i] = 0;
        if (pattern[i].setLevel != finest) continue;
        for (const auto& c : pattern[i].corner)
            if (std::hypot(float(c[0]) - x, float(c[1]) - y) < radius) eligible[i] = 1;
    }
}

bool isPatternEligible(const PatternHeat& heat, const glm::vec3 corner[3], uint32_t depth,
                       uint32_t seed) {
    const uint32_t n = 1u << depth;
    for (uint32_t b = 0; b <= n; ++b)
        for (uint32_t a = 0; a + b <= n; ++a) {
            const float wa = float(a) / float(n), wb = float(b) / float(n);
            const glm::vec3 p = corner[0] * (1 - wa - wb) + corner[1] * wa + corner[2] * wb;
            const float theta =
                float(core::hash32(seed ^ core::hash32(b * 64 + a)) >> 8) / 8388608.0f;
            if (patternHeatDistance(heat, p, theta) < heat.radius) return true;
        }
    return false;
}

bool isPatternHidden(std::span<const PatternTriangle> pattern, std::span<const uint32_t> burnLevel,
                     uint32_t triangle) noexcept {
    const uint32_t child = pattern[triangle].firstChild;
    if (child == kPatternNone || pattern[child].setLevel < kPatternLevels) return false;
    uint32_t higher = 0;
    for (uint32_t k = child; k < child + 4; ++k) higher += burnLevel[k] > burnLevel[triangle];
    return higher >= 2;
}

}  // namespace fw::reference
