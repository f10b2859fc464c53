// Bounds of a flame, and the part of a ray in which the flame can burn. The flipbook tool marches
// with them; frames march on the device.
#pragma once
#include "volume/curve.h"
#include "volume/profile.h"

#include "shared/volume_march.h"

namespace fw::volume {

// m along the curve, end of the visible flame and smoke.
float topOf(const gpu::FlameRecord& flame) noexcept;
// Conservative bounds of the visible flame and smoke.
Bounds flameBounds(const gpu::FlameRecord& flame, std::span<const gpu::FlameNode> nodes) noexcept;

// Samples of the curve along a ray.
struct RayKnots {
    float from = 0.0f, gap = 0.0f;  // m along the ray
    vec4 first{0.0f};
    vec4 delta[gpu::kFlameIntervals]{};
    uint32_t broken = 0;  // bit per interval in which the nearest place jumps: nothing burns there
};
// The part of a ray in which the flame may burn, m along the ray; empty where x >= y.
vec2 flameChord(const gpu::FlameRecord& flame, std::span<const gpu::FlameNode> nodes, vec3 from,
                vec3 direction, float farthest, uint32_t intervals, RayKnots& out) noexcept;

}  // namespace fw::volume
