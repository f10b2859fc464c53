// Ragged holes: scales every slot's burn-through time by the noise that discards fragments of far
// objects, so that near objects are cut where far ones discard.
#pragma once
#include "mesh/refine/model.h"

namespace fw::mesh {

struct RefineHoles {      // of a material
    float variation = 0;  // of the noise, as a share of the time to a hole; 0: smooth
    float tilesX = 0;     // of the noise, per metre
    float tilesY = 0;     // the same, along the grain
    bool wood = false;    // every plank (or the whole object) shows another place of the noise
};

// `slots`: a copy of the model's. `noise`: side * side tiling bytes.
void refineRoughen(const BurnDomain& domain, const RefineModel& model,
                   std::span<const RefineHoles> materials, std::span<const uint8_t> noise,
                   uint32_t side, std::span<gpu::RefineSlot> slots) noexcept;

}  // namespace fw::mesh
