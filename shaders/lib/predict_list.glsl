// The predict list.
#ifndef FW_LIB_PREDICT_LIST_GLSL
#define FW_LIB_PREDICT_LIST_GLSL
#include "lib/lists.glsl"
FW_LISTS(PREDICT_LISTS)
void predictAppend(uint parity, uint worldTile) {
    predictLists[2u * listSlot(kRowPredict + parity, 8u) + parity] = worldTile;
}
void predictTouch(uint parity, uint worldTile) {
    uint bit = kTilePredict << parity;
    if ((atomicOr(tileState[worldTile].flag, bit) & bit) == 0u) predictAppend(parity, worldTile);
}
#endif
