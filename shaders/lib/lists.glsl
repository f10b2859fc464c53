// Appends to tile lists, and touching of tiles. Membership is a flag bit, so a tile is in a list at
// most once and the order does not matter.
#ifndef FW_LIB_LISTS_GLSL
#define FW_LIB_LISTS_GLSL

// Slot of a new entry in the list of `row`; `perGroup` entries make one indirect group.
uint listSlot(uint row, uint perGroup) {
    uint slot = atomicAdd(counters[row].listCount, 1u);
    if (slot % perGroup == 0u) {
        atomicMax(counters[row].listX, min(slot / perGroup + 1u, kMaxGroups));
        if (slot == 0u) {
            counters[row].listY = 1u;
            counters[row].listZ = 1u;
        }
    }
    return slot;
}

#ifdef FW_USE_LISTS
void frontAppend(uint parity, uint row, uint worldTile) {
    uint slot = listSlot(row, 64u);
    if (parity == 0u) listA[slot] = worldTile;
    else listB[slot] = worldTile;
}
// bits: set in addition to kTileListed.
void touchTile(uint parity, uint row, uint worldTile, uint bits) {
    uint old = atomicOr(tileState[worldTile].flag, kTileListed | bits);
    if ((old & kTileListed) == 0u) frontAppend(parity, row, worldTile);
}
#endif

#ifdef FW_USE_BURN_LISTS
void burnAppend(uint parity, uint worldTile) {
    uint slot = listSlot(kRowBurn + parity, 64u);
    if (parity == 0u) burnA[slot] = worldTile;
    else burnB[slot] = worldTile;
}
#endif

#ifdef FW_USE_HOT_LISTS
uint hotTile(uint parity, uint slot) { return parity == 0u ? hotLists[slot].x : hotLists[slot].y; }
void hotStore(uint parity, uint slot, uint worldTile) {
    if (parity == 0u) hotLists[slot].x = worldTile;
    else hotLists[slot].y = worldTile;
}
// First of `count` slots. A group of `heat` handles 256.
const uint kHotPerGroup = 256u;
uint hotSlots(uint parity, uint count) {
    uint row = kRowHot + parity;
    uint slot = atomicAdd(counters[row].listCount, count);
    if (count != 0u) {
        atomicMax(counters[row].listX, min((slot + count - 1u) / kHotPerGroup + 1u, kMaxGroups));
        if (slot == 0u) {
            counters[row].listY = 1u;
            counters[row].listZ = 1u;
        }
    }
    return slot;
}
void hotAppend(uint parity, uint worldTile) {
    hotStore(parity, listSlot(kRowHot + parity, kHotPerGroup), worldTile);
}
// Objects with heat only: the tile's temperature, water or flux changes from now on. It is updated
// every step (kTileWarm), or at intervals.
void hotList(uint parity, uint worldTile, uint warm) {
    uint old = atomicOr(tileState[worldTile].flag, kTileHot | warm);
    if ((old & kTileHot) == 0u) hotAppend(parity, worldTile);
}
void hotTouch(uint parity, uint worldTile) { hotList(parity, worldTile, kTileWarm); }
#endif

#ifdef FW_USE_PREDICT_LISTS
void predictAppend(uint parity, uint worldTile) {
    uint slot = listSlot(kRowPredict + parity, 8u);
    if (parity == 0u) predictA[slot] = worldTile;
    else predictB[slot] = worldTile;
}
void predictTouch(uint parity, uint worldTile) {
    uint bit = kTilePredict << parity;
    if ((atomicOr(tileState[worldTile].flag, bit) & bit) == 0u) predictAppend(parity, worldTile);
}
#endif

#if defined(FW_USE_BURN_LISTS) && defined(FW_USE_OBJECT_COUNTERS) && defined(FW_USE_TILE_STATE) && \
    (defined(FW_USE_PUSH) || defined(FW_USE_EXCHANGE_PUSH))
// end: end tick of the window in which a texel caught.
void nowBurns(uint object, uint worldTile, uint end) {
    atomicMax(objectCounters[object].lastIgnition, end);
    if ((atomicOr(tileState[worldTile].flag, kTileBurning) & kTileBurning) == 0u) {
        burnAppend(push.burnParity, worldTile);
        atomicAdd(objectCounters[object].burningTiles, 1u);
    }
}
void addEnergy(uint object, uint low, uint high) {
    uint before = atomicAdd(objectCounters[object].energyLow, low);
    atomicAdd(objectCounters[object].energyHigh, high + (before + low < low ? 1u : 0u));
}
#endif

