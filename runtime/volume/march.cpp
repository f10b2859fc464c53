// One ray through one flame, by the shader's own text.
#include "volume/march.h"

#include <algorithm>
#include <cmath>

namespace fw::volume {
namespace {

float reachOf(const gpu::FlameRecord& flame, const gpu::FlameNode& a,
              const gpu::FlameNode& b) noexcept {
    return gpu::flameReachAt(flame, a.along.w, b.along.w, std::max(a.centre.w, b.centre.w),
                             std::max(a.side.w, b.side.w));
}

}  // namespace

Bounds flameBounds(const gpu::FlameRecord& flame, std::span<const gpu::FlameNode> nodes) noexcept {
    Bounds b{vec3(nodes.empty() ? 0.0f : 1e30f), vec3(nodes.empty() ? 0.0f : -1e30f)};
    for (size_t k = 0; k + 1 < nodes.size(); ++k) {
        if (nodes[k].along.w > topOf(flame)) break;
        const vec3 reach(reachOf(flame, nodes[k], nodes[k + 1]));
        for (const vec3 c : {vec3(nodes[k].centre), vec3(nodes[k + 1].centre)})
            b.low = glm::min(b.low, c - reach), b.high = glm::max(b.high, c + reach);
    }
    return b;
}

float topOf(const gpu::FlameRecord& flame) noexcept {
    return flame.high.w * std::max(gpu::kFlameTop, flame.smoke > 0.0f ? flame.smokeTop : 0.0f);
}

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
        const vec2 s = gpu::flameSegmentSpan(from, direction, nodes[k], nodes[k + 1],
                                             reachOf(flame, nodes[k], nodes[k + 1]));
        if (s.x < s.y) span = vec2(std::min(span.x, s.x), std::max(span.y, s.y));
    }
    return span;
}

gpu::FlameRay marchRay(const gpu::FlameRecord& flame, std::span<const gpu::FlameNode> nodes,
                       const Profile& profile, vec3 from, vec3 direction,
                       const MarchRules& rules) noexcept {
    gpu::FlameRay ray{vec3(0.0f), vec3(1.0f)};
    vec2 span = flameSpan(flame, nodes, from, direction);
    span.y = std::min(span.y, rules.farthest);
    if (!(span.x < span.y)) return ray;
    const float step = (span.y - span.x) / float(std::max(rules.steps, 1u));
    for (uint32_t k = 0; k < rules.steps && ray.through.g > 0.003f; ++k) {
        const float t = span.x + step * (float(k) + rules.jitter);
        const vec3 x = from + direction * t;
        const auto at = locate(nodes, x);
        if (!at) continue;
        const float size =
            rules.detail > 0.0f ? rules.detail : std::max(0.35f * step, rules.pixel * t);
        const gpu::FlameMedium m = sampleFlame(flame, profile, at->place, size, rules.smoke);
        const vec3 to = vec3(flame.glow) - x;
        const vec3 incoming = gpu::flameSmokeLight(flame, dot(to, to), m.smokeShade);
        ray = gpu::flameStep(ray, m, incoming, step);
    }
    return ray;
}

}  // namespace fw::volume
