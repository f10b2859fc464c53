#include "reference/flame_march.h"

#include <algorithm>
#include <cmath>

namespace fw::volume {
namespace {

float reachOf(const gpu::FlameRecord& flame, const gpu::FlameNode& a,
              const gpu::FlameNode& b) noexcept {
    return gpu::flameReachAt(flame, a.along.w, b.along.w, std::max(a.centre.w, b.centre.w),
                             std::max(a.side.w, b.side.w));
}

// Range of a ray near a segment, by a bounding sphere: x to y, none where x >= y. reach: m from the
// axis.
vec2 segmentSpan(vec3 from, vec3 direction, const gpu::FlameNode& a, const gpu::FlameNode& b,
                 float reach) noexcept {
    const vec3 half = 0.5f * (vec3(b.centre) - vec3(a.centre));
    const vec3 to = vec3(a.centre) + half - from;
    const float radius = glm::length(half) + reach, at = glm::dot(to, direction);
    const float room = radius * radius - (glm::dot(to, to) - at * at);
    const float along = std::sqrt(std::max(room, 0.0f));
    return room > 0.0f ? vec2(std::max(at - along, 0.0f), at + along) : vec2(0.0f);
}

}  // namespace

gpu::FlameMedium sampleFlame(const gpu::FlameRecord& flame, const Profile& profile,
                             const gpu::FlamePlace& at, float size, bool smoke) noexcept {
    gpu::FlameMedium m{0.0f, 0.0f, 0.5f, vec3(0.0f)};
    const gpu::FlameLookup look = gpu::flameLookup(flame, at, size);
    if (look.lit > 0.0f) m = gpu::flameMedium(flame, look, profile.sample(look.rho, look.y));
    if (smoke) {
        const vec2 s = gpu::flameSmoke(flame, at);
        m.smoke = flame.air.w * s.x, m.smokeShade = s.y;
    }
    return m;
}

vec2 flameSpan(const gpu::FlameRecord& flame, std::span<const gpu::FlameNode> nodes, vec3 from,
               vec3 direction) noexcept {
    vec2 span(1e30f, -1e30f);
    for (size_t k = 0; k + 1 < nodes.size(); ++k) {
        const vec2 s = segmentSpan(from, direction, nodes[k], nodes[k + 1],
                                   reachOf(flame, nodes[k], nodes[k + 1]));
        if (s.x < s.y) span = vec2(std::min(span.x, s.x), std::max(span.y, s.y));
    }
    return span;
}

gpu::FlameRay marchRay(const gpu::FlameRecord& flame, std::span<const gpu::FlameNode> nodes,
                       const Profile& profile, vec3 from, vec3 direction,
                       const MarchRules& rules) noexcept {
    gpu::FlameRay ray{vec3(0.0f), vec3(1.0f)};
    if (nodes.size() != gpu::kFlameNodes) return ray;
    RayKnots knots;
    const vec2 chord =
        flameChord(flame, nodes, from, direction, rules.farthest, rules.intervals, knots);
    const bool planes = rules.apart > 0.0f;
    const float step =
        planes ? rules.apart : (chord.y - chord.x) / float(std::max(rules.steps, 1u));
    const float begin = planes ? rules.first : chord.x;
    const bool burns = chord.x < chord.y;
    for (uint32_t k = 0; burns && k < rules.steps && ray.through.g > 0.003f; ++k) {
        const float t = begin + step * (float(k) + rules.jitter);
        const float u = (t - knots.from) / knots.gap;
        gpu::FlameMedium m{};
        if (t >= chord.x && t <= chord.y && ((knots.broken >> uint32_t(u)) & 1u) == 0) {
            const gpu::FlamePlace at = gpu::flameAlong(knots.first, knots.delta, u);
            const float size =
                rules.detail > 0.0f ? rules.detail : std::max(0.35f * step, rules.pixel * t);
            m = sampleFlame(flame, profile, at, size, false);
        }
        ray = gpu::flameStep(ray, m, vec3(0.0f), step);
    }
    if (!rules.smoke) return ray;
    const vec4 spans = gpu::flameSpans(nodes.data(), flame, from, direction);
    const float metres = std::min(spans.w, rules.farthest) - spans.z;
    gpu::FlameSmokeRay smoke{{vec3(0.0f), vec3(1.0f)}, {vec3(0.0f), vec3(1.0f)}};
    const gpu::FlamePieces pieces = gpu::flamePieces(nodes.data());
    const float stride = metres / float(gpu::kFlameSmokeSteps);
    const gpu::FlameSun sun = gpu::flameSun(nodes.back(), rules.toSun, direction, rules.sun);
    for (uint32_t k = 0; metres > 0.0f && k < gpu::kFlameSmokeSteps; ++k) {
        const float t = spans.z + stride * (float(k) + rules.jitter);
        const vec3 x = from + direction * t;
        const bool behind = planes ? t > rules.middle : burns && t > 0.5f * (chord.x + chord.y);
        smoke = gpu::flameSmokeStep(flame, smoke, gpu::flamePlaceNear(nodes.data(), pieces, x), x,
                                    sun, behind, stride);
    }
    return gpu::flameBetween(ray, smoke);
}

}  // namespace fw::volume
