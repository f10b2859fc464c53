// The hot list.
#include "lib/lists.glsl"
FW_READ_WRITE(HOT_LISTS)
const uint kHotPerGroup = 256u;  // of a group of `heat`
void hotStore(uint parity, uint slot, uint worldTile) {
    if (parity == 0u) hotLists[slot].x = worldTile;
    else hotLists[slot].y = worldTile;
}
void hotAppend(uint parity, uint worldTile) {
    hotStore(parity, listSlot(kRowHot + parity, kHotPerGroup), worldTile);
}
// Objects with heat only: the tile's temperature, water or flux changes from now on. It is updated
// every step (kTileWarm), or at intervals.
void hotList(uint parity, uint worldTile, uint warm) {
    uint old = atomicOr(tileState[worldTile].flag, kTileHot | warm);
    if ((old & kTileHot) == 0u) hotAppend(parity, worldTile);
}
void hotTouch(uint parity, uint worldTile) { hotList(parity, worldTile, kTileWarm); }
