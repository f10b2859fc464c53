// Finds the texels of the predict list's tiles whose shown arrival may change, and packs them for
// `predict`. States that are no arrival (wet, put out, ...) are passed on here. What has an arrival
// already is gone over in about every eighth frame only. One thread per row.
#version 450
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#define FW_USE_PUSH
#define FW_USE_OBJECTS readonly
#define FW_USE_TILES readonly
#define FW_USE_STATE readonly
#define FW_USE_TILE_STATE FW_READ_WRITE
#define FW_USE_COUNTERS FW_READ_WRITE
#define FW_USE_SCRATCH writeonly
#define FW_USE_PREDICT FW_READ_WRITE
#define FW_USE_GRADIENT writeonly
#define FW_USE_PREDICT_LISTS FW_READ_WRITE
#include "lib/buffers.glsl"
#include "shared/front.h"
#include "lib/lists.glsl"

bool hasTime(uint p) { return p < kLiveEnd; }

void gatherRow(uint slot, uint row) {
    uint counterRow = kRowPredict + push.predictParity;
    uint worldTile = push.predictParity == 0u ? predictA[slot] : predictB[slot];
    if (row == 0u)
        atomicAnd(tileState[worldTile].flag, ~(kTilePredict << push.predictParity));
    TileRef tile = tileRef(worldTile);
    if (!tile.alive) return;
    int width = int(objects[tile.object].width);
    int height = int(objects[tile.object].height);
    uint tilesX = objects[tile.object].tilesX;
    uint tileY = divide(tile.local, tilesX);
    int base = int(objects[tile.object].stateBase);
    int x0 = int(tile.local - tileY * tilesX) * 8;
    int y = int(tileY * 8u + row);
    int at = base + y * width + x0;

    bool again = (hash32((push.now >> 7u) + worldTile) & 7u) == 0u;
    uint chosen = 0u;
    uint known = 0u; // unburnt, with a time
    uint open = 0u;  // unburnt: an arrival may be predicted
    uint own[10];
    for (int i = 0; i < 8; ++i) {
        uint t = state[at + i];
        uint p = predict[at + i];
        own[i + 1] = p;
        if (isSource(t)) {
            if (p != t) chosen |= 1u << uint(i);
        } else if (t == kNever) {
            open |= 1u << uint(i);
            if (hasTime(p)) known |= 1u << uint(i);
        } else if (p != t) {
            // What was put out keeps the look of the age it had: its gradient is that age.
            if (hasTime(p) && t != kWet) gradient[at + i] = p <= push.now ? push.now - p : 0u;
            predict[at + i] = t;
        }
    }
    if (again) chosen |= known;
    else if (known != 0u) predictTouch(push.predictParity ^ 1u, worldTile);
    uint fresh = open & ~known;
    if (fresh != 0u) {
        uvec4 statics = tiles[(objects[tile.object].tileBase + tile.local) * 2u + 1u];
        uint rim = ((row < 4u ? statics.x : statics.y) >> ((row & 3u) * 8u)) & 0xFFu;
        chosen |= fresh & rim;
        bool left = x0 > 0;
        bool right = x0 + 8 < width;
        // Bit i + 1: the row, or one beside it, has a time in column i.
        uint times = 0u;
        for (int i = 0; i < 10; ++i) {
            bool inside = (i > 0 || left) && (i < 9 || right);
            if (!inside) continue;
            uint p = i > 0 && i < 9 ? own[i] : predict[at + i - 1];
            bool any = hasTime(p);
            if (y > 0) any = hasTime(predict[at - width + i - 1]) || any;
            if (y + 1 < height) any = hasTime(predict[at + width + i - 1]) || any;
            if (any) times |= 1u << uint(i);
        }
        chosen |= fresh & (times | (times >> 1u) | (times >> 2u)) & 0xFFu;
    }
    uint count = uint(bitCount(chosen));
    if (count == 0u) return;
    uint first = atomicAdd(counters[counterRow].workCount, count);
    atomicMax(counters[counterRow].workX, min((first + count - 1u) / 64u + 1u, kMaxGroups));
    counters[counterRow].workY = 1u;
    counters[counterRow].workZ = 1u;
    for (int i = 0; i < 8; ++i) {
        if ((chosen & (1u << uint(i))) == 0u) continue;
        scratch[first * 2u] = slot * 64u + row * 8u + uint(i);
        ++first;
    }
}

void main() {
    uint count = counters[kRowPredict + push.predictParity].listCount;
    uint row = gl_LocalInvocationID.x & 7u;
    uint slot = gl_WorkGroupID.x * 8u + (gl_LocalInvocationID.x >> 3u);
    for (; slot < count; slot += gl_NumWorkGroups.x * 8u) gatherRow(slot, row);
}
