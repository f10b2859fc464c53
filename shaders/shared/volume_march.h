// A ray's path through a flame: its range in the tube and its coordinates along the curve. The
// curve is evaluated at a few knots; samples interpolate between them. FW_FLAME_NODE(i) is the
// includer's: in GLSL one flame's nodes are a uniform block.
// clang-format off
#ifndef FW_SHARED_VOLUME_MARCH_H
#define FW_SHARED_VOLUME_MARCH_H
#include "shared/volume.h"

FW_SHARED_BEGIN
#ifdef __cplusplus
#define FW_FLAME_OF const FlameNode* nodes,
#define FW_FLAME_ALONE const FlameNode* nodes
#define FW_FLAME_IT nodes,
#define FW_FLAME_NODE(i) nodes[i]
#else
#define FW_FLAME_OF
#define FW_FLAME_ALONE
#define FW_FLAME_IT
#endif

FW_CONST uint kFlameSkip = 2u;         // a march uses every second node
FW_CONST uint kFlameIntervals = 6u;    // between knots of a ray, at most
FW_CONST uint kFlamePieces = 12u;      // curve pieces of a march
FW_CONST uint kFlameSmokeSteps = 4u;   // per ray

struct FlameChord {       // range of a ray in a tube
    float from; float gap;    // m along the ray: first knot, distance of knots
    // In gaps from the first knot: range that may burn; first > last: none.
    float first; float last;
};

// Bounding sphere of two pieces of tube; w: its square radius.
FW_FN vec4 flameBall(FlameNode a, FlameNode middle, FlameNode b, float reach) {
    vec3 half_ = 0.5f * (vec3(b.centre) - vec3(a.centre));
    vec3 centre = vec3(a.centre) + half_;
    float wide = reach + length(vec3(middle.centre) - centre);
    return vec4(centre, dot(half_, half_) + wide * wide);
}

FW_FN vec2 flameWiden(vec2 span, vec4 ball, vec3 from, vec3 direction, bool used) {
    vec3 to = vec3(ball) - from;
    float at = dot(to, direction);
    float room = ball.w + at * at - dot(to, to);
    float along = sqrt(max(room, 0.0f));
    bool seen = used && room > 0.0f;
    return vec2(seen ? min(span.x, at - along) : span.x, seen ? max(span.y, at + along) : span.y);
}

// Range of a ray in the flame (xy) and in its smoke (zw), m; x >= y: none.
FW_FN vec4 flameSpans(FW_FLAME_OF FlameRecord f, vec3 from, vec3 direction) {
    vec2 fire = vec2(1e9f, -1e9f);
    vec2 smoke = fire;
    FW_UNROLL
    for (uint k = 0u; k + 1u < kFlameNodes; k += kFlameSkip) {
        FlameNode a = FW_FLAME_NODE(k);
        FlameNode m = FW_FLAME_NODE(k + 1u);
        FlameNode b = FW_FLAME_NODE(min(k + kFlameSkip, kFlameNodes - 1u));
        float radius = max(max(a.centre.w, m.centre.w), b.centre.w);
        vec4 ball = flameBall(a, m, b, kFlameReach * (1.0f + f.puff) * radius);
        fire = flameWiden(fire, ball, from, direction, a.along.w < kFlameTop * f.high.w);
        float widened = max(max(a.side.w, m.side.w), b.side.w);
        ball = flameBall(a, m, b, flameReachAt(f, a.along.w, b.along.w, radius, widened));
        smoke = flameWiden(
            smoke, ball, from, direction,
            f.smoke > 0.0f && b.along.w > 0.6f * f.high.w && a.along.w < f.smokeTop * f.high.w);
    }
    return vec4(max(fire.x, 0.0f), fire.y, max(smoke.x, 0.0f), smoke.y);
}

struct FlamePieces {      // of the curve: planes to find the piece of a point
    vec4 plane[kFlamePieces + 1u]; // signed distance in m: dot(x, xyz) + w
    vec4 middle[kFlamePieces];
};

FW_FN uint flameNodeOf(uint piece) { return min(piece * kFlameSkip, kFlameNodes - 1u); }

FW_FN FlamePieces flamePieces(FW_FLAME_ALONE) {
    FlamePieces pieces;
    FW_UNROLL
    for (uint k = 0u; k <= kFlamePieces; ++k) {
        vec3 along = vec3(FW_FLAME_NODE(flameNodeOf(k)).along);
        pieces.plane[k] = vec4(along, -dot(along, vec3(FW_FLAME_NODE(flameNodeOf(k)).centre)));
    }
    FW_UNROLL
    for (uint k = 0u; k < kFlamePieces; ++k)
        pieces.middle[k] = FW_FLAME_NODE(k * kFlameSkip + 1u).centre;
    return pieces;
}

