// A volumetric flame along one ray, or many for a small flame, or the part in one slab, for views
// without a previous march. Emission and absorption are exact per step, so brightness depends
// neither on the number of steps nor of slabs. Output is premultiplied: light, and coverage.
#include "volume/flame.glsl"

layout(constant_id = 0) const uint kEncoding = 0u;
layout(set = 2, binding = 0) uniform sampler2DArray profiles;
layout(push_constant) uniform Push { VolumeDraw draw; };

layout(location = 0) in vec3 inRay;
layout(location = 1) flat in vec2 inSlab;
layout(location = 2) flat in uint inZero;
layout(location = 3) in float inBase;

layout(location = 0) out vec4 outColor;

#include "lib/colour.glsl"
#include "volume/ray.glsl"
#ifdef FW_SOFT
#include "volume/scene_depth.glsl"
#endif

// Mean over the four pixels of a shading quad.
vec3 meanOfFour(vec3 value) {
    vec2 to = 1.0 - 2.0 * vec2(uvec2(gl_FragCoord.xy) & 1u);  // towards the neighbours
    value += 0.5 * to.x * dFdxFine(value);
    return value + 0.5 * to.y * dFdyFine(value);
}

// Depth range, in flame diameters, within which four pixels lie on one surface.
const float kOneSurface = 0.02;

// Smoke has few samples with a phase per pixel: unfiltered they show as a screen-door pattern.
FlameSmokeRay smokeOfFour(FlameSmokeRay smoke) {
    FlameSmokeRay mean =
        FlameSmokeRay(FlameRay(meanOfFour(smoke.front.radiance), meanOfFour(smoke.front.through)),
                      FlameRay(meanOfFour(smoke.back.radiance), meanOfFour(smoke.back.through)));
    bool alike = draw.perPixel == 1u;
#ifdef FW_SOFT
    // No light from behind a depth edge leaks in front of it.
    float there = min(depthOfScene(draw.clip), 1e6);
    alike = alike && abs(there - meanOfFour(vec3(there)).x) < kOneSurface * draw.wide;
#endif
    if (alike) smoke = mean;
    return smoke;
}

// Colour along the ray `off` pixels from the pixel's middle, with samples delayed by `jitter` of a
// step.
vec4 shownAlong(FlameRecord f, vec2 off, float jitter) {
    vec2 perPixel = 2.0 / abs(view.viewport.zw);
    ViewRay along =
        viewRay(inRay + off.x * perPixel.x * draw.rayX.xyz + off.y * perPixel.y * draw.rayY.xyz);
    vec3 from = along.from, direction = along.direction;
    float perDepth = along.perDepth;
    vec3 white = flameWhite(f, view.sunColor.w);
    f.air.rgb = flameAir(view.ambientSky.rgb, view.ambientGround.rgb, white);
    FlameSun sun = raySun(direction, white);

    vec4 spans = flameSpans(f, from, direction);
#ifdef FW_SOFT
    spans.yw = min(spans.yw, vec2(depthOfScene(draw.clip) * perDepth));
#else
    // Limits samples to the flame's side of the base plane, as dense as where the ground is known.
    float base = inBase + off.x * perPixel.x * draw.base.y + off.y * perPixel.y * draw.base.z;
    float beyond = 0.5 - 0.5 * draw.base.w;
    base = metresOfDepth(draw.clip, base) * perDepth;
    spans.xz = max(spans.xz, vec2(beyond * base));
    spans.yw = min(spans.yw, vec2(base + beyond * 1e9));
#endif
    float pixel = sampleFootprint(view.eye.w * along.perMetre, draw.perPixel);
    vec2 slab = inSlab * perDepth;

    RayTube tube = rayTube(f, spans, from, direction, draw.intervals | inZero);
    FlameChord chord = tube.chord;
    float metres = spans.x < spans.y ? chord.gap * max(chord.last - chord.first, 0.0) : 0.0;
    float steps = rayStepCount(metres, draw.spacing, draw.mostSteps);
    float stride = metres / steps;
    float begin = metres > 0.0 ? chord.from + chord.gap * chord.first : 0.0;
    // A sample belongs to one slab.
    vec2 ends = clamp(ceil((slab - begin) / max(stride, 1e-9) - jitter), 0.0, steps);
    float k = ends.x, last = metres > 0.0 ? ends.y : 0.0;
    FlameRay ray = FlameRay(vec3(0.0), vec3(1.0));
    while (k < last && ray.through.g > 0.003) {
        float t = begin + stride * (k + jitter);
        FlameMedium m = rayMedium(f, tube, t, max(0.35 * stride, pixel * t));
        // lavapipe continues lanes that left a loop while others stay: they add nothing.
        ray = flameStep(ray, m, vec3(0.0), k < last ? stride : 0.0);
        k += 1.0;
    }

    float middle = begin + 0.5 * metres;
    stride = max(spans.w - spans.z, 0.0) / float(kFlameSmokeSteps);
    ends = clamp(ceil((slab - spans.z) / max(stride, 1e-9) - jitter), 0.0, float(kFlameSmokeSteps));
    k = ends.x;
    last = spans.z < spans.w ? ends.y : 0.0;
    FlameSmokeRay smoke =
        FlameSmokeRay(FlameRay(vec3(0.0), vec3(1.0)), FlameRay(vec3(0.0), vec3(1.0)));
    while (k < last) {
        float t = spans.z + stride * (k + jitter);
        vec3 x = from + direction * t;
        smoke = flameSmokeStep(f, smoke, flamePlaceNear(tube.pieces, x), x, sun,
                               metres > 0.0 && t > middle, k < last ? stride : 0.0);
        k += 1.0;
    }
    smoke = smokeOfFour(smoke);
    vec3 scattered = smoke.front.radiance + smoke.front.through * ray.through * smoke.back.radiance;
    ray = flameBetween(ray, smoke);

    return flameShown(ray, scattered, white * view.sunDirection.w, kEncoding);
}

void main() {
    FlameRecord f = flame.record;
    addZero(f, inZero);
    uint side = draw.perPixel | inZero;
    uvec2 first = uvec2(gl_FragCoord.xy) * side;
    vec4 sum = vec4(0.0);
    uint k = 0u;
    do {  // the same number of iterations for all
        uvec2 at = first + uvec2(k % side, k / side);
        vec2 off = (vec2(k % side, k / side) + 0.5 +
                    (side > 1u ? marchRayShift(at.x, at.y) : vec2(0.0))) /
                       float(side) -
                   0.5;
        sum += shownAlong(f, off, marchSamplePhase(at.x, at.y));
        k += 1u;
    } while (k < side * side);
    outColor = sum / float(side * side);
}
