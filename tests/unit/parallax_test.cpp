// Parallax occlusion by the shader's own code against the geometry that the reliefs represent.
#include <gtest/gtest.h>

#include "common/relief_maps.h"

#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>
#include <vector>

namespace fw::test {
namespace {

namespace parallax {
using namespace glm;
float (*relief)(vec2 at) = nullptr;
float reliefDepth(vec2 at) { return relief(at); }
vec2 (*cones)(vec2 at) = nullptr;
vec2 reliefCone(vec2 at) { return cones(at); }
#define RELIEF_CONES
#include "common/shaders/parallax.h"
}  // namespace parallax

using glm::vec2;
using glm::vec3;
using parallax::ReliefRay;

constexpr float kDeep = 0.5f;  // m

// A ray into a level relief from `from`, on or below z = 0, along unit `direction`.
ReliefRay rayOf(vec3 from, vec3 direction) {
    return {vec2(from), vec2(direction), -from.z, -direction.z, 0, 1e3f};
}

vec3 unitDirection(float angle, float down) {
    const float flat = std::sqrt(1 - down * down);
    return {flat * std::cos(angle), flat * std::sin(angle), -down};
}

// Half a ball of radius kDeep on the floor of a relief of that depth.
float dome(vec2 at) {
    const float square = kDeep * kDeep - glm::dot(at, at);
    return square > 0 ? 1 - std::sqrt(square) / kDeep : 1;
}
// m from z = 0 to the ball; negative: misses.
float domeHit(vec3 from, vec3 direction) {
    const vec3 middle = from + vec3(0, 0, kDeep);
    const float b = glm::dot(middle, direction), c = glm::dot(middle, middle) - kDeep * kDeep;
    return b * b >= c ? -b - std::sqrt(b * b - c) : -1;
}

TEST(Parallax, ADomeLooksLikeItsBall) {
    parallax::relief = dome;
    double squares = 0, hits = 0, both = 0, either = 0;
    for (float down : {0.35f, 0.5f, 0.7f, 0.95f})
        for (int j = -60; j <= 60; ++j)
            for (int i = -60; i <= 60; ++i) {
                // Parallel rays across a picture, passing around the ball's middle.
                const vec3 direction = unitDirection(0.4f, down),
                           side(-std::sin(0.4f), std::cos(0.4f), 0);
                const vec3 up = glm::cross(direction, side);
                const vec3 at = vec3(0, 0, -kDeep) + 0.011f * (float(i) * side + float(j) * up);
                const vec3 from = at + direction * (at.z / down);  // back to z = 0
                const float mesh = domeHit(from, direction);
                const bool there = mesh >= 0 && (from + direction * mesh).z > -kDeep;
                const ReliefRay ray = rayOf(from, direction);
                const float hit = parallax::reliefHit(ray, kDeep, 48);
                ASSERT_GE(hit, 0);  // the floor is always hit
                const bool found = parallax::reliefBelow(ray, hit) < 0.999f * kDeep;
                both += there && found;
                either += there || found;
                if (there && found) {
                    const double off =
                        parallax::reliefBelow(ray, hit) + (from + direction * mesh).z;
                    squares += off * off;
                    ++hits;
                }
            }
    const double rms = std::sqrt(squares / hits) / double(kDeep);
    std::printf("depth off by %.3f %% of the relief (RMS), silhouettes agree by %.4f\n", 100 * rms,
                both / either);
    EXPECT_GT(hits, 10000);
    EXPECT_LT(rms, 0.005);
    EXPECT_GT(both / either, 0.97);
}

TEST(Parallax, UsesFewLayersFromAbove) {
    EXPECT_EQ(8, parallax::reliefLayers(1, 1000, 8, 48));
    EXPECT_EQ(48, parallax::reliefLayers(0, 1000, 8, 48));
    EXPECT_EQ(7, parallax::reliefLayers(0.1f, 3, 8, 48));  // three texels hold no more
    EXPECT_EQ(4, parallax::reliefLayers(1, 0, 8, 48));
    parallax::relief = dome;
    for (int i = 0; i < 50; ++i) {
        const vec3 from(0.01f * float(i), 0.1f, 0), direction = unitDirection(float(i), 0.97f);
        const float mesh = domeHit(from, direction);
        if (mesh < 0) continue;
        EXPECT_NEAR(mesh, parallax::reliefHit(rayOf(from, direction), kDeep, 8), 0.01f * kDeep)
            << i;
    }
}

// A round log whose relief is at its bottom everywhere looks like a thinner log.
TEST(Parallax, SilhouettesShrinkOnCurvedSurfaces) {
    parallax::relief = [](vec2) { return 1.0f; };
    constexpr float kRound = 0.3f, kBark = 0.02f;
    for (float offset = 0.005f; offset < kRound; offset += 0.005f) {
        // Along x past the axis (y) at a height: enters where the surface has this height.
        const float rise = offset / kRound, flat = std::sqrt(1 - rise * rise);
        ReliefRay ray{vec2(0), vec2(rise, 0), 0, flat, 0, 1e3f};
        ray.sag = 0.5f / kRound * rise * rise;
        const float hit = parallax::reliefHit(ray, kBark, 32);
        const bool expected = offset < kRound - kBark;
        // A parabola approximates the circle: an error of a tenth of the bark is allowed.
        if (std::abs(offset - (kRound - kBark)) > 0.1f * kBark) {
            EXPECT_EQ(expected, hit >= 0) << offset;
        }
        if (expected && hit >= 0 && offset < 0.8f * (kRound - kBark)) {
            const float inner = kRound - kBark;
            const float direction = std::sqrt(kRound * kRound - offset * offset) -
                                    std::sqrt(inner * inner - offset * offset);
            EXPECT_NEAR(direction, hit, 0.08f * direction) << offset;
        }
    }
}

TEST(Parallax, StopsAtTheBorder) {
    parallax::relief = dome;
    ReliefRay ray = rayOf({-2, 0, 0}, unitDirection(0, 0.1f));
    ray.most = 0.5f;  // the ray ends before it reaches the relief
    EXPECT_LT(parallax::reliefHit(ray, kDeep, 48), 0);
    // From inside the stone sideways it hits at once; upwards out of it, nothing.
    EXPECT_EQ(0, parallax::reliefHit(rayOf({0, 0, -0.3f}, unitDirection(0, 0.5f)), kDeep, 48));
    EXPECT_LT(parallax::reliefHit(rayOf({-0.9f, 0, -0.3f}, unitDirection(3.1f, -0.5f)), kDeep, 48),
              0);
}

TEST(Parallax, ShadowsGrowWithTheirCaster) {
    // A wall at x = 0 of height `wall`; light comes over it from the left at 45 degrees.
    static float wall;
    parallax::relief = [](vec2 at) { return std::abs(at.x) < 0.05f ? 1 - wall : 1.0f; };
    const vec3 light = glm::normalize(vec3(-1, 0, 1));
    double before = -1;
    for (wall = 0.2f; wall <= 1; wall += 0.2f) {
        double dark = 0;
        float last = 0;
        for (float x = 0.06f; x < 1.2f; x += 0.01f) {
            const float lit =
                parallax::reliefLit({x, 0}, vec2(light), light.z, kDeep, kDeep, 2, 64);
            EXPECT_GE(lit, 0);
            EXPECT_LE(lit, 1);
            if (x > 0.1f) {
                EXPECT_GE(lit, last - 0.12f) << "darker again at " << x;  // one step's width
            }
            last = lit;
            dark += 1 - double(lit);
        }
        EXPECT_EQ(1, last) << "far from the wall";
        EXPECT_GT(dark, before) << "a wall of " << wall;
        before = dark;
    }
    EXPECT_EQ(1, parallax::reliefLit({0, 0}, vec2(light), light.z, 0, kDeep, 2, 64));
    EXPECT_EQ(0, parallax::reliefLit({0, 0}, vec2(-1, 0), -0.1f, 0.1f, kDeep, 2, 64));
}

// Round stones side by side on a repeating picture of 1 m, with joints between.
constexpr uint32_t kTexels = 128;
constexpr float kStones = 6, kStoneDepth = 0.05f;  // stones per row; m
float stones(vec2 at) {
    const vec2 cell = glm::fract(at * kStones) - 0.5f;
    return std::min(1.0f, 8 * glm::dot(cell, cell) * glm::dot(cell, cell) * 4);
}

struct StoneMaps {
    std::vector<float> heights = std::vector<float>(kTexels * kTexels);
    std::vector<float> cones;
    sample::ReliefHorizon horizonMap;
    StoneMaps() {
        for (uint32_t i = 0; i < kTexels * kTexels; ++i)
            heights[i] = 1 - stones((vec2(i % kTexels, i / kTexels) + 0.5f) / float(kTexels));
        const sample::ReliefHeights relief{kTexels, kTexels, {1, 1}, kStoneDepth, true, heights};
        cones = sample::reliefCones(relief);
        horizonMap = sample::reliefHorizon(relief);
    }
    // Bilinear and repeating, like a device.
    template <class Read>
    static auto between(vec2 at, uint32_t side, Read read) {
        const vec2 p = at * float(side) - 0.5f, low = glm::floor(p), f = p - low;
        const auto texel = [&](int i, int j) {
            const auto n = int(side);
            const int x = ((int(low.x) + i) % n + n) % n, y = ((int(low.y) + j) % n + n) % n;
            return read(size_t(y) * side + size_t(x));
        };
        return glm::mix(glm::mix(texel(0, 0), texel(1, 0), f.x),
                        glm::mix(texel(0, 1), texel(1, 1), f.x), f.y);
    }
    [[nodiscard]] vec2 read(vec2 at) const {
        return between(at, kTexels, [&](size_t i) { return vec2(1 - heights[i], cones[i]); });
    }
    [[nodiscard]] glm::vec4 horizon(vec2 at) const {
        const std::vector<uint8_t>& of = horizonMap.texels;
        return between(at, horizonMap.width, [&](size_t i) {
            return glm::vec4(of[4 * i], of[4 * i + 1], of[4 * i + 2], of[4 * i + 3]) / 255.0f;
        });
    }
};
const StoneMaps& stoneMaps() {
    static const StoneMaps maps;
    return maps;
}

TEST(Parallax, ConesAreEmpty) {
    const StoneMaps& maps = stoneMaps();
    float narrowest = 1e9f, widest = 0;
    for (uint32_t i = 0; i < kTexels * kTexels; i += 37) {
        const vec2 at(i % kTexels, i / kTexels);
        narrowest = std::min(narrowest, maps.cones[i]);
        widest = std::max(widest, maps.cones[i]);
        for (int y = -40; y <= 40; ++y)
            for (int x = -40; x <= 40; ++x) {
                const uint32_t there =
                    ((uint32_t(at.y) + kTexels + uint32_t(y)) % kTexels) * kTexels +
                    (uint32_t(at.x) + kTexels + uint32_t(x)) % kTexels;
                const float up = (maps.heights[there] - maps.heights[i]) * kStoneDepth;
                const float aside = glm::length(vec2(x, y)) / float(kTexels);
                ASSERT_LE(maps.cones[i] * up, aside * 1.0001f) << i << ": " << x << ", " << y;
            }
    }
    EXPECT_LT(narrowest, 1.0f);  // in the joints
    EXPECT_EQ(sample::kWidestCone, widest);
}

TEST(Parallax, ConeStepsMatchManyLayers) {
    parallax::relief = [](vec2 at) { return stoneMaps().read(at).x; };
    parallax::cones = [](vec2 at) { return stoneMaps().read(at); };
    for (const float down : {0.25f, 0.48f, 0.9f}) {
        double squares = 0, far = 0;
        int rays = 0;
        for (int i = 0; i < 4000; ++i) {
            const vec3 from(0.0137f * float(i % 63), 0.0219f * float(i / 63), 0);
            const ReliefRay ray = rayOf(from, unitDirection(0.37f * float(i), down));
            const float wanted = parallax::reliefHit(ray, kStoneDepth, 400);
            const float hit = parallax::reliefHitByCones(ray, kStoneDepth, 8);
            ASSERT_GE(hit, 0) << i;
            const double off =
                double(parallax::reliefBelow(ray, hit) - parallax::reliefBelow(ray, wanted)) /
                double(kStoneDepth);
            squares += off * off;
            far += std::abs(off) > 0.1;
            ++rays;
        }
        std::printf(
            "down %.2f: depth off by %.2f %% of the relief (RMS), %.2f %% of rays by over 10 %%\n",
            double(down), 100 * std::sqrt(squares / rays), 100 * far / rays);
        EXPECT_LT(std::sqrt(squares / rays), 0.1);  // a few slip past a corner
        EXPECT_LT(far / rays, 0.06);
    }
}

TEST(Parallax, HorizonsMatchSteppedShadows) {
    parallax::relief = [](vec2 at) { return stoneMaps().read(at).x; };
    const StoneMaps& maps = stoneMaps();
    double off = 0, bias = 0, shaded = 0;
    int places = 0;
    for (const float up : {0.2f, 0.45f, 0.8f})
        for (int i = 0; i < 2000; ++i) {
            const vec2 at(0.0137f * float(i % 63), 0.0219f * float(i / 63));
            const vec3 light = -unitDirection(0.71f * float(i), up);
            const float depth = kStoneDepth * maps.read(at).x;
            const float wanted =
                parallax::reliefLit(at, vec2(light), light.z, depth, kStoneDepth, 3, 200);
            const float lit =
                parallax::reliefLitByHorizon(maps.horizon(at), vec2(light), light.z, 3);
            off += std::abs(double(lit - wanted));
            bias += double(lit - wanted);
            shaded += 1 - double(wanted);
            ++places;
        }
    std::printf("shadows off by %.3f, their mean by %.3f, where %.3f is in shade\n", off / places,
                bias / places, shaded / places);
    EXPECT_GT(shaded / places, 0.1);
    EXPECT_LT(off / places, 0.16);  // four directions miss some of what lies between
    EXPECT_LT(std::abs(bias / places), 0.07);
}

}  // namespace
}  // namespace fw::test
