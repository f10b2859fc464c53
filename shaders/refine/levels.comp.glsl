// Levels of edges and interiors, in phases with a barrier between: 0 aim (items), 1 what each bias
// would come to (triangles), 2 move (items), 3 pack (triangles), and where that is more than there
// is room for, 4 go at once (items), 5 pack again (triangles). `sums` is zero before phase 1.
#version 450
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#define FW_USE_TRIANGLES readonly
#define FW_USE_EDGES readonly
#define FW_USE_SLOTS readonly
#define FW_USE_HEAT readonly
#define FW_USE_ITEMS FW_READ_WRITE
#define FW_USE_LEVELS FW_READ_WRITE
#define FW_USE_SUMS FW_READ_WRITE
#include "lib/refine_buffers.glsl"

float edgeLod(RefineEdge edge) {
    if (frame.viewCount == 0u) return float(kRefineDepth + 1u);
    vec3 a = vec3(slots[edge.low].x, slots[edge.low].y, slots[edge.low].z);
    vec3 b = vec3(slots[edge.high].x, slots[edge.high].y, slots[edge.high].z);
    float most = 0.0;
    for (uint v = 0u; v < frame.viewCount; ++v)
        most = max(most, refineLod(a, b, frame.eye[v].xyz, frame.eye[v].w, frame.pixelsPerEdge));
    return most;
}

// Numbers of edges and interiors, for the order in which they lose levels.
uint spreadId(uint item) {
    return item < frame.edgeCount ? item * 2u : (item - frame.edgeCount) * 2u + 1u;
}

float wanted(uint item, float bias) {
    float target = items[item].target;
    if (target == 0.0 || bias == 0.0) return target;
    return refineBiased(target, bias, refineSpread(spreadId(item), heat[item]));
}

float leastBias() {
    for (uint k = 0u; k + 1u < kRefineBiases; ++k)
        if (sums[k] <= frame.budget) return float(k) * kRefineBiasStep;
    return float(kRefineBiases - 1u) * kRefineBiasStep;
}

uint aimedLevels(uint triangle, float bias) {
    RefineTriangle t = triangles[triangle];
    uint a = refineTop(wanted(t.edge[0], bias));
    uint b = refineTop(wanted(t.edge[1], bias));
    uint c = refineTop(wanted(t.edge[2], bias));
    return refinePack(a, b, c, refineFit(a, b, c, refineTop(wanted(frame.edgeCount + triangle, bias))));
}

void aim(uint item) {
    RefineLevel s = items[item];
    float lod = 0.0;
    float depth;
    if (item < frame.edgeCount) {
        lod = edgeLod(edges[item]);
        depth = float(edges[item].flags & 15u);
    } else {
        RefineTriangle t = triangles[item - frame.edgeCount];
        for (uint e = 0u; e < 3u; ++e) lod = max(lod, edgeLod(edges[t.edge[e]]));
        depth = float(refineInteriorDepth(t.flags));
    }
    refineAim(s, heat[item], lod, depth, frame.now, frame.cool);
    items[item] = s;
}

void pack(uint triangle) {
    RefineTriangle t = triangles[triangle];
    uint a = refineTop(items[t.edge[0]].level);
    uint b = refineTop(items[t.edge[1]].level);
    uint c = refineTop(items[t.edge[2]].level);
    uint m = refineTop(items[frame.edgeCount + triangle].level);
    uint packed = refinePack(a, b, c, refineFit(a, b, c, m));
    levels[triangle] = packed;
    if (push.phase == 3u) atomicAdd(sums[kRefineBiases], refineCount(packed));
}

void main() {
    uint i = gl_GlobalInvocationID.x;
    bool perItem = (push.phase & 1u) == 0u;
    if (i >= (perItem ? frame.edgeCount + frame.triangleCount : frame.triangleCount)) return;
    if (push.phase >= 4u && sums[kRefineBiases] <= frame.capacity) return;
    if (push.phase == 0u) {
        aim(i);
    } else if (push.phase == 1u) {
        for (uint k = 0u; k < kRefineBiases; ++k)
            atomicAdd(sums[k], refineCount(aimedLevels(i, float(k) * kRefineBiasStep)));
    } else if (push.phase == 2u) {
        RefineLevel s = items[i];
        refineMove(s, wanted(i, leastBias()), frame.now, frame.dt, frame.rate, frame.grace);
        items[i] = s;
    } else if (push.phase == 4u) {
        items[i].level = wanted(i, leastBias());
    } else {
        pack(i);
    }
}
