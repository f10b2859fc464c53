// `predict` for rim texels, whose ring is anywhere in the map. One thread per gathered texel.
#include "lib/compute.glsl"
FW_READ(TEXELS) FW_READ(NORMALS) FW_READ(SLOWNESS) FW_READ(LINK_QUADS) FW_READ(PREDICT)
FW_READ_WRITE(TILE_STATE) FW_READ_WRITE(COUNTERS) FW_READ_WRITE(SCRATCH)
#include "lib/burn_material.glsl"
#include "lib/predict.glsl"
#include "lib/predict_touch.glsl"
#include "lib/rim.glsl"

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
        FrontDrive p =
            prepareFront(decodeNormal(normals[bases.x + texel]), slownessAt(bases.z, texel),
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
        touchAround(worldTile, laneMask(lane), object, x >> 3u, y >> 3u);
    } else if (beyond) {
        predictTouch(push.predictParity ^ 1u, worldTile);
    }
}

void main() { FW_STRIDE(counters[kRowPredict + push.predictParity].rimCount, predictTexel) }
