// The front list.
#include "lib/lists.glsl"
FW_READ_WRITE(LISTS)
void frontAppend(uint parity, uint row, uint worldTile) {
    uint slot = listSlot(row, 64u);
    if (parity == 0u) listA[slot] = worldTile;
    else listB[slot] = worldTile;
}
// bits: set in addition to kTileListed.
void touchTile(uint parity, uint row, uint worldTile, uint bits) {
    uint old = atomicOr(tileState[worldTile].flag, kTileListed | bits);
    if ((old & kTileListed) == 0u) frontAppend(parity, row, worldTile);
}
