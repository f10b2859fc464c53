// The front kernel over one tile, as the arrival pass does it on a device. The cpu backend and
// arrivals.h keep the lists of tiles.
#pragma once
#include "mesh/burn_domain.h"
#include "shared/front.h"

namespace fw::mesh {

struct FrontArrays {  // of one object
    FrontArrays() = default;
    // own: the object's slowness per texel; empty: the mesh's.
    FrontArrays(const BurnDomain& domain, const uint32_t* state_, std::span<const uint16_t> own,
                const gpu::BurnMaterial* materials_) noexcept
        : state(state_),
          texels(domain.texels.data()),
          normals(domain.normals.data()),
          slowness(own.empty() ? domain.slowness.data() : own.data()),
          links(domain.links.data()),
          tiles(domain.tiles.data()),
          materials(materials_),
          width(domain.width),
          tilesX(domain.tilesX) {
        FW_ASSERT(own.empty() || own.size() == domain.texelCount(), "%zu of %u texels", own.size(),
                  domain.texelCount());
    }
    const uint32_t* state = nullptr;
    const TexelPosition* texels = nullptr;
    const uint32_t* normals = nullptr;
    const uint16_t* slowness = nullptr;
    const uint32_t* links = nullptr;
    const TileStatic* tiles = nullptr;
    const gpu::BurnMaterial* materials = nullptr;
    uint32_t width = 0, tilesX = 0;  // texels, tiles
};

struct FrontTile {         // result of a tile's run
    uint64_t changed = 0;  // lanes with a new tick in the scratch words
    uint64_t lit = 0;      // changed lanes that were receptive
    uint32_t wake = gpu::kNever;
    uint32_t late = 0;  // candidates below the floor
};

// `scratch`: 64 words, written for the lanes of `changed`.
FrontTile runFrontTile(const FrontArrays& arrays, uint32_t tile, uint32_t windowEnd,
                       uint32_t floorTick, uint32_t* scratch) noexcept;

// Calls visit(tile) for each neighbour on the grid that reads a changed texel of the tile (`mask`:
// a bit per lane).
template <typename Visit>
void forEachTileBeside(const BurnDomain& domain, uint32_t tile, uint64_t mask, const Visit& visit) {
    FW_ASSERT(tile < domain.tileCount(), "%u of %u tiles", tile, domain.tileCount());
    const uint32_t beside = gpu::dependentNeighbours(uint32_t(mask), uint32_t(mask >> 32));
    if (beside == 0) return;
    const int x = int(tile % domain.tilesX), y = int(tile / domain.tilesX);
    for (uint32_t k = 0; k < 8; ++k) {
        if ((beside >> k & 1) == 0) continue;
        const int otherX = x + kRingX[k], otherY = y + kRingY[k];
        if (otherX < 0 || otherY < 0 || otherX >= int(domain.tilesX) ||
            otherY >= int(domain.tilesY))
            continue;
        visit(uint32_t(otherY) * domain.tilesX + uint32_t(otherX));
    }
}
// The tiles that read a changed texel through links.
inline std::span<const uint32_t> seamDependents(const BurnDomain& domain, uint32_t tile,
                                                uint64_t mask) noexcept {
    FW_ASSERT(tile < domain.tiles.size(), "%u of %zu tiles", tile, domain.tiles.size());
    const TileStatic& statics = domain.tiles[tile];
    if ((statics.seamMask & mask) == 0) return {};
    FW_ASSERT(statics.dependentStart + statics.dependentCount <= domain.dependents.size(),
              "%u dependents", statics.dependentCount);
    return {domain.dependents.data() + statics.dependentStart, statics.dependentCount};
}

}  // namespace fw::mesh
