// The hot list.
#include "lib/lists.glsl"
FW_READ_WRITE(HOT_LISTS)
const uint kHotPerGroup = 256u;  // of a group of `heat`
void hotAppend(uint parity, uint worldTile) {
    hotLists[2u * listSlot(kRowHot + parity, kHotPerGroup) + parity] = worldTile;
}
// Objects with heat only: the tile's temperature, water or flux changes from now on. It is updated
// every step (kTileWarm), or at intervals.
void hotList(uint parity, uint worldTile, uint warm) {
    uint old = atomicOr(tileState[worldTile].flag, kTileHot | warm);
    if ((old & kTileHot) == 0u) hotAppend(parity, worldTile);
}
void hotTouch(uint parity, uint worldTile) { hotList(parity, worldTile, kTileWarm); }
