// Adaptive refinement per lane, one text for C++ and GLSL: which triangle is the k-th of a pattern,
// which vertex stands where, how levels move, where a vertex lies, where a hole cuts. It loads
// nothing: callers hand over table words, ticks and positions. Cosmetic: floats, never simulated.
//
// A coarse triangle has a level per edge (0..5: 2^l segments) and one of its interior (m). Edge
// levels are shared by all owners, so no crack can open; the interior is a lattice of 2^m steps,
// and a strip joins each edge to it. m < 2: no lattice, a small table.
// GLSL too, and laid out by hand.
// clang-format off
#ifndef FW_SHARED_REFINE_H
#define FW_SHARED_REFINE_H
#include "shared/front.h"

#ifdef __cplusplus
#define FW_PRECISE
#define FW_CONSTANT_FN constexpr
#else
#define FW_PRECISE precise
#define FW_CONSTANT_FN
#endif

FW_SHARED_BEGIN

#ifdef __cplusplus
using std::log2;
#endif

FW_SHARED_CONST uint kRefineDepth = 5u;
// The table of u16 tokens: strips by (m, edge level), lattices by m, then eight rows of four for m < 2.
FW_SHARED_CONST uint kRefineInner = 540u;
FW_SHARED_CONST uint kRefineHand = 1576u;
FW_SHARED_CONST uint kRefineTableSize = 1608u;
FW_SHARED_CONST float kRefineNever = 1e30f;   // s: not lit, or no hole to come
FW_SHARED_CONST float kRefineUnlit = 1000.0f; // s to the hole of a vertex that has none
FW_SHARED_CONST uint kRefineInside = 0x80000000u;  // in RefineCorner::high: of the inner skin
FW_SHARED_CONST uint kRefineOpposed = 0xFFFFFFFFu; // RefineSlot::opposite: none
// Heat of a tile, an edge or an interior.
FW_SHARED_CONST uint kRefineHot = 1u;      // the front is near, or it burns
FW_SHARED_CONST uint kRefineBurning = 2u;  // something of it burns
// What its vertices say when they are placed.
FW_SHARED_CONST uint kRefineGone = 4u;     // some are burnt through; kept
FW_SHARED_CONST uint kRefineStays = 8u;    // some are not
FW_SHARED_CONST uint kRefineGoing = 16u;   // some of these are lit

struct RefineTriangle {  // a coarse triangle; corners and sides counter-clockwise, side e = e, e + 1
    uint edge[3];
    uint flags;          // bit e: side e runs from the edge's high end; 4 bits each from 4, 8, 12:
                         // deepest level of the sides; from 16: of the interior
    uint corner[3];      // draw vertices
    uint slot;           // first of the interior; its draw vertices have the same numbers
    uint side[3];        // draw vertex of the first point of each side's edge, low end first
    uint source;         // triangle of the burn domain
};
FW_SHARED_SIZE(RefineTriangle, 48)

struct RefineEdge {
    uint low;            // slots of the ends, low < high
    uint high;
    uint slot;           // first of its 2^depth - 1 inner points, from the low end
    uint flags;          // deepest level; 16: open (one owner)
};
FW_SHARED_SIZE(RefineEdge, 16)

struct RefineSlot {      // a vertex at rest
    float x, y, z;       // m, object space
    uint offset;         // signed 11:11:10 of [-2, 2]: moving by d * offset moves every face by d
    uint reach;          // low: farthest recession, 10 um; high: burn-through time, 1/4096 of a wall's
    uint texel;          // 24 bits: lower left of four; 8 bits: material
    uint weights;        // 4 x 8 bits: of texel, + 1, + width, + width + 1
    uint opposite;       // 24 bits: lower left texel of the wall behind; 4 + 4 bits: place between
};                       // texels, 1/16; or kRefineOpposed
FW_SHARED_SIZE(RefineSlot, 32)

struct RefineVertex {    // a vertex now
    float x, y, z;       // m, object space
    float hole;          // s since the object's epoch: burnt through; kRefineNever: not known
};
FW_SHARED_SIZE(RefineVertex, 16)

struct RefineDraw {      // what an index names: a slot seen from one chart
    uint slot;
    uint triangle;       // of the burn domain; all attributes are mixed from its corners
    float weight1;       // of corner 1; corner 0 has the rest
    float weight2;
};
FW_SHARED_SIZE(RefineDraw, 16)

struct RefineLevel {     // of an edge or an interior; s since the object's epoch
    float level;         // 2^ceil segments; the fraction is how far the newest points have come
    float target;        // before the budget
    float lastHot;
    float burningSince;
};
FW_SHARED_SIZE(RefineLevel, 16)

