// Touches the tiles that depend on changed texels: they are due in the front list.
#include "lib/dependents.glsl"
#include "lib/front_list.glsl"

// r-th dependent tile over seams. The switches serve the tests.
uint dependentTile(uint object, uint dependentStart, uint r) {
    uint tile = dependents[objects[object].dependentBase + dependentStart + r];
    return (push.switches & kSwitchWrongDependents) != 0u ? 0u : tile;
}
// Touches the tiles beside a tile, and over seams, that depend on its texels of `mask`.
void touchBeside(uint parity, uint row, uint object, uint local, uvec2 mask, uint bits) {
    uint worldTileBase = objects[object].worldTileBase;
    uint tilesX = objects[object].tilesX;
    uint tileY = divide(local, tilesX);
    uint tileX = local - tileY * tilesX;
    int tilesY = int(objects[object].height >> 3u);
    for (uint beside = dependentNeighbours(mask.x, mask.y); beside != 0u; beside &= beside - 1u) {
        uint other = besideTile(int(tilesX), tilesY, int(tileX), int(tileY), uint(findLSB(beside)));
        if (other != kNoneTexel) touchTile(parity, row, worldTileBase + other, bits);
    }
    if ((push.switches & kSwitchNoSeamWake) != 0u) return;
    uvec4 seam = tiles[(objects[object].tileBase + local) * 2u];
    if (((seam.x & mask.x) | (seam.y & mask.y)) == 0u) return;
    for (uint r = 0u; r < seam.w; ++r)
        touchTile(parity, row, worldTileBase + dependentTile(object, seam.z, r), bits);
}
// Texels of this mask of a tile changed between iterations: touches the tile and all tiles that
// depend on them.
void touchDependents(uint object, uint local, uvec2 mask) {
    touchTile(push.parity, push.row, objects[object].worldTileBase + local, kTileTouched);
    touchBeside(push.parity, push.row, object, local, mask, kTileTouched);
}
