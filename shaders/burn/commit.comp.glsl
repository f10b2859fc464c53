// Writes the new ticks (one thread per gathered row), keeps tiles with pending arrivals listed, and
// touches the tiles that depend on a changed texel (one thread per due tile). The halves are
// independent: tiles are read, texels written.
#include "lib/compute.glsl"
FW_READ(OBJECTS) FW_READ(RUN) FW_READ(PENDING) FW_READ(SCRATCH_QUADS) FW_READ(MASKS)
FW_READ_WRITE(TILE_STATE) FW_READ_WRITE(COUNTERS) FW_READ_WRITE(OBJECT_COUNTERS) FW_WRITE(STATE)
FW_PUSH(StepPush)
#include "lib/hot_list.glsl"
#include "lib/burn_budget.glsl"
#include "lib/touch.glsl"
#include "lib/object_quads.glsl"

// Is the tile held back by the burn limit? It stays unchanged and is due again.
bool refused(uint slot) {
    return (masks[slot].z | masks[slot].w) != 0u && !mayBurn(run[slot].x);
}

void commitTile(uint slot) {
    uvec4 tile = run[slot];
    uint worldTile = tile.x;
    uvec4 mask = masks[slot];
    uint parity = push.parity ^ 1u;
    uint row = push.row + 1u;
    if ((mask.x | mask.y) == 0u) {
        if (tileState[worldTile].wake != kNever) touchTile(parity, row, worldTile, 0u);
        return;
    }
    for (bool capped = (push.switches & kSwitchCapped) != 0u; capped; capped = false)
        if (refused(slot)) {
            touchTile(parity, row, worldTile, kTileTouched);
            return;
        }
    uint object = tile.y;
    uint end = iterationEnd(push.now, push.iteration, push.stepShift, objects[object].substepShift);
    tileState[worldTile].lastChange = end;
    uint lit = uint(bitCount(mask.z) + bitCount(mask.w));
    uint touched =
        (tileState[worldTile].flag & kTileCorrected) != 0u ? kTileTouched : kTileLitBeside;
    uint bits = touched | (kTilePredict << push.predictParity);
    if (lit != 0u) {
        atomicAdd(objectCounters[object].ignited, lit);
        atomicMax(objectCounters[object].lastIgnition, end);
        bits |= kTileBurning;
        if ((objects[object].flags & kObjectHeat) != 0u) bits |= kTileHot | kTileWarm;
    }
    uint old = atomicOr(tileState[worldTile].flag, kTileListed | bits);
    if ((old & kTileListed) == 0u) frontAppend(parity, row, worldTile);
    if ((bits & ~old & kTileBurning) != 0u) {
        burnAppend(push.burnParity, worldTile);
        atomicAdd(objectCounters[object].burningTiles, 1u);
    }
    if ((bits & ~old & kTileHot) != 0u) hotAppend(push.hotParity, worldTile);
    if ((old & (kTilePredict << push.predictParity)) == 0u)
        predictAppend(push.predictParity, worldTile);

    touchBeside(parity, row, object, worldTile - objects[object].worldTileBase, mask.xy, touched);
}

void commitRow(uint work) {
    uvec4 item = scratchQuads[work];
    uint at = objectBases(item.w).y + item.z;
    uint changed = (item.y >> 8u) & 0xFFu;
    for (bool capped = (push.switches & kSwitchCapped) != 0u; capped; capped = false)
        if (refused(item.x >> 3u)) return;
    if (changed == 0u) return;
    uint late = uint(bitCount(item.y >> 16u));
    if (late != 0u) atomicAdd(objectCounters[item.w].lateClamps, late);
    do {
        uint i = at + uint(findLSB(changed));
        state[i] = pendingTick[i];
        changed &= changed - 1u;
    } while (changed != 0u);
}

void main() {
    uint rowCount = counters[push.row].workCount;
    uint tileCount = counters[push.row].runCount;
    uint i = gl_GlobalInvocationID.x;
    if (i >= max(rowCount, tileCount)) return;
    do {
        if (i < rowCount) commitRow(i);
        if (i < tileCount) commitTile(i);
        i += gl_NumWorkGroups.x * 64u;
    } while (i < max(rowCount, tileCount));
}
