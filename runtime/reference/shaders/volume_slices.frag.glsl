// A slice of a volumetric flame's lattice: one sample, weighted by the slice spacing along its ray,
// so brightness does not depend on the number of slices. Premultiplied.
#include "volume/flame.glsl"
#include "reference/slices_push.h"

layout(constant_id = 0) const uint kEncoding = 0u;
layout(set = 2, binding = 0) uniform sampler2DArray profiles;
layout(push_constant) uniform Push { SlicesPush draw; };

layout(location = 0) centroid in vec4 inPlace;
layout(location = 1) centroid in vec3 inOff;
layout(location = 2) flat in vec2 inShows;
layout(location = 3) flat in float inDepth;
layout(location = 4) flat in uint inZero;
layout(location = 5) centroid in vec4 inSlope;

layout(location = 0) out vec4 outColor;

#include "lib/colour.glsl"
#include "volume/ray.glsl"
#ifdef FW_SOFT
#include "volume/scene_depth.glsl"
#endif

void main() {
    outColor = vec4(0.0);
    if (!passesDither(uint(gl_FragCoord.x), uint(gl_FragCoord.y), inShows.x, inShows.y)) return;
    FlameRecord f = flame.record;
    addZero(f, inZero);
    bool perspective = view.forward.w > 0.5;
    float away = length(inOff);
    float perDepth = perspective ? away / max(inDepth, 1e-6) : 1.0;
    vec3 direction = perspective ? inOff / away : view.forward.xyz;
    vec3 white = flameWhite(f, view.sunColor.w);
    f.air.rgb = flameAir(view.ambientSky.rgb, view.ambientGround.rgb, white);
    float stride = draw.spacing * perDepth;
    float pixel = view.eye.w * (perspective ? inDepth : 1.0);
    // Sampled at a random depth in the slice, different among four pixels, to hide layers.
    float later =
        draw.spacing * (marchSamplePhase(uint(gl_FragCoord.x), uint(gl_FragCoord.y)) - 0.5);
    vec4 place = inPlace + later * inSlope;
    FlamePlace at;
    at.p = place.xy;
    at.s = place.z;
    at.radius = place.w;
    FlameMedium m = placeMedium(f, at, max(0.35 * stride, 0.25 * pixel));
    vec2 smoke = flameSmoke(f, at);
    m.smoke = f.air.w * smoke.x;
    vec3 x = view.eye.xyz + inOff + later * perDepth * direction;
    FlameSun sun = raySun(direction, white);
    vec3 to = f.glow.xyz - x;
    vec3 light =
        flameSmokeLight(f, dot(to, to), smoke.y, sun.light, flameSmokeDepth(f, at, sun.to));
    float part = 1.0;
#ifdef FW_SOFT
    part = clamp((depthOfScene(draw.clip) - inDepth) / draw.spacing + 0.5, 0.0, 1.0);
#endif
    FlameRay one = flameStep(FlameRay(vec3(0.0), vec3(1.0)), m, light, stride * part);
    outColor = flameShown(one, vec3(0.0), white * view.sunDirection.w, kEncoding);
    // One coverage for all channels: half by its absorption of light of its own colour, which
    // dominates what is behind, and half by its absorption of white, for the scene.
    const vec3 seen = vec3(0.2126, 0.7152, 0.0722);
    vec3 lit = seen * one.radiance;
    float all = lit.r + lit.g + lit.b;
    if (all > 1e-9) outColor.a = 1.0 - dot(one.through, 0.5 * (lit / all + seen));
}
