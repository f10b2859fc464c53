// Initial state of a new object: receptive and inert texels, tiles asleep. One group per tile.
#include "lib/compute.glsl"
FW_READ(OBJECTS) FW_READ(MATERIALS) FW_READ(TEXELS) FW_READ(SLOWNESS)
FW_READ_WRITE(TILE_STATE) FW_WRITE(STATE) FW_WRITE(PREDICT) FW_WRITE(GRADIENT)
FW_WRITE(HEAT) FW_WRITE(TILE_HEAT) FW_WRITE(TILE_FIRE) FW_PUSH(StepPush)
#include "lib/heat_material.glsl"
#include "lib/tile.glsl"
#include "lib/extension_reset.glsl"

void resetTile(uint local, uint lane) {
    uint object = push.object;
    uint texel = texelOf(object, local, lane);
    uvec2 packedTexel = texels[objects[object].texelBase + texel];
    uint slow = slownessAt(objects[object].slowBase, texel);
    uint material = object * kMaterialsPerObject + ((packedTexel.y >> 16u) & 7u);
    bool burns = canTexelBurn(packedTexel.y >> 16u, slow, materials[material].flags);
    uint at = objects[object].stateBase + texel;
    uint code = burns ? kNever : kInert;
    if ((objects[object].flags & kObjectHeat) != 0u) {
        HeatMaterial m = heatMaterial(material);
        HeatTexel x = unheatedTexel(m, burns);
        heat[objects[object].heatBase + texel] = packHeat(x);
        code = wetState(code, isBarrierByWater(x, m));
    }
    state[at] = code;
    predict[at] = code;
    gradient[at] = 0u;
    if (lane == 0u) {
        uint worldTile = objects[object].worldTileBase + local;
        // One by one: GPU-assisted validation does not check a store of a whole record.
        tileState[worldTile].wake = kNever;
        tileState[worldTile].flag = 0u;
        tileState[worldTile].lastChange = kNeverChanged;
        tileState[worldTile].object = object;
        tileHeat[worldTile] = TileHeat(0u, 0u);
        tileFire[worldTile] = 0.0;
    }
    if ((objects[object].flags & kObjectExtended) != 0u)
        extensionReset(object, texel, material, slow, burns);
}

void main() {
    uint tiles = objects[push.object].tileCount;
    for (uint local = gl_WorkGroupID.x; local < tiles; local += gl_NumWorkGroups.x)
        resetTile(local, gl_LocalInvocationID.x);
}
