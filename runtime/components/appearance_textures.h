// Noise textures of burning surfaces: two kinds of noise and the slopes baked from them, one 512^2
// RGBA8 array of three tiling layers with mips. Constant data, computed without a device.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <vector>

namespace fw::components {

constexpr uint32_t kAppearanceTextureSide = 512;
constexpr uint32_t kAppearanceTextureMips = 10;
constexpr uint32_t kAppearanceTextureLayers = 3;

// RGBA8 texels: layer by layer, each with its mips, largest first. See shaders/shared/appearance.h.
[[nodiscard]] std::pmr::vector<std::byte> bakeAppearanceTextures(std::pmr::memory_resource* memory);
// Offset of a mip of a layer, bytes.
[[nodiscard]] size_t appearanceTextureOffset(uint32_t layer, uint32_t mip) noexcept;

}  // namespace fw::components
