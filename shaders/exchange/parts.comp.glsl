// Fire from part to part of one mesh, over gaps of a few centimetres: 64 of the tiles that `reduce`
// found a group. Whoever lights a texel does so at the exchange's tick, so order is of no account.
#version 450
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "lib/light_uses.glsl"
#define FW_USE_BURN_TILES readonly
#define FW_USE_REMOTE_TILES
#define FW_USE_MATERIALS readonly
#include "lib/buffers.glsl"
#include "lib/lists.glsl"
#include "lib/change.glsl"
#include "lib/light.glsl"

void lightFrom(uint object, uint tile, uint link, uint block) {
    uint width = objects[object].width;
    uint lane = partFrom(link, block);
    uint tilesX = objects[object].tilesX;
    uint from = (tile / tilesX * 8u + (lane >> 3u)) * width + tile % tilesX * 8u + (lane & 7u);
    uint to = link % kPartTexels;
    uvec2 a = texels[objects[object].texelBase + from];
    uvec2 b = texels[objects[object].texelBase + to];
    uint its = object * kMaterialsPerObject + ((a.y >> 16u) & (kMaterialsPerObject - 1u));
    uint others = object * kMaterialsPerObject + ((b.y >> 16u) & (kMaterialsPerObject - 1u));
    uint delay = partDelay(materials[others], decodePosition(b) - decodePosition(a));
    if ((materials[others].flags & 1u) != 0u &&
        partCrossed(state[objects[object].stateBase + from], materials[its].flameTicks, delay,
                    push.now))
        lightTexel(object, to, push.now, 0u);
}

void main() {
    uint count = counters[kRowBurn + push.burnParity].runCount;
    for (uint i = gl_GlobalInvocationID.x; i < count; i += gl_NumWorkGroups.x * 64u) {
        uint object = burnTiles[i].object;
        if ((remoteObjects[object].flags & kRemoteLive) == 0u) continue;
        uint tile = burnTiles[i].tile;
        uvec4 links = remoteTiles[objects[object].tileBase + tile].parts;
        for (uint block = 0u; block < 4u; ++block)
            if (links[block] != kNoneTexel) lightFrom(object, tile, links[block], block);
    }
}
