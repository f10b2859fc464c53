// Tiles of a restored object: into the lists that contained them, which are stored in `wake`. One
// thread per tile.
#version 450
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#define FW_USE_PUSH
#define FW_USE_OBJECTS readonly
#define FW_USE_TILE_STATE FW_READ_WRITE
#define FW_USE_LISTS FW_READ_WRITE
#define FW_USE_COUNTERS FW_READ_WRITE
#define FW_USE_BURN_LISTS FW_READ_WRITE
#define FW_USE_HOT_LISTS FW_READ_WRITE
#define FW_USE_PREDICT_LISTS FW_READ_WRITE
#include "lib/buffers.glsl"
#include "lib/lists.glsl"
#include "lib/stride.glsl"

void restoreTile(uint local) {
    uint worldTile = objects[push.object].worldTileBase + local;
    uint kept = tileState[worldTile].wake;
    tileState[worldTile].wake = kNever;
    tileState[worldTile].flag = kTileMarked | (kept & ~kTileListed);
    if ((kept & kTileListed) != 0u) {
        touchTile(push.parity, push.row, worldTile, kTileTouched);
        predictTouch(push.predictParity, worldTile);
    }
    if ((kept & kTileBurning) != 0u) burnAppend(push.burnParity, worldTile);
    if ((kept & kTileHot) != 0u) hotAppend(push.hotParity, worldTile);
}
void main() { FW_STRIDE(objects[push.object].tileCount, restoreTile) }
