// See tile.h. The maths is shared/front.h; this file loads its inputs in the shader's order.
#include "mesh/front/tile.h"

#include <algorithm>
#include <bit>

namespace fw::mesh {

using namespace gpu;

static_assert(gpu::kTexelReal == mesh::kTexelReal && gpu::kTexelRim == mesh::kTexelRim);

namespace {

// Whether one of `count` texels is a source.
bool anySource(const uint32_t* first, uint32_t count) noexcept {
    uint32_t least = kNever;
    for (uint32_t i = 0; i < count; ++i) least = std::min(least, first[i]);
    return isSource(least);
}

// The texels of a row of eight that may change: all eligible ones, or only eligible rim texels if
// no inner texel has a source in its ring. The rings of rim texels lie elsewhere.
uint32_t chosenOfRow(const uint32_t* row, uint32_t width, uint32_t rim,
                     uint32_t floorTick) noexcept {
    uint32_t eligible = 0;
    for (uint32_t x = 0; x < 8; ++x) eligible |= uint32_t(isFrontEligible(row[x], floorTick)) << x;
    const uint32_t inner = eligible & ~rim;
    if (inner == 0) return eligible;
    // The rows and columns beside an inner texel exist.
    const uint32_t left = inner & 1u;
    const uint32_t count = 8 + left + (inner >> 7);
    const uint32_t* middle = row - left;
    return anySource(middle - width, count) || anySource(middle, count) ||
                   anySource(middle + width, count)
               ? eligible
               : eligible & rim;
}

}  // namespace

FrontTile runFrontTile(const FrontArrays& arrays, uint32_t tile, uint32_t windowEnd,
                       uint32_t floorTick, uint32_t* scratch) noexcept {
    FrontTile out;
    const int width = int(arrays.width);
    FW_ASSERT(arrays.tilesX > 0 && floorTick <= windowEnd, "%u tiles a row, ticks %u to %u",
              arrays.tilesX, floorTick, windowEnd);
    int offsets[8];
    for (int k = 0; k < 8; ++k) offsets[k] = kRingX[k] + kRingY[k] * width;
    const TileStatic& statics = arrays.tiles[tile];
    const uint64_t rimMask = statics.rimMask;
    const uint32_t corner =
        (tile / arrays.tilesX) * 8u * arrays.width + (tile % arrays.tilesX) * 8u;

    uint64_t chosen = 0;
    for (uint32_t row = 0; row < 8; ++row)
        chosen |= uint64_t(chosenOfRow(arrays.state + corner + row * arrays.width, arrays.width,
                                       uint32_t(rimMask >> row * 8) & 0xFFu, floorTick))
                  << row * 8;
    FrontDrive prep{};  // kept while normal, slowness and material stay
    uint64_t prepKey = ~0ull;
    for (; chosen != 0; chosen &= chosen - 1) {
        const auto lane = uint32_t(std::countr_zero(chosen));
        const uint32_t texel = corner + (lane >> 3) * arrays.width + (lane & 7);
        const uint32_t t = arrays.state[texel];
        FrontRing ring;
        uint32_t other[8];
        uint32_t present = 0xFF;
        if (rimMask >> lane & 1) {
            const uint32_t* links = arrays.links + size_t(statics.recordOf(lane)) * 8;
            present = 0;
            for (uint32_t k = 0; k < 8; ++k) {
                other[k] = links[k];
                ring.tick[k] = kInert;
                if (other[k] == kNoneTexel) continue;
                present |= 1u << k;
                ring.tick[k] = arrays.state[other[k]];
            }
        } else {
            for (int k = 0; k < 8; ++k) {
                other[k] = uint32_t(int(texel) + offsets[k]);
                ring.tick[k] = arrays.state[other[k]];
            }
        }
        uint32_t pending = kNever;
        const uint32_t counts = countingSources(ring, present, windowEnd, pending);
        const uint32_t future = pending;  // a source of the ring begins then: may correct us too
        uint32_t decided = t;
        uint32_t late = 0;
        if (counts != 0) {
            const TexelPosition& me = arrays.texels[texel];
            for (uint32_t k = 0; k < 8; ++k) {
                if ((counts >> k & 1) == 0) continue;
                const TexelPosition& they = arrays.texels[other[k]];
                ring.link[k] = me.units() - they.units();
                ring.burn[k] = arrays.materials[they.materialFlags & 7u].burnTicks;
            }
            const uint32_t material = me.materialFlags & 7u;
            const uint32_t slow = arrays.slowness[texel];
            const uint32_t normal = arrays.normals[texel];
            const uint64_t key = uint64_t(normal) << 19 | slow << 3 | material;
            if (key != prepKey) {
                prep = prepareFront(decodeNormal(normal), slow, arrays.materials[material]);
                prepKey = key;
            }
            uint32_t soonest = kNever;
            const uint32_t candidate =
                frontArrival(ring, counts, prep, arrays.materials[material].windowMax, windowEnd,
                             floorTick, texel, false, pending, soonest);
            FW_ASSERT(slow != 0, "texel %u has no slowness", texel);
            decided = decideTick(t, candidate, windowEnd, floorTick, pending, late);
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

}  // namespace fw::mesh
