// What burns, tile by tile: counts per object, a BurnTile for lights and flames, and the burn list
// without the tiles that burnt out. One group per tile of the list.
#version 450
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#define FW_USE_PUSH
#define FW_USE_OBJECTS readonly
#define FW_USE_MATERIALS readonly
#define FW_USE_TEXELS readonly
#define FW_USE_NORMALS readonly
#define FW_USE_STATE readonly
#define FW_USE_TILE_STATE FW_READ_WRITE
#define FW_USE_COUNTERS FW_READ_WRITE
#define FW_USE_OBJECT_COUNTERS FW_READ_WRITE
#define FW_USE_BURN_LISTS FW_READ_WRITE
#define FW_USE_BURN_TILES writeonly
#include "lib/buffers.glsl"
#include "shared/front.h"
#include "lib/lists.glsl"

shared uint sharedTexels, sharedPosition[3], sharedAge;
shared int sharedNormal[3];
shared uint sharedPower;  // W / 1024, at most 6e7 a texel

void main() {
    uint parity = push.burnParity;
    uint count = counters[kRowBurn + parity].listCount;
    uint lane = gl_LocalInvocationID.x;
    for (uint i = gl_WorkGroupID.x; i < count; i += gl_NumWorkGroups.x) {
        uint worldTile = parity == 0u ? burnA[i] : burnB[i];
        if (lane == 0u) {
            sharedTexels = 0u;
            sharedAge = 0u;
            sharedPower = 0u;
            for (int k = 0; k < 3; ++k) {
                sharedPosition[k] = 0u;
                sharedNormal[k] = 0;
            }
        }
        barrier();
        TileRef tile = tileRef(worldTile);
        if (tile.alive) {
            uint object = tile.object;
            uint texel = texelOf(object, tile.local, lane);
            uint t = state[objects[object].stateBase + texel];
            if (isSource(t)) {
                uvec2 packedTexel = texels[objects[object].texelBase + texel];
                uint material = object * kMaterialsPerObject + ((packedTexel.y >> 16u) & 7u);
                if (flames(t, push.now, materials[material].flameTicks)) {
                    uint age = push.now - t;
                    ivec3 n = decodeNormal(normals[objects[object].texelBase + texel]);
                    atomicAdd(sharedTexels, 1u);
                    atomicAdd(sharedAge, (age < 0xFFFFFFu ? age : 0xFFFFFFu) >> 2u);
                    atomicAdd(sharedPosition[0], packedTexel.x & 0xFFFFu);
                    atomicAdd(sharedPosition[1], packedTexel.x >> 16u);
                    atomicAdd(sharedPosition[2], packedTexel.y & 0xFFFFu);
                    atomicAdd(sharedNormal[0], n.x);
                    atomicAdd(sharedNormal[1], n.y);
                    atomicAdd(sharedNormal[2], n.z);
                    atomicAdd(sharedPower, uint(clamp(materials[material].powerPerArea *
                                                          objects[object].tint.w * 1024.0,
                                                      0.0, 6.0e7)));
                }
            }
        }
        barrier();
        if (lane == 0u) {
            if (sharedTexels == 0u) {
                atomicAnd(tileState[worldTile].flag, ~kTileBurning);
            } else {
                uint object = tile.object;
                uint slot = listSlot(kRowBurn + (parity ^ 1u), 1u);
                if (parity == 0u) burnB[slot] = worldTile;
                else burnA[slot] = worldTile;
                atomicAdd(counters[kRowBurn + (parity ^ 1u)].runCount, 1u);
                if ((slot & 63u) == 0u) {
                    atomicMax(counters[kRowBurn + (parity ^ 1u)].runX,
                              min(slot / 64u + 1u, kMaxGroups));
                    if (slot == 0u) {
                        counters[kRowBurn + (parity ^ 1u)].runY = 1u;
                        counters[kRowBurn + (parity ^ 1u)].runZ = 1u;
                    }
                }
                atomicAdd(objectCounters[object].burning, sharedTexels);
                atomicAdd(objectCounters[object].burningTiles, 1u);
                float inverse = 1.0 / float(sharedTexels);
                vec4 rest = vec4(objects[object].originQuantum.xyz +
                                     objects[object].originQuantum.w * inverse *
                                         vec3(sharedPosition[0], sharedPosition[1],
                                              sharedPosition[2]),
                                 1.0);
                vec3 n = vec3(sharedNormal[0], sharedNormal[1], sharedNormal[2]);
                vec3 world = vec3(dot(objects[object].worldRow0.xyz, n),
                                  dot(objects[object].worldRow1.xyz, n),
                                  dot(objects[object].worldRow2.xyz, n));
                float len = length(world);
                BurnTile b;
                b.positionArea = vec4(dot(objects[object].worldRow0, rest),
                                      dot(objects[object].worldRow1, rest),
                                      dot(objects[object].worldRow2, rest),
                                      float(sharedTexels) * objects[object].tint.w);
                b.normalPower = vec4(len > 0.0 ? world / len : vec3(0.0),
                                     float(sharedPower) / 1024.0);
                b.object = object;
                b.tile = tile.local;
                b.texels = sharedTexels;
                b.age = (sharedAge / sharedTexels) << 2u;
                burnTiles[slot] = b;
            }
        }
        barrier();
    }
}
