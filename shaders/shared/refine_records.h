// Records of adaptive refinement, and the packed levels of a triangle. A coarse triangle has a
// level per edge (0..5: 2^l segments) and one for its interior (m). Edge levels are shared by all
// owners, so no crack can open. The interior is a lattice of 2^m steps; a strip joins each edge to
// it. m < 2: a small table instead.
// clang-format off
#ifndef FW_SHARED_REFINE_RECORDS_H
#define FW_SHARED_REFINE_RECORDS_H
#include "shared/front.h"

#ifdef __cplusplus
#define FW_CONSTANT_FN constexpr
#else
#define FW_CONSTANT_FN
#endif

FW_SHARED_BEGIN


FW_CONST uint kRefineDepth = 5u;
// The table of u16 tokens: strips by (m, edge level), lattices by m, then eight rows of four for m
// < 2.
FW_CONST uint kRefineInner = 540u;
FW_CONST uint kRefineHand = 1576u;
FW_CONST uint kRefineTableSize = 1608u;
FW_CONST float kRefineNever = 1e30f;   // s: not lit, or no hole
FW_CONST float kRefineUnlit = 1000.0f; // s to the hole of a vertex without one
FW_CONST uint kRefineOpposed = 0xFFFFFFFFu; // RefineSlot::opposite: none
// Heat of a tile, an edge or an interior.
FW_CONST uint kRefineHot = 1u;      // the front is near, or it burns
FW_CONST uint kRefineBurning = 2u;  // something of it burns
// Results of placing its vertices.
FW_CONST uint kRefineGone = 4u;     // some are burnt through; kept
FW_CONST uint kRefineStays = 8u;    // some are not
FW_CONST uint kRefineGoing = 16u;   // some of the others are lit
FW_CONST uint kRefineLost = 32u;    // interior: the whole triangle is burnt through; kept

// Coarse triangle; corners and sides counter-clockwise, side e from e to e + 1.
struct RefineTriangle {
    uint edge[3];
    uint flags;          // bit e: side e runs from the edge's high end; 4 bits each from 4, 8, 12:
                         // deepest level of the sides; from 16: of the interior
    uint corner[3];      // draw vertices
    uint slot;           // first of the interior; draw vertices use the same numbers
    uint side[3];        // draw vertex of the first point of each side's edge, low end first
    uint source;         // triangle of the burn domain
};
FW_SIZE(RefineTriangle, 48)

struct RefineEdge {
    uint low;            // slots of the ends, low < high
    uint high;
    uint slot;           // first of its 2^depth - 1 inner points, from the low end
    uint flags;          // deepest level; 16: open (one owner)
};
FW_SIZE(RefineEdge, 16)

struct RefineSlot {      // a vertex at rest
    float x, y, z;       // m, object space
    uint offset;         // signed 11:11:10 of [-2, 2]: moving by d * offset moves every face by d
    uint reach;  // low: farthest recession, 10 um; high: burn-through time, 1/4096 of a wall's
    uint texel;          // 24 bits: lower left of four; 8 bits: material
    uint weights;        // 4 x 8 bits: of texel, + 1, + width, + width + 1
    uint opposite;  // 24 bits: lower left texel of the opposite wall; 4 + 4 bits: place between
};                       // texels, 1/16; or kRefineOpposed
FW_SIZE(RefineSlot, 32)

struct RefineVertex {    // a vertex in this frame
    float x, y, z;       // m, object space
    float hole;  // s since the object's epoch: burnt through; kRefineNever: unknown. On the inner
                 // skin: when the opposite wall was lit, see evaluateSlotNow
};
FW_SIZE(RefineVertex, 16)

struct RefineDraw {      // what an index names: a slot in one chart
    uint slot;
    uint triangle;       // of the burn domain; attributes are interpolated from its corners
    float weight1;       // of corner 1; corner 0 has the rest
    float weight2;
};
FW_SIZE(RefineDraw, 16)

struct RefineLevel {     // of an edge or an interior; s since the object's epoch
    float level;         // 2^ceil segments; the fraction is the morph progress of the newest points
    float target;        // before the budget
    float lastHot;
    float burningSince;
};
FW_SIZE(RefineLevel, 16)

// An object in the frame's passes, rewritten in each frame that refines it (see isDue). Bases are
// record indices of the buffers; mesh...: shared by objects.
struct RefineObject {
    uint items;          // edges, then interiors
    uint triangles;
    uint vertices;
    uint indices;        // of the output
    uint meshTriangles;
    uint meshEdges;
    uint meshSlots;
    uint meshWords;      // per tile + 1: start of its items; then the items
    uint edgeCount;
    uint triangleCount;  // sorted by material
    uint cornerCount;
    uint textureWidth;   // texels
    uint stateBase;      // as BurnObject
    uint epochTick;      // origin of its clock
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
    uint cutTriangles;   // capacity; divided among materials by their triangles
    float dt;            // s since its last refinement
    uint inner;          // offset to a vertex on the inner skin; 0: a sheet, none
    uint reserved1; uint reserved2; uint reserved3; uint reserved4;
};
FW_SIZE(RefineObject, 192)
FW_CONST uint kRefineIsActive = 1u;
FW_CONST uint kRefineIsFresh = 2u;  // nothing is initialised yet
FW_CONST uint kRefineIsCut = 4u;    // near: holes are cut; else fragments are discarded
FW_CONST uint kRefineIsWhole = 8u;  // no longer cut: all triangles are emitted again
FW_CONST uint kRefineHasPerPixelHoles =
    32u;  // cut, but coarser than its size requires: corners miss holes, and
          // per-pixel holes are used
