// Counts the front list's tiles per object.
#include "lib/compute.glsl"
FW_READ(OBJECTS) FW_READ(TILE_STATE) FW_READ(LISTS) FW_READ(COUNTERS) FW_READ_WRITE(OBJECT_COUNTERS)
FW_PUSH(StepPush)
#include "lib/tile.glsl"

void main() {
    uint count = counters[push.row].listCount;
    for (uint i = gl_GlobalInvocationID.x; i < count; i += gl_NumWorkGroups.x * 64u) {
        TileRef tile = tileRef(push.parity == 0u ? listA[i] : listB[i]);
        if (tile.alive) atomicAdd(objectCounters[tile.object].frontTiles, 1u);
    }
}