struct RefineCorner {    // of a triangle of the cut shell
    uint low;            // slot
    uint high;           // the same, or a cut point of the small edge low < high; kRefineInside
};

// An object in the frame's passes, rewritten in each frame that refines it: see isDue. Bases are in records of
// the planes; mesh...: what objects share.
struct RefineObject {
    uint items;          // edges, then interiors
    uint triangles;
    uint vertices;
    uint indices;        // of the output
    uint meshTriangles;
    uint meshEdges;
    uint meshSlots;
    uint meshWords;      // per tile and one: where its items start; then the items
    uint edgeCount;
    uint triangleCount;  // sorted by material
    uint cornerCount;
    uint textureWidth;   // texels
    uint stateBase;      // as BurnObject
    uint epochTick;      // s count from here
    uint flags;          // kRefineIs...
    uint ordinal;        // in the frame's list of objects
    uint meshDraws;      // first draw vertex
    uint tileCount;
    float pixelsPerEdge;
    float now;           // s since the epoch
    vec4 eye;            // m, object space; w: pixels of 1 m at 1 m, 0: no limit by size
    vec4 burnSeconds0;   // per material: a wall burnt through; negative: it never opens
    vec4 burnSeconds1;
    uvec4 materialEnd0;  // per material: its last triangle + 1
    uvec4 materialEnd1;
    uint cuts;           // first of its cut vertices
    uint cutTriangles;   // room for; shared out to materials by their triangles
    float dt;            // s since it was last refined
    uint inner;          // from a vertex to its place on the inner skin; 0: a sheet, it has none
    uint reserved2; uint reserved3; uint reserved4; uint reserved5;
};
FW_SHARED_SIZE(RefineObject, 192)
FW_SHARED_CONST uint kRefineIsActive = 1u;
FW_SHARED_CONST uint kRefineIsFresh = 2u;  // nothing of it is initialised yet
FW_SHARED_CONST uint kRefineIsCut = 4u;    // near: holes are cut; else fragments are discarded
FW_SHARED_CONST uint kRefineIsWhole = 8u;  // no longer cut: all its triangles are emitted again
FW_SHARED_CONST uint kRefineIsCounted = 16u;  // shares the budget, whether it is its turn or not

// A word of the heat plane: what the lists of tiles say for the next frame; the same for this one; and
// whether this frame places the item anew.
FW_SHARED_CONST uint kRefineHeatShift = 8u;
FW_SHARED_CONST uint kRefineMoving = 0x10000u;

// The work plane: five indirect dispatches, the bias, then lists of two words (object slot, number).
FW_SHARED_CONST uint kRefineWorkEmit = 0u;    // x, y, z, jobs: 64 output triangles each
FW_SHARED_CONST uint kRefineWorkPlace = 4u;   // x, y, z, jobs: interiors, two a group
FW_SHARED_CONST uint kRefineWorkCut = 8u;     // x, y, z, jobs: a triangle with a hole each
FW_SHARED_CONST uint kRefineWorkEdges = 12u;  // x, y, z, jobs: edges that move, 64 a group
FW_SHARED_CONST uint kRefineWorkMorph = 16u;  // as place: those with points on their way
FW_SHARED_CONST uint kRefineWorkBias = 20u;   // the least, in steps, with which all fits the budget
FW_SHARED_CONST uint kRefineWorkLists = 24u;
// After an object's triangles in the plane of levels: what each bias comes to, two a record, as of its
// last turn.
FW_SHARED_CONST uint kRefineSums = 8u;

struct RefinePush {
    uint phase;
    uint nowTick;
    uint budget;      // triangles; 0: all fit
    uint row;         // heat: counters row of the list
    uint parity;      // heat: of the list; + 2: it is the burn list
    uint full;        // 1: everything at its deepest and moving, for comparison
    uint reserved;
    float recede;     // share of a slot's reach, below 1
    uint edgeGroups;  // 64 edges each; lists follow each other in this order
    uint triangleGroups;
    uint cornerGroups;
    uint objects;     // (object slot, triangles that it emits; 0: none)
    uint emitJobs;    // first words of the lists that the device writes
    uint placeJobs;   // half way to cutJobs: of the morph
    uint objectEnd;   // object slots with a record
    uint cutJobs;     // as far behind it: edges
};
FW_SHARED_SIZE(RefinePush, 64)
FW_SHARED_CONST float kRefineRate = 4.0f;    // levels per s, once a surface has moved
FW_SHARED_CONST float kRefineCool = 1.0f;    // s that a level outlives its heat
FW_SHARED_CONST float kRefineGrace = 0.25f;  // s of burning during which a surface counts as flat

