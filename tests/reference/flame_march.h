// The march of one ray through a flame on the CPU, by the shader's own text: the reference for the
// march pass.
#pragma once
#include "reference/flame_chord.h"
#include "volume/flame.h"

namespace fw::volume {

struct MarchRules {
    uint32_t steps = 64;                        // >= 1, over the ray's part of the tube
    uint32_t intervals = gpu::kFlameIntervals;  // between knots, see volume_march.h
    float jitter = 0.5f;                        // [0, 1) of a step, position of the sample in it
    float pixel = 0.0f;                         // m per m away, width of a pixel
    float detail = 0.0f;    // m: noise finer than this fades; 0: by step and pixel
    float farthest = 1e9f;  // m, the scene behind
    bool smoke = true;
    // m: as the march pass samples, `steps` samples `apart` from `first` on; smoke beyond `middle`
    // lies behind the flame. apart 0: spread over the ray's part of the tube.
    float apart = 0.0f, first = 0.0f, middle = 0.0f;
    vec3 sun{0.0f};  // light on the smoke before its phase function, see FlameSun::light
    vec3 toSun{0.0f, 1.0f, 0.0f};  // unit
};

gpu::FlameMedium sampleFlame(const gpu::FlameRecord& flame, const Profile& profile,
                             const gpu::FlamePlace& at, float size, bool smoke) noexcept;

// Start and end of a ray's part of the tube, m; empty where x >= y. Conservative.
vec2 flameSpan(const gpu::FlameRecord& flame, std::span<const gpu::FlameNode> nodes, vec3 from,
               vec3 direction) noexcept;

// `direction` is unit. ray.through is the share of light that passes the flame.
gpu::FlameRay marchRay(const gpu::FlameRecord& flame, std::span<const gpu::FlameNode> nodes,
                       const Profile& profile, vec3 from, vec3 direction,
                       const MarchRules& rules) noexcept;

}  // namespace fw::volume
