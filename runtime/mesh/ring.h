// The ring of eight texels around a texel: from the image, or from a rim texel's link record.
#pragma once
#include "mesh/burn_domain.h"

#include <bit>

namespace fw::mesh {

// The k-th in the ring of a real texel, or kNone.
inline uint32_t ringOf(const BurnDomain& domain, uint32_t texel, uint32_t k) noexcept {
    FW_ASSERT(k < 8 && domain.real(texel), "slot %u of texel %u", k, texel);
    const uint32_t x = texel % domain.width, y = texel / domain.width;
    if (domain.texels[texel].materialFlags & kTexelRim) {
        const TileStatic& tile = domain.tiles[domain.tileOf(texel)];
        const uint32_t lane = domain.laneOf(texel);
        const uint64_t mask = uint64_t(tile.rimMaskHigh) << 32 | tile.rimMaskLow;
        const uint64_t below = mask & ((uint64_t(1) << lane) - 1);
        const uint32_t record = tile.rimBase + uint32_t(std::popcount(below));
        FW_ASSERT(size_t(record) * 8 + k < domain.links.size(), "record %u", record);
        return domain.links[size_t(record) * 8 + k];
    }
    const int nx = int(x) + kRingX[k], ny = int(y) + kRingY[k];
    if (nx < 0 || ny < 0 || nx >= int(domain.width) || ny >= int(domain.height)) return kNone;
    return uint32_t(ny) * domain.width + uint32_t(nx);
}

}  // namespace fw::mesh