// ---- levels of a triangle in one word: sides at bits 0, 4, 8, interior at 12

FW_SHARED_FN uint refinePack(uint l0, uint l1, uint l2, uint m) {
    return l0 | (l1 << 4u) | (l2 << 8u) | (m << 12u);
}
FW_SHARED_FN uint refineSide(uint levels, uint e) { return (levels >> (4u * e)) & 15u; }
FW_SHARED_FN uint refineInterior(uint levels) { return (levels >> 12u) & 15u; }
FW_SHARED_FN uint refineSideDepth(uint flags, uint e) { return (flags >> (4u + 4u * e)) & 15u; }
FW_SHARED_FN uint refineInteriorDepth(uint flags) { return (flags >> 16u) & 15u; }
FW_SHARED_FN bool refineFlipped(uint flags, uint e) { return ((flags >> e) & 1u) != 0u; }
FW_SHARED_FN uint refineNext(uint e) { return e == 2u ? 0u : e + 1u; }
FW_SHARED_FN uint refineBefore(uint e) { return e == 0u ? 2u : e - 1u; }

// The interior level nearest to m from above that these sides can be joined to.
FW_SHARED_FN uint refineFit(uint l0, uint l1, uint l2, uint m) {
    uint most = l0 > l1 ? l0 : l1;
    most = most > l2 ? most : l2;
    if (most >= 2u) return m > 2u ? m : 2u;
    return m >= 2u ? m : most;
}

FW_SHARED_FN uint refineCount(uint levels) {
    uint m = refineInterior(levels);
    uint l0 = refineSide(levels, 0u), l1 = refineSide(levels, 1u), l2 = refineSide(levels, 2u);
    if (m < 2u) return 1u + l0 + l1 + l2;
    uint s = (1u << m) - 3u;
    return s * s + 3u * s + (1u << l0) + (1u << l1) + (1u << l2);
}

FW_SHARED_END
#include "shared/refine_pattern.h"
#include "shared/refine_cut.h"
FW_SHARED_BEGIN

// ---- levels

