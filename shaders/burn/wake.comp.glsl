// A wind or pose latch: touches the tiles that may change, which are listed or changed within the
// correction window. One group per 64 tiles of an object.
#version 450
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#define FW_USE_PUSH
#define FW_USE_OBJECTS readonly
#define FW_USE_TILE_STATE FW_READ_WRITE
#define FW_USE_LISTS FW_READ_WRITE
#define FW_USE_COUNTERS FW_READ_WRITE
#define FW_USE_WAKE_GROUPS readonly
#define FW_USE_PREDICT_LISTS FW_READ_WRITE
#include "lib/buffers.glsl"
#include "shared/front.h"
#include "lib/lists.glsl"

void main() {
    if ((push.switches & kSwitchNoWindWake) != 0u) return;
    for (uint g = gl_WorkGroupID.x; g < push.count; g += gl_NumWorkGroups.x) {
        uint object = wakeGroups[g].x;
        uint local = wakeGroups[g].y + gl_LocalInvocationID.x;
        if (local >= objects[object].tileCount) continue;
        uint worldTile = objects[object].worldTileBase + local;
        uint flag = tileState[worldTile].flag;
        bool listed = (flag & kTileListed) != 0u;
        if (!latchReaches(listed, tileState[worldTile].lastChange, push.now, objects[object].window))
            continue;
        touchTile(push.parity, push.row, worldTile, kTileTouched);
        predictTouch(push.predictParity, worldTile);
    }
}