FW_CONST uint kRefineIsCounted = 16u;  // counts against the budget in every frame

// A word of the heat buffer: heat from the tile lists for the next frame, then for this one, and
// whether this frame places the item again.
FW_CONST uint kRefineHeatShift = 8u;
FW_CONST uint kRefineMoving = 0x10000u;

// Work buffer: five indirect dispatches, the bias, then lists of two words (object slot, number).
FW_CONST uint kRefineWorkEmit = 0u;    // x, y, z, jobs: 64 output triangles each
FW_CONST uint kRefineWorkPlace = 4u;   // x, y, z, jobs: interiors, two a group
FW_CONST uint kRefineWorkCut = 8u;     // x, y, z, jobs: a triangle with a hole each
FW_CONST uint kRefineWorkEdges = 12u;  // x, y, z, jobs: edges that move, 64 a group
FW_CONST uint kRefineWorkMorph = 16u;  // as place: items with morphing points
FW_CONST uint kRefineWorkBias = 20u;   // least bias, in steps, that fits the budget
FW_CONST uint kRefineWorkLists = 24u;
// Behind an object's triangles in the level buffer: triangle sum for each bias, two per record,
// from its last turn.
FW_CONST uint kRefineSums = 8u;

struct RefinePush {
    uint phase;
    uint nowTick;
    uint budget;      // triangles; 0: no limit
    uint row;         // heat: counters row of the list
    uint parity;      // heat: of the list; + 2: burn list; kRefineFreshHeat
    uint full;        // 1: everything at its deepest level and moving, for comparison
    uint reserved;
    float recede;     // share of a slot's reach, [0, 1)
    uint edgeGroups;  // 64 edges each; lists follow in this order
    uint triangleGroups;
    uint cornerGroups;
    uint objects;     // (object slot, emitted triangles; 0: none)
    uint emitJobs;    // first words of the lists that the device writes
    uint placeJobs;   // morph jobs start half way to cutJobs
    uint objectEnd;   // object slots with a record
    uint cutJobs;     // edge jobs start as far behind it
};
FW_SIZE(RefinePush, 64)
FW_CONST uint kRefineFreshHeat = 4u;  // RefinePush::parity
FW_CONST float kRefineRate = 4.0f;    // levels per s, once a surface has moved
FW_CONST float kRefineCool = 1.0f;    // s that a level outlives its heat
FW_CONST float kRefineGrace = 0.25f;  // s of burning during which a surface counts as flat

// ---- levels of a triangle in one word: sides at bits 0, 4, 8, interior at 12

FW_FN uint refinePack(uint l0, uint l1, uint l2, uint m) {
    return l0 | (l1 << 4u) | (l2 << 8u) | (m << 12u);
}
FW_FN uint refineSide(uint levels, uint e) { return (levels >> (4u * e)) & 15u; }
FW_FN uint refineInterior(uint levels) { return (levels >> 12u) & 15u; }
FW_FN uint refineSideDepth(uint flags, uint e) { return (flags >> (4u + 4u * e)) & 15u; }
FW_FN uint refineInteriorDepth(uint flags) { return (flags >> 16u) & 15u; }
FW_FN bool refineFlipped(uint flags, uint e) { return ((flags >> e) & 1u) != 0u; }
FW_FN uint refineNext(uint e) { return e == 2u ? 0u : e + 1u; }
FW_FN uint refineBefore(uint e) { return e == 0u ? 2u : e - 1u; }

// Least interior level >= m that these sides can be joined to.
FW_FN uint fitInterior(uint l0, uint l1, uint l2, uint m) {
    uint most = l0 > l1 ? l0 : l1;
    most = most > l2 ? most : l2;
    if (most >= 2u) return m > 2u ? m : 2u;
    return m >= 2u ? m : most;
}

FW_FN uint refineCount(uint levels) {
    uint m = refineInterior(levels);
    uint l0 = refineSide(levels, 0u), l1 = refineSide(levels, 1u), l2 = refineSide(levels, 2u);
    if (m < 2u) return 1u + l0 + l1 + l2;
    uint s = (1u << m) - 3u;
    return s * s + 3u * s + (1u << l0) + (1u << l1) + (1u << l2);
}

FW_SHARED_END
#endif
