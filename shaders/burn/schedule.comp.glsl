// Sorts the front list into due tiles (run list) and waiting tiles (the other list); the rest
// leaves. With the dense switch all tiles of the wake groups run instead.
#include "lib/compute.glsl"
FW_READ(OBJECTS) FW_READ(WAKE_GROUPS) FW_READ(EXCHANGE_OBJECTS) FW_READ(OBJECT_COUNTERS)
FW_READ_WRITE(TILE_STATE) FW_READ_WRITE(COUNTERS) FW_WRITE(RUN) FW_WRITE(MASKS) FW_PUSH(StepPush)
#include "lib/front_list.glsl"
#include "lib/tile.glsl"

void runTile(uint worldTile, TileRef tile, uint flag, uint why) {
    uint slot = atomicAdd(counters[push.row].runCount, 1u);
    FW_COVER(push.row, run, slot, 8u)
    FW_COVER(push.row, work, slot, 64u)
    if (slot == 0u) counters[push.row].rimY = counters[push.row].rimZ = 1u;
    uint tilesX = objects[tile.object].tilesX;
    uint tileY = divide(tile.local, tilesX);
    run[slot] = uvec4(worldTile, tile.object,
                      (tileY * objects[tile.object].width + tile.local - tileY * tilesX) * 8u + why,
                      objects[tile.object].tileBase + tile.local);
    masks[slot] = uvec4(0u);
    tileState[worldTile].wake = kNever;
    tileState[worldTile].flag = flag & ~(kTileListed | kTileTouched | kTileLitBeside |
                                         kTilePendingUnknown | kTileCorrected);
}

void schedule(uint worldTile, bool dense) {
    TileRef tile = tileRef(worldTile);
    uint flag = tileState[worldTile].flag;
    if (!tile.alive) {
        tileState[worldTile].flag = flag & ~(kTileListed | kTileTouched | kTileLitBeside);
        return;
    }
    if (dense && (objects[tile.object].flags & kObjectExtended) != 0u) return;
    uint shift = objects[tile.object].substepShift;
    bool waits = !runsInIteration(push.iteration, push.stepShift, shift);
    // Loops: devices without branches would also load under an `if`. A baked burn is due once it
    // goes live.
    for (bool plays = (push.switches & kSwitchPlayback) != 0u; plays; plays = false)
        waits = waits || isPlayingBack(objectCounters[tile.object].playsUntil, push.now);
    for (bool governed = !waits && (push.switches & kSwitchGoverned) != 0u; governed;
         governed = false) {
        if (stoppedAt(objectCounters[tile.object].stopTick, push.now)) {
            tileState[worldTile].flag = flag & ~(kTileListed | kTileTouched | kTileLitBeside);
            return;
        }
        waits = holdsTile(flag, counters[kRowBurn + push.burnParity].listCount, push.maxTiles,
                          objectCounters[tile.object].burningTiles,
                          exchangeObjects[tile.object].flags,
                          exchangeObjects[tile.object].maxTiles);
    }
    if (waits) {
        if ((flag & kTileListed) != 0u) frontAppend(push.parity ^ 1u, push.row + 1u, worldTile);
        return;
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

void scheduleItem(uint i) { schedule(frontLists[2u * i + push.parity], false); }

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
