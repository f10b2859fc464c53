// Places of all vertices in use, in phases with a barrier between: 0 corners, a lane each; 1 edges, a
// lane each, their own places and then the morph of their newest points; 2 interiors, a workgroup
// each, own places; 3 interiors, the morph.
#version 450
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#define FW_USE_TRIANGLES readonly
#define FW_USE_EDGES readonly
#define FW_USE_SLOTS readonly
#define FW_USE_ITEMS readonly
#define FW_USE_LEVELS readonly
#define FW_USE_VERTICES FW_READ_WRITE
#define FW_USE_TICKS readonly
#include "lib/refine_buffers.glsl"

float arrivalAt(uint base, uint weights) {
    uint up = base + frame.textureWidth;
    uvec4 t = uvec4(ticks[base], ticks[base + 1u], ticks[up], ticks[up + 1u]);
    return refineArrival(t, weights, frame.nowTick, frame.epochTick);
}

void evaluate(uint s) {
    RefineSlot slot = slots[s];
    float own = arrivalAt(slot.texel & 0xFFFFFFu, slot.weights);
    float opposite = kRefineNever;
    if (slot.opposite != kRefineOpposed)
        opposite = arrivalAt(slot.opposite & 0xFFFFFFu, refineOppositeWeights(slot.opposite));
    vec4 v = refineEvaluate(slot, own, opposite, frame.now, frame.burnSeconds[slot.texel >> 24u],
                            frame.recede);
    vertices[s].x = v.x;
    vertices[s].y = v.y;
    vertices[s].z = v.z;
    vertices[s].hole = v.w;
}

vec3 placeOf(uint s) { return vec3(vertices[s].x, vertices[s].y, vertices[s].z); }

void morph(uint s, vec3 a, vec3 b, float age) {
    vec3 p = refineMorph(placeOf(s), a, b, age);
    vertices[s].x = p.x;
    vertices[s].y = p.y;
    vertices[s].z = p.z;
}

vec3 latticePlace(RefineTriangle t, uint packed, uint c1, uint c2) {
    RefineSpot spot = refineSpot(t, packed, c1, c2);
    if (spot.side == 3u) return placeOf(refineInnerSlot(t, c1, c2, refineInterior(packed)));
    RefineEdge edge = edges[t.edge[spot.side]];
    uint l = refineSide(packed, spot.side);
    vec3 a = placeOf(refineEdgeSlot(edge, spot.i, l));
    if (spot.f == 0.0) return a;
    return a + (placeOf(refineEdgeSlot(edge, spot.i + 1u, l)) - a) * spot.f;
}

void edgeLane(uint e) {
    RefineEdge edge = edges[e];
    float level = items[e].level;
    uint l = refineTop(level), steps = 1u << l;
    for (uint i = 1u; i < steps; ++i) evaluate(refineEdgeSlot(edge, i, l));
    float age = refineAge(level, l);
    if (l == 0u || age >= 1.0) return;
    for (uint i = 1u; i < steps; i += 2u)
        morph(refineEdgeSlot(edge, i, l), placeOf(refineEdgeSlot(edge, i - 1u, l)),
              placeOf(refineEdgeSlot(edge, i + 1u, l)), age);
}

void interiorGroup(uint triangle) {
    RefineTriangle t = triangles[triangle];
    uint packed = levels[triangle];
    uint m = refineInterior(packed);
    if (m < 2u) return;
    float level = items[frame.edgeCount + triangle].level;
    float age = refineTop(level) == m ? refineAge(level, m) : 1.0;
    if (push.phase == 3u && age >= 1.0) return;
    uint n = 1u << m;
    uint side = n - 2u;
    for (uint k = gl_LocalInvocationID.x; k < side * side; k += 64u) {
        uint c1 = k % side + 1u, c2 = k / side + 1u;
        if (c1 + c2 >= n) continue;
        uint s = refineInnerSlot(t, c1, c2, m);
        if (push.phase == 2u) {
            evaluate(s);
        } else if (refineIsNew(c1, c2)) {
            RefineParents p = refineParents(c1, c2);
            morph(s, latticePlace(t, packed, p.a1, p.a2), latticePlace(t, packed, p.b1, p.b2), age);
        }
    }
}

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (push.phase == 0u) {
        if (i < frame.cornerCount) evaluate(i);
    } else if (push.phase == 1u) {
        if (i < frame.edgeCount) edgeLane(i);
    } else if (gl_WorkGroupID.x < frame.triangleCount) {
        interiorGroup(gl_WorkGroupID.x);
    }
}
