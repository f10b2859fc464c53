// Cuts the holes of near objects out of their small triangles. Phases with a barrier between: 0
// lists coarse triangles with a hole, and those along open edges of closed meshes, one lane each.
// 1, one workgroup each: small triangles crossed by a hole leave the index list; the rest of them
// is written as vertices, with inner skin and walls along the hole and along open edges; without
// capacity they stay whole. 2 writes draw arguments. Objects with per-pixel holes keep triangles
// whole until all of a triangle is gone, and only get walls along open edges.
#include "lib/refine.glsl"
FW_READ(REFINE_WORDS) FW_READ(REFINE_TRIANGLES) FW_READ(REFINE_EDGES) FW_READ(REFINE_SLOTS)
FW_READ(REFINE_LEVELS) FW_READ(REFINE_VERTICES) FW_READ(PREDICT) FW_READ(GRADIENT) FW_READ(VERTICES)
FW_READ_WRITE(REFINE_WORK) FW_READ_WRITE(REFINE_HEAT) FW_WRITE(REFINE_INDICES) FW_WRITE(REFINE_CUTS)
FW_WRITE(REFINE_CUT_DRAWS)
#include "lib/refine_arrival.glsl"

const uint kLost = 0x80000000u;  // of a job's triangle: all burnt through

uint slotOf(uint object, uint vertex) {
    return meshVertices[(refined[object].meshDraws + vertex) * 3u + 2u].w;
}

// Sides on open edges, one bit each; meshes with an inner skin only.
uint openSides(uint object, RefineTriangle t) {
    uint open = 0u;
    for (uint e = 0u; e < 3u; ++e)
        open |= ((edges[refined[object].meshEdges + t.edge[e]].flags >> 4u) & 1u) << e;
    return refined[object].inner != 0u ? open : 0u;
}

bool hasPerPixelHoles(uint object) {
    return (refined[object].flags & kRefineHasPerPixelHoles) != 0u;
}

bool isGone(uint object, float hole) { return hole <= refined[object].now; }

// Is all of it burnt through? Tests its corners, the middles of its sides and three inner points.
bool isLost(uint object, RefineTriangle t) {
    bool lost = true;
    for (uint v = 0u; v < 3u; ++v) {
        uint at = refined[object].vertices + slotOf(object, t.corner[v]);
        lost = lost && isGone(object, vertices[at].hole);
    }
    bool inner = refineInteriorDepth(t.flags) >= 2u;
    uint count = lost ? 6u : 0u;
    for (uint k = 0u; k < count; ++k) {
        uint side = k % 3u;
        RefineEdge edge = edges[refined[object].meshEdges + t.edge[side]];
        uint s = (edge.flags & 15u) > 0u ? refineEdgeSlot(edge, 1u, 1u) : edge.low;
        if (k >= 3u && inner)
            s = refineInnerSlot(t, side == 1u ? 2u : 1u, side == 2u ? 2u : 1u, 2u);
        RefineSlot slot = slots[refined[object].meshSlots + s];
        float behind;
        lost =
            lost &&
            isGone(object, evaluateSlotNow(object, slot, push.nowTick, push.recede, behind).hole);
    }
    return lost;
}

void find(uint object, uint triangle) {
    RefineTriangle t = triangles[refined[object].meshTriangles + triangle];
    uint base = refined[object].items, own = base + refined[object].edgeCount + triangle;
    uint seen =
        heat[own] | heat[base + t.edge[0]] | heat[base + t.edge[1]] | heat[base + t.edge[2]];
    uint open = openSides(object, t);
    if ((seen & kRefineGone) == 0u && open == 0u) return;
    bool lost = (heat[own] & kRefineLost) != 0u;
    bool asks = (seen & (kRefineGone | kRefineStays)) == kRefineGone && !lost;
    while (asks) {
        lost = isLost(object, t);
        if (lost) heat[own] |= kRefineLost;
        asks = false;
    }
    if (hasPerPixelHoles(object) && !lost && open == 0u) return;
    // Most burnt triangles are gone and coarse again: no workgroup for those.
    uvec2 packed = levels[refined[object].triangles + triangle];
    if (lost && packed.x == 0u) {
        uint to = refined[object].indices + packed.y * 3u;
        indices[to] = indices[to + 1u] = indices[to + 2u] = t.corner[0];
        return;
    }
    FW_ADD_JOB(kRefineWorkCut, push.cutJobs, 1u, object, triangle | (lost ? kLost : 0u))
}

