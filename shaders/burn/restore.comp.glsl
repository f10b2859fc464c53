// Tiles of a restored object: into the lists that contained them, which are stored in `wake`. One
// thread per tile.
#include "lib/compute.glsl"
FW_READ(OBJECTS) FW_READ_WRITE(TILE_STATE) FW_READ_WRITE(COUNTERS) FW_PUSH(StepPush)
#include "lib/front_list.glsl"
#include "lib/burn_list.glsl"
#include "lib/hot_list.glsl"
#include "lib/predict_list.glsl"

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
