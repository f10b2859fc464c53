// Cosmetic collapse: a tile's distance, over standing tiles, to a support (unburnt texels or the
// ground). A piece without a path to one falls to ash: its displayed age runs ahead. One thread per
// tile, in two phases: 0 computes from the neighbours' last values what 1 writes, so the order of
// threads does not matter. Distances converge by one tile per frame; cycles count up to the limit.
// Not part of the simulation, which has no gravity.
#include "lib/compute.glsl"
FW_READ(OBJECTS) FW_READ(MATERIALS) FW_READ(TEXELS) FW_READ(DEPENDENTS) FW_READ(TILES)
FW_READ(STATE) FW_READ_WRITE(TILE_STATE) FW_READ_WRITE(SCRATCH) FW_READ_WRITE(PREDICT)
FW_PUSH(StepPush)
#include "lib/object_quads.glsl"
#include "lib/tile.glsl"

const uint kFar = 1023u;      // largest distance
const uint kCheckEvery = 32u;  // frames, about, between scans of a tile's texels
const float kFallTime = 1.1;  // s from the first flake to the last

uint distanceOf(uint flag) { return flag >> kTileDistanceShift; }

// Sides 0..3: left, right, below, above. Texel i of the tile's side, or the one beside it in the
// next tile.
uint sideTexel(uint corner, uint width, uint side, uint i, bool beside) {
    uint off = beside ? 1u : 0u;
    if (side < 2u) return corner + i * width + (side == 0u ? 0u - off : 7u + off);
    return corner + i + (side == 2u ? 0u - off * width : (7u + off) * width);
}

// Facts of the texels: spent, on the ground, connected sides, material.
uint breakFacts(uint object, uvec4 bases, uvec4 sizes, uvec2 tile) {
    uint corner = (tile.y * bases.w + tile.x) * 8u;
    uvec4 up = materials[object * kMaterialsPerObject].upCeiling;
    uint facts = kTileSpent;
    for (uint lane = 0u; lane < 64u; ++lane) {
        uint texel = corner + (lane >> 3u) * bases.w + (lane & 7u);
        uint t = state[bases.y + texel];
        uvec2 place = texels[bases.x + texel];
        uint flags = place.y >> 16u;
        if ((flags & kTexelReal) == 0u) continue;
        if (!isSource(t) || t > push.now) facts &= ~kTileSpent;
        int rise = int(place.x & 0xFFFFu) * int(up.x) + int(place.x >> 16u) * int(up.y) +
                   int(place.y & 0xFFFFu) * int(up.z);
        if (rise <= int(up.w)) facts |= kTileGround;
        facts = (facts & ~(7u << kTileMaterialShift)) | ((flags & 7u) << kTileMaterialShift);
    }
    for (uint k = 0u; k < 32u; ++k) {
        uint side = k >> 3u;
        if (side == 0u && tile.x == 0u || side == 1u && tile.x + 1u >= sizes.z) continue;
        if (side == 2u && tile.y == 0u || side == 3u && (tile.y + 1u) * 8u >= sizes.y) continue;
        uint mine = texels[bases.x + sideTexel(corner, bases.w, side, k & 7u, false)].y;
        uint other = texels[bases.x + sideTexel(corner, bases.w, side, k & 7u, true)].y;
        if ((mine & other & (kTexelReal << 16u)) != 0u) facts |= 1u << (kTileSidesShift + side);
    }
    return facts;
}

// Distance that a neighbour offers.
uint offer(uint worldTile) {
    uint flag = tileState[worldTile].flag;
    // It burns soon, or is known.
    if (tileState[worldTile].lastChange == kNeverChanged) return kFar;
    return (flag & kTileSolid) != 0u ? distanceOf(flag) : kFar;
}

// Can the tile fall?
bool concerns(uint worldTile, TileRef ref) {
    return ref.alive && tileState[worldTile].lastChange != kNeverChanged &&
           (objectPlaces(ref.object).w & (kObjectNoHoles | kObjectExtended)) == 0u;
}

uint materialOf(uint object, uint flag) {
    return object * kMaterialsPerObject + ((flag >> kTileMaterialShift) & 7u);
}

