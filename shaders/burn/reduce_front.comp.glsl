// Counts the front list's tiles per object.
#version 450
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#define FW_USE_PUSH
#define FW_USE_OBJECTS readonly
#define FW_USE_TILE_STATE readonly
#define FW_USE_LISTS readonly
#define FW_USE_COUNTERS readonly
#define FW_USE_OBJECT_COUNTERS FW_READ_WRITE
#include "lib/buffers.glsl"

void main() {
    uint count = counters[push.row].listCount;
    for (uint i = gl_GlobalInvocationID.x; i < count; i += gl_NumWorkGroups.x * 64u) {
        TileRef tile = tileRef(push.parity == 0u ? listA[i] : listB[i]);
        if (tile.alive) atomicAdd(objectCounters[tile.object].frontTiles, 1u);
    }
}
