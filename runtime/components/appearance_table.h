// Appearance of each material preset while it burns: the rows of the appearance table that shaders
// read. Tuned by eye on lit pictures. Cosmetic.
#pragma once
#include "mesh/refine/model.h"
#include "shared/appearance.h"

#include <cstdint>
#include <span>

namespace fw::components {

// By FwMaterialPreset.
[[nodiscard]] std::span<const gpu::MaterialAppearance> materialAppearances() noexcept;
[[nodiscard]] std::span<const gpu::MaterialFamily> materialFamilies() noexcept;
// Row of a FwMaterialPreset; a number beyond the table gets row 0, which never burns.
[[nodiscard]] gpu::MaterialAppearance materialAppearance(uint32_t preset) noexcept;
// Stiffness against bending of its fresh sheets, [0, 1].
[[nodiscard]] float freshBend(uint32_t preset) noexcept;
// Parameters of its holes, for refined meshes.
[[nodiscard]] mesh::RefineHoles holesOf(const gpu::MaterialAppearance& appearance) noexcept;
// s after ignition until nothing of it is visible, at the latest noise.
[[nodiscard]] float holeEndSeconds(const gpu::MaterialAppearance& appearance) noexcept;

}  // namespace fw::components
