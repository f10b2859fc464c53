// Appearance of each material preset while it burns: the rows of the appearance table that shaders
// read. Tuned by eye on lit pictures. Cosmetic.
#pragma once
#include "mesh/refine/model.h"
#include "shared/appearance.h"

#include <cstdint>
#include <span>

namespace fw::components {

constexpr uint32_t kAppearanceCount = 14;  // FW_MATERIAL_PRESET_COUNT

[[nodiscard]] std::span<const gpu::MaterialAppearance, kAppearanceCount> materialLooks() noexcept;
// Row of a FwMaterialPreset; a number beyond the table gets row 0, which never burns.
[[nodiscard]] gpu::MaterialAppearance materialAppearance(uint32_t preset) noexcept;
// Parameters of its holes, for refined meshes.
[[nodiscard]] mesh::RefineHoles holesOf(const gpu::MaterialAppearance& appearance) noexcept;
// s after ignition until nothing of it is visible, at the latest noise.
[[nodiscard]] float holeEndSeconds(const gpu::MaterialAppearance& appearance) noexcept;

}  // namespace fw::components