// Level at which a segment covers `pixels` on the screen. focal: pixels of 1 m at 1 m.
FW_SHARED_FN float refineLod(vec3 a, vec3 b, vec3 eye, float focal, float pixels) {
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

// Notes the heat; sets the target. cool: s that a level outlives its heat.
FW_SHARED_FN void refineAim(FW_INOUT(RefineLevel) s, uint heat, float lod, float depth, float now,
                            float cool) {
    if ((heat & kRefineHot) != 0u) s.lastHot = now;
    if ((heat & kRefineBurning) != 0u && s.burningSince > now) s.burningSince = now;
    bool kept = (heat & kRefineHot) != 0u || now - s.lastHot < cool;
    s.target = kept ? (lod < depth ? lod : depth) : 0.0f;
}

// Who gives up a level last: what burns, then by number.
FW_SHARED_FN float refineSpread(uint id, uint heat) {
    return ((heat & kRefineBurning) != 0u ? 0.5f : 0.0f) +
           0.45f * float(hash32(id) >> 8u) / 16777216.0f;
}
FW_SHARED_FN float refineBiased(float target, float bias, float spread) {
    float less = bias - spread;
    float level = target - (less > 0.0f ? less : 0.0f);
    return level > 0.0f ? level : 0.0f;
}
FW_SHARED_CONST uint kRefineBiases = 16u;
FW_SHARED_CONST float kRefineBiasStep = 0.4f;

FW_SHARED_FN uint refineTop(float level) {
    float l = level > 1e-4f ? level - 1e-4f : 0.0f;
    int whole = int(l);
    return uint(float(whole) < l ? whole + 1 : whole);
}
// How far the points of the top level have come from between their parents.
FW_SHARED_FN float refineAge(float level, uint top) {
    float f = level - float(top) + 1.0f;
    return f < 1.0f ? f : 1.0f;
}

// Towards `want`: upwards at once while all is flat, else by `rate` levels per s. grace: s of
// burning after which a surface is no longer flat.
FW_SHARED_FN void refineMove(FW_INOUT(RefineLevel) s, float want, float now, float dt, float rate,
                             float grace) {
    float step = rate * dt;
    bool flatStill = now - s.burningSince < grace;
    if (want > s.level) s.level = flatStill || s.level + step > want ? want : s.level + step;
    else s.level = s.level - step < want ? want : s.level - step;
}

// ---- places

FW_SHARED_FN vec3 refineOffset(uint offset) {
    int x = int(offset << 21u) >> 21;
    int y = int(offset << 10u) >> 21;
    int z = int(offset) >> 22;
    return vec3(float(x) * (2.0f / 1023.0f), float(y) * (2.0f / 1023.0f),
                float(z) * (2.0f / 511.0f));
}

// Arrival at a slot, s since `epoch`, from its four texels: over those lit by `now` (ticks) only.
// Ticks may lie before the world began.
FW_SHARED_FN float refineArrival(FW_IN(uvec4) ticks, uint weights, uint now, uint epoch) {
    float sum = 0.0f, weight = 0.0f;
    for (int k = 0; k < 4; ++k) {
        bool lit = ticks[k] < kLiveEnd && int(now - ticks[k]) >= 0;
        uint w = lit ? (weights >> (8u * uint(k))) & 255u : 0u;
        sum += float(int(w)) * float(int(ticks[k] - epoch));
        weight += float(int(w));
    }
    return weight > 0.0f ? sum / weight * (1.0f / 4096.0f) : kRefineNever;
}
// Weights of the texels around a place between them.
FW_SHARED_FN uint refineOppositeWeights(uint opposite) {
    uint fx = (opposite >> 24u) & 15u, fy = opposite >> 28u;
    uint a = (16u - fx) * (16u - fy), b = fx * (16u - fy), c = (16u - fx) * fy, d = fx * fy;
    a = a > 255u ? 255u : a;
    return a | (b << 8u) | (c << 16u) | (d << 24u);
}

// When a wall is burnt through: `through` s after it is lit from one side; from both, when the two
// fronts meet.
FW_SHARED_FN float refineHole(float a, float b, float through) {
    float one = a < b ? a : b;
    if (one >= kRefineNever) return kRefineNever;
    float alone = one + through;
    float other = a < b ? b : a;
    if (other >= kRefineNever) return alone;
    float both = (through + a + b) * 0.5f;
    both = both > other ? both : other;
    return alone < both ? alone : both;
}

// burnSeconds: of a wall of full thickness; negative: its char stays, it never opens. recede: share
// of the slot's reach, below 1.
FW_SHARED_FN vec4 refineEvaluate(FW_IN(RefineSlot) s, float arrival, float opposite, float now,
                                 float burnSeconds, float recede) {
    vec3 rest = vec3(s.x, s.y, s.z);
    float seconds = burnSeconds < 0.0f ? -burnSeconds : burnSeconds;
    float through = seconds * float(s.reach >> 16u) * (1.0f / 4096.0f);
    float hole = burnSeconds < 0.0f ? kRefineNever : refineHole(arrival, opposite, through);
    float burnt = 0.0f;
    if (arrival < now) burnt = through > 0.0f ? (now - arrival) / through : 1.0f;
    burnt = burnt < recede ? burnt : recede;
    float depth = float(s.reach & 0xFFFFu) * 1e-5f * burnt;
    vec3 p = rest + refineOffset(s.offset) * depth;
    return vec4(p.x, p.y, p.z, hole);
}
// The inner skin: the slot at its full reach.
FW_SHARED_FN vec3 refineInnerSkin(FW_IN(RefineSlot) s) {
    float depth = float(s.reach & 0xFFFFu) * 1e-5f;
    return vec3(s.x, s.y, s.z) + refineOffset(s.offset) * depth;
}

// ---- morph: a point of the top level starts between its parents

FW_SHARED_FN vec3 refineMorph(vec3 own, vec3 a, vec3 b, float age) {
    float k = age * age * (3.0f - 2.0f * age);
    vec3 middle = (a + b) * 0.5f;
    return middle + (own - middle) * k;
}

struct RefineParents {
    uint a1, a2, b1, b2;  // c1, c2 of both
};
// Is a lattice point of the top level only?
FW_SHARED_FN bool refineIsNew(uint c1, uint c2) { return ((c1 | c2) & 1u) != 0u; }
// They lie along the direction of its two odd coordinates.
FW_SHARED_FN RefineParents refineParents(uint c1, uint c2) {
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

struct RefineSpot {  // a place on a side of a triangle's lattice
    uint side;       // 3: inside
    uint i;          // segment of the edge, from the low end
    float f;         // place in it
};
// Where lattice point (c1, c2) of 2^m steps lies on the polyline of the edges.
FW_SHARED_FN RefineSpot refineSpot(FW_IN(RefineTriangle) t, uint levels, uint c1, uint c2) {
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
