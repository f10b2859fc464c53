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

// Where along which pair of planes; x < 0: before the base or beyond the end.
vec3 segmentOf(vec3 x) {
    vec3 found = vec3(-1.0, 0.0, -1.0);
    float best = 1e30;
    float da = flamePlane(x, flame.nodes[0]);
    // Constant indices: software devices read the block once for all lanes then.
    FW_UNROLL
    for (uint k = 0u; k + 1u < kFlameNodes; ++k) {
        float db = flamePlane(x, flame.nodes[k + 1u]);
        vec4 axis = mix(flame.nodes[k].centre, flame.nodes[k + 1u].centre, da / max(da - db, 1e-9));
        vec3 off = x - axis.xyz;
        float cost = dot(off, off) / max(axis.w * axis.w, 1e-12);
        bool nearer = da >= 0.0 && db < 0.0 && cost < best;
        best = nearer ? cost : best;
        found = nearer ? vec3(float(k), da, db) : found;
        da = db;
    }
    return found;
}

// Where the ray is in the tube, conservatively.
vec2 spanOf(FlameRecord f, vec3 from, vec3 direction) {
    vec2 span = vec2(1e30, -1e30);
    FW_UNROLL
    for (uint k = 0u; k + 1u < kFlameNodes; ++k) {
        FlameNode a = flame.nodes[k], b = flame.nodes[k + 1u];
        float reach = flameReachAt(f, a.along.w, b.along.w, max(a.centre.w, b.centre.w),
                                   max(a.side.w, b.side.w));
        vec2 s = flameSegmentSpan(from, direction, a, b, reach);
        bool seen = s.x < s.y;
        span.x = seen ? min(span.x, s.x) : span.x;
        span.y = seen ? max(span.y, s.y) : span.y;
    }
    return span;
}

void main() {
    FlameRecord f = flame.record;
    // Zero. A software device compiles a shader anew, in milliseconds a draw, for each set of
    // constants that alone decide its branches.
    f.octaves |= inZero;
    f.tint.w += float(inZero);
    f.smoke += float(inZero);
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

    vec2 span = spanOf(f, from, direction);
#ifdef FW_SOFT
    span.y = min(span.y, depthOfScene() * perDepth);
#endif
    float metres = max(span.y - span.x, 0.0);
    span.x = metres > 0.0 ? span.x : 0.0;
    float steps = volumeSteps(metres, draw.spacing, draw.mostSteps);
    float stride = metres / steps;
    float jitter = volumeJitter(gl_FragCoord.x, gl_FragCoord.y, view.ambientSky.w);
    // Each sample is in one slab.
    vec2 ends = (inSlab * perDepth - span.x) / max(stride, 1e-9) - jitter;
    float k = clamp(ceil(ends.x), 0.0, steps), last = clamp(ceil(ends.y), 0.0, steps);
    last = metres > 0.0 ? last : 0.0;
    float pixel = view.eye.w * (perspective ? 1.0 / perDepth : 0.0);

    FlameRay ray = FlameRay(vec3(0.0), vec3(1.0));
    vec3 scattered = vec3(0.0);
    while (k < last && ray.through.g > 0.003) {
        float t = span.x + stride * (k + jitter);
        vec3 x = from + direction * t;
        vec3 found = segmentOf(x);
        FlameMedium m = FlameMedium(0.0, 0.0, 0.5, vec3(0.0));
        vec3 incoming = vec3(0.0);
        if (found.x >= 0.0) {
            uint a = uint(found.x);
            FlamePlace at = flamePlaceAt(x, flame.nodes[a], flame.nodes[a + 1u], found.y, found.z);
            FlameLookup look = flameLookup(f, at, max(0.35 * stride, pixel * t));
            vec2 texel = vec2(look.rho * (float(kProfileWidth) / kProfileReach),
                              look.y * float(kProfileHeight));
            vec2 size = vec2(float(kProfileWidth), float(kProfileHeight));
            vec2 uv = clamp(texel, vec2(0.5), size - 0.5) / size;
            if (look.lit > 0.0)
                m = flameMedium(f, look, textureLod(profiles, vec3(uv, float(f.profile)), 0.0).xy);
            vec2 smoke = flameSmoke(f, at);
            m.smoke = f.air.w * smoke.x;
            m.smokeShade = smoke.y;
            vec3 to = f.glow.xyz - x;
            incoming = flameSmokeLight(f, dot(to, to), m.smokeShade);
        }
        // lavapipe goes on with lanes that have left a loop where others stay: they add nothing.
        float d = k < last ? stride : 0.0;
        vec3 before = ray.radiance;
        vec3 share = m.smoke * incoming / (m.emission + m.smoke * incoming + vec3(1e-20));
        ray = flameStep(ray, m, incoming, d);
        scattered += (ray.radiance - before) * share;
        k += 1.0;
    }

    float alpha = 1.0 - dot(ray.through, vec3(0.2126, 0.7152, 0.0722));
    vec3 color = ray.radiance * white * view.sunDirection.w;
    if (kEncoding != 0u) {
        // Blending happens on what is shown. Smoke is a thing with a colour; flame adds light, and
        // a thin one must turn red, not grey.
        vec3 smoke = scattered * white * view.sunDirection.w;
        float cover = max(alpha, 1e-4);
        color = encodeOutput(max(color - smoke, vec3(0.0)), kEncoding) +
                encodeOutput(smoke / cover, kEncoding) * cover;
    }
    outColor = vec4(min(color, vec3(60000.0)), alpha);
}
