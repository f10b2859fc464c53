// The village's small maths library: 2D and 3D vectors, rigid frames, hashes and value noise.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace village {

constexpr float kPi = 3.14159265f;

struct Vec2 {
    float x = 0, y = 0;
};
struct Vec3 {
    float x = 0, y = 0, z = 0;
};

inline Vec2 operator+(Vec2 a, Vec2 b) { return {a.x + b.x, a.y + b.y}; }
inline Vec2 operator-(Vec2 a, Vec2 b) { return {a.x - b.x, a.y - b.y}; }
inline Vec2 operator*(Vec2 a, float s) { return {a.x * s, a.y * s}; }
inline Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3 operator*(Vec3 a, Vec3 b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
inline Vec3 operator*(Vec3 a, float s) { return {a.x * s, a.y * s, a.z * s}; }

inline float dot(Vec2 a, Vec2 b) { return a.x * b.x + a.y * b.y; }
inline float dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3 cross(Vec3 a, Vec3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline float length(Vec2 a) { return std::sqrt(dot(a, a)); }
inline float length(Vec3 a) { return std::sqrt(dot(a, a)); }
// Maps the zero vector to straight up, so that a degenerate face still has a normal.
inline Vec3 normalize(Vec3 a) {
    const float l = length(a);
    return l > 0 ? a * (1 / l) : Vec3{0, 1, 0};
}
inline Vec3 minimum(Vec3 a, Vec3 b) {
    return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}
inline Vec3 maximum(Vec3 a, Vec3 b) {
    return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}

inline float clamp01(float x) { return std::min(1.0f, std::max(0.0f, x)); }
inline float mix(float a, float b, float t) { return a + (b - a) * t; }
inline Vec3 mix(Vec3 a, Vec3 b, float t) { return a + (b - a) * t; }
// Allows falling edges: a > b inverts the step.
inline float smoothStep(float a, float b, float x) {
    const float t = clamp01((x - a) / (b - a));
    return t * t * (3 - 2 * t);
}

inline uint32_t hash(uint32_t a) {
    a ^= a >> 16;
    a *= 0x7feb352du;
    a ^= a >> 15;
    a *= 0x846ca68bu;
    return a ^ (a >> 16);
}
// Uniform in [0, 1], a pure function of the cell and the seed.
inline float random01(int x, int y, uint32_t seed) {
    const uint32_t h =
        hash(uint32_t(x) * 0x9E3779B1u ^ hash(uint32_t(y) * 0x85EBCA77u ^ hash(seed)));
    return float(h) * (1 / 4294967296.0f);
}
// Value noise in [-1, 1], one cell per unit.
inline float noise(float x, float y, uint32_t seed) {
    const float fx = std::floor(x), fy = std::floor(y);
    float u = x - fx, v = y - fy;
    u = u * u * (3 - 2 * u);
    v = v * v * (3 - 2 * v);
    const int i = int(fx), j = int(fy);
    const float low = mix(random01(i, j, seed), random01(i + 1, j, seed), u);
    const float high = mix(random01(i, j + 1, seed), random01(i + 1, j + 1, seed), u);
    return 2 * mix(low, high, v) - 1;
}
// Octaves of noise in about [-1, 1]. footprint: width of a texel in cells of the first octave.
// Octaves finer than two texels fade out, so that a bake never aliases.
inline float fbm(float x, float y, int octaves, uint32_t seed, float footprint = 0) {
    float sum = 0, amplitude = 0.5f;
    for (int o = 0; o < octaves; ++o) {
        const float keep = footprint > 0 ? 1 - smoothStep(0.35f, 0.9f, footprint) : 1;
        if (keep <= 0) break;
        sum += keep * amplitude * noise(x, y, seed + uint32_t(o));
        x = x * 2.03f + 17;
        y = y * 2.03f + 31;
        amplitude *= 0.5f;
        footprint *= 2.03f;
    }
    return sum;
}

// A frame of three axes (the columns) and an origin.
struct Frame {
    Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1}, origin{};
    Vec3 direction(Vec3 a) const { return x * a.x + y * a.y + z * a.z; }
    Vec3 point(Vec3 a) const { return direction(a) + origin; }
    Frame operator*(const Frame& b) const {
        return {direction(b.x), direction(b.y), direction(b.z), point(b.origin)};
    }
};
inline Frame translate(float x, float y, float z) {
    Frame f;
    f.origin = {x, y, z};
    return f;
}
inline Frame rotateX(float a) {
    const float c = std::cos(a), s = std::sin(a);
    return {{1, 0, 0}, {0, c, s}, {0, -s, c}, {}};
}
inline Frame rotateY(float a) {
    const float c = std::cos(a), s = std::sin(a);
    return {{c, 0, -s}, {0, 1, 0}, {s, 0, c}, {}};
}
inline Frame rotateZ(float a) {
    const float c = std::cos(a), s = std::sin(a);
    return {{c, s, 0}, {-s, c, 0}, {0, 0, 1}, {}};
}
inline Frame scale(float s) { return {{s, 0, 0}, {0, s, 0}, {0, 0, s}, {}}; }
// The y axis runs from a to b; the origin is a.
inline Frame along(Vec3 a, Vec3 b) {
    const Vec3 y = normalize(b - a);
    const Vec3 helper = std::fabs(y.y) > 0.98f ? Vec3{0, 0, 1} : Vec3{0, 1, 0};
    const Vec3 x = normalize(cross(helper, y));
    return {x, y, cross(x, y), a};
}

}  // namespace village
