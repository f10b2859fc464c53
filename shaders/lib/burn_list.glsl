// The burn list.
#include "lib/lists.glsl"
FW_LISTS(BURN_LISTS)
void burnAppend(uint parity, uint worldTile) {
    burnLists[2u * listSlot(kRowBurn + parity, 64u) + parity] = worldTile;
}
