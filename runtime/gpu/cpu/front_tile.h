// The front kernel over one tile, as the arrival pass does it on a device. Plain pointers; the
// driver of lists is cpu_backend.cpp.
#pragma once
#include "mesh/burn_domain.h"
#include "shared/front.h"

namespace fw::gpu::cpu {

struct FrontPlanes {  // of one object
    const uint32_t* state = nullptr;
    const mesh::TexelPosition* texels = nullptr;
    const uint32_t* normals = nullptr;
    const uint16_t* slowness = nullptr;
    const uint32_t* links = nullptr;
    const mesh::TileStatic* tiles = nullptr;
    const BurnMaterial* materials = nullptr;
    uint32_t width = 0, tilesX = 0;  // texels, tiles
};

struct FrontTile {         // what a tile's run says
    uint64_t changed = 0;  // lanes with a new tick in the scratch words
    uint64_t lit = 0;      // of these, lanes that were receptive
    uint32_t wake = kNever;
    uint32_t late = 0;  // candidates that came below the floor
};

// `scratch`: 64 words, written where `changed` says.
FrontTile runFrontTile(const FrontPlanes& planes, uint32_t tile, uint32_t windowEnd,
                       uint32_t floorTick, uint32_t* scratch) noexcept;

}  // namespace fw::gpu::cpu
