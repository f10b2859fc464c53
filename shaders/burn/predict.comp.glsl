// Arrival ahead of the front, for looks: one ring of tiles further each frame, up to the object's
// horizon, and its gradient. Cosmetic: read and written in place, plain hops, no pairs.
#version 450
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#define FW_USE_PUSH
#define FW_USE_OBJECTS readonly
#define FW_USE_MATERIALS readonly
#define FW_USE_TEXELS readonly
#define FW_USE_NORMALS readonly
#define FW_USE_SLOWNESS readonly
#define FW_USE_LINKS readonly
#define FW_USE_READERS readonly
#define FW_USE_TILES readonly
#define FW_USE_STATE readonly
#define FW_USE_TILE_STATE FW_READ_WRITE
#define FW_USE_COUNTERS FW_READ_WRITE
#define FW_USE_PREDICT FW_READ_WRITE
#define FW_USE_GRADIENT writeonly
#define FW_USE_PREDICT_LISTS FW_READ_WRITE
#include "lib/buffers.glsl"
#include "shared/front.h"
#include "lib/lists.glsl"

shared uint sharedChanged[2];
shared uint sharedAgain;

bool hasTime(uint p) { return p < kLiveEnd; }

// P of one texel: a tick, or its state's code; `beyond`: it has an arrival, but past the horizon.
uint predicted(uint object, uint local, uint lane, uint texel, out bool beyond) {
    beyond = false;
    uint stateBase = objects[object].stateBase;
    uint t = state[stateBase + texel];
    if (t != kNever) return t;
    uint texelBase = objects[object].texelBase;
    uvec2 me = texels[texelBase + texel];
    uint width = objects[object].width;
    bool rim = ((me.y >> 16u) & kTexelRim) != 0u;
    uint record = 0u;
    if (rim) {
        uvec4 r = tiles[(objects[object].tileBase + local) * 2u + 1u];
        uint below = lane < 32u
                         ? uint(bitCount(r.x & ((1u << lane) - 1u)))
                         : uint(bitCount(r.x) + bitCount(r.y & ((1u << (lane - 32u)) - 1u)));
        record = (objects[object].linkBase + r.z + below) * 8u;
    }
    FrontPrep p;
    bool ready = false;
    uint best = kNever;
    for (uint k = 0u; k < 8u; ++k) {
        uint other = rim ? links[record + k]
                         : texel + uint(kFrontRingX[k]) + uint(kFrontRingY[k]) * width;
        if (other == kNoneTexel) continue;
        uint q = predict[stateBase + other];
        if (!hasTime(q)) continue;
        if (!ready) {
            p = frontPrep(decodeNormal(normals[texelBase + texel]),
                          slownessAt(objects[object].slowBase, texel),
                          materials[object * kMaterialsPerObject + ((me.y >> 16u) & 7u)]);
            ready = true;
        }
        ivec3 l = decodePosition(me) - decodePosition(texels[texelBase + other]);
        uint arrival = q + (uint(linkCost(l * 8, p)) >> 4u);
        best = min(best, arrival);
    }
    if (best == kNever) return kNever;
    if (best > push.now + objects[object].horizon) {
        beyond = true;
        return kNever;
    }
    return best;
}

// Difference quotient over +-2 texels along one axis, s per texel; 0 where neither side is known.
float slope(uint stateBase, uint texel, int at, int size, int stride, uint centre) {
    uint low = centre, high = centre;
    int span = 0;
    for (int d = 2; d >= 1; --d) {
        if (at - d < 0) continue;
        uint q = predict[stateBase + uint(int(texel) - d * stride)];
        if (hasTime(q)) {
            low = q;
            span += d;
            break;
        }
    }
    for (int d = 2; d >= 1; --d) {
        if (at + d >= size) continue;
        uint q = predict[stateBase + uint(int(texel) + d * stride)];
        if (hasTime(q)) {
            high = q;
            span += d;
            break;
        }
    }
    return span == 0 ? 0.0 : float(int(high - low)) / (float(span) * float(kTicksPerSecond));
}

void main() {
    uint parity = push.predictParity;
    uint lane = gl_LocalInvocationID.x;
    uint count = counters[kRowPredict + parity].listCount;
    for (uint i = gl_WorkGroupID.x; i < count; i += gl_NumWorkGroups.x) {
        uint worldTile = parity == 0u ? predictA[i] : predictB[i];
        if (lane == 0u) {
            sharedChanged[0] = 0u;
            sharedChanged[1] = 0u;
            sharedAgain = 0u;
            atomicAnd(tileState[worldTile].flag, ~(kTilePredict << parity));
        }
        barrier();
        TileRef tile = tileRef(worldTile);
        if (tile.alive) {
            uint object = tile.object;
            uint texel = texelOf(object, tile.local, lane);
            uint at = objects[object].stateBase + texel;
            bool beyond;
            uint before = predict[at];
            uint now = predicted(object, tile.local, lane, texel, beyond);
            if (beyond) atomicOr(sharedAgain, 1u);
            if (now != before) {
                predict[at] = now;
                // Small changes stay here: rings would chase rounding for ever.
                if (!hasTime(now) || !hasTime(before) || abs(int(now - before)) > 32)
                    atomicOr(sharedChanged[lane >> 5u], 1u << (lane & 31u));
            }
            if ((now == kOut || now == kOutWet) && hasTime(before)) {
                // What was put out keeps the look of the age it had: its gradient is that age.
                gradient[at] = before <= push.now ? push.now - before : 0u;
            }
            if (hasTime(now)) {
                uint width = objects[object].width;
                int x = int(texel % width);
                int y = int(texel / width);
                gradient[at] = packHalf2x16(
                    vec2(slope(objects[object].stateBase, texel, x, int(width), 1, now),
                         slope(objects[object].stateBase, texel, y, int(objects[object].height),
                               int(width), now)));
            }
        }
        barrier();
        uint low = sharedChanged[0];
        uint high = sharedChanged[1];
        if (tile.alive && (low | high) != 0u) {
            uint base = objects[tile.object].worldTileBase;
            if (lane < 8u) {
                uint other = besideTile(tile.object, tile.local, lane);
                if (other != kNoneTexel && (neighboursOf(low, high) & (1u << lane)) != 0u)
                    predictTouch(parity ^ 1u, base + other);
            } else if (lane == 8u) {
                predictTouch(parity ^ 1u, worldTile);
            }
            uvec4 seam = tiles[(objects[tile.object].tileBase + tile.local) * 2u];
            if (((seam.x & low) | (seam.y & high)) != 0u) {
                for (uint r = lane; r < seam.w; r += 64u)
                    predictTouch(parity ^ 1u, base + readerTile(tile.object, seam.z, r));
            }
        } else if (tile.alive && lane == 0u && sharedAgain != 0u) {
            predictTouch(parity ^ 1u, worldTile);
        }
        barrier();
    }
}