uint roomBefore(uint object, uint m) {
    return refineCutShare(refined[object].cutTriangles, materialStart(object, m),
                          refined[object].triangleCount);
}

struct Point {   // of a kept polygon
    vec3 outer;
    vec3 inner;
    uvec4 atlas;   // second and third quad of its vertex, without the last word
    uvec4 detail;
    uint normal;
    float left;    // s to the hole
};

// at: see RefineCut::corner.
Point pointOf(uint object, uvec3 drawn, uvec3 slots_, vec3 fields, uint at) {
    uint i = at & 3u, j = at < 4u ? i : refineNext(i);
    bool ordered = slots_[i] <= slots_[j];
    uint a = ordered ? i : j, b = ordered ? j : i;
    float fa = fields[a], fb = fields[b];
    float share = at < 4u ? 0.0 : refineCutAt(fa, fb);
    RefineVertex va = vertices[refined[object].vertices + slots_[a]];
    RefineVertex vb = vertices[refined[object].vertices + slots_[b]];
    vec3 innerA = refineInnerSkin(slots[refined[object].meshSlots + slots_[a]]);
    vec3 innerB = refineInnerSkin(slots[refined[object].meshSlots + slots_[b]]);
    Point p;
    p.outer = vec3(va.x, va.y, va.z);
    p.inner = innerA;
    p.left = fa;
    if (at >= 4u) {
        p.outer = refineCutPoint(p.outer, vec3(vb.x, vb.y, vb.z), fa, fb);
        p.inner = refineCutPoint(innerA, innerB, fa, fb);
        p.left = 0.0;
    }
    uint first = (refined[object].meshDraws + drawn[a]) * 3u;
    uint second = (refined[object].meshDraws + drawn[b]) * 3u;
    bool near = share < 0.5;
    p.normal = meshVertices[near ? first : second].w;
    uvec4 a1 = meshVertices[first + 1u], b1 = meshVertices[second + 1u];
    uvec4 a2 = meshVertices[first + 2u], b2 = meshVertices[second + 2u];
    p.atlas = floatBitsToUint(mix(uintBitsToFloat(a1), uintBitsToFloat(b1), share));
    p.detail.xy = floatBitsToUint(mix(uintBitsToFloat(a2.xy), uintBitsToFloat(b2.xy), share));
    p.detail.z = near ? a2.z : b2.z;
    p.detail.w = 0u;
    return p;
}

void writeVertex(uint at, Point p, bool inner, float left) {
    vec3 place = inner ? p.inner : p.outer;
    cuts[at * 3u] = uvec4(floatBitsToUint(place), p.normal);
    cuts[at * 3u + 1u] = p.atlas;
    cuts[at * 3u + 2u] = uvec4(p.detail.xyz, floatBitsToUint(left));
}

void cutTriangle(uint object, uvec3 drawn, uvec3 slots_, vec3 fields, RefineCut cut, bool whole,
                 uint first) {
    Point points[4];
    for (uint i = 0u; i < 4u; ++i)
        points[i] = pointOf(object, drawn, slots_, fields, cut.corner[min(i, cut.points - 1u)]);
    bool skin = refined[object].inner != 0u;
    uint count = refineCutDrawnCount(cut, skin, whole);
    for (uint k = 0u; k < count; ++k) {
        uint piece = refineCutDrawn(cut, k, skin, whole);
        uvec3 corners = refineCutTriangle(cut, piece);
        bool wall = piece + 4u >= 2u * cut.points;
        bool rim = wall && refineCutWallSide(cut, piece) == cut.rim;
        float outer = rim ? kRefineCutRim : kRefineBorder;
        for (uint v = 0u; v < 3u; ++v) {
            uint p = corners[v];
            bool inner = p >= 4u;
            float left = wall ? (inner ? outer - 1.0 : outer) : points[p & 3u].left;
            writeVertex(first + 3u * k + v, points[p & 3u], inner, left);
        }
    }
}

