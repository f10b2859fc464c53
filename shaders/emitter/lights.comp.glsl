// Clusters burning tiles into clusters, and clusters into the strongest lights, which take over the
// power of all clusters: no watt is lost. One group; integer sums make the result independent of
// order.
#define FW_THREADS 128
#include "lib/compute.glsl"
#include "lib/view.glsl"
FW_READ(OBJECTS) FW_READ(MATERIALS) FW_READ(COUNTERS) FW_READ(BURN_TILES) FW_READ(APPEARANCES)
FW_READ_WRITE(CLUSTERS) FW_WRITE(DRAW_ARGS) FW_WRITE(LIGHTS) FW_PUSH(StepPush)
#include "emitter/clusters.glsl"

const uint kMost = 1024u;      // competing clusters
const uint kMostLights = 64u;
shared uint candidate[kMost];  // slots of clusters
shared float score[kMost];
shared uint candidates, stronger, bestScore, bestKey, bestAt;
shared uint lightPower[kMostLights], lightRelease[kMostLights];  // W: shining, and total
shared uint homelessPower, homelessRelease;  // W of tiles and clusters without a light
shared uint lightNear[kMostLights];          // 16 W: near enough to influence the light's position
shared int lightOffset[kMostLights * 3u];
shared uint lightArea[kMostLights];
shared uint lightSlot[kMostLights];
shared vec4 lightPlace[kMostLights];  // m, world; w: side of its cluster

void addTo(BurnTile tile, vec3 place, float side, uint level, uint release) {
    vec3 at = place / side;
    ivec3 cell = ivec3(floor(at));
    uint key = clusterKey(cell, side);
    uint weight = max(uint(tile.normalPower.w + 0.5), 1u);  // W
    for (uint i = 0u; i < kClusterProbes; ++i) {
        uint slot = (key + i) % kClusterSlots;
        uint there = atomicCompSwap(clusterOf(slot, 0u), 0u, key);
        if (there != 0u && there != key) continue;
        atomicAdd(clusterOf(slot, 1u), weight);
        if (level == 0u) {
            uvec3 offset = uvec3((at - vec3(cell)) * 64.0) * weight;
            for (uint k = 0u; k < 3u; ++k) atomicAdd(clusterOf(slot, 2u + k), offset[k]);
        }
        atomicAdd(clusterOf(slot, 5u), uint(tile.positionArea.w * 1e5) + 1u);
        atomicMax(clusterOf(slot, 6u), floatBitsToUint(side));
        // All tiles of a cluster write the same values.
        for (uint k = 0u; k < 3u; ++k) clusterOf(slot, 7u + k) = uint(cell[k]);
        clusterOf(slot, 10u) = level;
        atomicAdd(clusterOf(slot, 11u), release);
        return;
    }
    if (level != 0u) return;
    atomicAdd(homelessPower, weight);
    atomicAdd(homelessRelease, release);
}

uint keyOf(uint slot) { return clusterOf(slot, 0u); }
bool mayLight(uint slot) { return keyOf(slot) != 0u && clusterOf(slot, 10u) == 0u; }

// Orders clusters by power, to an eighth of it, and similar ones by key. 19 bits.
uint rankOf(uint slot) {
    return floatBitsToUint(float(clusterOf(slot, 1u))) >> 20u << 8u | keyOf(slot) >> 24u;
}

// The rank that fewer than kMost clusters exceed: thread order must not decide which compete.
uint rankOfMost(uint me) {
    uint least = 0u;
    for (uint bit = 1u << 18u; bit != 0u; bit >>= 1u) {
        if (me == 0u) stronger = 0u;
        barrier();
        for (uint slot = me; slot < kClusterSlots; slot += 128u)
            if (mayLight(slot) && rankOf(slot) >= (least | bit)) atomicAdd(stronger, 1u);
        barrier();
        if (stronger >= kMost) least |= bit;
        barrier();
    }
    return least;
}

