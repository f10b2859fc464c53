#include "volume/march.h"

#include "shared/volume_march.h"

#include "core/assert.h"

#include <algorithm>
#include <cmath>

namespace fw::volume {
Bounds flameBounds(const gpu::FlameRecord& flame, std::span<const gpu::FlameNode> nodes) noexcept {
    Bounds b{vec3(nodes.empty() ? 0.0f : 1e30f), vec3(nodes.empty() ? 0.0f : -1e30f)};
    for (size_t k = 0; k + 1 < nodes.size(); ++k) {
        if (nodes[k].along.w > topOf(flame)) break;
        const gpu::FlameNode &a = nodes[k], &next = nodes[k + 1];
        const vec3 reach(gpu::flameReachAt(flame, a.along.w, next.along.w,
                                           std::max(a.centre.w, next.centre.w),
                                           std::max(a.side.w, next.side.w)));
        for (const vec3 c : {vec3(a.centre), vec3(next.centre)})
            b.low = glm::min(b.low, c - reach), b.high = glm::max(b.high, c + reach);
    }
    return b;
}

float topOf(const gpu::FlameRecord& flame) noexcept {
    return flame.high.w * std::max(gpu::kFlameTop, flame.smoke > 0.0f ? flame.smokeTop : 0.0f);
}

vec2 flameChord(const gpu::FlameRecord& flame, std::span<const gpu::FlameNode> nodes, vec3 from,
                vec3 direction, float farthest, uint32_t intervals, RayKnots& out) noexcept {
    const vec4 spans = gpu::flameSpans(nodes.data(), flame, from, direction);
    const float end = std::min(spans.y, farthest);
    out = {};
    if (!(spans.x < end)) return vec2(0.0f);
    FW_ASSERT(nodes.size() == gpu::kFlameNodes, "%zu nodes", nodes.size());
    const uint32_t turns = std::clamp(intervals, 1u, gpu::kFlameIntervals);
    gpu::FlameChord chord{spans.x, (end - spans.x) / float(turns), 1e9f, -1e9f};
    const gpu::FlamePieces pieces = gpu::flamePieces(nodes.data());
    out.from = chord.from, out.gap = chord.gap;
    out.first = gpu::flameKnot(nodes.data(), pieces, from + direction * chord.from);
    vec4 knot = out.first;
    for (uint32_t i = 0; i < turns; ++i) {
        const vec3 x = from + direction * (chord.from + chord.gap * float(i + 1));
        const vec4 next = gpu::flameKnot(nodes.data(), pieces, x);
        out.delta[i] = next - knot;
        if (!gpu::flameWhole(chord, next - knot)) out.broken |= 1u << i;
        chord = gpu::flameInterval(flame, chord, float(i), knot, next - knot);
        knot = next;
    }
    if (!(chord.first < chord.last)) return vec2(0.0f);
    return chord.from + chord.gap * vec2(chord.first, chord.last);
}

}  // namespace fw::volume
