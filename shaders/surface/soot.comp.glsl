// Soot that flames leave on surfaces above them, stored in the low byte of each texel's gradient;
// 255: matt black. It grows towards the current fires' soot and never fades. One thread per tile
// row; a part of all tiles each frame, round-robin. Cosmetic.
#include "lib/compute.glsl"
#include "lib/view.glsl"
FW_READ(OBJECTS) FW_READ(TEXELS) FW_READ(PREDICT) FW_READ(LIGHTS) FW_READ_WRITE(TILE_STATE)
FW_READ_WRITE(GRADIENT) FW_PUSH(StepPush)
#include "lib/tile.glsl"
#include "lib/skin.glsl"
#include "surface/plume.glsl"

const uint kUnseen = 3u;  // invisible amount of soot
const float kSootPerSecond = 2.0;  // simulated: slower than a tongue licks, faster than it burns

void sootRow(uint i, uint row) {
    uint worldTile = push.object + i;
    TileRef tile = tileRef(worldTile);
    if (!tile.alive) return;
    uint object = tile.object;
    uint first = texelOf(object, tile.local, row * 8u);
    uint texelAt = objects[object].texelBase + first, at = objects[object].stateBase + first;
    uint anchor = 0u;  // the middle may be outside its chart
    uvec2 texel = uvec2(0u);
    for (uint x = 0u; x < 8u && (texel.y & (kTexelReal << 16u)) == 0u; ++x) {
        anchor = (x * 3u + 4u) & 7u;
        texel = texels[texelAt + anchor];
    }
    if ((texel.y & (kTexelReal << 16u)) == 0u) return;
    vec3 rest = restOf(object, texel), moved = rest, normal = vec3(0.0);
    moveWithSkin(object, first + anchor, moved, normal);
    vec3 shift = moved - rest, middle = inWorld(object, moved);
    float reach = 9.0 * sqrt(max(objects[object].tint.w, 0.0));  // m
    uint near = 0u;
    uint count = min(view.lightCount, kSurfaceLights);
    for (uint i = 0u; i < count && lights[i].power > 0.0; ++i)
        near |=
            plumeNear(lights[i].positionRadius.xyz - middle, lights[i].power, view.up.xyz, reach)
                ? 1u << i
                : 0u;
    uint most =
        uint(min(255.0 * kSootPerSecond / float(kTicksPerSecond) * float(push.count), 255.0));
    bool marks = false;
    for (uint x = 0u; near != 0u && x < 8u; ++x) {
        uint t = predict[at + x];
        // The word has another meaning then.
        if (t == kInert || t == kOut || t == kOutWet) continue;
        vec3 place = inWorld(object, restOf(object, texels[texelAt + x]) + shift);
        float soot = 0.0;
        for (uint bits = near; bits != 0u; bits &= bits - 1u) {
            uint i = uint(findLSB(bits));
            soot += plumeSoot(lights[i].positionRadius.xyz - place, lights[i].power, view.up.xyz);
        }
        uint word = gradient[at + x];
        uint stored = word & 0xFFu, wanted = uint(255.0 * min(soot, 1.0));
        marks = marks || (wanted > stored && wanted > kUnseen);
        if (wanted > stored)
            gradient[at + x] = (word & ~0xFFu) | min(wanted, stored + max(most, 1u));
    }
    if (marks) atomicOr(tileState[worldTile].flag, kTileMarked);
}

// push.object: first tile; push.iteration: number of tiles.
void main() { FW_STRIDE_ROWS(push.iteration, sootRow) }
