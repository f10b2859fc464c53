// The front kernel over the gathered texels, one thread each: new ticks to scratch, changed texels
// to masks, the earliest pending arrival to the tile. Reads states, writes none: updates are Jacobi.
#version 450
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#define FW_USE_PUSH
#define FW_USE_OBJECTS readonly
#define FW_USE_MATERIALS readonly
#define FW_USE_TEXELS readonly
#define FW_USE_NORMALS readonly
#define FW_USE_SLOWNESS readonly
#define FW_USE_LINKS readonly
#define FW_USE_TILES readonly
#define FW_USE_STATE readonly
#define FW_USE_TILE_STATE FW_READ_WRITE
#define FW_USE_RUN readonly
#define FW_USE_SCRATCH FW_READ_WRITE
#define FW_USE_MASKS FW_READ_WRITE
#define FW_USE_COUNTERS readonly
#define FW_USE_OBJECT_COUNTERS FW_READ_WRITE
#include "lib/buffers.glsl"
#include "shared/front.h"

void arrive(uint work) {
    uint packedTexel = scratch[work * 2u];
    uint slot = packedTexel >> 6u;
    uint lane = packedTexel & 63u;
    uint worldTile = run[slot];
    uint object = tileState[worldTile].object;
    uint local = worldTile - objects[object].worldTileBase;
    uint shift = objects[object].substepShift;
    uint end = iterationEnd(push.now, push.iteration, push.stepShift, shift);
    uint floorTick = frontFloor(end - windowTicks(push.stepShift, shift), objects[object].window);
    uint width = objects[object].width;
    uint tilesX = objects[object].tilesX;
    uint tileY = divide(local, tilesX);
    uint texel = (tileY * 8u + (lane >> 3u)) * width + (local - tileY * tilesX) * 8u + (lane & 7u);
    uint stateBase = objects[object].stateBase;
    uint texelBase = objects[object].texelBase;
    uint t = state[stateBase + texel];
    uvec2 me = texels[texelBase + texel];

    FrontRing ring;
    uint other[8];
    uint present = 0xFFu;
    if (((me.y >> 16u) & kTexelRim) != 0u) {
        uvec4 rim = tiles[(objects[object].tileBase + local) * 2u + 1u];
        uint below = lane < 32u
                         ? uint(bitCount(rim.x & ((1u << lane) - 1u)))
                         : uint(bitCount(rim.x) + bitCount(rim.y & ((1u << (lane - 32u)) - 1u)));
        uint record = (objects[object].linkBase + rim.z + below) * 8u;
        present = 0u;
        for (uint k = 0u; k < 8u; ++k) {
            other[k] = links[record + k];
            if (other[k] != kNoneTexel) present |= 1u << k;
        }
    } else {
        for (uint k = 0u; k < 8u; ++k)
            other[k] = texel + uint(kFrontRingX[k]) + uint(kFrontRingY[k]) * width;
    }
    for (uint k = 0u; k < 8u; ++k)
        ring.tick[k] = (present & (1u << k)) != 0u ? state[stateBase + other[k]] : kInert;

    uint pending = kNever;
    uint late = 0u;
    uint decided = t;
    uint counts = frontSources(ring, present, end, pending);
    if (counts != 0u) {
        uint material = (me.y >> 16u) & 7u;
        uint materialBase = object * kMaterialsPerObject;
        uint ownBurn = materials[materialBase + material].burnTicks;
        ivec3 mine = decodePosition(me);
        for (uint k = 0u; k < 8u; ++k) {
            if ((counts & (1u << k)) == 0u) continue;
            uvec2 they = texels[texelBase + other[k]];
            uint theirs = (they.y >> 16u) & 7u;
            ring.link[k] = mine - decodePosition(they);
            ring.burn[k] = ownBurn;
            if (theirs != material) ring.burn[k] = materials[materialBase + theirs].burnTicks;
        }
        FrontPrep p = frontPrep(decodeNormal(normals[texelBase + texel]),
                                slownessAt(objects[object].slowBase, texel),
                                materials[materialBase + material]);
        uint candidate =
            frontArrival(ring, counts, p, materials[materialBase + material].windowMax, end,
                         floorTick, texel, pending);
        decided = frontDecide(t, candidate, end, floorTick, pending, late);
    }
    scratch[work * 2u] = stateBase + texel;
    scratch[work * 2u + 1u] = decided == t ? kNever : decided;
    if (decided != t) {
        uint bit = 1u << (lane & 31u);
        if (lane < 32u) {
            atomicOr(masks[slot].x, bit);
            if (isReceptive(t)) atomicOr(masks[slot].z, bit);
        } else {
            atomicOr(masks[slot].y, bit);
            if (isReceptive(t)) atomicOr(masks[slot].w, bit);
        }
        if (late != 0u) atomicAdd(objectCounters[object].lateClamps, 1u);
    } else if (pending != kNever && isReceptive(t)) {
        atomicMin(tileState[worldTile].wake, pending);
    }
}

void main() {
    uint count = counters[push.row].workCount;
    for (uint i = gl_GlobalInvocationID.x; i < count; i += gl_NumWorkGroups.x * 64u) arrive(i);
}
