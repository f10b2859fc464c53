// Hash grid of heat-release clusters: two sizes per object, keyed by place. Slots depend on
// thread order, contents do not.
#include "emitter/flame_laws.glsl"

float tileSide(uint object) { return 8.0 * sqrt(max(objects[object].tint.w, 1e-8)); }
// Side of the clusters that form lights, m: fixed per object, so nothing pops.
float lightClusterSide(uint object) {
    return clamp(exp2(floor(log2(2.5 * tileSide(object)) + 0.5)), 0.125, 2.0);
}
// Side of the clusters within which flames merge, m.
float flameClusterSide(uint object) { return clamp(4.0 * lightClusterSide(object), 0.5, 4.0); }

// A tile's cluster position: above the surface, as flames are. Light clusters are smaller, and
// lights stand further off.
vec3 lightPlaceOf(BurnTile tile, float side) {
    return tile.positionArea.xyz + tile.normalPower.xyz * (0.35 * side) +
           view.up.xyz * (0.15 * side);
}
vec3 flamePlaceOf(BurnTile tile, float side) {
    return tile.positionArea.xyz + tile.normalPower.xyz * (0.3 * tileSide(tile.object)) +
           view.up.xyz * (0.1 * side);
}
float flameFade(BurnTile tile) {
    return flameFade(materials[tile.object * kMaterialsPerObject], float(tile.age), 1.0);
}

uint clusterKey(ivec3 cell, float side) {
    uint h = hash32(uint(cell.x) * 73856093u ^ floatBitsToUint(side));
    h = hash32(h ^ uint(cell.y) * 19349663u);
    return max(hash32(h ^ uint(cell.z) * 83492791u), 1u);
}
#define clusterOf(slot, word) clusters[kClusterHeader + (slot) * kClusterWords + (word)]

const uint kClusterProbes = 24u;
const float kFlameCover = 3.8;  // overlapping quads over a burning area

// W and m^2 that flame in the cluster of this key.
vec2 clusterFire(uint key) {
    for (uint i = 0u; i < kClusterProbes; ++i) {
        uint slot = (key + i) % kClusterSlots, there = clusterOf(slot, 0u);
        if (there == key) return vec2(clusterOf(slot, 1u), float(clusterOf(slot, 5u)) * 1e-5);
        if (there == 0u) break;
    }
    return vec2(0.0);
}
// Flame height from a fire and its surroundings: neighbours draw each other up.
float flameLength(vec2 near, vec2 around) {
    float own = flameLength(near.x, near.y);
    return clamp(flameLength(around.x, around.y), own, 1.5 * own);
}
float flameHalfWidth(float len, float area) { return max(0.13 * len, 0.12 * sqrt(area)); }
// Number of tongues for an area.
float flameQuads(float area, float halfWidth) {
    return kFlameCover * area / (4.0 * halfWidth * halfWidth);
}
