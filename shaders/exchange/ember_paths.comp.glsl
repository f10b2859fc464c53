// Removes embers whose path an occluder box or the heat-occlusion grid crosses. One thread per
// object slot.
#version 450
#extension GL_GOOGLE_include_directive : require
#include "lib/compute.glsl"
FW_READ(OBJECTS) FW_READ(OBJECT_COUNTERS) FW_READ(EXCHANGE_OBJECTS) FW_READ(EXCHANGE_TILES)
FW_READ(HEAT_OCCLUDERS) FW_READ_WRITE(SOURCES) FW_PUSH(ExchangePush)
#include "lib/occlusion.glsl"
#include "lib/ember.glsl"

bool stopped(FireSource source) {
    Ember ember = emberFrom(source);
    uint tile;
    uint object = landsOn(ember.landing, upAxis(worldUp()), tile);
    if (tile == kNoneTexel) return true;
    ivec3 flame = alongFlame(source, worldUp(), 8);
    ivec3 place = toWorldMm(exchangeObjects[object],
                            tileMiddle(exchangeTiles[objects[object].tileBase + tile]));
    for (uint b = 0u; b < push.occluders; ++b)
        if (occluderBlocks(occluders[b], flame, ember.landing) ||
            occluderBlocks(occluders[b], ember.landing, place))
            return true;
    if (push.occlusionCell == 0u) return false;
    OcclusionEnds ends = emberOcclusionEnds(source, object, push.occlusionCell);
    return isOccluded(ends, flame, ember.landing) || isOccluded(ends, ember.landing, place);
}

void main() { FW_EACH_EMBER(if (stopped(sources[at])) sources[at].ember = 0u;) }
