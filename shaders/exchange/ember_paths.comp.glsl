// Removes embers whose path an occluder box or the heat-occlusion grid crosses. One thread per
// object slot.
#version 450
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#define FW_USE_EXCHANGE_PUSH
#define FW_USE_OBJECTS readonly
#define FW_USE_OBJECT_COUNTERS readonly
#define FW_USE_EXCHANGE_OBJECTS
#define FW_USE_EXCHANGE_TILES
#define FW_USE_SOURCES FW_READ_WRITE
#define FW_USE_HEAT_OCCLUDERS
#include "lib/occlusion_uses.glsl"
#include "lib/buffers.glsl"
#include "lib/ember.glsl"
#include "lib/occlusion.glsl"

bool stopped(FireSource source) {
    Ember ember = emberFrom(source);
    uint tile;
    uint object = landsOn(ember.landing, upAxis(worldUp()), tile);
    if (tile == kNoneTexel) return true;
    ivec3 flame = alongFlame(source, worldUp(), 8);
    ivec3 place = toWorldMm(exchangeObjects[object], tileMiddle(exchangeTiles[objects[object].tileBase + tile]));
    for (uint b = 0u; b < push.occluders; ++b)
        if (occluderBlocks(occluders[b], flame, ember.landing) || occluderBlocks(occluders[b], ember.landing, place))
            return true;
    if (push.occlusionCell == 0u) return false;
    OcclusionEnds ends = emberOcclusionEnds(source, object, push.occlusionCell);
    return isOccluded(ends, flame, ember.landing) || isOccluded(ends, ember.landing, place);
}

void main() { FW_EACH_EMBER(if (stopped(sources[at])) sources[at].ember = 0u;) }
