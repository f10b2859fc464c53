// Adds the marked tiles of an object that a view shows again to the predict list. One thread per
// tile.
#include "lib/compute.glsl"
FW_READ(OBJECTS) FW_READ_WRITE(TILE_STATE) FW_READ_WRITE(COUNTERS) FW_PUSH(StepPush)
#include "lib/predict_list.glsl"

void addTile(uint local) {
    uint worldTile = objects[push.object].worldTileBase + local;
    if ((tileState[worldTile].flag & kTileMarked) != 0u)
        predictTouch(push.predictParity, worldTile);
}
void main() { FW_STRIDE(objects[push.object].tileCount, addTile) }
