// A ray through a volumetric flame: its tube and the medium at a sample. Sample loops are in the
// shaders. Needs `profiles`, `view` and FW_FLAME_NODE.
#include "shared/volume_march.h"

struct RayTube {
    FlameChord chord;
    FlamePieces pieces;
    vec4 first;  // knot
    vec4 delta[kFlameIntervals];
    uint broken;  // one bit per interval with a discontinuous nearest place
};

RayTube rayTube(FlameRecord f, vec4 spans, vec3 from, vec3 direction, uint turns) {
    RayTube tube;
    FW_UNROLL
    for (uint k = 0u; k < kFlameIntervals; ++k) tube.delta[k] = vec4(0.0);
    tube.chord = FlameChord(spans.x, max(spans.y - spans.x, 0.0) / float(turns), 1e9, -1e9);
    tube.pieces = flamePieces();
    tube.broken = 0u;
    tube.first = flameKnot(tube.pieces, from + direction * tube.chord.from);
    vec4 knot = tube.first;
    uint i = 0u;
    // Uniform loops test at their end: see lib/compute.glsl.
    do {
        vec4 next = flameKnot(
            tube.pieces, from + direction * (tube.chord.from + tube.chord.gap * float(i + 1u)));
        FW_UNROLL
        for (uint k = 0u; k < kFlameIntervals; ++k)
            tube.delta[k] = i == k ? next - knot : tube.delta[k];
        tube.broken |= flameWhole(tube.chord, next - knot) ? 0u : 1u << i;
        tube.chord = flameInterval(f, tube.chord, float(i), knot, next - knot);
        knot = next;
        i += 1u;
    } while (i < turns);
    return tube;
}

// Medium of a lookup.
FlameMedium lookupMedium(FlameRecord f, FlameLookup lookup) {
    vec2 texel =
        vec2(lookup.rho * (float(kProfileWidth) / kProfileReach), lookup.y * float(kProfileHeight));
    vec2 texels = vec2(float(kProfileWidth), float(kProfileHeight));
    vec2 uv = clamp(texel, vec2(0.5), texels - 0.5) / texels;
    FlameMedium m = FlameMedium(0.0, 0.0, 0.5, vec3(0.0));
    if (lookup.lit > 0.0)
        m = flameMedium(f, lookup, textureLod(profiles, vec3(uv, float(f.profile)), 0.0).xy);
    return m;
}

// Medium at a place in the tube; size: as flameLookup's.
FlameMedium placeMedium(FlameRecord f, FlamePlace at, float size) {
    return lookupMedium(f, flameLookup(f, at, size));
}

// Medium at t m along the ray.
FlameMedium rayMedium(FlameRecord f, RayTube tube, float t, float size) {
    float u = (t - tube.chord.from) / max(tube.chord.gap, 1e-9);
    FlameLookup lookup = flameLookup(f, flameAlong(tube.first, tube.delta, u), size);
    if (((tube.broken >> uint(clamp(u, 0.0, float(kFlameIntervals)))) & 1u) != 0u) lookup.lit = 0.0;
    return lookupMedium(f, lookup);
}

// White balance; tints keep their colour.
vec3 flameWhite(FlameRecord f, float emissionScale) {
    return mix(kFireWhite, vec3(1.0), f.tint.w) * (kVolumeWhite * max(emissionScale, 1e-6));
}

vec3 flameAir(vec3 sky, vec3 ground, vec3 white) { return 0.5 * (sky + ground) / white; }

// Needs `view`.
struct ViewRay {
    vec3 from, direction;
    float perDepth;   // m along the ray per m along the view
    float perMetre;   // footprint growth of a pixel of width 1 along the ray; 0: orthographic
};
ViewRay viewRay(vec3 at) {
    bool perspective = view.forward.w > 0.5;
    vec3 along = perspective ? at : view.forward.xyz;
    ViewRay ray;
    ray.from = view.eye.xyz + (perspective ? vec3(0.0) : at);
    ray.perDepth = length(along);
    ray.direction = along / ray.perDepth;
    ray.perMetre = perspective ? 1.0 / ray.perDepth : 0.0;
    return ray;
}

// Makes branches depend on `zero`, which is 0 but not constant: a software device recompiles a
// shader, in milliseconds per draw, for each set of constants that alone decide its branches.
void addZero(inout FlameRecord f, uint zero) {
    f.octaves |= zero;
    f.tint.w += float(zero);
    f.smoke += float(zero);
    f.puff += float(zero);
}
FlameSun raySun(vec3 direction, vec3 white) {
    return flameSun(FW_FLAME_NODE(kFlameNodes - 1u), view.sunDirection.xyz, direction,
                    0.3 * view.sunColor.rgb / white);
}

// Premultiplied, encoded; scattered: the smoke's share of the light.
vec4 flameShown(FlameRay ray, vec3 scattered, vec3 white, uint encoding) {
    float alpha = 1.0 - dot(ray.through, vec3(0.2126, 0.7152, 0.0722));
    vec3 color = ray.radiance * white;
    if (encoding != 0u) {
        // The target blends encoded values. Smoke is a coloured medium. Flame adds light, and a
        // thin one must turn red, not grey.
        vec3 grey = scattered * white;
        float cover = max(alpha, 1e-4);
        color = encodeOutput(max(color - grey, vec3(0.0)), encoding) +
                encodeOutput(grey / cover, encoding) * cover;
    }
    return vec4(min(color, vec3(60000.0)), alpha);
}
