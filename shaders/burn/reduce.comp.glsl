// Burning tiles: counts per object, a BurnTile for lights and flames, and the burn list without
// burnt-out tiles. 64 list entries per group. kSwitchDisplayOnly: BurnTiles only; after a load the
// first frame shows flames while counts stay those of the save.
#include "lib/compute.glsl"
FW_READ(OBJECTS) FW_READ(MATERIALS) FW_READ(TEXELS) FW_READ(NORMALS) FW_READ(STATE) FW_READ(HEAT)
FW_READ(TILE_FIRE) FW_READ_WRITE(TILE_STATE) FW_READ_WRITE(COUNTERS) FW_READ_WRITE(OBJECT_COUNTERS)
FW_WRITE(BURN_TILES) FW_PUSH(StepPush)
#include "lib/burn_list.glsl"
#include "lib/tile.glsl"
#include "lib/turn.glsl"
#include "lib/skin.glsl"

// One thread per tile without shared memory: a software device runs eight tiles at once.
void reduceTile(uint worldTile, uint parity) {
    TileRef tile = tileRef(worldTile);
    uint object = tile.object;
    uint texelBase = objects[object].texelBase;
    uint stateBase = objects[object].stateBase;
    uint width = objects[object].width;
    uint corner = texelOf(object, tile.local, 0u);
    uint count = 0u;
    uint age = 0u, anchor = 0u;
    uvec3 position = uvec3(0u);
    ivec3 normal = ivec3(0);
    float power = 0.0, whole = 0.0;
    bool shows = (push.switches & kSwitchDisplayOnly) != 0u;
    bool heats = (objects[object].flags & kObjectHeat) != 0u;
    uint heatBase = objects[object].heatBase;
    for (uint lane = 0u; tile.alive && lane < 64u; ++lane) {
        uint texel = corner + (lane >> 3u) * width + (lane & 7u);
        uint t = state[stateBase + texel];
        if (!isSource(t)) continue;
        uvec2 packedTexel = texels[texelBase + texel];
        uint material = object * kMaterialsPerObject + ((packedTexel.y >> 16u) & 7u);
        bool burns = flames(t, push.now, materials[material].flameTicks);
        bool nominal = true;
        if (heats) {
            uint phase = heat[heatBase + texel].y >> 30u;
            burns = t <= push.now && phase != kPhaseBurnt;
            // Thick fuel's power is its loss, once a heat step has run; thin fuel shows its mean.
            nominal = phase != kPhaseBurning ||
                      materials[material].burnTicks == materials[material].flameTicks;
        }
        if (!burns) continue;
        ++count;
        anchor = texel;
        age += min(push.now - t, 0xFFFFFFu) >> 2u;
        position += uvec3(packedTexel.x & 0xFFFFu, packedTexel.x >> 16u, packedTexel.y & 0xFFFFu);
        normal += decodeNormal(normals[texelBase + texel]);
        power += nominal ? materials[material].powerPerArea : 0.0;
        whole += materials[material].powerPerArea;
    }
    if (count == 0u) {
        if (!shows) atomicAnd(tileState[worldTile].flag, ~kTileBurning);
        return;
    }
    uint row = kRowBurn + (shows ? parity : parity ^ 1u), slot;
    if (shows) {
        slot = atomicAdd(counters[row].runCount, 1u);
    } else {
        slot = listSlot(row, 64u);
        burnLists[2u * slot + (parity ^ 1u)] = worldTile;
        atomicAdd(counters[row].runCount, 1u);
        atomicAdd(objectCounters[object].burning, count);
        atomicAdd(objectCounters[object].burningTiles, 1u);
    }
    FW_COVER(row, run, slot, 64u)
    float area = objects[object].tint.w;
    vec3 rest = objects[object].originQuantum.xyz +
                objects[object].originQuantum.w * vec3(position) / float(count);
    vec3 n = vec3(normal);
    // A tile of a skinned object moves with one of its texels.
    moveWithSkin(object, anchor, rest, n);
    vec3 world = turnNormal(objects[object].worldRow0.xyz, objects[object].worldRow1.xyz,
                            objects[object].worldRow2.xyz, n);
    float size = length(world);
    BurnTile b;
    b.positionArea = vec4(inWorld(object, rest), float(count) * area);
    float fire = heats ? tileFire[worldTile] : 0.0;
    power = shows && fire == 0.0 ? whole : power;  // before its first heat step
    power *= float(airStrength(objectCounters[object].air)) / float(kAirFull);
    b.normalPower = vec4(size > 0.0 ? world / size : vec3(0.0), power * area + fire);
    b.object = object;
    b.tile = tile.local;
    b.texels = count;
    b.age = (age / count) << 2u;
    burnTiles[slot] = b;
}

void reduceItem(uint i) {
    reduceTile(burnLists[2u * i + push.burnParity], push.burnParity);
}
void main() { FW_STRIDE(counters[kRowBurn + push.burnParity].listCount, reduceItem) }
