// Sliced lattice: a flame's tube as a chain of hexahedra between its nodes' planes, and the convex
// polygon that a plane across the view cuts out of each. Corners keep their place along the curve.
// FW_FLAME_NODE(i): see volume_march.h.
#ifndef FW_REFERENCE_VOLUME_SLICES_H
#define FW_REFERENCE_VOLUME_SLICES_H
#include "reference/slices_push.h"
#include "shared/volume_march.h"

FW_SHARED_BEGIN

FW_CONST uint kSliceCorners = 6u;    // of a polygon, at most
FW_CONST uint kSliceVertices = 12u;  // of its triangle fan

struct SlicePoint {
    vec3 at;       // m, world
    uint corners;  // of its polygon; 0: no intersection
};

// Reach of the lattice at a node, m from the axis.
FW_FN float sliceReach(FlameRecord f, FlameNode a) {
    return flameReachAt(f, a.along.w, a.along.w, a.centre.w, a.side.w);
}

// Corner 0 to 3 of the lattice in a node's plane, in order around the axis.
FW_FN vec3 sliceCorner(FlameNode a, float reach, uint corner) {
    vec3 side = vec3(a.side);
    vec3 across = cross(vec3(a.along), side);
    float u = corner == 0u || corner == 3u ? -reach : reach;
    float v = corner < 2u ? -reach : reach;
    return vec3(a.centre) + u * side + v * across;
}

// Corner `vertex` of the polygon cut by the plane dot(x - eye, forward) == depth out of a lattice
// piece, in order around it. With fewer corners: the last one.
FW_FN SlicePoint sliceVertex(FlameRecord f, FlameNode a, FlameNode b, vec3 eye, vec3 forward,
                             float depth, uint vertex) {
    float reachA = sliceReach(f, a);
    float reachB = sliceReach(f, b);
    vec3 low[4];
    vec3 high[4];
    float under[4];
    float over[4];  // m, beyond the plane
    FW_UNROLL
    for (uint k = 0u; k < 4u; ++k) {
        low[k] = sliceCorner(a, reachA, k);
        high[k] = sliceCorner(b, reachB, k);
        under[k] = dot(low[k] - eye, forward) - depth;
        over[k] = dot(high[k] - eye, forward) - depth;
    }
    // Edges: four in each plane, four between them.
    vec3 cut[12];
    bool is[12];
    vec3 sum = vec3(0.0f);
    uint corners = 0u;
    FW_UNROLL
    for (uint e = 0u; e < 12u; ++e) {
        uint k = e & 3u;
        uint next = (k + 1u) & 3u;
        vec3 from = e < 4u ? low[k] : e < 8u ? high[k] : low[k];
        vec3 to = e < 4u ? low[next] : high[e < 8u ? next : k];
        float d0 = e < 4u ? under[k] : e < 8u ? over[k] : under[k];
        float d1 = e < 4u ? under[next] : over[e < 8u ? next : k];
        is[e] = (d0 < 0.0f) != (d1 < 0.0f);
        cut[e] = from + (to - from) * (is[e] ? d0 / (d0 - d1) : 0.0f);
        sum += is[e] ? cut[e] : vec3(0.0f);
        corners += is[e] ? 1u : 0u;
    }
    SlicePoint point;
    point.corners = corners < 3u ? 0u : corners;
    vec3 middle = sum / max(float(corners), 1.0f);
    point.at = middle;
    // Order around the middle: by quadrant, then by tangent, [0, 4).
    vec3 right = abs(forward.y) < 0.9f ? cross(forward, vec3(0.0f, 1.0f, 0.0f))
                                       : cross(forward, vec3(1.0f, 0.0f, 0.0f));
    vec3 upward = cross(right, forward);
    float angle[12];
    FW_UNROLL
    for (uint e = 0u; e < 12u; ++e) {
        vec3 off = cut[e] - middle;
        float x = dot(off, right);
        float y = dot(off, upward);
        float slope = y / max(abs(x) + abs(y), 1e-30f);
        angle[e] = x >= 0.0f ? 1.0f + slope : 3.0f - slope;
    }
    uint wanted = min(vertex, max(corners, 1u) - 1u);
    FW_UNROLL
    for (uint e = 0u; e < 12u; ++e) {
        uint before = 0u;
        FW_UNROLL
        for (uint o = 0u; o < 12u; ++o)
            before += is[o] && (angle[o] < angle[e] || (angle[o] == angle[e] && o < e)) ? 1u : 0u;
        if (is[e] && before == wanted) point.at = cut[e];
    }
    return point;
}

// Polygon corner of vertex [0, kSliceVertices).
FW_FN uint sliceFan(uint vertex) {
    uint triangle = vertex / 3u;
    uint corner = vertex - 3u * triangle;
    return corner == 0u ? 0u : triangle + corner;
}

// Coordinates along the curve of a point in a piece.
FW_FN FlamePlace slicePlace(FlameNode a, FlameNode b, vec3 x) {
    float da = max(flamePlane(x, a), 0.0f);
    float db = min(flamePlane(x, b), 0.0f);
    return flamePlaceAt(x, a, b, da, db);
}
FW_SHARED_END
#endif
