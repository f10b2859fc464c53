// Sorts the front list into due tiles (run list) and waiting tiles (the other list); the rest
// leaves. With the dense switch all tiles of the wake groups run instead.
#version 450
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#define FW_USE_PUSH
#define FW_USE_OBJECTS readonly
#define FW_USE_TILE_STATE FW_READ_WRITE
#define FW_USE_LISTS FW_READ_WRITE
#define FW_USE_COUNTERS FW_READ_WRITE
#define FW_USE_RUN writeonly
#define FW_USE_MASKS writeonly
#define FW_USE_WAKE_GROUPS readonly
#define FW_USE_EXCHANGE_OBJECTS
#define FW_USE_OBJECT_COUNTERS readonly
#include "lib/buffers.glsl"
#include "shared/front.h"
#include "lib/lists.glsl"
#include "lib/stride.glsl"

void runTile(uint worldTile, TileRef tile, uint flag, uint why) {
    uint slot = atomicAdd(counters[push.row].runCount, 1u);
    if ((slot & 7u) == 0u) atomicMax(counters[push.row].runX, min(slot / 8u + 1u, kMaxGroups));
    if ((slot & 63u) == 0u) atomicMax(counters[push.row].workX, min(slot / 64u + 1u, kMaxGroups));
    if (slot == 0u) {
        counters[push.row].runY = 1u;
        counters[push.row].runZ = 1u;
        counters[push.row].workY = 1u;
        counters[push.row].workZ = 1u;
        counters[push.row].rimY = 1u;
        counters[push.row].rimZ = 1u;
    }
    uint tilesX = objects[tile.object].tilesX;
    uint tileY = divide(tile.local, tilesX);
    run[slot] = uvec4(worldTile, tile.object,
                      (tileY * objects[tile.object].width + tile.local - tileY * tilesX) * 8u + why,
                      objects[tile.object].tileBase + tile.local);
    masks[slot] = uvec4(0u);
    tileState[worldTile].wake = kNever;
    tileState[worldTile].flag = flag & ~(kTileListed | kTileTouched | kTileLitBeside | kTilePendingUnknown | kTileCorrected);
}

void schedule(uint worldTile, bool dense) {
    TileRef tile = tileRef(worldTile);
    uint flag = tileState[worldTile].flag;
    if (!tile.alive) {
        tileState[worldTile].flag = flag & ~(kTileListed | kTileTouched | kTileLitBeside);
        return;
    }
    if (dense && (objects[tile.object].flags & kObjectPublished) != 0u) return;
    uint shift = objects[tile.object].substepShift;
    bool wanted = runsInIteration(push.iteration, push.stepShift, shift);
    if (!wanted) {
        if ((flag & kTileListed) != 0u) frontAppend(push.parity ^ 1u, push.row + 1u, worldTile);
        return;
    }
    // Loops: devices without branches would also load under an `if`.
    for (bool plays = (push.switches & kSwitchPlayback) != 0u; plays; plays = false) {
        if (isPlayingBack(objectCounters[tile.object].playsUntil, push.now)) {  // due once it goes live
            if ((flag & kTileListed) != 0u) frontAppend(push.parity ^ 1u, push.row + 1u, worldTile);
            return;
        }
    }
    for (bool governed = (push.switches & kSwitchGoverned) != 0u; governed; governed = false) {
        if (stoppedAt(objectCounters[tile.object].stopTick, push.now)) {
            tileState[worldTile].flag = flag & ~(kTileListed | kTileTouched | kTileLitBeside);
            return;
        }
        if (holdsTile(flag, counters[kRowBurn + push.burnParity].listCount, push.maxTiles,
                      objectCounters[tile.object].burningTiles, exchangeObjects[tile.object].flags,
                      exchangeObjects[tile.object].maxTiles)) {
            if ((flag & kTileListed) != 0u) frontAppend(push.parity ^ 1u, push.row + 1u, worldTile);
            return;
        }
    }
    uint wake = tileState[worldTile].wake;
    uint end = iterationEnd(push.now, push.iteration, push.stepShift, shift);
    bool touched = dense || (flag & kTileTouched) != 0u;
    bool litBeside = (flag & kTileLitBeside) != 0u;
    if (touched || litBeside || wake <= end) {
        bool inTime = wake > end - windowTicks(push.stepShift, shift);
        uint why = litBeside ? kRunLitBeside : inTime ? kRunWoken : 0u;
        if (touched || (flag & kTilePendingUnknown) != 0u) why = 0u;
        runTile(worldTile, tile, flag, why);
    } else if (wake != kNever) {
        frontAppend(push.parity ^ 1u, push.row + 1u, worldTile);
    } else {
        tileState[worldTile].flag = flag & ~kTileListed;
    }
}

void scheduleItem(uint i) { schedule(push.parity == 0u ? listA[i] : listB[i], false); }

void main() {
    if ((push.switches & kSwitchDense) != 0u) {
        for (uint g = gl_WorkGroupID.x; g < push.count; g += gl_NumWorkGroups.x) {
            uint object = wakeGroups[g].x;
            uint local = wakeGroups[g].y + gl_LocalInvocationID.x;
            if (local < objects[object].tileCount)
                schedule(objects[object].worldTileBase + local, true);
        }
        return;
    }
    FW_STRIDE(counters[push.row].listCount, scheduleItem)
}
