// Writes the new ticks of the due tiles, keeps tiles with pending arrivals on the list and touches
// whoever reads a changed texel: the tile, its grid neighbours, its readers over seams.
#version 450
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#define FW_USE_PUSH
#define FW_USE_OBJECTS readonly
#define FW_USE_TILES readonly
#define FW_USE_READERS readonly
#define FW_USE_STATE FW_READ_WRITE
#define FW_USE_TILE_STATE FW_READ_WRITE
#define FW_USE_LISTS FW_READ_WRITE
#define FW_USE_RUN readonly
#define FW_USE_SCRATCH readonly
#define FW_USE_MASKS readonly
#define FW_USE_COUNTERS FW_READ_WRITE
#define FW_USE_OBJECT_COUNTERS FW_READ_WRITE
#define FW_USE_BURN_LISTS FW_READ_WRITE
#define FW_USE_PREDICT_LISTS FW_READ_WRITE
#include "lib/buffers.glsl"
#include "shared/front.h"
#include "lib/lists.glsl"

void commitTile(uint slot, uint lane) {
    uint worldTile = run[slot];
    uvec4 mask = masks[slot];
    uint parity = push.parity ^ 1u;
    uint row = push.row + 1u;
    if ((mask.x | mask.y) == 0u) {
        if (lane == 0u && tileState[worldTile].wake != kNever)
            touchTile(parity, row, worldTile, 0u);
        return;
    }
    uint object = tileState[worldTile].object;
    uint worldTileBase = objects[object].worldTileBase;
    uint local = worldTile - worldTileBase;
    if (((lane < 32u ? mask.x : mask.y) & (1u << (lane & 31u))) != 0u)
        state[objects[object].stateBase + texelOf(object, local, lane)] =
            scratch[slot * 64u + lane];

    if (lane < 8u) {
        if ((neighboursOf(mask.x, mask.y) & (1u << lane)) != 0u) {
            uint other = besideTile(object, local, lane);
            if (other != kNoneTexel)
                touchTile(parity, row, worldTileBase + other, kTileTouched);
        }
    } else if (lane == 8u) {
        uint end = iterationEnd(push.now, push.iteration, push.stepShift,
                             objects[object].substepShift);
        tileState[worldTile].lastChange = end;
        uint lit = uint(bitCount(mask.z) + bitCount(mask.w));
        uint bits = kTileTouched | (kTilePredict << push.predictParity);
        if (lit != 0u) {
            atomicAdd(objectCounters[object].ignited, lit);
            atomicMax(objectCounters[object].lastIgnition, end);
            bits |= kTileBurning;
        }
        uint old = atomicOr(tileState[worldTile].flag, kTileListed | bits);
        if ((old & kTileListed) == 0u) frontAppend(parity, row, worldTile);
        if ((bits & ~old & kTileBurning) != 0u) burnAppend(push.burnParity, worldTile);
        if ((old & (kTilePredict << push.predictParity)) == 0u)
            predictAppend(push.predictParity, worldTile);
    }
    if ((push.switches & kSwitchNoSeamWake) != 0u) return;
    uvec4 seam = tiles[(objects[object].tileBase + local) * 2u];
    if (((seam.x & mask.x) | (seam.y & mask.y)) == 0u) return;
    for (uint r = lane; r < seam.w; r += 64u)
        touchTile(parity, row, worldTileBase + readerTile(object, seam.z, r), kTileTouched);
}

void main() {
    uint count = counters[push.row].runCount;
    for (uint slot = gl_WorkGroupID.x; slot < count; slot += gl_NumWorkGroups.x)
        commitTile(slot, gl_LocalInvocationID.x);
}
