// Counts the front list's tiles per object.
#include "lib/compute.glsl"
FW_READ(OBJECTS) FW_READ(TILE_STATE) FW_READ(FRONT_LISTS) FW_READ(COUNTERS)
FW_READ_WRITE(OBJECT_COUNTERS) FW_PUSH(StepPush)
#include "lib/tile.glsl"

void countTile(uint i) {
    TileRef tile = tileRef(frontLists[2u * i + push.parity]);
    if (tile.alive) atomicAdd(objectCounters[tile.object].frontTiles, 1u);
}
void main() { FW_STRIDE(counters[push.row].listCount, countTile) }