// Coordinates in the nearest piece whose planes enclose the point; the curve continues straight
// before its base and beyond its end.
FW_FN FlamePlace flamePlaceNear(FW_FLAME_OF FlamePieces pieces, vec3 x) {
    float best = 1e30f;
    uint at = 0u;
    float before = 0.0f; float after = 1.0f;
    float da = dot(x, vec3(pieces.plane[0])) + pieces.plane[0].w;
    FW_UNROLL
    for (uint k = 0u; k < kFlamePieces; ++k) {
        float db = dot(x, vec3(pieces.plane[k + 1u])) + pieces.plane[k + 1u].w;
        vec3 off = x - vec3(pieces.middle[k]);
        float cost = dot(off, off);
        bool nearer =
            (k == 0u || da >= 0.0f) && (k + 1u == kFlamePieces || db < 0.0f) && cost < best;
        best = nearer ? cost : best;
        at = nearer ? k : at;
        before = nearer ? da : before;
        after = nearer ? db : after;
        da = db;
    }
    return flamePlaceAt(x, FW_FLAME_NODE(flameNodeOf(at)), FW_FLAME_NODE(flameNodeOf(at + 1u)),
                        before, after);
}

FW_FN vec4 flameKnot(FW_FLAME_OF FlamePieces pieces, vec3 x) {
    FlamePlace at = flamePlaceNear(FW_FLAME_IT pieces, x);
    return vec4(at.p, at.s, at.radius);
}

// Is the nearest place continuous over an interval? It jumps between the sides of a loop.
FW_FN bool flameWhole(FlameChord chord, vec4 delta) {
    return abs(delta.z) <= 3.0f * chord.gap + 1e-6f;
}

// Extends the chord by an interval's burning range. A discontinuous interval burns nowhere.
FW_FN FlameChord flameInterval(FlameRecord f, FlameChord chord, float i, vec4 knot, vec4 delta) {
    bool whole = flameWhole(chord, delta);
    vec4 slack = 0.125f * vec4(abs(delta.x), abs(delta.y), abs(delta.z), abs(delta.w));
    FW_UNROLL
    for (uint j = 0u; j < 4u; ++j) {
        vec4 p = knot + (0.25f * float(j) + 0.125f) * delta;
        float reach = kFlameReach * (1.0f + f.puff) * (p.w + slack.w) + slack.x + slack.y;
        bool lit = whole && p.x * p.x + p.y * p.y < reach * reach && p.z > -slack.z &&
                   p.z < kFlameTop * f.high.w + slack.z;
        float u = i + 0.25f * float(j);
        chord.first = lit ? min(chord.first, u) : chord.first;
        chord.last = lit ? max(chord.last, u + 0.25f) : chord.last;
    }
    return chord;
}

// u: in gaps from the first knot.
FW_FN FlamePlace flameAlong(vec4 knot, vec4 delta[kFlameIntervals], float u) {
    FW_UNROLL
    for (uint k = 0u; k < kFlameIntervals; ++k) knot += delta[k] * clamp(u - float(k), 0.0f, 1.0f);
    FlamePlace place;
    place.p = vec2(knot.x, knot.y); place.s = knot.z; place.radius = knot.w;
    return place;
}

// Smoke is thin and wide and marched separately. Smoke beyond `middle` m is accumulated in `back`,
// which flameBetween places behind the flame.
struct FlameSmokeRay {
    FlameRay front; FlameRay back;
};

FW_FN FlameSmokeRay flameSmokeStep(FlameRecord f, FlameSmokeRay ray, FlamePlace at, vec3 x,
                                   FlameSun sun, bool behind, float d) {
    vec2 smoke = flameSmoke(f, at);
    FlameMedium m;
    m.soot = 0.0f; m.smoke = f.air.w * smoke.x; m.smokeShade = smoke.y; m.emission = vec3(0.0f);
    vec3 to = vec3(f.glow) - x;
    vec3 light =
        flameSmokeLight(f, dot(to, to), smoke.y, sun.light, flameSmokeDepth(f, at, sun.to));
    FlameRay front = flameStep(ray.front, m, light, behind ? 0.0f : d);
    ray.back = flameStep(ray.back, m, light, behind ? d : 0.0f);
    ray.front = front;
    return ray;
}

FW_FN FlameRay flameBehind(FlameRay ray, FlameRay behind) {
    ray.radiance += ray.through * behind.radiance;
    ray.through *= behind.through;
    return ray;
}

FW_FN FlameRay flameBetween(FlameRay fire, FlameSmokeRay smoke) {
    FlameRay all;
    all.radiance = smoke.front.radiance +
                   smoke.front.through * (fire.radiance + fire.through * smoke.back.radiance);
    all.through = smoke.front.through * fire.through * smoke.back.through;
    return all;
}
FW_SHARED_END
#endif
