// See front_tile.h. The maths is shared/front.h; here are only the loads, in the shader's order.
#include "gpu/cpu/front_tile.h"

#include <algorithm>
#include <bit>

namespace fw::gpu::cpu {

static_assert(kTexelReal == mesh::kTexelReal && kTexelRim == mesh::kTexelRim);

FrontTile runFrontTile(const FrontPlanes& planes, uint32_t tile, uint32_t windowEnd,
                       uint32_t floorTick, uint32_t* scratch) noexcept {
    FrontTile out;
    const int width = int(planes.width);
    int offsets[8];
    for (int k = 0; k < 8; ++k) offsets[k] = kFrontRingX[k] + kFrontRingY[k] * width;
    const mesh::TileStatic& statics = planes.tiles[tile];
    const uint64_t rimMask = uint64_t(statics.rimMaskHigh) << 32 | statics.rimMaskLow;
    const uint32_t corner =
        (tile / planes.tilesX) * 8u * planes.width + (tile % planes.tilesX) * 8u;

    FrontPrep prep{};  // kept while normal, slowness and material stay
    uint64_t prepKey = ~0ull;
    for (uint32_t lane = 0; lane < 64; ++lane) {
        const uint32_t texel = corner + (lane >> 3) * planes.width + (lane & 7);
        const uint32_t t = planes.state[texel];
        if (!frontEligible(t, floorTick)) continue;

        FrontRing ring;
        uint32_t other[8];
        uint32_t present = 0xFF;
        if (rimMask >> lane & 1) {
            const uint64_t below = rimMask & ((1ull << lane) - 1);
            const uint32_t* links =
                planes.links + size_t(statics.rimBase + uint32_t(std::popcount(below))) * 8;
            present = 0;
            for (uint32_t k = 0; k < 8; ++k) {
                other[k] = links[k];
                ring.tick[k] = kInert;
                if (other[k] == kNoneTexel) continue;
                present |= 1u << k;
                ring.tick[k] = planes.state[other[k]];
            }
        } else {
            for (int k = 0; k < 8; ++k) {
                other[k] = uint32_t(int(texel) + offsets[k]);
                ring.tick[k] = planes.state[other[k]];
            }
        }
        uint32_t pending = kNever;
        const uint32_t counts = frontSources(ring, present, windowEnd, pending);
        const uint32_t future = pending;  // a source of the ring begins then: may correct us too
        uint32_t decided = t;
        uint32_t late = 0;
        if (counts != 0) {
            const mesh::TexelPosition& me = planes.texels[texel];
            for (uint32_t k = 0; k < 8; ++k) {
                if ((counts >> k & 1) == 0) continue;
                const mesh::TexelPosition& they = planes.texels[other[k]];
                ring.link[k] = ivec3(int(me.x) - int(they.x), int(me.y) - int(they.y),
                                     int(me.z) - int(they.z));
                ring.burn[k] = planes.materials[they.materialFlags & 7u].burnTicks;
            }
            const uint32_t material = me.materialFlags & 7u;
            const uint32_t slow = planes.slowness[texel];
            const uint32_t normal = planes.normals[texel];
            const uint64_t key = uint64_t(normal) << 19 | slow << 3 | material;
            if (key != prepKey) {
                prep = frontPrep(decodeNormal(normal), slow, planes.materials[material]);
                prepKey = key;
            }
            const uint32_t candidate =
                frontArrival(ring, counts, prep, planes.materials[material].windowMax, windowEnd,
                             floorTick, texel, pending);
            decided = frontDecide(t, candidate, windowEnd, floorTick, pending, late);
        }
        if (decided != t) {
            scratch[lane] = decided;
            out.changed |= 1ull << lane;
            if (isReceptive(t)) out.lit |= 1ull << lane;
            out.late += late;
        } else {
            out.wake = std::min(out.wake, isReceptive(t) ? pending : future);
        }
    }
    return out;
}

}  // namespace fw::gpu::cpu
