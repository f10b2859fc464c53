// Adaptive refinement per lane, for C++ and GLSL: motion of levels and position of a vertex; with
// refine_pattern.h and refine_cut.h. It accesses no buffer. Cosmetic floats.
// clang-format off
#ifndef FW_SHARED_REFINE_H
#define FW_SHARED_REFINE_H
#include "shared/refine_cut.h"
#include "shared/refine_pattern.h"
#include "shared/refine_records.h"

FW_SHARED_BEGIN

// ---- levels

// Level at which a segment covers `pixels` on the screen. focal: pixels of 1 m at a distance of 1
// m.
FW_FN float refineLod(vec3 a, vec3 b, vec3 eye, float focal, float pixels) {
    vec3 middle = (a + b) * 0.5f;
    float d = distance(middle, eye);
    float da = distance(a, eye);
    float db = distance(b, eye);
    d = da < d ? da : d;
    d = db < d ? db : d;
    d = d > 0.05f ? d : 0.05f;
    float segments = distance(a, b) * focal / (d * pixels);
    return log2(segments > 1.0f ? segments : 1.0f);
}

// Updates the heat times and sets the target. cool: s that a level outlives its heat.
FW_FN void setRefineTarget(FW_INOUT(RefineLevel) s, uint heat, float lod, float depth, float now,
                           float cool) {
    if ((heat & kRefineHot) != 0u) s.lastHot = now;
    if ((heat & kRefineBurning) != 0u && s.burningSince > now) s.burningSince = now;
    bool kept = (heat & kRefineHot) != 0u || now - s.lastHot < cool;
    s.target = kept ? (lod < depth ? lod : depth) : 0.0f;
}

// Order in which items lose levels: burning items last, then by number.
FW_FN float levelLossOrder(uint id, uint heat) {
    return ((heat & kRefineBurning) != 0u ? 0.5f : 0.0f) + 0.45f * hashUnit(id);
}
FW_FN float biasedLevel(float target, float bias, float spread) {
    float less = bias - spread;
    float level = target - (less > 0.0f ? less : 0.0f);
    return level > 0.0f ? level : 0.0f;
}
FW_CONST uint kRefineBiases = 16u;
FW_CONST float kRefineBiasStep = 0.4f;

FW_FN uint topLevel(float level) {
    float l = level > 1e-4f ? level - 1e-4f : 0.0f;
    int whole = int(l);
    return uint(float(whole) < l ? whole + 1 : whole);
}
// Morph progress of the points of the top level from the middle of their parents.
FW_FN float levelMorphAge(float level, uint top) {
    float f = level - float(top) + 1.0f;
    return f < 1.0f ? f : 1.0f;
}

// Moves the level towards `want`: up at once while the surface is flat, else by `rate` levels per
// s. grace: s of burning after which a surface is no longer flat.
FW_FN void moveRefineLevel(FW_INOUT(RefineLevel) s, float want, float now, float dt, float rate,
                           float grace) {
    float step = rate * dt;
    bool flatStill = now - s.burningSince < grace;
    if (want > s.level) s.level = flatStill || s.level + step > want ? want : s.level + step;
    else s.level = s.level - step < want ? want : s.level - step;
}

// ---- positions

FW_FN vec3 refineOffset(uint offset) {
    int x = int(offset << 21u) >> 21;
    int y = int(offset << 10u) >> 21;
    int z = int(offset) >> 22;
    return vec3(float(x) * (2.0f / 1023.0f), float(y) * (2.0f / 1023.0f),
                float(z) * (2.0f / 511.0f));
}

// Arrival at a slot, s since `epoch`, from the texels among its four that are lit by `now` (ticks).
// Ticks may lie before the world began.
FW_FN float refineArrival(FW_IN(uvec4) ticks, uint weights, uint now, uint epoch) {
    float sum = 0.0f, weight = 0.0f;
    for (int k = 0; k < 4; ++k) {
        bool lit = ticks[k] < kLiveEnd && int(now - ticks[k]) >= 0;
        uint w = lit ? (weights >> (8u * uint(k))) & 255u : 0u;
        sum += float(int(w)) * float(int(ticks[k] - epoch));
        weight += float(int(w));
    }
    return weight > 0.0f ? sum / weight * (1.0f / 4096.0f) : kRefineNever;
}
// Bilinear weights of the texels around a place between them.
FW_FN uint refineOppositeWeights(uint opposite) {
    uint fx = (opposite >> 24u) & 15u, fy = opposite >> 28u;
    uint a = (16u - fx) * (16u - fy), b = fx * (16u - fy), c = (16u - fx) * fy, d = fx * fy;
    a = a > 255u ? 255u : a;
    return a | (b << 8u) | (c << 16u) | (d << 24u);
}

