// A wind or pose latch: touches the tiles that may change, which are listed or changed within the
// correction window. One group per 64 tiles of an object.
#include "lib/compute.glsl"
FW_READ(OBJECTS) FW_READ(WAKE_GROUPS) FW_READ_WRITE(TILE_STATE) FW_READ_WRITE(COUNTERS)
FW_PUSH(StepPush)
#include "lib/front_list.glsl"
#include "lib/predict_list.glsl"

void main() {
    if ((push.switches & kSwitchNoWindWake) != 0u) return;
    for (uint g = gl_WorkGroupID.x; g < push.count; g += gl_NumWorkGroups.x) {
        uint object = wakeGroups[g].x;
        uint local = wakeGroups[g].y + gl_LocalInvocationID.x;
        if (local >= objects[object].tileCount) continue;
        uint worldTile = objects[object].worldTileBase + local;
        uint flag = tileState[worldTile].flag;
        bool listed = (flag & kTileListed) != 0u;
        if (!latchReaches(listed, tileState[worldTile].lastChange, push.now,
                          objects[object].window))
            continue;
        touchTile(push.parity, push.row, worldTile, kTileTouched);
        predictTouch(push.predictParity, worldTile);
    }
}
