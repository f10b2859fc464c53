// The march of one ray through a flame on the CPU: the reference that the march pass is compared
// with. For tests, tools and queries, not for frames.
#pragma once
#include "volume/curve.h"
#include "volume/profile.h"

#include "shared/volume_march.h"

namespace fw::volume {

struct MarchRules {
    uint32_t steps = 64;                        // >= 1, over what the ray sees of the tube
    uint32_t intervals = gpu::kFlameIntervals;  // between knots, see volume_march.h
    float jitter = 0.5f;                        // [0, 1) of a step, where in it the sample lies
    float pixel = 0.0f;                         // m per m away, width of a pixel
    float detail = 0.0f;    // m: noise finer than this fades; 0: by step and pixel
    float farthest = 1e9f;  // m, the scene behind
    bool smoke = true;
    // As the march pass: `steps` samples this far apart, the first cell of them this far away,
    // and smoke from here on behind the flame. m; apart 0: over what the ray sees of the tube.
    float apart = 0.0f, first = 0.0f, middle = 0.0f;
    vec3 sun{0.0f};  // that smoke takes, see FlameSun::light, before its phase function
    vec3 toSun{0.0f, 1.0f, 0.0f};  // unit
};

gpu::FlameMedium sampleFlame(const gpu::FlameRecord& flame, const Profile& profile,
                             const gpu::FlamePlace& at, float size, bool smoke) noexcept;

// m along the curve to which anything shows.
float topOf(const gpu::FlameRecord& flame) noexcept;
// Of everything that shows. Conservative: outside there is nothing.
Bounds flameBounds(const gpu::FlameRecord& flame, std::span<const gpu::FlameNode> nodes) noexcept;

// From where to where a ray is in the tube, m; empty where x >= y. Conservative.
vec2 flameSpan(const gpu::FlameRecord& flame, std::span<const gpu::FlameNode> nodes, vec3 from,
               vec3 direction) noexcept;

// Where the curve is looked up along a ray.
struct RayKnots {
    float from = 0.0f, gap = 0.0f;  // m along the ray
    vec4 first{0.0f};
    vec4 delta[gpu::kFlameIntervals]{};
    uint32_t broken =
        0;  // a bit per interval in which the nearest place jumps: nothing burns there
};
// From where to where something may burn, m along the ray; empty where x >= y.
vec2 flameChord(const gpu::FlameRecord& flame, std::span<const gpu::FlameNode> nodes, vec3 from,
                vec3 direction, float farthest, uint32_t intervals, RayKnots& out) noexcept;

// `direction` is unit. What is behind the flame shows by ray.through.
gpu::FlameRay marchRay(const gpu::FlameRecord& flame, std::span<const gpu::FlameNode> nodes,
                       const Profile& profile, vec3 from, vec3 direction,
                       const MarchRules& rules) noexcept;

}  // namespace fw::volume