void cutGroup(uint object, uint triangle, bool lost) {
    RefineTriangle t = triangles[refined[object].meshTriangles + triangle];
    uvec2 packed = levels[refined[object].triangles + triangle];
    float now = refined[object].now;
    uint material = 0u;
    for (uint m = 1u; m < kMaterialsPerObject; ++m)
        material += triangle >= materialStart(object, m) ? 1u : 0u;
    uint counts = cutCounts(refined[object].ordinal) + material;
    uint before = roomBefore(object, material);
    uint room = roomBefore(object, material + 1u) - before;
    uint open = openSides(object, t);
    uint count = refineCount(packed.x);
    for (uint k = gl_LocalInvocationID.x; k < count; k += 64u) {
        RefinePlace place = refineLocate(packed.x, k);
        uvec3 codes = refineCodes(packed.x, place, tableToken(place.entry));
        uvec3 drawn, slots_;
        vec3 fields;
        uint solid = 0u;
        for (uint v = 0u; v < 3u; ++v) {
            drawn[v] = refineDrawVertex(t, packed.x, codes[v]);
            slots_[v] = slotOf(object, drawn[v]);
            fields[v] = secondsToHole(vertices[refined[object].vertices + slots_[v]].hole, now);
            solid |= fields[v] > 0.0 ? 1u << v : 0u;
        }
        uint border = 0u;
        for (uint v = 0u; v < 3u; ++v) {
            uint sides =
                refineSidesOf(packed.x, codes[v]) & refineSidesOf(packed.x, codes[refineNext(v)]);
            border |= (sides & open) != 0u ? 1u << v : 0u;
        }
        if (hasPerPixelHoles(object)) solid = 7u;
        if (lost) solid = 0u;
        bool whole = solid == 7u;
        uint crossed = solid != 0u && (!whole || border != 0u) ? 1u : 0u;
        while (crossed != 0u) {
            RefineCut cut = refineCut(solid, border);
            uint pieces = refineCutDrawnCount(cut, refined[object].inner != 0u, whole);
            uint at = atomicAdd(work[counts], pieces);
            if (at + pieces > room) {
                atomicMin(work[counts + 8u], at);
                whole = true;
            } else {
                cutTriangle(object, drawn, slots_, fields, cut, whole,
                            refined[object].cuts + 3u * (before + at));
            }
            crossed = 0u;
        }
        uint to = refined[object].indices + (packed.y + k) * 3u;
        indices[to] = drawn.x;
        indices[to + 1u] = whole ? drawn.y : drawn.x;
        indices[to + 2u] = whole ? drawn.z : drawn.x;
    }
}

void main() {
    if (push.phase == 0u) {
        for (uint g = gl_WorkGroupID.x; g < push.triangleGroups; g += gl_NumWorkGroups.x) {
            uint object = work[triangleList() + 2u * g];
            uint i = work[triangleList() + 2u * g + 1u] + gl_LocalInvocationID.x;
            bool cut = (refined[object].flags & kRefineIsCut) != 0u;
            if (cut && i < refined[object].triangleCount) find(object, i);
        }
        return;
    }
    if (push.phase == 1u) {
        uint jobs = work[kRefineWorkCut + 3u];
        for (uint job = gl_WorkGroupID.x; job < jobs; job += gl_NumWorkGroups.x) {
            uint triangle = work[push.cutJobs + 2u * job + 1u];
            cutGroup(work[push.cutJobs + 2u * job], triangle & ~kLost, (triangle & kLost) != 0u);
        }
        return;
    }
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.objects * kMaterialsPerObject) return;
    uint ordinal = i / kMaterialsPerObject, material = i % kMaterialsPerObject;
    uint object = work[objectList() + 2u * ordinal];
    if ((refined[object].flags & kRefineIsCut) == 0u) return;
    uint counts = cutCounts(ordinal) + material;
    uint at = (object * kMaterialsPerObject + material) * 4u;
    cutDraws[at] = 3u * min(work[counts], work[counts + 8u]);
    cutDraws[at + 1u] = 1u;
    cutDraws[at + 2u] = refined[object].cuts + 3u * roomBefore(object, material);
    cutDraws[at + 3u] = 0u;
}
