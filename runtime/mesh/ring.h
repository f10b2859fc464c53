// The ring of eight texels around a texel: from the image, or from a rim texel's link record.
#pragma once
#include "mesh/burn_domain.h"

namespace fw::mesh {

// The k-th in the ring of a real texel, or kNone.
inline uint32_t ringOf(const BurnDomain& domain, uint32_t texel, uint32_t k) noexcept {
    FW_ASSERT(k < 8 && domain.real(texel), "slot %u of texel %u", k, texel);
    if (domain.texels[texel].materialFlags & kTexelRim) {
        const TileStatic& tile = domain.tiles[domain.tileOf(texel)];
        const uint32_t record = tile.recordOf(domain.laneOf(texel));
        FW_ASSERT(size_t(record) * 8 + k < domain.links.size(), "record %u", record);
        return domain.links[size_t(record) * 8 + k];
    }
    const int other = int(texel) + kRingY[k] * int(domain.width) + kRingX[k];
    FW_ASSERT(other >= 0 && other < int(domain.texelCount()), "texel %d", other);
    return uint32_t(other);
}

}  // namespace fw::mesh
