// `predict` for rim texels, whose ring is anywhere in the map. One thread per gathered texel.
#version 450
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#define FW_USE_MATERIAL_QUADS
#define FW_USE_TEXELS readonly
#define FW_USE_NORMALS readonly
#define FW_USE_SLOWNESS readonly
#define FW_USE_LINKS readonly
#define FW_USE_DEPENDENTS readonly
#define FW_USE_TILES readonly
#define FW_USE_TILE_STATE FW_READ_WRITE
#define FW_USE_COUNTERS FW_READ_WRITE
#define FW_USE_SCRATCH FW_READ_WRITE
#define FW_USE_PREDICT readonly
#define FW_USE_PREDICT_LISTS FW_READ_WRITE
#include "lib/predict_uses.glsl"
#include "lib/buffers.glsl"
#include "shared/front.h"
#include "lib/lists.glsl"
#include "lib/predict.glsl"
#include "lib/rim.glsl"
#include "lib/stride.glsl"

void predictTexel(uint rimWork) {
    uint packedTexel = scratch[rimItem(rimWork)];
    uint item = (packedTexel >> 3u) * 4u;
    uint object = scratch[item + 3u];
    uint texel = scratch[item + 2u] + (packedTexel & 7u);
    uint row = scratch[item];
    uint lane = (row & 7u) * 8u + (packedTexel & 7u);
    uint worldTile = row >> 3u;
    uvec4 bases = objectBases(object);
    uvec4 sizes = objectSizes(object);
    uint at = bases.y + texel;
    uint before = predict[at];
    uint now = state[at];
    bool beyond = false;
    if (now == kNever) {
        uvec2 me = texels[bases.x + texel];
        uint other[8] = rimRing(object, sizes.x + worldTile - objects[object].worldTileBase, lane);
        FrontDrive p = prepareFront(decodeNormal(normals[bases.x + texel]), slownessAt(bases.z, texel),
            burnMaterial(object * kMaterialsPerObject + ((me.y >> 16u) & 7u)));
        FW_UNROLL for (int k = 0; k < 8; ++k) {
            if (other[k] != kNoneTexel) {
                uint q = predict[bases.y + other[k]];
                if (hasTime(q)) {
                    ivec3 l = decodePosition(me) - decodePosition(texels[bases.x + other[k]]);
                    now = min(now, q + (uint(linkCost(l * 8, p)) >> 4u));
                }
            }
        }
        if (now != kNever && now > push.now + objects[object].horizon) {
            beyond = true;
            now = kNever;
        }
    }
    bool spread = false;
    uint y = divide(texel, bases.w);
    uint x = texel - y * bases.w;
    bool shownAgain = (objectPlaces(object).w & kObjectShownAgain) != 0u;
    if (now != before || shownAgain) {
        gradient[at] = packTimeNext(gradient[at], now);
        atomicOr(scratch[item + 1u], 0x100u << (packedTexel & 7u));
        spread = concernsOthers(before, now) || (shownAgain && hasTime(now));
    }
    if (spread) {
        uvec2 mask = lane < 32u ? uvec2(1u << lane, 0u) : uvec2(0u, 1u << (lane - 32u));
        touchAround(worldTile, mask, object, x >> 3u, y >> 3u);
    } else if (beyond) {
        predictTouch(push.predictParity ^ 1u, worldTile);
    }
}

void main() { FW_STRIDE(counters[kRowPredict + push.predictParity].rimCount, predictTexel) }
