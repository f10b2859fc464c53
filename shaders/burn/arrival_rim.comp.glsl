// `arrival` for rim texels: their ring is anywhere in the map and found through links. One thread
// per gathered texel; runs after `arrival` and adds to its rows' words.
#version 450
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#define FW_USE_PUSH
#define FW_USE_OBJECTS readonly
#define FW_USE_OBJECT_QUADS
#define FW_USE_MATERIAL_QUADS
#define FW_USE_TEXELS readonly
#define FW_USE_NORMALS readonly
#define FW_USE_SLOWNESS readonly
#define FW_USE_LINKS readonly
#define FW_USE_TILES readonly
#define FW_USE_STATE readonly
#define FW_USE_TILE_STATE FW_READ_WRITE
#define FW_USE_RUN readonly
#define FW_USE_SCRATCH FW_READ_WRITE
#define FW_USE_SCRATCH_QUADS readonly
#define FW_USE_MASK_WORDS
#define FW_USE_COUNTERS readonly
#define FW_USE_PENDING writeonly
#include "lib/buffers.glsl"
#include "shared/front.h"
#include "lib/rim.glsl"
#include "lib/stride.glsl"

void arrive(uint rimWork) {
    uint packedTexel = scratch[rimItem(rimWork)];
    uint work = packedTexel >> 3u;
    uint x = packedTexel & 7u;
    uvec4 item = scratchQuads[work];
    uint slot = item.x >> 3u;
    uint object = item.w;
    uint texel = item.z + x;
    uint lane = (item.x & 7u) * 8u + x;
    uvec4 tile = run[slot];
    uvec4 bases = objectBases(object);
    uvec4 times = objectTimes(object);
    uint end = iterationEnd(push.now, push.iteration, push.stepShift, times.y);
    uint floorTick = windowFloor(end - windowTicks(push.stepShift, times.y), times.x);
    uint t = state[bases.y + texel];
    uint other[8] = rimRing(object, tile.w, lane);
    FrontRing ring;
    uint present = 0u;
    FW_UNROLL for (int k = 0; k < 8; ++k) {
        ring.tick[k] = kInert;
        if (other[k] != kNoneTexel) {
            present |= 1u << uint(k);
            ring.tick[k] = state[bases.y + other[k]];
        }
    }
    uint pending = kNever;
    uint late = 0u;
    uint counts = countingSources(ring, present, end, pending);
    uint future = pending;  // a source of the ring begins then and may correct the result
    uvec2 me = texels[bases.x + texel];
    uint material = (me.y >> 16u) & 7u;
    uint materialBase = object * kMaterialsPerObject;
    BurnMaterial m = burnMaterial(materialBase + material);
    ivec3 mine = decodePosition(me);
    FW_UNROLL for (int k = 0; k < 8; ++k) {
        uvec2 they = uvec2(0u);
        ring.burn[k] = m.burnTicks;
        if ((counts & (1u << uint(k))) != 0u) {
            they = texels[bases.x + other[k]];
            uint theirs = (they.y >> 16u) & 7u;
            if (theirs != material) ring.burn[k] = burnTicksOf(materialBase + theirs);
        }
        ring.link[k] = mine - decodePosition(they);
    }
    uint decided = t;
    if (counts != 0u) {
        FrontDrive p = prepareFront(decodeNormal(normals[bases.x + texel]), slownessAt(bases.z, texel), m);
        uint settledFrom = kNever;
        uint candidate = frontArrival(ring, counts, p, m.windowMax, end, floorTick, texel, false, pending, settledFrom);
        decided = decideTick(t, candidate, end, floorTick, pending, late);
    }
    if (decided != t) {
        pendingTick[bases.y + texel] = decided;
        atomicOr(scratch[work * 4u + 1u], (0x100u | (late << 16u)) << x);
        uint word = slot * 4u + (lane >> 5u);
        atomicOr(maskWords[word], 1u << (lane & 31u));
        if (isReceptive(t)) atomicOr(maskWords[word + 2u], 1u << (lane & 31u));
        if (!isReceptive(t) || decided <= end - windowTicks(push.stepShift, times.y))
            atomicOr(tileState[tile.x].flag, kTileCorrected);
    } else {
        uint next = isReceptive(t) ? pending : future;
        if (next != kNever) atomicMin(tileState[tile.x].wake, next);
    }
}

void main() { FW_STRIDE(counters[push.row].rimCount, arrive) }
