// The predict list.
#ifndef FW_LIB_PREDICT_LIST_GLSL
#define FW_LIB_PREDICT_LIST_GLSL
#include "lib/lists.glsl"
#ifdef FW_COHERENT_LISTS
FW_COHERENT(PREDICT_LISTS)
#else
FW_READ_WRITE(PREDICT_LISTS)
#endif
void predictAppend(uint parity, uint worldTile) {
    uint slot = listSlot(kRowPredict + parity, 8u);
    if (parity == 0u) predictA[slot] = worldTile;
    else predictB[slot] = worldTile;
}
void predictTouch(uint parity, uint worldTile) {
    uint bit = kTilePredict << parity;
    if ((atomicOr(tileState[worldTile].flag, bit) & bit) == 0u) predictAppend(parity, worldTile);
}
#endif
