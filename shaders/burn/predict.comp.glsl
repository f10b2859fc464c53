// Arrival ahead of the front, for looks: one ring further each frame, up to the object's horizon,
// and its gradient. One thread per gathered texel. Cosmetic: in place, plain hops, no pairs.
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
#define FW_USE_SCRATCH readonly
#define FW_USE_PREDICT FW_READ_WRITE
#define FW_USE_GRADIENT writeonly
#define FW_USE_PREDICT_LISTS FW_READ_WRITE
#include "lib/buffers.glsl"
#include "shared/front.h"
#include "lib/lists.glsl"

bool hasTime(uint p) { return p < kLiveEnd; }

// Difference quotient over +-2 texels along one axis, s per texel; 0 where neither side is known.
float slope(int centreAt, int at, int size, int stride, uint centre) {
    uint low = centre;
    uint high = centre;
    int before = 0;
    int after = 0;
    for (int d = 1; d <= 2; ++d) {
        uint q = at >= d ? predict[centreAt - d * stride] : kNever;
        uint r = at + d < size ? predict[centreAt + d * stride] : kNever;
        if (hasTime(q)) {
            low = q;
            before = d;
        }
        if (hasTime(r)) {
            high = r;
            after = d;
        }
    }
    int span = before + after;
    return span == 0 ? 0.0 : float(int(high - low)) / (float(span) * float(kTicksPerSecond));
}

void predictTexel(uint work) {
    uint packedTexel = scratch[work * 2u];
    uint slot = packedTexel >> 6u;
    uint lane = packedTexel & 63u;
    uint parity = push.predictParity;
    uint worldTile = parity == 0u ? predictA[slot] : predictB[slot];
    uint object = tileState[worldTile].object;
    uint local = worldTile - objects[object].worldTileBase;
    uint width = objects[object].width;
    uint tilesX = objects[object].tilesX;
    uint tileY = divide(local, tilesX);
    uint tileX = local - tileY * tilesX;
    uint x = tileX * 8u + (lane & 7u);
    uint y = tileY * 8u + (lane >> 3u);
    uint texel = y * width + x;
    uint stateBase = objects[object].stateBase;
    uint texelBase = objects[object].texelBase;
    uint at = stateBase + texel;
    uint before = predict[at];
    uint now = state[at];
    bool beyond = false;
    if (now == kNever) {
        uvec2 me = texels[texelBase + texel];
        bool rim = ((me.y >> 16u) & kTexelRim) != 0u;
        uint record = 0u;
        if (rim) {
            uvec4 r = tiles[(objects[object].tileBase + local) * 2u + 1u];
            uint below =
                lane < 32u
                    ? uint(bitCount(r.x & ((1u << lane) - 1u)))
                    : uint(bitCount(r.x) + bitCount(r.y & ((1u << (lane - 32u)) - 1u)));
            record = (objects[object].linkBase + r.z + below) * 8u;
        }
        FrontPrep p = frontPrep(decodeNormal(normals[texelBase + texel]),
                                slownessAt(objects[object].slowBase, texel),
                                materials[object * kMaterialsPerObject + ((me.y >> 16u) & 7u)]);
        for (uint k = 0u; k < 8u; ++k) {
            uint other = texel + uint(kFrontRingX[k]) + uint(kFrontRingY[k]) * width;
            if (rim) other = links[record + k];
            if (other == kNoneTexel) continue;
            uint q = predict[stateBase + other];
            if (!hasTime(q)) continue;
            ivec3 l = decodePosition(me) - decodePosition(texels[texelBase + other]);
            now = min(now, q + (uint(linkCost(l * 8, p)) >> 4u));
        }
        if (now != kNever && now > push.now + objects[object].horizon) {
            beyond = true;
            now = kNever;
        }
    }
    if (beyond) predictTouch(parity ^ 1u, worldTile);
    if (now == before) return;
    predict[at] = now;
    if (hasTime(now)) {
        float dx = slope(int(at), int(x), int(width), 1, now);
        float dy = slope(int(at), int(y), int(objects[object].height), int(width), now);
        gradient[at] = packHalf2x16(vec2(dx, dy));
    }
    // Small changes stay here: rings would chase rounding for ever. The farther ahead, the less
    // they matter.
    int ahead = max(int(now - push.now), 0);
    if (hasTime(now) && hasTime(before) && abs(int(now - before)) <= 64 + ahead / 8) return;
    predictTouch(parity ^ 1u, worldTile);
    uint base = objects[object].worldTileBase;
    uvec2 mask = lane < 32u ? uvec2(1u << lane, 0u) : uvec2(0u, 1u << (lane - 32u));
    uint beside = neighboursOf(mask.x, mask.y);
    for (uint k = 0u; k < 8u; ++k) {
        if ((beside & (1u << k)) == 0u) continue;
        uint other = besideTile(int(tilesX), int(objects[object].height >> 3u), int(tileX),
                                int(tileY), k);
        if (other != kNoneTexel) predictTouch(parity ^ 1u, base + other);
    }
    uvec4 seam = tiles[(objects[object].tileBase + local) * 2u];
    if (((seam.x & mask.x) | (seam.y & mask.y)) == 0u) return;
    for (uint r = 0u; r < seam.w; ++r)
        predictTouch(parity ^ 1u, base + readerTile(object, seam.z, r));
}

void main() {
    uint count = counters[kRowPredict + push.predictParity].workCount;
    for (uint i = gl_GlobalInvocationID.x; i < count; i += gl_NumWorkGroups.x * 64u)
        predictTexel(i);
}
