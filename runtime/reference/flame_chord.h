// The part of a ray in which a flame can burn, for tools and tests that march on the CPU. Frames
// march on the device.
#pragma once
#include "core/assert.h"
#include "shared/volume_march.h"

#include <algorithm>
#include <span>

namespace fw::volume {

using gpu::vec2;
using gpu::vec3;
using gpu::vec4;

// Samples of the curve along a ray.
struct RayKnots {
    float from = 0.0f, gap = 0.0f;  // m along the ray
    vec4 first{0.0f};
    vec4 delta[gpu::kFlameIntervals]{};
    uint32_t broken = 0;  // bit per interval in which the nearest place jumps: nothing burns there
};
// m along the ray; empty where x >= y.
inline vec2 flameChord(const gpu::FlameRecord& flame, std::span<const gpu::FlameNode> nodes,
                       vec3 from, vec3 direction, float farthest, uint32_t intervals,
                       RayKnots& out) noexcept {
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
