// Warms the edges and interiors near the tiles of the front (lit soon, or moving) or of the burn list:
// a wave of heat that runs ahead of the fire. One lane per tile.
#version 450
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#define FW_USE_WORK readonly
#define FW_USE_WORDS readonly
#define FW_USE_HEAT FW_READ_WRITE
#include "lib/refine_buffers.glsl"

layout(std430, set = 0, binding = FW_BIND_OBJECTS) readonly buffer ObjectQuadsBuffer {
    uvec4 objectQuads[];
};
layout(std430, set = 0, binding = FW_BIND_TILE_STATE) readonly buffer TileStateBuffer {
    TileState tileState[];
};
layout(std430, set = 0, binding = FW_BIND_COUNTERS) readonly buffer CountersBuffer {
    IterationCounters counters[];
};
layout(std430, set = 0, binding = FW_BIND_LIST_A) readonly buffer ListABuffer { uint listA[]; };
layout(std430, set = 0, binding = FW_BIND_LIST_B) readonly buffer ListBBuffer { uint listB[]; };
layout(std430, set = 0, binding = FW_BIND_BURN_A) readonly buffer BurnABuffer { uint burnA[]; };
layout(std430, set = 0, binding = FW_BIND_BURN_B) readonly buffer BurnBBuffer { uint burnB[]; };

uint entry(uint i) {
    if (push.parity == 0u) return listA[i];
    if (push.parity == 1u) return listB[i];
    if (push.parity == 2u) return burnA[i];
    return burnB[i];
}

void main() {
    uint count = counters[push.row].listCount;
    for (uint i = gl_GlobalInvocationID.x; i < count; i += gl_NumWorkGroups.x * 64u) {
        uint tile = entry(i);
        uint object = tileState[tile].object;
        uint local = tile - objectQuads[object * 10u + 1u].x;
        bool known = object < push.objectEnd;
        object = known ? object : 0u;
        known = known && (refined[object].flags & kRefineIsActive) != 0u &&
                local < refined[object].tileCount;
        bool burns = push.parity >= 2u || (tileState[tile].flag & kTileBurning) != 0u;
        uint bits = kRefineHot | (burns ? kRefineBurning : 0u);
        uint base = refined[object].meshWords;
        uint at = known ? words[base + local] : 0u;
        uint end = known ? words[base + local + 1u] : 0u;
        uint list = base + refined[object].tileCount + 1u;
        uint first = refined[object].items;
        while (at < end) {
            atomicOr(heat[first + words[list + at]], bits);
            at += 1u;
        }
    }
}
