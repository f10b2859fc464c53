#include "lib/dependents.glsl"
#include "lib/object_quads.glsl"
#include "lib/predict_list.glsl"

// Lists the tile, and those that depend on its texels of `mask` (lane = y * 8 + x), for the next
// frame.
void touchAround(uint worldTile, uvec2 mask, uint object, uint tileX, uint tileY) {
    uint parity = push.predictParity ^ 1u;
    predictTouch(parity, worldTile);
    uvec4 places = objectPlaces(object);
    uvec4 sizes = objectSizes(object);
    for (uint beside = dependentNeighbours(mask.x, mask.y); beside != 0u; beside &= beside - 1u) {
        uint other = besideTile(int(sizes.z), int(sizes.y >> 3u), int(tileX), int(tileY),
                                uint(findLSB(beside)));
        if (other != kNoneTexel) predictTouch(parity, places.x + other);
    }
    uvec4 seam = tiles[(sizes.x + worldTile - places.x) * 2u];
    if (((seam.x & mask.x) | (seam.y & mask.y)) == 0u) return;
    for (uint r = 0u; r < seam.w; ++r)
        predictTouch(parity, places.x + dependents[places.z + seam.z + r]);
}
