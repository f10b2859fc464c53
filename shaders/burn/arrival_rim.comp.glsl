// `arrival` for rim texels: their ring is anywhere in the map and found through links. One thread
// per gathered texel; runs after `arrival` and adds to its rows' words.
#include "lib/compute.glsl"
FW_READ(OBJECTS) FW_READ(TEXELS) FW_READ(NORMALS) FW_READ(SLOWNESS) FW_READ(LINK_QUADS)
FW_READ(TILES) FW_READ(STATE) FW_READ(RUN) FW_READ(SCRATCH_QUADS) FW_READ(COUNTERS)
FW_READ_WRITE(TILE_STATE) FW_READ_WRITE(SCRATCH) FW_READ_WRITE(MASK_WORDS) FW_WRITE(PENDING)
FW_PUSH(StepPush)
#include "lib/object_quads.glsl"
#include "lib/burn_material.glsl"
#include "lib/rim.glsl"

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
        FrontDrive p =
            prepareFront(decodeNormal(normals[bases.x + texel]), slownessAt(bases.z, texel), m);
        uint settledFrom = kNever;
        uint candidate = frontArrival(ring, counts, p, m.windowMax, end, floorTick, texel, false,
                                      pending, settledFrom);
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
