// Fire between parts of one mesh, over gaps of a few centimetres. 64 of the tiles found by `reduce`
// per group. All ignitions have the exchange's tick, so order does not matter.
#include "lib/light.glsl"
#include "lib/tile.glsl"
FW_READ(BURN_TILES) FW_READ(EXCHANGE_TILES) FW_READ(MATERIALS)

void lightFrom(uint object, uint tile, uint link, uint block) {
    uint from = texelOf(object, tile, partFrom(link, block));
    uint to = link % kPartTexels;
    uint others = materialOfTexel(object, to);
    ivec3 gap = decodePosition(texels[objects[object].texelBase + to]) -
                decodePosition(texels[objects[object].texelBase + from]);
    uint delay = partDelay(materials[others], gap);
    if ((materials[others].flags & 1u) != 0u &&
        partCrossed(state[objects[object].stateBase + from],
                    materials[materialOfTexel(object, from)].flameTicks, delay, push.now))
        lightTexel(object, to, push.now, 0u);
}

void main() {
    uint count = counters[kRowBurn + push.burnParity].runCount;
    for (uint i = gl_GlobalInvocationID.x; i < count; i += gl_NumWorkGroups.x * 64u) {
        uint object = burnTiles[i].object;
        if ((exchangeObjects[object].flags & kExchangeLive) == 0u) continue;
        uint tile = burnTiles[i].tile;
        uvec4 links = exchangeTiles[objects[object].tileBase + tile].parts;
        for (uint block = 0u; block < 4u; ++block)
            if (links[block] != kNoneTexel) lightFrom(object, tile, links[block], block);
    }
}
