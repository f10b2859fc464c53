// Landing of the remaining embers: whether each lights its target. A thread per object slot handles
// its sources; embers are rare.
#version 450
#extension GL_GOOGLE_include_directive : require
#include "lib/light.glsl"
FW_READ(EXCHANGE_TILES) FW_READ(SOURCES)
#include "lib/ember.glsl"
#include "lib/tile.glsl"

uint nearestLane(uint object, uint corner, ivec3 at, uint axis) {
    uint nearest = kNoneTexel;
    uint found = kNoneTexel;
    for (uint lane = 0u; lane < 64u; ++lane) {
        uint texel = corner + (lane >> 3u) * objects[object].width + (lane & 7u);
        if (state[objects[object].stateBase + texel] == kInert) continue;
        ivec3 p = decodePosition(texels[objects[object].texelBase + texel]);
        uint beside = besidePlace(exchangeObjects[object], p, at, axis);
        if (beside < nearest) {
            nearest = beside;
            found = lane;
        }
    }
    return found;
}

void land(FireSource source) {
    uint axis = upAxis(worldUp());
    Ember ember = emberFrom(source);
    uint tile;
    uint object = landsOn(ember.landing, axis, tile);
    if (tile == kNoneTexel) return;
    uint chance = multiplyChances(emberLights(ember.energy, exchangeObjects[object].catches),
                              multiplyChances(push.chance, exchangeObjects[source.object].chance));
    if (!drawn(hash32(source.ember + 7u), chance)) return;
    uint corner = texelOf(object, tile, 0u);
    uint lane = nearestLane(object, corner, ember.landing, axis);
    if (lane == kNoneTexel) return;
    uint lit = 0u;
    for (uint other = 0u; other < 64u; ++other) {
        if (!besideLane(lane, other)) continue;
        uint texel = corner + (other >> 3u) * objects[object].width + (other & 7u);
        if (lightTexel(object, texel, push.now, litBy(source.hops, source.object))) {
            lit = 1u;
            atomicMax(objectCounters[object].spotTexel, kSpotFresh | texel);
        }
    }
    atomicAdd(objectCounters[object].spots, lit);
}

void main() { FW_EACH_EMBER(land(sources[at]);) }