// When a wall burns through: `through` s after it is lit from one side; from both, when the fronts
// meet.
FW_FN float burnThroughTime(float a, float b, float through) {
    float one = a < b ? a : b;
    if (one >= kRefineNever) return kRefineNever;
    float alone = one + through;
    float other = a < b ? b : a;
    if (other >= kRefineNever) return alone;
    float both = (through + a + b) * 0.5f;
    both = both > other ? both : other;
    return alone < both ? alone : both;
}

// burnSeconds: of a wall of full thickness; negative: it never opens. recede: share of the slot's
// reach, [0, 1).
FW_FN vec4 evaluateSlot(FW_IN(RefineSlot) s, float arrival, float opposite, float now,
                        float burnSeconds, float recede) {
    vec3 rest = vec3(s.x, s.y, s.z);
    float seconds = burnSeconds < 0.0f ? -burnSeconds : burnSeconds;
    float through = seconds * float(s.reach >> 16u) * (1.0f / 4096.0f);
    float hole = burnSeconds < 0.0f ? kRefineNever : burnThroughTime(arrival, opposite, through);
    float burnt = 0.0f;
    if (arrival < now) burnt = through > 0.0f ? (now - arrival) / through : 1.0f;
    burnt = burnt < recede ? burnt : recede;
    float depth = float(s.reach & 0xFFFFu) * 1e-5f * burnt;
    vec3 p = rest + refineOffset(s.offset) * depth;
    return vec4(p.x, p.y, p.z, hole);
}
// Position on the inner skin: the slot at its full reach.
FW_FN vec3 refineInnerSkin(FW_IN(RefineSlot) s) {
    float depth = float(s.reach & 0xFFFFu) * 1e-5f;
    return vec3(s.x, s.y, s.z) + refineOffset(s.offset) * depth;
}

// ---- morph: a point of the top level starts in the middle of its parents

FW_FN vec3 refineMorph(vec3 own, vec3 a, vec3 b, float age) {
    float k = age * age * (3.0f - 2.0f * age);
    vec3 middle = (a + b) * 0.5f;
    return middle + (own - middle) * k;
}

struct RefineParents {
    uint a1, a2, b1, b2;  // c1, c2 of both
};
// Is a lattice point of the top level only?
FW_FN bool refineIsNew(uint c1, uint c2) { return ((c1 | c2) & 1u) != 0u; }
// Parents lie along the direction of the point's two odd coordinates.
FW_FN RefineParents refineParents(uint c1, uint c2) {
    RefineParents p;
    uint d1 = c1 & 1u, d2 = c2 & 1u;
    p.a1 = c1 - d1;
    p.b1 = c1 + d1;
    if (d1 == 1u && d2 == 1u) {
        p.a2 = c2 + 1u;
        p.b2 = c2 - 1u;
    } else {
        p.a2 = c2 - d2;
        p.b2 = c2 + d2;
    }
    return p;
}

struct RefineSpot {  // a position on a side of a triangle's lattice
    uint side;       // 3: inside
    uint i;          // edge segment, from the low end
    float f;         // position in the segment
};
// Position of lattice point (c1, c2) of 2^m steps on the polyline of the edges.
FW_FN RefineSpot refineSpot(FW_IN(RefineTriangle) t, uint levels, uint c1, uint c2) {
    RefineSpot spot;
    uint n = 1u << refineInterior(levels);
    uint c0 = n - c1 - c2;
    spot.side = c2 == 0u ? 0u : c1 == 0u ? 2u : c0 == 0u ? 1u : 3u;
    spot.i = 0u;
    spot.f = 0.0f;
    if (spot.side == 3u) return spot;
    uint along = spot.side == 0u ? c1 : spot.side == 1u ? c2 : c0;
    along = refineFlipped(t.flags, spot.side) ? n - along : along;
    uint steps = 1u << refineSide(levels, spot.side);
    float x = float(along) * float(steps) / float(n);
    spot.i = uint(x) < steps - 1u ? uint(x) : steps - 1u;
    spot.f = x - float(spot.i);
    return spot;
}

FW_SHARED_END
#endif
