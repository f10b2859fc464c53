// Embers: where each of them comes down, and whether it lights what it lies on. A thread an object
// slot takes its sources in turn; embers are rare, so it looks through all objects for each, then
// through the tiles of one.
#version 450
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#define FW_USE_EXCHANGE_PUSH
#define FW_USE_OBJECTS readonly
#define FW_USE_TILES readonly
#define FW_USE_READERS readonly
#define FW_USE_STATE FW_READ_WRITE
#define FW_USE_TILE_STATE FW_READ_WRITE
#define FW_USE_LISTS FW_READ_WRITE
#define FW_USE_COUNTERS FW_READ_WRITE
#define FW_USE_OBJECT_COUNTERS FW_READ_WRITE
#define FW_USE_BURN_LISTS FW_READ_WRITE
#define FW_USE_PREDICT_LISTS FW_READ_WRITE
#define FW_USE_HOT_LISTS FW_READ_WRITE
#define FW_USE_PUBLISHED FW_READ_WRITE
#define FW_USE_REMOTE_OBJECTS
#define FW_USE_TEXELS readonly
#define FW_USE_REMOTE_TILES
#define FW_USE_SOURCES readonly
#define FW_USE_BLOCKERS
#define FW_USE_SHIELD
#define FW_USE_HEAT readonly
#define FW_USE_MATERIALS readonly
#include "lib/buffers.glsl"
#include "lib/lists.glsl"
#include "lib/change.glsl"
#include "lib/light.glsl"
#include "lib/shield.glsl"

uint landsOn(ivec3 at, uint axis, out int top) {
    uint found = kNoneTexel;
    top = kNoTop;
    for (uint slot = 0u; slot < push.count; ++slot) {
        if ((remoteObjects[slot].flags & kRemoteLive) == 0u) continue;
        int here = topBelow(remoteObjects[slot], at, axis);
        if (here > top) {
            top = here;
            found = slot;
        }
    }
    return found;
}

uint nearestLane(uint object, uint corner, ivec3 at, uint axis) {
    uint nearest = kNoneTexel;
    uint found = kNoneTexel;
    for (uint lane = 0u; lane < 64u; ++lane) {
        uint texel = corner + (lane >> 3u) * objects[object].width + (lane & 7u);
        if (state[objects[object].stateBase + texel] == kInert) continue;
        ivec3 p = decodePosition(texels[objects[object].texelBase + texel]);
        uint beside = besidePlace(remoteObjects[object], p, at, axis);
        if (beside < nearest) {
            nearest = beside;
            found = lane;
        }
    }
    return found;
}

void land(FireSource source) {
    ivec3 up = ivec3(push.upX, push.upY, push.upZ);
    uint axis = upAxis(up);
    ivec3 wind = ivec3(push.windX, push.windY, push.windZ) +
                 unpackWind(uint(remoteObjects[source.object].high.w));
    Ember ember = flyingEmber(source, source.ember, up, wind);
    int top;
    uint object = landsOn(ember.landing, axis, top);
    if (object == kNoneTexel) return;
    uint least = kMisses;
    uint tile = kNoneTexel;
    for (uint i = 0u; i < objects[object].tileCount; ++i) {
        uint miss = landingMiss(remoteObjects[object], remoteTiles[objects[object].tileBase + i],
                                ember.landing, top, axis);
        if (miss < least) {
            least = miss;
            tile = i;
        }
    }
    if (tile == kNoneTexel) return;
    ivec3 place = remotePlace(remoteObjects[object],
                              tileMiddle(remoteTiles[objects[object].tileBase + tile]));
    for (uint b = 0u; b < push.blockers; ++b)
        if (blockerCuts(blockers[b], alongFlame(source, up, 8), ember.landing) ||
            blockerCuts(blockers[b], ember.landing, place))
            return;
    if (push.shieldCell != 0u) {
        ShieldEnds ends = emberEnds(source, object, push.shieldCell);
        if (shieldCuts(ends, alongFlame(source, up, 8), ember.landing) ||
            shieldCuts(ends, ember.landing, place))
            return;
    }
    uint chance = bothChances(emberLights(ember.energy, remoteObjects[object].catches),
                              bothChances(push.chance, remoteObjects[source.object].chance));
    if (!drawn(hash32(source.ember + 7u), chance)) return;
    uint tilesX = objects[object].tilesX;
    uint corner = tile / tilesX * 8u * objects[object].width + tile % tilesX * 8u;
    uint lane = nearestLane(object, corner, ember.landing, axis);
    if (lane == kNoneTexel) return;
    uint lit = 0u;
    for (uint other = 0u; other < 64u; ++other) {
        if (!besideLane(lane, other)) continue;
        uint texel = corner + (other >> 3u) * objects[object].width + (other & 7u);
        if (lightTexel(object, texel, push.now, litBy(source.hops, source.object))) {
            lit = 1u;
            atomicExchange(objectCounters[object].spotTexel, texel);
        }
    }
    atomicAdd(objectCounters[object].spots, lit);
}

void main() {
    uint slot = gl_GlobalInvocationID.x;
    if (slot >= push.count) return;
    bool burns = (remoteObjects[slot].flags & kRemoteLive) != 0u && objectCounters[slot].burning != 0u;
    uint base = remoteObjects[slot].sourceBase;
    uint end = burns ? base + remoteObjects[slot].sourceCount : base;
    for (uint at = base; at < end; ++at)
        for (bool sent = sources[at].ember != 0u && sources[at].watts != 0u; sent; sent = false)
            land(sources[at]);
}
