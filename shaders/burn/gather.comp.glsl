// Finds the texels of the due tiles that have something to answer to, and packs them densely for
// `arrival`: few texels of a tile do, and a software device pays for idle lanes. One thread per row
// of a tile, eight tiles a group.
#version 450
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#define FW_USE_PUSH
#define FW_USE_OBJECTS readonly
#define FW_USE_TILES readonly
#define FW_USE_STATE readonly
#define FW_USE_TILE_STATE FW_READ_WRITE
#define FW_USE_RUN readonly
#define FW_USE_SCRATCH writeonly
#define FW_USE_COUNTERS FW_READ_WRITE
#include "lib/buffers.glsl"
#include "shared/front.h"

void gatherRow(uint slot, uint row) {
    uint worldTile = run[slot];
    uint object = tileState[worldTile].object;
    uint local = worldTile - objects[object].worldTileBase;
    uint shift = objects[object].substepShift;
    uint end = iterationEnd(push.now, push.iteration, push.stepShift, shift);
    uint floorTick = frontFloor(end - windowTicks(push.stepShift, shift), objects[object].window);
    int width = int(objects[object].width);
    int height = int(objects[object].height);
    uint tilesX = objects[object].tilesX;
    uint tileY = divide(local, tilesX);
    int base = int(objects[object].stateBase);
    int x0 = int(local - tileY * tilesX) * 8;
    int y = int(tileY * 8u + row);
    int at = base + y * width + x0;

    uint eligible = 0u;
    uint own[10];  // the row with one texel more on either side
    for (int i = 0; i < 8; ++i) {
        own[i + 1] = state[at + i];
        if (frontEligible(own[i + 1], floorTick)) eligible |= 1u << uint(i);
    }
    if (eligible == 0u) return;
    uvec4 statics = tiles[(objects[object].tileBase + local) * 2u + 1u];
    uint rim = ((row < 4u ? statics.x : statics.y) >> ((row & 3u) * 8u)) & 0xFFu;
    // Of rim texels the neighbours are elsewhere: `arrival` looks.
    uint chosen = eligible & rim;
    uint inner = eligible & ~rim;
    uint pending = kNever;
    if (inner != 0u) {
        bool left = x0 > 0;
        bool right = x0 + 8 < width;
        own[0] = left ? state[at - 1] : kInert;
        own[9] = right ? state[at + 8] : kInert;
        uint below[10];
        uint above[10];
        for (int i = 0; i < 10; ++i) {
            bool inside = (i > 0 || left) && (i < 9 || right);
            below[i] = inside && y > 0 ? state[at - width + i - 1] : kInert;
            above[i] = inside && y + 1 < height ? state[at + width + i - 1] : kInert;
        }
        for (int i = 0; i < 8; ++i) {
            if ((inner & (1u << uint(i))) == 0u) continue;
            FrontRing ring;
            ring.tick[0] = own[i + 2];
            ring.tick[1] = above[i + 2];
            ring.tick[2] = above[i + 1];
            ring.tick[3] = above[i];
            ring.tick[4] = own[i];
            ring.tick[5] = below[i];
            ring.tick[6] = below[i + 1];
            ring.tick[7] = below[i + 2];
            uint later = kNever;
            if (frontSources(ring, 0xFFu, end, later) != 0u) chosen |= 1u << uint(i);
            else if (isReceptive(own[i + 1])) pending = min(pending, later);
        }
    }
    if (pending != kNever) atomicMin(tileState[worldTile].wake, pending);
    uint count = uint(bitCount(chosen));
    if (count == 0u) return;
    uint first = atomicAdd(counters[push.row].workCount, count);
    // Groups of 64: those that begin in [first, first + count).
    atomicMax(counters[push.row].workX, min((first + count - 1u) / 64u + 1u, kMaxGroups));
    uint lane = row * 8u;
    for (int i = 0; i < 8; ++i) {
        if ((chosen & (1u << uint(i))) == 0u) continue;
        scratch[first * 2u] = slot * 64u + lane + uint(i);
        ++first;
    }
}

void main() {
    uint count = counters[push.row].runCount;
    uint row = gl_LocalInvocationID.x & 7u;
    uint slot = gl_WorkGroupID.x * 8u + (gl_LocalInvocationID.x >> 3u);
    for (; slot < count; slot += gl_NumWorkGroups.x * 8u) gatherRow(slot, row);
}
