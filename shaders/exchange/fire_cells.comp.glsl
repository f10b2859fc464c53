// Sums burning tiles into the fire sources of their objects, in any order. 64 of the tiles found by
// `reduce` per group.
#version 450
#extension GL_GOOGLE_include_directive : require
#include "lib/compute.glsl"
FW_READ(COUNTERS) FW_READ(OBJECTS) FW_READ(BURN_TILES) FW_READ(EXCHANGE_OBJECTS)
FW_READ(EXCHANGE_TILES) FW_READ_WRITE(SOURCES) FW_PUSH(ExchangePush)

void sumTile(uint i) {
    uint object = burnTiles[i].object;
    if ((exchangeObjects[object].flags & kExchangeLive) == 0u) return;
    uint texels = burnTiles[i].texels;
    ExchangeTile tile = exchangeTiles[objects[object].tileBase + burnTiles[i].tile];
    uint material = tileMaterial(tile);
    uint power = material < 4u ? exchangeObjects[object].power0[material & 3u]
                               : exchangeObjects[object].power1[material & 3u];
    uint source = exchangeObjects[object].sourceBase + tileCell(tile);
    ivec3 middle = tileMiddle(tile);
    atomicAdd(sources[source].power, texels * power);
    atomicAdd(sources[source].texels, texels);
    atomicAdd(sources[source].tiles, 1u);
    atomicAdd(sources[source].sumX, uint(middle.x) >> 2u);
    atomicAdd(sources[source].sumY, uint(middle.y) >> 2u);
    atomicAdd(sources[source].sumZ, uint(middle.z) >> 2u);
}

void main() {
    uint count = counters[kRowBurn + push.burnParity].runCount;
    for (uint i = gl_GlobalInvocationID.x; i < count; i += gl_NumWorkGroups.x * 64u) sumTile(i);
}
