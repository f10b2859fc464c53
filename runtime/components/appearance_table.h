// Appearance of each material preset while it burns: the rows of the look table that shaders read.
// Tuned by eye on lit pictures. Cosmetic.
#pragma once
#include "mesh/refine/model.h"
#include "shared/look.h"

#include <cstdint>
#include <span>

namespace fw::components {

constexpr uint32_t kLookCount = 14;  // FW_MATERIAL_PRESET_COUNT

[[nodiscard]] std::span<const gpu::MaterialAppearance, kLookCount> materialLooks() noexcept;
// Row of a FwMaterialPreset; a number beyond the table gets row 0, which never burns.
[[nodiscard]] gpu::MaterialAppearance materialLook(uint32_t preset) noexcept;
// Parameters of its holes, for refined meshes.
[[nodiscard]] mesh::RefineHoles holesOf(const gpu::MaterialAppearance& look) noexcept;
// s after ignition until nothing of it is visible, at the latest noise.
[[nodiscard]] float lookHoleEnd(const gpu::MaterialAppearance& look) noexcept;

}  // namespace fw::components
