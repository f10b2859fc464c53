// Heat from sources to the tiles of the objects that they may heat, an eighth of the tiles per
// exchange. One group per receiver, one thread per tile. FW_HEAT_OCCLUSION: with a heat-occlusion
// grid; a variant, as a software device executes loop bodies once even without active lanes.
#version 450
#extension GL_GOOGLE_include_directive : require
#include "lib/compute.glsl"
FW_READ(OBJECTS) FW_READ(EXCHANGE_OBJECTS) FW_READ(EXCHANGE_TILES) FW_READ(SOURCES)
FW_READ(RECEIVERS) FW_READ(HEAT_OCCLUDERS) FW_READ_WRITE(COUNTERS) FW_READ_WRITE(OBJECT_COUNTERS)
FW_READ_WRITE(TILE_STATE) FW_READ_WRITE(TILE_HEAT) FW_PUSH(ExchangePush)
#include "lib/hot_list.glsl"
#ifdef FW_HEAT_OCCLUSION
#include "lib/occlusion.glsl"
#endif

bool blocked(FireSource s, ivec3 up, uint slot, ivec3 at, ivec3 normal) {
    ivec3 flame = alongFlame(s, up, 4);
    for (uint b = 0u; b < push.occluders; ++b)
        if (occluderBlocks(occluders[b], flame, at)) return true;
#ifdef FW_HEAT_OCCLUSION
    return isOccluded(flameOcclusionEnds(s, flame, slot, at, normal, push.occlusionCell), flame,
                      at);
#else
    return false;
#endif
}

void warmTile(uint slot, uint local) {
    ExchangeTile tile = exchangeTiles[objects[slot].tileBase + local];
    if (tile.texels == 0u) return;
    uint worldTile = objects[slot].worldTileBase + local;
    ivec3 up = ivec3(push.upX, push.upY, push.upZ);
    ivec3 at = toWorldMm(exchangeObjects[slot], tileMiddle(tile));
    ivec3 normal = turnToWorld(exchangeObjects[slot], decodeNormal(tile.normal));
    bool both = (exchangeObjects[slot].flags & kExchangeTwoSided) != 0u;
    uint count = receivers[slot * kReceiverWords + 1u];
    if (!mayCatch(objectCounters[slot].held, tileState[worldTile].flag)) count = 0u;
    uint flux = 0u, pilot = 0u, strongest = 0u, by = 0u;
    for (uint i = 0u; i < count; ++i) {
        uint entry = receivers[slot * kReceiverWords + 2u + i];
        FireSource s = sources[entry & 0xFFFFFFu];
        Received r = receivedFrom(s, push.flags, push.ambient, up, at, normal, both, entry >> 24u);
        if ((r.flux | r.pilot) == 0u || blocked(s, up, slot, at, normal)) continue;
        flux = min(flux + r.flux, kMaxFlux);
        pilot |= r.pilot;
        uint key = litBy(s.hops, s.object);
        if (r.flux > strongest || (r.flux == strongest && key > by)) {
            strongest = r.flux;
            by = key;
        }
    }
    if (workOfFlux(flux) == kWorkAlways) atomicMin(objectCounters[slot].playsUntil, push.now);
    if (flux != 0u && objectCounters[slot].litTick == 0u)
        atomicMax(objectCounters[slot].litBy, by);
    if (tileHeat[worldTile].flux == flux && tileHeat[worldTile].pilot == pilot) return;
    tileHeat[worldTile].flux = flux;
    tileHeat[worldTile].pilot = pilot;
    hotList(push.hotParity, worldTile, workOfFlux(flux) == kWorkAlways ? kTileWarm : 0u);
}

void main() {
    uint count = counters[kRowExchange].runCount;
    uint turn = (push.now / kExchangeTicks) % kExchangeRounds;
    for (uint g = gl_WorkGroupID.x; g < count; g += gl_NumWorkGroups.x) {
        uint slot = receivers[g * kReceiverWords];
        for (uint local = turn + gl_LocalInvocationID.x * kExchangeRounds;
             local < objects[slot].tileCount; local += 64u * kExchangeRounds)
            warmTile(slot, local);
    }
}
