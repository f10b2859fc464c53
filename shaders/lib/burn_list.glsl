// The burn list.
#include "lib/lists.glsl"
#ifdef FW_COHERENT_LISTS
FW_COHERENT(BURN_LISTS)
#else
FW_READ_WRITE(BURN_LISTS)
#endif
void burnAppend(uint parity, uint worldTile) {
    uint slot = listSlot(kRowBurn + parity, 64u);
    if (parity == 0u) burnA[slot] = worldTile;
    else burnB[slot] = worldTile;
}
