// The curve of a flame: a cubic B-spline from a base, with a radius along it, as evenly spaced
// nodes with bisector planes and a twist-free frame. Fixed storage, no heap. Takes any finite
// points: coincident, collinear, looping, few. motion.h moves them.
#pragma once
#include "shared/volume.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>

namespace fw::volume {

using gpu::vec2;
using gpu::vec3;
using gpu::vec4;

// v / |v|; for a vector without a direction the other one.
inline vec3 unitOr(vec3 v, vec3 fallback, float least = 1e-6f) noexcept {
    const float l = glm::length(v);
    return l > least && std::isfinite(l) ? v / l : fallback;
}
// A vector turned by a unit quaternion xyzw.
inline vec3 turned(vec4 q, vec3 v) noexcept {
    const vec3 u(q);
    return v + 2.0f * glm::cross(u, glm::cross(u, v) + q.w * v);
}
// A unit vector across a unit vector.
inline vec3 anyNormalTo(vec3 t) noexcept {
    const vec3 axis = std::abs(t.x) < 0.8f ? vec3(1.0f, 0.0f, 0.0f) : vec3(0.0f, 0.0f, 1.0f);
    return glm::normalize(axis - t * glm::dot(axis, t));
}
inline vec3 vecOf(const float v[3]) noexcept { return {v[0], v[1], v[2]}; }

constexpr uint32_t kMaxControlPoints = 32;
constexpr uint32_t kArcEntries = 64;  // intervals of the arc-length table

struct ControlPoint {
    vec3 position{0.0f};  // m
    float radius = 0.0f;  // m, >= 0
};

struct CurveSample {
    vec3 position{0.0f};
    vec3 tangent{0.0f, 1.0f, 0.0f};  // unit
    float radius = 0.0f;
};

// The spline itself, by parameter and by arc length.
class Curve {
 public:
    // Uses the first kMaxControlPoints. Coincident points become a short straight piece along `up`.
    void set(std::span<const ControlPoint> points, vec3 up) noexcept;
    [[nodiscard]] float length() const noexcept { return arc_[kArcEntries]; }  // m, > 0
    // At s metres from the base; straight on beyond either end.
    [[nodiscard]] CurveSample at(float s) const noexcept;

 private:
    [[nodiscard]] CurveSample evaluate(float u) const noexcept;  // u in [0, 1]
    [[nodiscard]] vec3 slope(float u) const noexcept;            // dp/du

    std::array<vec4, kMaxControlPoints + 2> points_{};  // with a phantom at each end
    std::array<float, kArcEntries + 1> arc_{};          // m from the base
    uint32_t spans_ = 1;
    vec3 up_{0.0f, 1.0f, 0.0f};
};

using FlameNodes = std::array<gpu::FlameNode, gpu::kFlameNodes>;

// Nodes every length / (kFlameNodes - 1) metres. Radii are clamped so that no two neighbouring
// bisector planes meet inside the tube: each point of it then lies between one pair of planes.
void placeFlameNodes(const Curve& curve, float length, FlameNodes& nodes) noexcept;
// Levels the lowest planes, so that a leaning flame stands flat on its bed: fully at the base, not
// at all from `over` metres on; scaled by `weight`.
void raiseNodes(std::span<gpu::FlameNode> nodes, vec3 up, float over, float weight) noexcept;
// Computes radius limits and frames again after nodes moved; `nodes` keep their places.
void repairNodes(std::span<gpu::FlameNode> nodes, vec3 up) noexcept;

// The place of a point in the curve's coordinates, between the pair of planes whose axis is nearest
// in radii. None: before the base or beyond the end.
struct Located {
    gpu::FlamePlace place;
    float rho = 0.0f;    // |p| over radius
    float angle = 0.0f;  // radians around the axis, from `side`
    uint32_t segment = 0;
};
std::optional<Located> locate(std::span<const gpu::FlameNode> nodes, vec3 point) noexcept;

struct Bounds {
    vec3 low{0.0f}, high{0.0f};
};

}  // namespace fw::volume
