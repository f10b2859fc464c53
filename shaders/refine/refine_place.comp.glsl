// Positions of moving vertices, in phases with a barrier between: 0 corners, one lane each; 1
// moving edges, one lane each, positions and then the morph of their newest points; 2 interiors,
// half a workgroup each; 3 their morph.
#include "lib/refine.glsl"
FW_READ(REFINE_WORK) FW_READ(REFINE_TRIANGLES) FW_READ(REFINE_EDGES) FW_READ(REFINE_SLOTS)
FW_READ(REFINE_ITEMS) FW_READ(REFINE_LEVELS) FW_READ(PREDICT) FW_READ(GRADIENT)
FW_READ_WRITE(REFINE_HEAT) FW_READ_WRITE(REFINE_VERTICES)
#include "lib/refine_arrival.glsl"

// Bits that a vertex with this burn-through time adds to its edge or interior.
uint fateOf(uint object, float hole) {
    if (hole <= refined[object].now) return kRefineGone;
    return hole < kRefineNever ? kRefineStays | kRefineGoing : kRefineStays;
}

uint evaluate(uint object, uint s) {
    RefineSlot slot = slots[refined[object].meshSlots + s];
    float behind;
    RefineVertex v = evaluateSlotNow(object, slot, push.nowTick, push.recede, behind);
    vertices[refined[object].vertices + s] = v;
    uint inner = refined[object].inner;
    while (inner != 0u) {
        vec3 p = refineInnerSkin(slot);
        vertices[refined[object].vertices + inner + s] = RefineVertex(p.x, p.y, p.z, behind);
        inner = 0u;
    }
    return fateOf(object, v.hole);
}

vec3 placeOf(uint object, uint s) {
    uint at = refined[object].vertices + s;
    return vec3(vertices[at].x, vertices[at].y, vertices[at].z);
}

void morph(uint object, uint s, vec3 a, vec3 b, float age) {
    vec3 p = refineMorph(placeOf(object, s), a, b, age);
    uint at = refined[object].vertices + s;
    vertices[at].x = p.x;
    vertices[at].y = p.y;
    vertices[at].z = p.z;
}

vec3 latticePlace(uint object, RefineTriangle t, uint packed, uint c1, uint c2) {
    RefineSpot spot = refineSpot(t, packed, c1, c2);
    if (spot.side == 3u)
        return placeOf(object, refineInnerSlot(t, c1, c2, refineInterior(packed)));
    RefineEdge edge = edges[refined[object].meshEdges + t.edge[spot.side]];
    uint l = refineSide(packed, spot.side);
    vec3 a = placeOf(object, refineEdgeSlot(edge, spot.i, l));
    if (spot.f == 0.0) return a;
    return a + (placeOf(object, refineEdgeSlot(edge, spot.i + 1u, l)) - a) * spot.f;
}

void edgeLane(uint object, uint e) {
    uint item = refined[object].items + e;
    RefineEdge edge = edges[refined[object].meshEdges + e];
    float level = items[item].level;
    uint l = topLevel(level), steps = 1u << l;
    uint fate = fateOf(object, vertices[refined[object].vertices + edge.low].hole) |
                fateOf(object, vertices[refined[object].vertices + edge.high].hole);
    for (uint i = 1u; i < steps; ++i) fate |= evaluate(object, refineEdgeSlot(edge, i, l));
    atomicOr(heat[item], fate);
    float age = levelMorphAge(level, l);
    steps = l == 0u || age >= 1.0 ? 0u : steps;
    for (uint i = 1u; i < steps; i += 2u)
        morph(object, refineEdgeSlot(edge, i, l), placeOf(object, refineEdgeSlot(edge, i - 1u, l)),
              placeOf(object, refineEdgeSlot(edge, i + 1u, l)), age);
}

// Lattice point k: rows from both ends are paired, so no lane is idle.
uvec2 latticePoint(uint k, uint n) {
    uint width = n - 1u;  // of a row and its partner: (n - 2) + 1, (n - 3) + 2, ...
    uint row = k / width, at = k % width;
    uint length = n - 2u - row;
    bool first = at < length;
    return first ? uvec2(at + 1u, row + 1u) : uvec2(at - length + 1u, n - 2u - row);
}

void placeInterior(uint object, uint triangle, uint lane) {
    RefineTriangle t = triangles[refined[object].meshTriangles + triangle];
    uint m = refineInterior(levels[refined[object].triangles + triangle].x);
    uint n = 1u << m;
    uint count = refineInnerCount(m), fate = 0u;
    for (uint k = lane; k < count; k += 32u) {
        uvec2 c = latticePoint(k, n);
        fate |= evaluate(object, refineInnerSlot(t, c.x, c.y, m));
    }
    if (fate != 0u)
        atomicOr(heat[refined[object].items + refined[object].edgeCount + triangle], fate);
}

void morphInterior(uint object, uint triangle, uint lane) {
    RefineTriangle t = triangles[refined[object].meshTriangles + triangle];
    uint packed = levels[refined[object].triangles + triangle].x;
    uint m = refineInterior(packed);
    float level = items[refined[object].items + refined[object].edgeCount + triangle].level;
    float age = levelMorphAge(level, m);
    uint n = 1u << m;
    uint count = refineInnerCount(m);
    for (uint k = lane; k < count; k += 32u) {
        uvec2 c = latticePoint(k, n);
        if (!refineIsNew(c.x, c.y)) continue;
        RefineParents p = refineParents(c.x, c.y);
        morph(object, refineInnerSlot(t, c.x, c.y, m), latticePlace(object, t, packed, p.a1, p.a2),
              latticePlace(object, t, packed, p.b1, p.b2), age);
    }
}

// Half a workgroup per interior.
void interiors(uint dispatched, uint list, bool morphs) {
    uint jobs = work[dispatched + 3u];
    uint lane = gl_LocalInvocationID.x & 31u;
    for (uint job = gl_GlobalInvocationID.x >> 5u; job < jobs; job += gl_NumWorkGroups.x * 2u) {
        uint object = work[list + 2u * job], triangle = work[list + 2u * job + 1u];
        if (morphs)
            morphInterior(object, triangle, lane);
        else
            placeInterior(object, triangle, lane);
    }
}

void main() {
    // Loops: a software device executes both sides of a branch.
    uint phase = push.phase;
    while (phase == 0u) {
        for (uint g = gl_WorkGroupID.x; g < push.cornerGroups; g += gl_NumWorkGroups.x) {
            uint object = work[cornerList() + 2u * g];
            uint i = work[cornerList() + 2u * g + 1u] + gl_LocalInvocationID.x;
            if (i < refined[object].cornerCount) evaluate(object, i);
        }
        return;
    }
    while (phase == 1u) {
        uint jobs = work[kRefineWorkEdges + 3u];
        for (uint i = gl_GlobalInvocationID.x; i < jobs; i += gl_NumWorkGroups.x * 64u)
            edgeLane(work[edgeJobs() + 2u * i], work[edgeJobs() + 2u * i + 1u]);
        return;
    }
    while (phase == 2u) {
        interiors(kRefineWorkPlace, push.placeJobs, false);
        return;
    }
    interiors(kRefineWorkMorph, morphJobs(), true);
}
