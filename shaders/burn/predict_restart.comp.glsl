// Adds the marked tiles of an object that a view shows again to the predict list. One thread per
// tile.
#version 450
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#define FW_USE_PUSH
#define FW_USE_OBJECTS readonly
#define FW_USE_TILE_STATE FW_READ_WRITE
#define FW_USE_COUNTERS FW_READ_WRITE
#define FW_USE_PREDICT_LISTS FW_READ_WRITE
#include "lib/buffers.glsl"
#include "lib/lists.glsl"
#include "lib/stride.glsl"

void addTile(uint local) {
    uint worldTile = objects[push.object].worldTileBase + local;
    if ((tileState[worldTile].flag & kTileMarked) != 0u) predictTouch(push.predictParity, worldTile);
}
void main() { FW_STRIDE(objects[push.object].tileCount, addTile) }
