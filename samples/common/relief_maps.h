// What is known of a relief before anyone looks at it, so that a pixel reads little: how wide a
// cone each place sees the sky through, and how high its horizon stands all around.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace sample {

struct ReliefHeights {
    uint32_t width = 0, height = 0;  // texels
    glm::vec2 metres{1};             // the picture's size
    float depth = 0.05f;             // m, from the highest to the lowest
    bool repeats = false;
    std::span<const float> heights;  // [0, 1], 1 the highest
};

// The widest cone that a map tells, m aside for each m up. What sees more is level ground.
inline constexpr float kWidestCone = 8.0f;

// Of each texel: m aside for each m up, so that nothing stands in the open cone above it.
std::vector<float> reliefCones(const ReliefHeights& relief);

// Half as wide and high as the relief: of each texel the horizon's tangents t, as t / (1 + t).
// RGBA8: along u, along v, against u, against v.
struct ReliefHorizon {
    uint32_t width = 0, height = 0;
    std::vector<uint8_t> texels;
};
ReliefHorizon reliefHorizon(const ReliefHeights& relief);

}  // namespace sample
