// Fire profile: an artist's temperature and soot over radius and height of a flame, and its cooked
// form
// (.fwprofile). Tools read images.
#pragma once
#include "shared/volume.h"

#include <array>
#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

namespace fw::volume {

constexpr float kMaxProfileKelvin = 3000.0f;
constexpr float kMaxProfileSoot = 2.0f;
constexpr uint32_t kMinProfileSide = 8, kMaxProfileSide = 512;

// 64 x 128 texels, x over rho in [0, kProfileReach], y over height in [0, 1], base row first.
struct Profile {
    static constexpr uint32_t kTexels = gpu::kProfileWidth * gpu::kProfileHeight;

    // Halfs: low 1000 K, high soot; R16G16_SFLOAT on a device. Below 1000 K soot does not glow:
    // there the first is the amount of clean burning gas (blue), in the same unit.
    std::array<uint32_t, kTexels> texels{};

    // Bilinear, clamped in rho, none above y = 1. x: 1000 K, y: soot.
    [[nodiscard]] gpu::vec2 sample(float rho, float y) const noexcept;
};

// From planes of width x height values, any size in [8, 512], resampled. Throws core::Error that
// names the texel, the value and the limit.
void paintProfile(std::span<const float> kelvin, std::span<const float> soot, uint32_t width,
                  uint32_t height, Profile& profile);

// .fwprofile, little-endian: u32 magic 'FWFP', u32 version, u32 width, u32 height, u64 FNV-1a of
// all before and after it, then width x height pairs of halfs as in Profile::texels.
std::pmr::vector<std::byte> cookProfile(const Profile& profile, std::pmr::memory_resource* memory);
// Throws core::Error; `profile` is then unchanged. Other sizes than 64 x 128 are resampled.
void readProfile(std::span<const std::byte> bytes, Profile& profile);

}  // namespace fw::volume
