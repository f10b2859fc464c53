#version 450
// A volumetric flame along one ray, or the part of it in one slab: samples at even steps through the
// tube, each with emission and absorption that are exact for its step, so that neither their number
// nor that of the slabs changes how bright it is. Premultiplied: light, and what it hides.
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

layout(location = 0) out vec4 outColor;

#define FW_FLAME_NODE(i) flame.nodes[i]
#include "shared/volume_march.h"

#include "lib/colour.glsl"

#ifdef FW_SOFT
// The host's depth at this pixel; of several samples the first, for a choice of one needs a feature.
#if FW_SOFT == 2
layout(set = 3, binding = 0) uniform sampler2DMS sceneDepth;
#else
layout(set = 3, binding = 0) uniform sampler2D sceneDepth;
#endif

// m along the view to what the host drew, from depth = clip z / clip w.
float depthOfScene() {
    float depth = texelFetch(sceneDepth, ivec2(gl_FragCoord.xy), 0).r;
    float per = draw.clip.x - depth * draw.clip.z;
    float at = (depth * draw.clip.w - draw.clip.y) / (abs(per) > 1e-12 ? per : 1e-12);
    return at > 0.0 ? at : 1e9;  // at the far end of an infinite view
}
#endif

void main() {
    FlameRecord f = flame.record;
    // Zero. A software device compiles a shader anew, in milliseconds a draw, for each set of
    // constants that alone decide its branches.
    f.octaves |= inZero;
    f.tint.w += float(inZero);
    f.smoke += float(inZero);
    f.puff += float(inZero);
    bool perspective = view.forward.w > 0.5;
    vec3 from = view.eye.xyz + (perspective ? vec3(0.0) : inRay);
    vec3 along = perspective ? inRay : view.forward.xyz;
    float perDepth = length(along);  // m along the ray per m along the view
    vec3 direction = along / perDepth;
    // Soot glows as a camera that is set for fire sees it; tints are what they are.
    vec3 white = mix(vec3(1.0, 1.25, 1.6), vec3(1.0), f.tint.w) *
                 (kVolumeWhite * max(view.sunColor.w, 1e-6));
    f.air.rgb = (0.5 * (view.ambientSky.rgb + view.ambientGround.rgb) +
                 0.15 * view.sunColor.rgb) / white;

    float farthest = 1e9;
#ifdef FW_SOFT
    farthest = depthOfScene() * perDepth;
#endif
    vec4 spans = flameSpans(f, from, direction);
    spans.yw = min(spans.yw, vec2(farthest));
    float jitter = volumeJitter(gl_FragCoord.x, gl_FragCoord.y, view.ambientSky.w);
    float pixel = view.eye.w * (perspective ? 1.0 / perDepth : 0.0);
    vec2 slab = inSlab * perDepth;

    // Loops that end for all at once test last: a software device runs one turn more of others.
    uint turns = draw.intervals | inZero;
    vec4 delta[kFlameIntervals];
    FW_UNROLL
    for (uint k = 0u; k < kFlameIntervals; ++k) delta[k] = vec4(0.0);
    FlameChord chord = FlameChord(spans.x, max(spans.y - spans.x, 0.0) / float(turns), 1e9, -1e9);
    FlamePieces pieces = flamePieces();
    vec4 first = flameKnot(pieces, from + direction * chord.from);
    vec4 knot = first;
    uint i = 0u;
    do {
        vec4 next = flameKnot(pieces, from + direction * (chord.from + chord.gap * float(i + 1u)));
        FW_UNROLL
        for (uint k = 0u; k < kFlameIntervals; ++k) delta[k] = i == k ? next - knot : delta[k];
        chord = flameInterval(f, chord, float(i), knot, next - knot);
        knot = next;
        i += 1u;
    } while (i < turns);
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
        FlamePlace at = flameAlong(first, delta, (t - chord.from) / max(chord.gap, 1e-9));
        FlameLookup look = flameLookup(f, at, max(0.35 * stride, pixel * t));
        vec2 texel = vec2(look.rho * (float(kProfileWidth) / kProfileReach),
                          look.y * float(kProfileHeight));
        vec2 size = vec2(float(kProfileWidth), float(kProfileHeight));
        vec2 uv = clamp(texel, vec2(0.5), size - 0.5) / size;
        FlameMedium m = FlameMedium(0.0, 0.0, 0.5, vec3(0.0));
        if (look.lit > 0.0)
            m = flameMedium(f, look, textureLod(profiles, vec3(uv, float(f.profile)), 0.0).xy);
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
        smoke = flameSmokeStep(f, smoke, flamePlaceNear(pieces, x), x, metres > 0.0 && t > middle,
                               k < last ? stride : 0.0);
        k += 1.0;
    }
    vec3 scattered = smoke.front.radiance + smoke.front.through * ray.through * smoke.back.radiance;
    ray = flameBetween(ray, smoke);

    float alpha = 1.0 - dot(ray.through, vec3(0.2126, 0.7152, 0.0722));
    vec3 color = ray.radiance * white * view.sunDirection.w;
    if (kEncoding != 0u) {
        // Blending happens on what is shown. Smoke is a thing with a colour; flame adds light, and
        // a thin one must turn red, not grey.
        vec3 grey = scattered * white * view.sunDirection.w;
        float cover = max(alpha, 1e-4);
        color = encodeOutput(max(color - grey, vec3(0.0)), kEncoding) +
                encodeOutput(grey / cover, kEncoding) * cover;
    }
    outColor = vec4(min(color, vec3(60000.0)), alpha);
}
