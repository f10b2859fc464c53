// Levels of edges and interiors, in phases with a barrier between: 0 aim (items); 1 triangles for
// each bias (only over budget); 2 least bias that fits (one group); 3 move (items); 4 pack
// (triangles): changed objects emit, moving items are listed to be placed.
#include "lib/refine.glsl"
FW_READ(REFINE_TRIANGLES) FW_READ(REFINE_EDGES) FW_READ(REFINE_SLOTS) FW_READ_WRITE(REFINE_WORK)
FW_READ_WRITE(REFINE_HEAT) FW_READ_WRITE(REFINE_ITEMS) FW_READ_WRITE(REFINE_LEVELS)

float edgeLod(uint object, RefineEdge edge) {
    vec4 eye = refined[object].eye;
    uint base = refined[object].meshSlots;
    vec3 a = vec3(slots[base + edge.low].x, slots[base + edge.low].y, slots[base + edge.low].z);
    vec3 b = vec3(slots[base + edge.high].x, slots[base + edge.high].y, slots[base + edge.high].z);
    float lod = refineLod(a, b, eye.xyz, eye.w, refined[object].pixelsPerEdge);
    return eye.w > 0.0 ? lod : float(kRefineDepth + 1u);
}

// Order in which edges and interiors lose levels.
uint spreadId(uint item, uint edgeCount) {
    return item < edgeCount ? item * 2u : (item - edgeCount) * 2u + 1u;
}

float wanted(uint object, uint item, float bias) {
    uint at = refined[object].items + item;
    float target = items[at].target;
    if (target == 0.0 || bias == 0.0) return target;
    return biasedLevel(target, bias, levelLossOrder(spreadId(item, refined[object].edgeCount),
                                     heat[at] >> kRefineHeatShift));
}

float minBias() {
    return push.budget == 0u ? 0.0 : float(work[kRefineWorkBias]) * kRefineBiasStep;
}

uint sumsOf(uint object) { return refined[object].triangles + refined[object].triangleCount; }

// Adds the triangle's count for each bias, minus the one that it always has.
void count(uint object, uint triangle) {
    RefineTriangle t = triangles[refined[object].meshTriangles + triangle];
    uint edgeCount = refined[object].edgeCount;
    uvec4 own = uvec4(t.edge[0], t.edge[1], t.edge[2], edgeCount + triangle);
    vec4 target, spread;
    for (int k = 0; k < 4; ++k) {
        uint at = refined[object].items + own[k];
        target[k] = items[at].target;
        spread[k] = levelLossOrder(spreadId(own[k], edgeCount), heat[at] >> kRefineHeatShift);
    }
    uint sums = sumsOf(object), k = 0u;
    bool more = target != vec4(0.0);
    while (more) {  // until a bias leaves nothing
        float bias = float(k) * kRefineBiasStep;
        uvec4 top;
        for (int i = 0; i < 4; ++i) top[i] = topLevel(biasedLevel(target[i], bias, spread[i]));
        uint sum =
            refineCount(refinePack(top.x, top.y, top.z, fitInterior(top.x, top.y, top.z, top.w))) -
            1u;
        if ((k & 1u) == 0u)
            atomicAdd(levels[sums + (k >> 1u)].x, sum);
        else
            atomicAdd(levels[sums + (k >> 1u)].y, sum);
        ++k;
        more = sum != 0u && k < kRefineBiases;
    }
}

shared uint sumOf[kRefineBiases];

// A lane's share: one bias, every fourth object.
void choose() {
    uint lane = gl_LocalInvocationID.x, bias = lane & 15u;
    if (lane < kRefineBiases) sumOf[lane] = 0u;
    barrier();
    uint sum = 0u;
    for (uint object = lane >> 4u; object < push.objectEnd; object += 4u) {
        bool counted = (refined[object].flags & kRefineIsCounted) != 0u;
        uvec2 both = levels[counted ? sumsOf(object) + (bias >> 1u) : 0u];
        uint one = (bias & 1u) == 0u ? both.x : both.y;
        sum += counted ? one : 0u;
    }
    atomicAdd(sumOf[bias], sum);
    barrier();
    if (lane != 0u) return;
    uint least = kRefineBiases - 1u;
    for (uint k = kRefineBiases - 1u; k > 0u; --k)
        least = sumOf[k - 1u] <= push.budget ? k - 1u : least;
    work[kRefineWorkBias] = least;
}