// New flags of the tile.
uint supported(uint worldTile, TileRef ref) {
    uint last = tileState[worldTile].lastChange;
    uint flag = tileState[worldTile].flag;
    uint object = ref.object;
    uvec4 bases = objectBases(object);
    uvec4 places = objectPlaces(object);
    uvec4 sizes = objectSizes(object);
    uvec2 tile = uvec2(ref.local % sizes.z, ref.local / sizes.z);
    bool falls = (flag & kTileFalling) != 0u;
    // Eight tiles at once: the width of a software device.
    bool checks = !falls && hash32((worldTile >> 3u) + (push.now >> 7u)) % kCheckEvery == 0u;
    if (checks) flag = (flag & ~kTileFacts) | breakFacts(object, bases, sizes, tile);
    uint holeTicks = materials[materialOf(object, flag)].holeTicks;
    bool spent = (flag & kTileSpent) != 0u;
    bool solid = !falls && holeTicks != 0u && (!spent || push.now - last < holeTicks);
    if (holeTicks == 0u) solid = true;
    uint before = distanceOf(flag);
    uint found = kFar;
    if (!falls && (!spent || holeTicks == 0u || (solid && (flag & kTileGround) != 0u))) found = 0u;
    for (uint side = 0u; side < 4u && found != 0u; ++side) {
        if ((flag >> (kTileSidesShift + side) & 1u) == 0u) continue;
        uint other = side < 2u ? worldTile + (side == 0u ? 0u - 1u : 1u)
                               : worldTile + (side == 2u ? 0u - sizes.z : sizes.z);
        found = min(found, offer(other) + 1u);
    }
    uvec2 seam = tiles[(sizes.x + ref.local) * 2u].zw;
    for (uint r = 0u; r < seam.y && found != 0u; ++r)
        found = min(found, offer(places.x + dependents[places.z + seam.x + r]) + 1u);
    // A grown distance counts up fast; an existing path corrects it.
    if (found > before) found = min(max(found, before + 3u), kFar);
    uint limit = min(uint(4.0 * sqrt(float(sizes.w))) + 48u, kFar - 8u);
    if (spent && holeTicks != 0u && found >= limit) falls = true;
    flag &= ~(kTileSolid | kTileFalling | (kFar << kTileDistanceShift));
    return flag | (solid ? kTileSolid : 0u) | (falls ? kTileFalling : 0u) |
           (min(found, kFar) << kTileDistanceShift);
}

// Advances the displayed age of a falling piece.
void fall(uint worldTile, TileRef ref, uint flag) {
    float fallTicks = materials[materialOf(ref.object, flag)].baseColor.w;
    if ((flag & kTileFalling) == 0u ||
        float(push.now - tileState[worldTile].lastChange) > 1.2 * fallTicks)
        return;
    uvec4 bases = objectBases(ref.object);
    uvec4 sizes = objectSizes(ref.object);
    uvec2 tile = uvec2(ref.local % sizes.z, ref.local / sizes.z);
    // push.count: ticks since this tile's last update.
    uint step = uint(min(float(push.count) * (fallTicks / (kFallTime * 4096.0)), 1e8));
    uint corner = (tile.y * bases.w + tile.x) * 8u;
    for (uint lane = 0u; lane < 64u; ++lane) {
        uint at = bases.y + corner + (lane >> 3u) * bases.w + (lane & 7u);
        uint time = predict[at];
        if (time >= kLiveEnd || int(push.now - time) > int(1.2 * fallTicks)) continue;
        predict[at] = min(time - step, kLiveEnd - 1u);  // may be before the world began
    }
}

void main() {
    // push.object: first tile; push.iteration: number of tiles; push.row: phase.
    for (uint i = gl_GlobalInvocationID.x; i < push.iteration; i += gl_NumWorkGroups.x * 64u) {
        uint worldTile = push.object + i;
        TileRef ref = tileRef(worldTile);
        if (!concerns(worldTile, ref)) continue;
        if (push.row == 0u) {
            scratch[i] = supported(worldTile, ref);
        } else {
            tileState[worldTile].flag = scratch[i];
            fall(worldTile, ref, scratch[i]);
        }
    }
}
