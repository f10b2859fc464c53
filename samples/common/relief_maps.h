// Maps that are computed once per relief, so that a pixel reads little: the open cone above each
// texel, and its horizon in four directions.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace sample {

struct ReliefHeights {
    uint32_t width = 0, height = 0;  // texels
    glm::vec2 metres{1};             // m, size of the picture
    float depth = 0.05f;             // m, from the highest to the lowest
    bool repeats = false;
    std::span<const float> heights;  // [0, 1], 1 the highest
};

// The widest cone that a map stores, m sideways per m up. Anything wider counts as level ground.
inline constexpr float kWidestCone = 8.0f;

// Returns, per texel, m sideways per m up of the widest open cone above it.
std::vector<float> reliefCones(const ReliefHeights& relief);

// Half the relief's resolution. Per texel the horizon's tangents t, as t / (1 + t). RGBA8: along u,
// along v, against u, against v.
struct ReliefHorizon {
    uint32_t width = 0, height = 0;
    std::vector<uint8_t> texels;
};
ReliefHorizon reliefHorizon(const ReliefHeights& relief);

}  // namespace sample