#if defined(FW_USE_BURN_LISTS) && defined(FW_USE_PREDICT_LISTS) && defined(FW_USE_TILE_STATE)
#include "shared/burn_budget.h"
// Where burning tiles are limited, no tile is lit that is not on the burn list. A lighting pass
// runs twice: first it requests tiles, then it lights those that `grant` put on the list in
// between; all else stays unchanged. Requests use storage that is free meanwhile: the predict list
// that the frame's prediction will write, and, as marks per world tile, the burn list that the next
// reduction will write.
const uint kRequested = 0xFFFFFFF0u;  // exceeds any world tile
const uint kRequestFitsObject = 1u;       // + these: fits the object's limit, the world's
const uint kRequestAllocated = 2u;
bool isRequestPass() { return (push.switches & kSwitchRequests) != 0u; }
bool mayBurn(uint worldTile) {
    return (push.switches & kSwitchCapped) == 0u || (tileState[worldTile].flag & kTileBurning) != 0u;
}
void requestToBurn(uint worldTile) {
    uint had = push.burnParity == 0u ? atomicExchange(burnB[worldTile], kRequested)
                                     : atomicExchange(burnA[worldTile], kRequested);
    if (had == kRequested) return;
    uint slot = atomicAdd(counters[kRowBurn + (push.burnParity ^ 1u)].workCount, 1u);
    if (push.predictParity == 0u) predictB[slot] = worldTile;
    else predictA[slot] = worldTile;
}
#endif

#ifdef FW_USE_DEPENDENTS
// Local tile `k` of the eight beside tile (tileX, tileY), or kNoneTexel.
uint besideTile(int tilesX, int tilesY, int tileX, int tileY, uint k) {
    // kFrontRingX and Y packed in words: `k` is not constant, and devices index arrays slowly.
    int x = tileX + int((0x901Au >> (2u * k)) & 3u) - 1;
    int y = tileY + int((0x01A9u >> (2u * k)) & 3u) - 1;
    return x < 0 || y < 0 || x >= tilesX || y >= tilesY ? kNoneTexel : uint(y * tilesX + x);
}
// r-th dependent tile over seams. The switches serve the tests.
uint dependentTile(uint object, uint dependentStart, uint r) {
    uint reader = readers[objects[object].dependentBase + dependentStart + r];
    return (push.switches & kSwitchWrongDependents) != 0u ? 0u : reader;
}
#if defined(FW_USE_LISTS) && defined(FW_USE_TILES) && defined(FW_USE_OBJECTS)
// Touches the tiles beside a tile, and over seams, that depend on its texels of `mask`.
void touchBeside(uint parity, uint row, uint object, uint local, uvec2 mask, uint bits) {
    uint worldTileBase = objects[object].worldTileBase;
    uint tilesX = objects[object].tilesX;
    uint tileY = divide(local, tilesX);
    uint tileX = local - tileY * tilesX;
    int tilesY = int(objects[object].height >> 3u);
    for (uint beside = dependentNeighbours(mask.x, mask.y); beside != 0u; beside &= beside - 1u) {
        uint other = besideTile(int(tilesX), tilesY, int(tileX), int(tileY), uint(findLSB(beside)));
        if (other != kNoneTexel) touchTile(parity, row, worldTileBase + other, bits);
    }
    if ((push.switches & kSwitchNoSeamWake) != 0u) return;
    uvec4 seam = tiles[(objects[object].tileBase + local) * 2u];
    if (((seam.x & mask.x) | (seam.y & mask.y)) == 0u) return;
    for (uint r = 0u; r < seam.w; ++r)
        touchTile(parity, row, worldTileBase + dependentTile(object, seam.z, r), bits);
}
// Texels of this mask of a tile changed between iterations: touches the tile and all tiles that
// depend on them.
void touchDependents(uint object, uint local, uvec2 mask) {
    touchTile(push.parity, push.row, objects[object].worldTileBase + local, kTileTouched);
    touchBeside(push.parity, push.row, object, local, mask, kTileTouched);
}
#endif
#endif
#endif
