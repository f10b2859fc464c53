// See relief_pictures.h.
#include "common/relief_pictures.h"

#include <algorithm>
#include <cmath>

#include "textures.h"

namespace sample {
namespace {

void setColor(ReliefPicture& p, size_t at, glm::vec3 albedo, float roughness) {
    for (int c = 0; c < 3; ++c)
        p.color[at * 4 + static_cast<size_t>(c)] = toByte(std::sqrt(std::max(albedo[c], 0.0f)));
    p.color[at * 4 + 3] = toByte(roughness);
}

ReliefPicture blank(uint32_t side, float metres, float depth) {
    ReliefPicture p;
    p.width = p.height = side;
    p.metres = glm::vec2(metres);
    p.depth = depth;
    p.color.resize(size_t{side} * side * 4);
    p.heights.resize(size_t{side} * side);
    return p;
}

float random(int x, int y, uint32_t seed) {
    uint32_t h = static_cast<uint32_t>(x) * 0x9E3779B1u ^ static_cast<uint32_t>(y) * 0x85EBCA77u ^
                 seed * 0xC2B2AE3Du;
    h = (h ^ (h >> 15)) * 0x2C1B3C6Du;
    h = (h ^ (h >> 12)) * 0x297A2D39u;
    return static_cast<float>((h ^ (h >> 15)) >> 8) / 16777216.0f;
}

// Tiles every `cells` cells.
float noise(glm::vec2 p, int cells, uint32_t seed) {
    p *= static_cast<float>(cells);
    const glm::vec2 low = glm::floor(p), f = p - low, s = f * f * (3.0f - 2.0f * f);
    const int x = static_cast<int>(low.x), y = static_cast<int>(low.y);
    auto at = [&](int i, int j) {
        return random((i % cells + cells) % cells, (j % cells + cells) % cells, seed);
    };
    return glm::mix(glm::mix(at(x, y), at(x + 1, y), s.x),
                    glm::mix(at(x, y + 1), at(x + 1, y + 1), s.x), s.y);
}

}  // namespace

ReliefPicture cobbles(uint32_t side, float metres) {
    constexpr float kDeepest = 0.05f;  // m, slightly more than the stones' height
    ReliefPicture p = blank(side, metres, kDeepest);
    const float texel = metres / static_cast<float>(side);
    for (uint32_t y = 0; y < side; ++y)
        for (uint32_t x = 0; x < side; ++x) {
            const village::Vec2 place{(static_cast<float>(x) + 0.5f) * texel,
                                      (static_cast<float>(y) + 0.5f) * texel};
            const village::Surface s =
                village::paintSurface(village::Texture::kCobble, place, texel, {1, 1, 1}, 0);
            const size_t at = size_t{y} * side + x;
            setColor(p, at, {s.albedo.x, s.albedo.y, s.albedo.z}, s.roughness);
            p.heights[at] = std::clamp(s.height / kDeepest, 0.0f, 1.0f);
        }
    return p;
}

ReliefPicture charredWood(uint32_t side, float metres, uint32_t seed) {
    ReliefPicture p = blank(side, metres, 0.014f);
    constexpr int kAcross = 7, kAlong = 5;  // blocks per picture
    for (uint32_t y = 0; y < side; ++y)
        for (uint32_t x = 0; x < side; ++x) {
            const glm::vec2 uv = (glm::vec2(x, y) + 0.5f) / static_cast<float>(side);
            const glm::vec2 bent =
                uv + 0.035f * (glm::vec2(noise(uv, 9, seed), noise(uv, 9, seed + 1)) - 0.5f);
            const glm::vec2 q = bent * glm::vec2(kAcross, kAlong);
            const glm::vec2 cell = glm::floor(q);
            // The distances to the nearest two points of a jittered grid; a crack runs where they
            // are equal.
            float nearest = 9, second = 9, which = 0;
            for (int j = -1; j <= 1; ++j)
                for (int i = -1; i <= 1; ++i) {
                    const int cx = static_cast<int>(cell.x) + i, cy = static_cast<int>(cell.y) + j;
                    const int wx = (cx % kAcross + kAcross) % kAcross;
                    const int wy = (cy % kAlong + kAlong) % kAlong;
                    const glm::vec2 point =
                        glm::vec2(cx, cy) +
                        glm::vec2(random(wx, wy, seed + 2), random(wx, wy, seed + 3)) * 0.8f + 0.1f;
                    const float d = glm::length(q - point);
                    second = std::min(second, std::max(nearest, d));
                    if (d < nearest) which = random(wx, wy, seed + 4);
                    nearest = std::min(nearest, d);
                }
            const float crack = second - nearest;
            const float pillow = glm::smoothstep(0.0f, 0.28f, crack);
            const float grain = noise(uv * glm::vec2(1, 0.25f), 48, seed + 5);
            const float fine = noise(uv, 90, seed + 6);
            const float height =
                pillow * (0.72f + 0.28f * which) + 0.10f * (grain - 0.5f) + 0.05f * (fine - 0.5f);
            const size_t at = size_t{y} * side + x;
            p.heights[at] = std::clamp(0.06f + 0.9f * height, 0.0f, 1.0f);
            const float shade = 0.016f + 0.022f * pillow * (0.5f + grain);
            const float ash =
                glm::smoothstep(0.62f, 0.9f, fine) * glm::smoothstep(0.4f, 0.8f, which);
            setColor(p, at, glm::mix(glm::vec3(shade), glm::vec3(0.19f, 0.185f, 0.18f), 0.5f * ash),
                     0.5f + 0.25f * fine);
        }
    return p;
}

}  // namespace sample
