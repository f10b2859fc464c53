#version 450
// A volumetric flame along one ray, or the part of it in one slab, for views that were not marched
// before; of a small flame, along many: samples at even steps through the tube, each with emission and absorption that are exact
// for its step, so that neither their number nor that of the slabs changes how bright it is.
// Premultiplied: light, and what it hides.
#extension GL_GOOGLE_include_directive : require
#include "shared/burn.h"
#include "shared/look.h"
#include "shared/volume_flame.h"

layout(constant_id = 0) const uint kEncoding = 0u;
layout(set = 0, binding = FW_BIND_VIEW, std140) uniform View { ViewParams view; };
layout(set = 0, binding = FW_BIND_VOLUMES, std140) uniform Volume { VolumeFlame flame; };
layout(set = 2, binding = 0) uniform sampler2DArray profiles;
layout(push_constant) uniform Push { VolumeDraw draw; };

layout(location = 0) in vec3 inRay;
layout(location = 1) flat in vec2 inSlab;
layout(location = 2) flat in uint inZero;
layout(location = 3) in float inBase;

layout(location = 0) out vec4 outColor;

#define FW_FLAME_NODE(i) flame.nodes[i]
#include "lib/colour.glsl"
#include "volume/ray.glsl"
#ifdef FW_SOFT
#include "volume/scene_depth.glsl"
#endif

// Of the four pixels that are shaded together.
vec3 meanOfFour(vec3 value) {
    vec2 to = 1.0 - 2.0 * vec2(uvec2(gl_FragCoord.xy) & 1u);  // the neighbours' side
    value += 0.5 * to.x * dFdxFine(value);
    return value + 0.5 * to.y * dFdyFine(value);
}

// Diameters of a flame within which the scene's depth at a pixel is the mean of four's on one surface.
const float kOneSurface = 0.02;

// Smoke has few samples, and each of four pixels begins them elsewhere: one by one they are seen as a screen door.
FlameSmokeRay smokeOfFour(FlameSmokeRay smoke) {
    FlameSmokeRay mean = FlameSmokeRay(FlameRay(meanOfFour(smoke.front.radiance), meanOfFour(smoke.front.through)),
                                       FlameRay(meanOfFour(smoke.back.radiance), meanOfFour(smoke.back.through)));
    bool alike = draw.perPixel == 1u;
#ifdef FW_SOFT
    // No light from behind an edge of the scene comes before it.
    float there = min(depthOfScene(draw.clip), 1e6);
    alike = alike && abs(there - meanOfFour(vec3(there)).x) < kOneSurface * draw.wide;
#endif
    if (alike) smoke = mean;
    return smoke;
}

// Of the ray `off` pixels beside the pixel's middle, whose samples begin `jitter` of a step late.
vec4 shownAlong(FlameRecord f, vec2 off, float jitter) {
    bool perspective = view.forward.w > 0.5;
    vec2 perPixel = 2.0 / abs(view.viewport.zw);
    vec3 way = inRay + off.x * perPixel.x * draw.rayX.xyz + off.y * perPixel.y * draw.rayY.xyz;
    vec3 from = view.eye.xyz + (perspective ? vec3(0.0) : way);
    vec3 along = perspective ? way : view.forward.xyz;
    float perDepth = length(along);  // m along the ray per m along the view
    vec3 direction = along / perDepth;
    vec3 white = flameWhite(f, view.sunColor.w);
    f.air.rgb = flameAir(view.ambientSky.rgb, view.ambientGround.rgb, white);
    FlameSun sun = raySun(direction, white);

    vec4 spans = flameSpans(f, from, direction);
#ifdef FW_SOFT
    spans.yw = min(spans.yw, vec2(depthOfScene(draw.clip) * perDepth));
#else
    // On the flame's side of the plane through its base: samples are as close as where ground is known.
    float base = inBase + off.x * perPixel.x * draw.base.y + off.y * perPixel.y * draw.base.z;
    float beyond = 0.5 - 0.5 * draw.base.w;
    base = volumeMetres(draw.clip, base) * perDepth;
    spans.xz = max(spans.xz, vec2(beyond * base));
    spans.yw = min(spans.yw, vec2(base + beyond * 1e9));
#endif
    float pixel = volumeFine(view.eye.w * (perspective ? 1.0 / perDepth : 0.0), draw.perPixel);
    vec2 slab = inSlab * perDepth;

    RayTube tube = rayTube(f, spans, from, direction, draw.intervals | inZero);
    FlameChord chord = tube.chord;
    float metres = spans.x < spans.y ? chord.gap * max(chord.last - chord.first, 0.0) : 0.0;
    float steps = volumeSteps(metres, draw.spacing, draw.mostSteps);
    float stride = metres / steps;
    float begin = metres > 0.0 ? chord.from + chord.gap * chord.first : 0.0;
    // Each sample is in one slab.
    vec2 ends = clamp(ceil((slab - begin) / max(stride, 1e-9) - jitter), 0.0, steps);
    float k = ends.x, last = metres > 0.0 ? ends.y : 0.0;
    FlameRay ray = FlameRay(vec3(0.0), vec3(1.0));
    while (k < last && ray.through.g > 0.003) {
        float t = begin + stride * (k + jitter);
        FlameMedium m = rayMedium(f, tube, t, max(0.35 * stride, pixel * t));
        // lavapipe goes on with lanes that have left a loop where others stay: they add nothing.
        ray = flameStep(ray, m, vec3(0.0), k < last ? stride : 0.0);
        k += 1.0;
    }

    float middle = begin + 0.5 * metres;
    stride = max(spans.w - spans.z, 0.0) / float(kFlameSmokeSteps);
    ends = clamp(ceil((slab - spans.z) / max(stride, 1e-9) - jitter), 0.0, float(kFlameSmokeSteps));
    k = ends.x;
    last = spans.z < spans.w ? ends.y : 0.0;
    FlameSmokeRay smoke = FlameSmokeRay(FlameRay(vec3(0.0), vec3(1.0)), FlameRay(vec3(0.0), vec3(1.0)));
    while (k < last) {
        float t = spans.z + stride * (k + jitter);
        vec3 x = from + direction * t;
        smoke = flameSmokeStep(f, smoke, flamePlaceNear(tube.pieces, x), x, sun, metres > 0.0 && t > middle,
                               k < last ? stride : 0.0);
        k += 1.0;
    }
    smoke = smokeOfFour(smoke);
    vec3 scattered = smoke.front.radiance + smoke.front.through * ray.through * smoke.back.radiance;
    ray = flameBetween(ray, smoke);

    return flameShown(ray, scattered, white * view.sunDirection.w, kEncoding);
}

void main() {
    FlameRecord f = flame.record;
    // Zero. A software device compiles a shader anew, in milliseconds a draw, for each set of
    // constants that alone decide its branches.
    f.octaves |= inZero;
    f.tint.w += float(inZero);
    f.smoke += float(inZero);
    f.puff += float(inZero);
    uint side = draw.perPixel | inZero;
    uvec2 first = uvec2(gl_FragCoord.xy) * side;
    vec4 sum = vec4(0.0);
    uint k = 0u;
    do {  // as many turns for all
        uvec2 cell = first + uvec2(k % side, k / side);
        vec2 off = (vec2(k % side, k / side) + 0.5 + (side > 1u ? volumeShift(cell.x, cell.y) : vec2(0.0))) /
                       float(side) - 0.5;
        sum += shownAlong(f, off, volumePhase(cell.x, cell.y));
        k += 1u;
    } while (k < side * side);
    outColor = sum / float(side * side);
}
