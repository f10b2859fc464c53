// Which flames of a body may reach each tile of its march, and in which slabs. Lists the tiles that
// some do. One thread per tile.
#include "lib/compute.glsl"
#include "shared/body.h"
#include "shared/volume_draw.h"
FW_READ_WRITE(VOLUME_RAYS) FW_READ_WRITE(VOLUME_WORK) FW_PUSH(MarchPush)

float wordAt(uint cell, uint word) {
    return uintBitsToFloat(rays[push.flames + cell * kBodyFlameWords + word]);
}

void main() {
    uint tile = gl_GlobalInvocationID.x, tiles = push.pixels / (kMarchTileSide * kMarchTileSide);
    if (tile >= tiles) return;
    uint row = quotient22(tile, push.tilesX);
    vec2 low = vec2(push.originX, push.originY) +
               vec2(tile - row * push.tilesX, row) * float(kMarchTileSide);
    vec2 high = low + float(kMarchTileSide);
    uint any = 0u;
    for (uint w = 0u; w < kBodyMaskWords; ++w) {
        uint mask = 0u;
        for (uint k = 0u; k < 32u; ++k) {
            uint cell = w * 32u + k;
            bool there = rays[push.flames + cell * kBodyFlameWords + 13u] != 0u;
            vec4 rect = vec4(wordAt(cell, 16u), wordAt(cell, 17u), wordAt(cell, 18u), wordAt(cell, 19u));
            bool meets = all(lessThan(rect.xy, high)) && all(greaterThan(rect.zw, low));
            mask |= there && meets ? 1u << k : 0u;
        }
        rays[push.tiles + (kMarchBodyMask + w) * tiles + tile] = mask;
        any |= mask;
    }
    if (any == 0u) return;
    rays[push.tiles + kMarchTileListed * tiles + tile] = 1u;
    uint place = atomicAdd(work[push.flame].groups, 1u);
    rays[push.tiles + kMarchTileList * tiles + place] = tile;
    atomicAdd(work[push.flame].vertices, 6u * push.slabs);
    work[push.flame].groupsY = work[push.flame].groupsZ = 1u;
    work[push.flame].instances = 1u;
}
