#version 450
// A volumetric flame's rays in cells of a few pixels, each of them once and whole, and kept slab by
// slab: what a slab adds does not depend on the scene, so the scene's depth, which is known later
// and for each pixel, chooses among slabs. A workgroup is a tile.
#extension GL_GOOGLE_include_directive : require
#include "shared/burn.h"
#include "shared/look.h"
#include "shared/volume_flame.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = FW_BIND_VIEW, std140) uniform View { ViewParams view; };
layout(set = 0, binding = FW_BIND_VOLUMES, std140) uniform Volume { VolumeFlame flame; };
layout(set = 0, binding = FW_BIND_VOLUME_RAYS, std430) buffer Rays { uint rays[]; };
layout(set = 1, binding = 0) uniform sampler2DArray profiles;
layout(push_constant) uniform Push { VolumeMarch march; };

#define FW_FLAME_NODE(i) flame.nodes[i]
#include "lib/colour.glsl"
#include "volume/ray.glsl"

FlameRay fresh() { return FlameRay(vec3(0.0), vec3(1.0)); }

void main() {
    FlameRecord f = flame.record;
    // Zero. A software device compiles a shader anew, in milliseconds a dispatch, for each set of
    // constants that alone decide its branches.
    uint zero = gl_GlobalInvocationID.x >> 31u;
    f.octaves |= zero;
    f.tint.w += float(zero);
    f.smoke += float(zero);
    f.puff += float(zero);
    uint tile = gl_WorkGroupID.x;
    // Eight that go together are four by two: they march as long as the longest of them.
    uint lane = gl_LocalInvocationIndex;
    uvec2 in_ = uvec2((lane & 3u) | ((lane >> 1u) & 4u), ((lane >> 2u) & 1u) | ((lane >> 4u) << 1u));
    uvec2 cell = uvec2(tile % march.tilesX, tile / march.tilesX) * kVolumeTile + in_;
    uvec2 place = cell + uvec2(march.originX, march.originY);
    vec3 ray = march.rayO.xyz + float(place.x) * march.rayX.xyz + float(place.y) * march.rayY.xyz;
    bool perspective = view.forward.w > 0.5;
    vec3 from = view.eye.xyz + (perspective ? vec3(0.0) : ray);
    vec3 along = perspective ? ray : view.forward.xyz;
    float perDepth = length(along);  // m along the ray per m along the view
    vec3 direction = along / perDepth;
    vec3 white = flameWhite(f, view.sunColor.w);
    f.air.rgb = flameAir(view.ambientSky.rgb, view.ambientGround.rgb, view.sunColor.rgb, white);

    vec4 spans = flameSpans(f, from, direction);
    RayTube tube = rayTube(f, spans, from, direction, march.intervals | zero);
    float metres =
        spans.x < spans.y ? tube.chord.gap * max(tube.chord.last - tube.chord.first, 0.0) : 0.0;
    float steps = volumeSteps(metres, march.rayY.w, march.mostSteps | zero);
    float stride = metres / steps;
    float begin = metres > 0.0 ? tube.chord.from + tube.chord.gap * tube.chord.first : 0.0;
    float phase = volumePhase(place.x, place.y, view.ambientSky.w);
    float pixel = march.rayX.w * (perspective ? 1.0 / perDepth : 0.0);
    // What is in front of all slabs, or behind them, belongs to the outermost.
    float perSlab = 1.0 / (march.deep * perDepth), front = march.rayO.w / march.deep;
    float farthest = float(march.slabs) - 1.0;

    FlameRay fires[kVolumeSlabs];
    FlameRay fronts[kVolumeSlabs];
    FlameRay backs[kVolumeSlabs];
    FW_UNROLL
    for (uint s = 0u; s < kVolumeSlabs; ++s) fires[s] = fronts[s] = backs[s] = fresh();
    FlameRay one = fresh();
    float slab = -1.0, before = 1.0, k = 0.0, last = metres > 0.0 ? steps : 0.0;
    while (k < last && before * one.through.g > 0.003) {
        float t = begin + stride * (k + phase);
        float now = clamp(floor(t * perSlab - front), 0.0, farthest);
        bool next = now != slab;
        before *= next ? one.through.g : 1.0;
        one.radiance = next ? vec3(0.0) : one.radiance;
        one.through = next ? vec3(1.0) : one.through;
        slab = now;
        FlameMedium m = rayMedium(f, tube, t, max(0.35 * stride, pixel * t));
        // lavapipe goes on with lanes that have left a loop where others stay: they add nothing.
        one = flameStep(one, m, vec3(0.0), k < last ? stride : 0.0);
        FW_UNROLL
        for (uint s = 0u; s < kVolumeSlabs; ++s) {
            bool here = slab == float(s);
            fires[s].radiance = here ? one.radiance : fires[s].radiance;
            fires[s].through = here ? one.through : fires[s].through;
        }
        k += 1.0;
    }

    float middle = begin + 0.5 * metres;
    stride = max(spans.w - spans.z, 0.0) / float(kFlameSmokeSteps);
    slab = -1.0;
    k = 0.0;
    last = spans.z < spans.w ? float(kFlameSmokeSteps) : 0.0;
    FlameSmokeRay smoke = FlameSmokeRay(fresh(), fresh());
    while (k < last) {
        float t = spans.z + stride * (k + phase);
        float now = clamp(floor(t * perSlab - front), 0.0, farthest);
        bool next = now != slab;
        smoke.front.radiance = next ? vec3(0.0) : smoke.front.radiance;
        smoke.front.through = next ? vec3(1.0) : smoke.front.through;
        smoke.back.radiance = next ? vec3(0.0) : smoke.back.radiance;
        smoke.back.through = next ? vec3(1.0) : smoke.back.through;
        slab = now;
        vec3 x = from + direction * t;
        smoke = flameSmokeStep(f, smoke, flamePlaceNear(tube.pieces, x), x,
                               metres > 0.0 && t > middle, k < last ? stride : 0.0);
        FW_UNROLL
        for (uint s = 0u; s < kVolumeSlabs; ++s) {
            bool here = slab == float(s);
            fronts[s].radiance = here ? smoke.front.radiance : fronts[s].radiance;
            fronts[s].through = here ? smoke.front.through : fronts[s].through;
            backs[s].radiance = here ? smoke.back.radiance : backs[s].radiance;
            backs[s].through = here ? smoke.back.through : backs[s].through;
        }
        k += 1.0;
    }

    vec3 shown = white * view.sunDirection.w;
    uint at = march.samples + kVolumeCellWords * (cell.y * (march.tilesX * kVolumeTile) + cell.x);
    uint lit = 0u;
    uint slabs = march.slabs | zero, encoding = march.encoding | zero;
    for (uint s = 0u; s < kVolumeSlabs; ++s) {
        if (s >= slabs) break;
        FlameSmokeRay around = FlameSmokeRay(fronts[s], backs[s]);
        vec3 scattered = around.front.radiance +
                         around.front.through * fires[s].through * around.back.radiance;
        vec4 color = flameShown(flameBetween(fires[s], around), scattered, shown, encoding);
        uvec2 words = uvec2(packHalf2x16(color.rg), packHalf2x16(color.ba));
        rays[at] = words.x;
        rays[at + 1u] = words.y;
        at += kVolumeCellWords * march.cells;
        lit |= max(max(color.r, color.g), max(color.b, color.a)) > 1e-4 ? 1u << s : 0u;
    }
    // In the tile; in its first and last column, first and last row.
    lit |= (in_.x == 0u ? lit << kVolumeSlabs : 0u) |
           (in_.x == kVolumeTile - 1u ? lit << (2u * kVolumeSlabs) : 0u) |
           (in_.y == 0u ? lit << (3u * kVolumeSlabs) : 0u) |
           (in_.y == kVolumeTile - 1u ? lit << (4u * kVolumeSlabs) : 0u);
    if (lit != 0u) atomicOr(rays[march.flags + tile], lit);
}
