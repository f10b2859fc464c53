// The spline of a flame: uniform cubic B-spline, arc length by Simpson, double-reflection frames.
#include "volume/curve.h"

#include "core/assert.h"

#include <algorithm>
#include <cmath>

namespace fw::volume {
namespace {

constexpr float kTiny = 1e-6f;           // m
constexpr float kPlaneMargin = 0.9f;     // of the radius at which two bisector planes meet
constexpr float kSteepestRadius = 1.0f;  // m per m along: a clamped radius does not jump

// Double reflection (Wang, Jüttler, Zheng, Liu 2008): the next frame's side.
vec3 nextSide(vec3 from, vec3 to, vec3 tangent, vec3 nextTangent, vec3 side) noexcept {
    const vec3 v1 = to - from;
    const float c1 = glm::dot(v1, v1);
    vec3 s = side, t = tangent;
    if (c1 > kTiny * kTiny) {
        s -= v1 * (2.0f / c1 * glm::dot(v1, side));
        t -= v1 * (2.0f / c1 * glm::dot(v1, tangent));
    }
    const vec3 v2 = nextTangent - t;
    const float c2 = glm::dot(v2, v2);
    if (c2 > kTiny) s -= v2 * (2.0f / c2 * glm::dot(v2, s));
    s -= nextTangent * glm::dot(nextTangent, s);
    return unitOr(s, anyNormalTo(nextTangent));
}

}  // namespace

void Curve::set(std::span<const ControlPoint> points, vec3 up) noexcept {
    up_ = unitOr(up, vec3(0.0f, 1.0f, 0.0f));
    const uint32_t count = uint32_t(std::min<size_t>(points.size(), kMaxControlPoints));
    uint32_t n = 0;
    for (uint32_t k = 0; k < count; ++k)
        points_[++n] = vec4(points[k].position, std::max(points[k].radius, 0.0f));
    if (n == 0) points_[++n] = vec4(0.0f);
    float extent = 0.0f;
    for (uint32_t k = 2; k <= n; ++k)
        extent = std::max(extent, glm::length(vec3(points_[k]) - vec3(points_[1])));
    if (n < 2 || extent < 1e-4f) {  // one place: a short piece, to have a direction
        const float piece = std::max(points_[1].w, 1e-3f);
        const float last = points_[n].w;
        n = 2;
        points_[2] = vec4(vec3(points_[1]) + up_ * piece, last);
    }
    const auto phantom = [](vec4 end, vec4 next) {
        const vec4 p = 2.0f * end - next;
        return vec4(vec3(p), end.w);
    };
    points_[0] = phantom(points_[1], points_[2]);
    points_[n + 1] = phantom(points_[n], points_[n - 1]);
    FW_ASSERT(n >= 2 && n + 1 < points_.size(), "%u points", n);
    spans_ = n - 1;

    arc_[0] = 0.0f;
    const float h = 1.0f / float(kArcEntries);
    float before = glm::length(slope(0.0f));
    for (uint32_t k = 0; k < kArcEntries; ++k) {
        const float middle = glm::length(slope((float(k) + 0.5f) * h));
        const float after = glm::length(slope(float(k + 1) * h));
        arc_[k + 1] = arc_[k] + h / 6.0f * (before + 4.0f * middle + after);
        before = after;
    }
    if (!(arc_[kArcEntries] > 0.0f)) arc_[kArcEntries] = kTiny;
}

CurveSample Curve::evaluate(float u) const noexcept {
    FW_ASSERT(spans_ > 0 && spans_ < kMaxControlPoints, "%u spans", spans_);
    const float x = std::clamp(u, 0.0f, 1.0f) * float(spans_);
    const uint32_t k = std::min(uint32_t(x), spans_ - 1);
    const float t = x - float(k), r = 1.0f - t;
    const vec4 p =
        (points_[k] * (r * r * r) + points_[k + 1] * (3.0f * t * t * (t - 2.0f) + 4.0f) +
         points_[k + 2] * (3.0f * r * r * (r - 2.0f) + 4.0f) + points_[k + 3] * (t * t * t)) /
        6.0f;
    return {vec3(p), unitOr(slope(u), up_), std::max(p.w, 0.0f)};
}

vec3 Curve::slope(float u) const noexcept {
    const float x = std::clamp(u, 0.0f, 1.0f) * float(spans_);
    const uint32_t k = std::min(uint32_t(x), spans_ - 1);
    const float t = x - float(k), r = 1.0f - t;
    const vec3 a = vec3(points_[k + 1] - points_[k]), b = vec3(points_[k + 2] - points_[k + 1]),
               c = vec3(points_[k + 3] - points_[k + 2]);
    return float(spans_) * 0.5f * (a * (r * r) + b * (1.0f + 2.0f * t * r) + c * (t * t));
}

CurveSample Curve::at(float s) const noexcept {
    if (s <= 0.0f || s >= length()) {
        CurveSample end = evaluate(s <= 0.0f ? 0.0f : 1.0f);
        end.position += end.tangent * (s <= 0.0f ? s : s - length());
        return end;
    }
    const auto above = std::upper_bound(arc_.begin(), arc_.end(), s);
    const uint32_t k = uint32_t(above - arc_.begin()) - 1;
    FW_ASSERT(k < kArcEntries, "piece %u", k);
    const float piece = arc_[k + 1] - arc_[k];
    return evaluate((float(k) + (piece > 0.0f ? (s - arc_[k]) / piece : 0.0f)) /
                    float(kArcEntries));
}

void placeFlameNodes(const Curve& curve, float length, FlameNodes& nodes) noexcept {
    FW_ASSERT(std::isfinite(length), "%g m", double(length));
    const float step = std::max(length, 1e-4f) / float(nodes.size() - 1);
    vec3 tangent = curve.at(0.0f).tangent;
    for (size_t k = 0; k < nodes.size(); ++k) {
        const CurveSample at = curve.at(step * float(k));
        // Where the spline's slope is zero, the previous tangent holds.
        tangent = unitOr(at.tangent, tangent);
        nodes[k].centre = vec4(at.position, at.radius);
        nodes[k].along = vec4(tangent, step * float(k));
        nodes[k].side = vec4(0.0f, 0.0f, 0.0f, 1.0f);
        nodes[k].squeeze = vec4(0.0f, 1.0f, 0.0f, 0.0f);
    }
    repairNodes(nodes, vec3(nodes[0].along));
}

void raiseNodes(std::span<gpu::FlameNode> nodes, vec3 up, float over, float weight) noexcept {
    FW_ASSERT(weight >= 0 && weight <= 1, "weight %g", double(weight));
    for (gpu::FlameNode& node : nodes) {
        const float level =
            weight - weight * glm::smoothstep(0.0f, std::max(over, kTiny), node.along.w);
        // Gas that flows down or sideways keeps its direction.
        const float upright = glm::smoothstep(0.05f, 0.4f, glm::dot(vec3(node.along), up));
        node.along =
            vec4(unitOr(glm::mix(vec3(node.along), up, level * upright), up), node.along.w);
    }
    repairNodes(nodes, up);
}

void repairNodes(std::span<gpu::FlameNode> nodes, vec3 up) noexcept {
    if (nodes.empty()) return;
    const size_t n = nodes.size();
    vec3 before = vec3(nodes[0].along);
    if (glm::length(before) < 0.5f) before = unitOr(up, vec3(0.0f, 1.0f, 0.0f));
    vec3 side = anyNormalTo(before);
    for (size_t k = 0; k < n; ++k) {
        const vec3 along = unitOr(vec3(nodes[k].along), before);
        if (k > 0)
            side = nextSide(vec3(nodes[k - 1].centre), vec3(nodes[k].centre), before, along, side);
        nodes[k].along = vec4(along, nodes[k].along.w);
        nodes[k].side = vec4(side, nodes[k].side.w);
        before = along;
    }
    // For neighbours a and b: a point c_a + p of a's plane lies before b's while p.t_b < h.t_b.
    const auto limit = [&](const gpu::FlameNode& a, const gpu::FlameNode& b) {
        const vec3 ta = vec3(a.along), tb = vec3(b.along), h = vec3(b.centre) - vec3(a.centre);
        const float lean = glm::length(tb - ta * glm::dot(ta, tb)) * gpu::kFlameReach;
        const float room = kPlaneMargin * std::min(glm::dot(h, tb), glm::dot(h, ta));
        return lean * 1e4f <= room ? 1e4f : std::max(room, 0.0f) / std::max(lean, kTiny);
    };
    for (size_t k = 0; k < n; ++k) {
        float most = nodes[k].centre.w;
        if (k > 0) most = std::min(most, limit(nodes[k - 1], nodes[k]));
        if (k + 1 < n) most = std::min(most, limit(nodes[k], nodes[k + 1]));
        nodes[k].centre.w = std::isfinite(most) ? std::max(most, 0.0f) : 0.0f;
    }
    // Limits the slope of the radius.
    for (size_t k = 1; k < n; ++k)
        nodes[k].centre.w = std::min(
            nodes[k].centre.w,
            nodes[k - 1].centre.w + kSteepestRadius * (nodes[k].along.w - nodes[k - 1].along.w));
    for (size_t k = n - 1; k > 0; --k)
        nodes[k - 1].centre.w = std::min(
            nodes[k - 1].centre.w,
            nodes[k].centre.w + kSteepestRadius * (nodes[k].along.w - nodes[k - 1].along.w));
}

std::optional<Located> locate(std::span<const gpu::FlameNode> nodes, vec3 point) noexcept {
    std::optional<Located> best;
    for (size_t k = 0; k + 1 < nodes.size(); ++k) {
        const float da = gpu::flamePlane(point, nodes[k]),
                    db = gpu::flamePlane(point, nodes[k + 1]);
        if (da < 0.0f || db >= 0.0f) continue;
        Located here{gpu::flamePlaceAt(point, nodes[k], nodes[k + 1], da, db), 0.0f, 0.0f,
                     uint32_t(k)};
        here.rho = glm::length(here.place.p) / std::max(here.place.radius, kTiny);
        if (!best || here.rho < best->rho) best = here;
    }
    if (best && best->rho > 0.0f) best->angle = std::atan2(best->place.p.y, best->place.p.x);
    return best;
}

}  // namespace fw::volume