void aim(uint object, uint item) {
    uint at = refined[object].items + item;
    uint edgeCount = refined[object].edgeCount;
    bool fresh = (refined[object].flags & kRefineIsFresh) != 0u;
    RefineLevel s = items[at];
    if (fresh) s = RefineLevel(0.0, 0.0, -kRefineNever, kRefineNever);
    uint seen = heat[at];
    uint warm = seen & 3u;
    // Keeps its levels while it opens, and where a hole's rim stays.
    uint rim = kRefineGone | kRefineStays;
    if ((seen & kRefineGoing) != 0u || (seen & rim) == rim) warm |= kRefineHot;
    if (push.full != 0u) warm = kRefineHot | kRefineBurning;
    uint kept = seen & (kRefineGone | kRefineLost);
    heat[at] = kept | (warm << kRefineHeatShift);
    // Most of a mesh is cold and flat.
    uint awake = warm == 0u && s.level == 0.0 && s.target == 0.0 ? 0u : 1u;
    while (awake != 0u) {
        float lod = 0.0;
        float depth;
        if (item < edgeCount) {
            RefineEdge edge = edges[refined[object].meshEdges + item];
            lod = edgeLod(object, edge);
            depth = float(edge.flags & 15u);
        } else {
            RefineTriangle t = triangles[refined[object].meshTriangles + item - edgeCount];
            for (uint e = 0u; e < 3u; ++e)
                lod = max(lod, edgeLod(object, edges[refined[object].meshEdges + t.edge[e]]));
            depth = float(refineInteriorDepth(t.flags));
        }
        setRefineTarget(s, warm, lod, depth, refined[object].now, kRefineCool);
        awake = 0u;
    }
    items[at] = s;
}

void move(uint object, uint item) {
    uint at = refined[object].items + item;
    RefineLevel s = items[at];
    float before = s.level;
    float now = refined[object].now;
    moveRefineLevel(s, wanted(object, item, minBias()), now, refined[object].dt, kRefineRate,
                    kRefineGrace);
    items[at] = s;
    if (s.level == before && now - s.lastHot >= kRefineCool) return;
    heat[at] |= kRefineMoving;
    if (item >= refined[object].edgeCount) return;
    FW_ADD_JOB(kRefineWorkEdges, edgeJobs(), 64u, object, item)
}

void pack(uint object, uint triangle) {
    RefineTriangle t = triangles[refined[object].meshTriangles + triangle];
    uint base = refined[object].items;
    uint own = base + refined[object].edgeCount + triangle;
    uint a = topLevel(items[base + t.edge[0]].level);
    uint b = topLevel(items[base + t.edge[1]].level);
    uint c = topLevel(items[base + t.edge[2]].level);
    uint m = fitInterior(a, b, c, topLevel(items[own].level));
    uint packed = refinePack(a, b, c, m);
    uint at = refined[object].triangles + triangle;
    bool changed =
        (refined[object].flags & (kRefineIsFresh | kRefineIsWhole)) != 0u || levels[at].x != packed;
    levels[at].x = packed;
    if (changed) atomicOr(work[objectList() + 2u * refined[object].ordinal + 1u], 1u);
    uint moving =
        heat[own] | heat[base + t.edge[0]] | heat[base + t.edge[1]] | heat[base + t.edge[2]];
    if (m >= 2u && (changed || (moving & kRefineMoving) != 0u)) {
        FW_ADD_JOB(kRefineWorkPlace, push.placeJobs, 2u, object, triangle)
        float level = items[own].level;
        if (topLevel(level) != m || levelMorphAge(level, m) >= 1.0) return;
        FW_ADD_JOB(kRefineWorkMorph, morphJobs(), 2u, object, triangle)
    }
}

void main() {
    if (push.phase == 2u) {
        choose();
        return;
    }
    bool perItem = push.phase == 0u || push.phase == 3u;
    uint first = perItem ? 0u : push.edgeGroups;
    uint last = push.edgeGroups + push.triangleGroups;
    for (uint g = first + gl_WorkGroupID.x; g < last; g += gl_NumWorkGroups.x) {
        uint object = work[edgeList() + 2u * g];
        uint i = work[edgeList() + 2u * g + 1u] + gl_LocalInvocationID.x;
        bool edge = g < push.edgeGroups;
        uint total = edge ? refined[object].edgeCount : refined[object].triangleCount;
        bool here = i < total;
        uint item = edge ? i : refined[object].edgeCount + i;
        if (push.phase == 0u) {
            if (!edge && i < kRefineSums) levels[sumsOf(object) + i] = uvec2(total);
            if (here) aim(object, item);
        } else if (push.phase == 1u) {
            if (here) count(object, i);
        } else if (push.phase == 3u) {
            if (here) move(object, item);
        } else if (here) {
            pack(object, i);
        }
    }
}