// Weighted mean position of a cluster, m, world.
vec3 clusterPlace(uint slot) {
    float side = uintBitsToFloat(clusterOf(slot, 6u));
    vec3 within = vec3(clusterOf(slot, 2u), clusterOf(slot, 3u), clusterOf(slot, 4u)) /
                  (64.0 * float(clusterOf(slot, 1u)));
    ivec3 cell = ivec3(clusterOf(slot, 7u), clusterOf(slot, 8u), clusterOf(slot, 9u));
    return (vec3(cell) + within) * side;
}

// Adds a cluster's power, release and area, or a part of them, to a light.
void give(uint slot, uint light, uvec3 what) {
    atomicAdd(lightPower[light], what.x);
    atomicAdd(lightRelease[light], what.y);
    float side = lightPlace[light].w;
    vec3 d = clusterPlace(slot) - lightPlace[light].xyz;
    if (dot(d, d) > 36.0 * side * side) return;  // too far to influence the light's position
    uint weight = max(what.x >> 4u, 1u);
    ivec3 offset = ivec3(d / side * 64.0) * int(min(weight, 100000u));
    atomicAdd(lightNear[light], weight);
    atomicAdd(lightArea[light], what.z);
    for (uint k = 0u; k < 3u; ++k) atomicAdd(lightOffset[light * 3u + k], offset[k]);
}

