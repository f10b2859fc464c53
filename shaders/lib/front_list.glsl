// The front list.
#include "lib/lists.glsl"
FW_READ_WRITE(FRONT_LISTS)
void frontAppend(uint parity, uint row, uint worldTile) {
    frontLists[2u * listSlot(row, 64u) + parity] = worldTile;
}
// bits: set in addition to kTileListed.
void touchTile(uint parity, uint row, uint worldTile, uint bits) {
    uint old = atomicOr(tileState[worldTile].flag, kTileListed | bits);
    if ((old & kTileListed) == 0u) frontAppend(parity, row, worldTile);
}
