// Predicted arrival ahead of the front, cosmetic: one ring further each frame, up to the object's
// horizon. One thread per gathered row, along which a ring moves as in `arrival`; predict_commit
// writes the times. Single hops, no pairs.
#include "lib/compute.glsl"
FW_READ(TEXELS) FW_READ(NORMALS) FW_READ(SLOWNESS) FW_READ(SCRATCH_QUADS) FW_READ(PREDICT)
FW_READ_WRITE(TILE_STATE) FW_READ_WRITE(COUNTERS) FW_WRITE(SCRATCH)
#include "lib/burn_material.glsl"
#include "lib/predict.glsl"
#include "lib/predict_touch.glsl"

struct Column {  // three texels, from below the row to above it
    uint time[3];
    uvec2 place[3];
};

Column columnAt(uint texel, uvec4 bases) {
    Column c;
    FW_UNROLL for (int i = 0; i < 3; ++i) {
        uint at = texel + uint(i - 1) * bases.w;
        c.time[i] = predict[bases.y + at];
        c.place[i] = uvec2(0u);
        if (i == 1 || hasTime(c.time[i])) c.place[i] = texels[bases.x + at];
    }
    return c;
}

uint hop(uint time, uvec2 place, ivec3 mine, FrontDrive p) {
    uint reach = time + (uint(linkCost((mine - decodePosition(place)) * 8, p)) >> 4u);
    return hasTime(time) ? reach : kNever;
}

void predictRow(uint work) {
    uvec4 item = scratchQuads[work];
    uint chosen = item.y & 0xFFu;
    if (chosen == 0u) return;
    uvec4 bases = objectBases(item.w);
    uint latest = push.now + objectTimes(item.w).z;
    bool shownAgain = (objectPlaces(item.w).w & kObjectShownAgain) != 0u;
    uint materialBase = item.w * kMaterialsPerObject;
    uint x = uint(findLSB(chosen));
    uint last = uint(findMSB(chosen));
    uint held = kNoneTexel;
    BurnMaterial m;
    Column left = columnAt(item.z + x - 1u, bases);
    Column middle = columnAt(item.z + x, bases);
    uint changed = 0u;
    uint spread = 0u;
    bool beyond = false;
    do {
        uint texel = item.z + x;
        Column right = columnAt(texel + 1u, bases);
        if ((chosen & (1u << x)) != 0u) {
            uint before = middle.time[1];
            uint now = state[bases.y + texel];
            if (now == kNever) {
                uint material = (middle.place[1].y >> 16u) & 7u;
                if (material != held) {
                    held = material;
                    m = burnMaterial(materialBase + held);
                }
                FrontDrive p = prepareFront(decodeNormal(normals[bases.x + texel]),
                                            slownessAt(bases.z, texel), m);
                ivec3 mine = decodePosition(middle.place[1]);
                now = min(hop(middle.time[0], middle.place[0], mine, p),
                          hop(middle.time[2], middle.place[2], mine, p));
                FW_UNROLL for (int i = 0; i < 3; ++i)
                    now = min(now, min(hop(left.time[i], left.place[i], mine, p),
                                       hop(right.time[i], right.place[i], mine, p)));
                if (now != kNever && now > latest) {
                    beyond = true;
                    now = kNever;
                }
            }
            if (now != before || shownAgain) {
                uint at = bases.y + texel;
                gradient[at] = packTimeNext(gradient[at], now);
                changed |= 1u << x;
                if (concernsOthers(before, now) || (shownAgain && hasTime(now))) spread |= 1u << x;
            }
        }
        left = middle;
        middle = right;
        ++x;
    } while (x <= last);
    uint y = divide(item.z, bases.w);
    uint x0 = item.z - y * bases.w;
    if (changed != 0u) scratch[work * 4u + 1u] = item.y | changed << 8u;
    uint worldTile = item.x >> 3u;
    if (spread != 0u) {
        touchAround(worldTile, rowMask(item.x & 7u, spread), item.w, x0 >> 3u, y >> 3u);
    } else if (beyond) {
        predictTouch(push.predictParity ^ 1u, worldTile);
    }
}

void main() { FW_STRIDE(counters[kRowPredict + push.predictParity].workCount, predictRow) }