void main() {
    uint me = gl_LocalInvocationID.x;
    uint count = counters[kRowBurn + push.burnParity].runCount;
    for (uint i = me; i < kClusterHeader + kClusterSlots * kClusterWords; i += 128u)
        clusters[i] = 0u;
    if (me == 0u) {
        candidates = stronger = homelessPower = homelessRelease = 0u;
        drawArgs[0] = 6u;
        for (uint i = 1u; i < kFlameOrder; ++i) drawArgs[i] = 0u;
    }
    syncBuffers();
    for (uint i = me; i < count; i += 128u) {
        BurnTile tile = burnTiles[i];
        float fade = flameFade(tile);
        uint release = max(uint(tile.normalPower.w + 0.5), 1u);
        tile.normalPower.w *= fade;
        tile.positionArea.w *= fade;
        float small = lightClusterSide(tile.object), large = flameClusterSide(tile.object);
        addTo(tile, lightPlaceOf(tile, small), small, 0u, release);
        addTo(tile, flamePlaceOf(tile, large), large, 1u, release);
    }
    syncBuffers();
    for (uint slot = me; slot < kClusterSlots; slot += 128u)
        if (mayLight(slot)) atomicAdd(stronger, 1u);
    barrier();
    bool tooMany = stronger > kMost;
    barrier();
    uint least = tooMany ? rankOfMost(me) + 1u : 0u;
    for (uint slot = me; slot < kClusterSlots; slot += 128u) {
        if (!mayLight(slot) || rankOf(slot) < least) continue;
        uint at = atomicAdd(candidates, 1u);
        if (at >= kMost) continue;
        candidate[at] = slot;
        score[at] = float(clusterOf(slot, 1u));
    }
    barrier();
    uint competing = min(candidates, kMost);
    uint wanted = min(view.lightCount, kMostLights);
    uint found = min(wanted, competing);

    for (uint light = 0u; light < found; ++light) {
        if (me == 0u) bestScore = bestKey = 0u;
        barrier();
        for (uint i = me; i < competing; i += 128u) atomicMax(bestScore, floatBitsToUint(score[i]));
        barrier();
        for (uint i = me; i < competing; i += 128u)
            if (floatBitsToUint(score[i]) == bestScore) atomicMax(bestKey, keyOf(candidate[i]));
        barrier();
        for (uint i = me; i < competing; i += 128u)
            if (floatBitsToUint(score[i]) == bestScore && keyOf(candidate[i]) == bestKey)
                bestAt = i;
        barrier();
        vec3 here = clusterPlace(candidate[bestAt]);
        float side = uintBitsToFloat(clusterOf(candidate[bestAt], 6u));
        for (uint i = me; i < competing; i += 128u) {
            if (i == bestAt) continue;
            // Reduces the score of neighbours, or one corner would get all lights.
            float d = length(clusterPlace(candidate[i]) - here) / (1.5 * side);
            score[i] *= clamp(d, 0.05, 1.0);
        }
        if (me == 0u) {
            lightSlot[light] = candidate[bestAt];
            lightPlace[light] = vec4(here, side);
            lightPower[light] = lightRelease[light] = lightNear[light] = lightArea[light] = 0u;
            for (uint k = 0u; k < 3u; ++k) lightOffset[light * 3u + k] = 0;
            score[bestAt] = 0.0;
        }
        barrier();
    }

    // Each cluster gives its power to the nearest light. The last light, which comes or goes, only
    // gets a share; the rest goes to the next nearest.
    float lastShare = found == wanted && found > 1u ? view.quads.z : 1.0;
    for (uint slot = me; slot < kClusterSlots; slot += 128u) {
        if (!mayLight(slot)) continue;
        uint nearest = 0u, next = 0u;
        float least = 1e30, leastNext = 1e30;
        for (uint light = 0u; light < found; ++light) {
            vec3 d = clusterPlace(slot) - lightPlace[light].xyz;
            float d2 = dot(d, d);
            bool last = light + 1u == found;
            nearest = d2 < least ? light : nearest;
            least = min(least, d2);
            next = d2 < leastNext && !last ? light : next;
            leastNext = last ? leastNext : min(leastNext, d2);
        }
        uvec3 all = uvec3(clusterOf(slot, 1u), clusterOf(slot, 11u), clusterOf(slot, 5u));
        float share = nearest + 1u == found ? lastShare : 1.0;
        uvec3 own = share < 1.0 ? min(uvec3(vec3(all) * share), all) : all;
        give(slot, nearest, own);
        if (share < 1.0) give(slot, next, all - own);
    }
    barrier();
    // Clears unused lights, too.
    for (uint light = me; light < uint(lights.length()); light += 128u) {
        BurnLight l = BurnLight(vec4(0.0), vec4(0.0), 0.0, 0u, 0.0, 0u);
        if (light < found) {
            float weight = float(lightNear[light]);
            float side = lightPlace[light].w;
            vec3 mean = vec3(float(lightOffset[light * 3u]), float(lightOffset[light * 3u + 1u]),
                             float(lightOffset[light * 3u + 2u])) *
                        (side / (64.0 * max(weight, 1.0)));
            uint key = keyOf(lightSlot[light]);
            float area = float(lightArea[light]) * 1e-5;
            uint homeless = light == 0u ? homelessPower : 0u;
            float power = float(lightPower[light] + homeless);
            float len = flameLength(min(weight * 16.0, power), area);
            vec3 at = lightPlace[light].xyz + mean + view.up.xyz * (0.25 * len);
            // Sines of incommensurate periods: no lookup, no pop. Light from distant fires is
            // steady.
            float t = view.ambientSky.w, p = 6.2832 * hashUnit(key);
            float flicker = 1.0 + min(weight * 16.0 / power, 1.0) *
                                      (0.10 * sin(11.3 * t + p) + 0.07 * sin(17.9 * t + 2.3 * p) +
                                       0.05 * sin(29.1 * t + 4.1 * p));
            l.positionRadius = vec4(at, clamp(0.4 * sqrt(area), 0.04, 0.5 * len + 0.04));
            // 30 % leaves as light and heat; luminance of the colour is 1.
            l.colorIntensity = vec4(vec3(1.717, 0.858, 0.292), power * (0.3 / 12.566) * flicker);
            l.power = power;
            l.release = float(lightRelease[light] + (light == 0u ? homelessRelease : 0u));
            l.id = key;
        }
        lights[light] = l;
    }
    // Requested quads, for the share of the available ones.
    for (uint slot = me; slot < kClusterSlots; slot += 128u) {
        if (!mayLight(slot)) continue;
        vec2 near = vec2(clusterOf(slot, 1u), float(clusterOf(slot, 5u)) * 1e-5);
        float large = clamp(4.0 * uintBitsToFloat(clusterOf(slot, 6u)), 0.5, 4.0);
        vec2 around = clusterFire(clusterKey(ivec3(floor(clusterPlace(slot) / large)), large));
        float quads = flameQuads(near.y, flameHalfWidth(flameLength(near, around), 0.0));
        atomicAdd(clusters[0], uint(min(quads, 4096.0) * 16.0));
    }
}
