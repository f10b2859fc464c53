// Finds the texels of the predict list's tiles whose shown arrival may change, and lists their rows
// for `predict`, rim texels for `predict_rim`. States that are no arrival (wet, put out, ...) are
// passed on here. What has an arrival already is gone over in about every eighth frame only. One
// thread per row.
#version 450
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#define FW_USE_PUSH
#define FW_USE_OBJECT_QUADS
#define FW_USE_TILE_WORDS
#define FW_USE_STATE readonly
#define FW_USE_STATE_QUADS
#define FW_USE_TILE_STATE FW_READ_WRITE
#define FW_USE_COUNTERS FW_READ_WRITE
#define FW_USE_SCRATCH writeonly
#define FW_USE_SCRATCH_QUADS writeonly
#define FW_USE_PREDICT FW_READ_WRITE
#define FW_USE_PREDICT_QUADS
#define FW_USE_GRADIENT writeonly
#define FW_USE_PREDICT_LISTS FW_READ_WRITE
#include "lib/buffers.glsl"
#include "shared/front.h"
#include "lib/lists.glsl"

bool hasTime(uint p) { return p < kLiveEnd; }

// Bit i: column i - 1 of the row has a time.
uint timesOf(uint left, uvec4 a, uvec4 b, uint right) {
    uint p[10] = uint[10](left, a.x, a.y, a.z, a.w, b.x, b.y, b.z, b.w, right);
    uint times = 0u;
    FW_UNROLL for (int i = 0; i < 10; ++i) times |= hasTime(p[i]) ? 1u << uint(i) : 0u;
    return times;
}

void gatherRow(uint slot, uint row) {
    uint counterRow = kRowPredict + push.predictParity;
    uint worldTile = push.predictParity == 0u ? predictA[slot] : predictB[slot];
    if (row == 0u)
        atomicAnd(tileState[worldTile].flag, ~(kTilePredict << push.predictParity));
    uint object = tileState[worldTile].object;
    uvec4 bases = objectBases(object);
    uvec4 places = objectPlaces(object);
    uvec4 sizes = objectSizes(object);
    uint local = worldTile - places.x;
    if ((places.w & kObjectLive) == 0u || local >= sizes.w) return;
    uint tileY = divide(local, sizes.z);
    uint tileX = local - tileY * sizes.z;
    uint texel = (tileY * bases.w + tileX) * 8u + row * bases.w;
    uint at = bases.y + texel;
    uvec4 ta = stateQuads[at >> 2u];
    uvec4 tb = stateQuads[(at >> 2u) + 1u];
    uvec4 pa = predictQuads[at >> 2u];
    uvec4 pb = predictQuads[(at >> 2u) + 1u];
    uint t[8] = uint[8](ta.x, ta.y, ta.z, ta.w, tb.x, tb.y, tb.z, tb.w);
    uint p[8] = uint[8](pa.x, pa.y, pa.z, pa.w, pb.x, pb.y, pb.z, pb.w);
    uint lit = 0u;   // burns, and is not shown so
    uint open = 0u;  // unburnt: an arrival may be predicted
    uint known = 0u; // of these: with a time
    uint passed = 0u;
    FW_UNROLL for (int i = 0; i < 8; ++i) {
        uint bit = 1u << uint(i);
        bool differs = p[i] != t[i];
        lit |= isSource(t[i]) && differs ? bit : 0u;
        open |= t[i] == kNever ? bit : 0u;
        known |= t[i] == kNever && hasTime(p[i]) ? bit : 0u;
        passed |= !isSource(t[i]) && t[i] != kNever && differs ? bit : 0u;
    }
    for (; passed != 0u; passed &= passed - 1u) {
        uint i = at + uint(findLSB(passed));
        uint code = state[i];
        uint time = predict[i];
        // What was put out keeps the look of the age it had: its gradient is that age.
        if (hasTime(time) && code != kWet) gradient[i] = time <= push.now ? push.now - time : 0u;
        predict[i] = code;
    }
    uint chosen = lit;
    bool again = (hash32((push.now >> 7u) + worldTile) & 7u) == 0u;
    if (again) chosen |= known;
    else if (known != 0u) predictTouch(push.predictParity ^ 1u, worldTile);
    uint rim = 0u;
    uint fresh = open & ~known;
    if ((fresh | chosen) != 0u) rim = rimOfRow(sizes.x + local, row);
    if (fresh != 0u) {
        bool left = tileX > 0u;
        bool right = tileX + 1u < sizes.z;
        uint times = timesOf(left ? predict[at - 1u] : kNever, pa, pb,
                             right ? predict[at + 8u] : kNever);
        if (tileY > 0u || row > 0u) {
            uint down = at - bases.w;
            times |= timesOf(left ? predict[down - 1u] : kNever, predictQuads[down >> 2u],
                             predictQuads[(down >> 2u) + 1u], right ? predict[down + 8u] : kNever);
        }
        if (tileY * 8u + row + 1u < sizes.y) {
            uint up = at + bases.w;
            times |= timesOf(left ? predict[up - 1u] : kNever, predictQuads[up >> 2u],
                             predictQuads[(up >> 2u) + 1u], right ? predict[up + 8u] : kNever);
        }
        chosen |= fresh & (rim | times | (times >> 1u) | (times >> 2u)) & 0xFFu;
    }
    if (chosen == 0u) return;
    uint item = atomicAdd(counters[counterRow].workCount, 1u);
    if ((item & 63u) == 0u) {
        atomicMax(counters[counterRow].workX, min(item / 64u + 1u, kMaxGroups));
        counters[counterRow].workY = 1u;
        counters[counterRow].workZ = 1u;
    }
    scratchQuads[item] = uvec4(worldTile * 8u + row, chosen & ~rim, texel, object);
    rim &= chosen;
    if (rim == 0u) return;
    uint count = uint(bitCount(rim));
    uint first = atomicAdd(counters[counterRow].rimCount, count);
    atomicMax(counters[counterRow].rimX, min((first + count - 1u) / 64u + 1u, kMaxGroups));
    counters[counterRow].rimY = 1u;
    counters[counterRow].rimZ = 1u;
    do {
        scratch[rimItem(first)] = item * 8u + uint(findLSB(rim));
        ++first;
        rim &= rim - 1u;
    } while (rim != 0u);
}

void main() {
    uint count = counters[kRowPredict + push.predictParity].listCount;
    uint row = gl_LocalInvocationID.x & 7u;
    uint slot = gl_WorkGroupID.x * 8u + (gl_LocalInvocationID.x >> 3u);
    if (slot >= count) return;
    do {
        gatherRow(slot, row);
        slot += gl_NumWorkGroups.x * 8u;
    } while (slot < count);
}
