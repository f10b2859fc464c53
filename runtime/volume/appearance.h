// Appearance of a flame: parameters of its noise, light and smoke, relative to its size, with
// presets; and the laws from heat release to height. Places are curve.h's and motion.h's.
#pragma once
#include "volume/profile.h"

#include <array>
#include <cstdint>

namespace fw::volume {

enum class Painter : uint32_t { Fire, Candle, Burner };

// Lengths of noise are in units of min(diameter, height / 0.75), which keeps squat fires fine.
struct FlameAppearance {
    float lambda = 0.44f, lambdaWarp = 0.47f, lambdaColumn = 0.36f;
    float stretch = 2.9f;      // 1 explosion, 3 silk
    float turbulence = 0.65f;  // [0, 2]
    float radial = 0.2f;
    float warp = 0.42f, columns = 1.7f;
    float ridge = 0.5f;        // [0, 1] round to pointed
    uint32_t octaves = 3;      // [1, 4]
    float converge = 1.05f;    // [0, 1.3] tongues lean inward
    float puff = 0.15f;        // [0, 0.5] amplitude of puffing at 1.5 / sqrt(D)
    float burn = 1.0f;         // speed of everything that moves
    float dispersion = 0.35f;  // [0, 1] random sideways speed of hot gas, of its speed
    float thickness = 5.4f;    // optical depth of soot across the scale length
    float blue = 0.15f, blueHeight = 0.10f;
    float erode = 0.28f;
    float filament = 1.0f, filamentWidth = 0.09f, filamentBase = 0.03f, filamentHeight = 0.25f;
    float tipFill = 0.45f;
    float smoke = 1.6f;                // 1/m
    float smokeTop = 4.0f;             // of the profile's height
    float smokeAlbedo = 0.6f;          // wood's; oil's and plastics' is less
    float tint[4] = {1, 1, 1, 0};      // linear rgb, weight
    float tintWhite = 0.18f;           // whiteness of the hottest under a tint
    float coreTint[4] = {1, 1, 1, 0};  // linear rgb of the hottest, weight over tintWhite
    float flicker = 0.15f;             // of the light proxy
    float radiant = 0.35f;             // radiated share of the heat release
    // Its default profile.
    Painter painter = Painter::Fire;
    float core = 1780.0f, tip = 1370.0f;  // K
    float coolCore = 0.06f;
    float fill = 0.35f, sheet = 0.6f, sheetWidth = 0.25f;
    float baseSoft = 0.12f, baseRound = 0.06f;
    // Visible over profile height, see heightFactor(): up to two diameters of height, and the
    // increase for each of the next two doublings.
    float heightFactor = 1.52f, heightSlope = 0.065f;
};

enum class FlamePreset : uint32_t {
    CampFire,
    Candle,
    Torch,
    Bonfire,
    HouseFire,
    GasBurner,
    MagicBlue,
    MagicGreen,
    DyingEmbers,
    Count
};
const char* presetName(FlamePreset preset) noexcept;

struct FlamePresetDef {
    FlameAppearance appearance;
    float power = 60.0f;    // kW
    float diameter = 0.6f;  // m
};
FlamePresetDef presetDef(FlamePreset preset) noexcept;

// The default profile of an appearance.
void paintDefaultProfile(const FlameAppearance& appearance, Profile& profile);

// Heskestad: mean visible height, m; negative for wide, weak fires. Q kW, D m.
float flameHeight(float power, float diameter) noexcept;
// Cetegen and Ahmed: Hz.
float puffFrequency(float diameter) noexcept;
// McCaffrey's centreline at z m above the base: m/s, K above ambient.
float plumeSpeed(float power, float z) noexcept;
float plumeExcess(float power, float z) noexcept;
// Visible height over the profile's, for this appearance. Measured; the unit tests of heights check
// it.
float heightFactor(const FlameAppearance& appearance, float height, float diameter) noexcept;

// A fire too weak for its width burns as many small flames, each as high as it is wide.
constexpr uint32_t kMaxFlamelets = 32;
struct Flamelet {
    float x = 0.0f, z = 0.0f;  // m from the fire's middle
    float power = 0.0f;        // kW
    float diameter = 0.0f;     // m
    float height = 0.0f;       // m, visible; > 0
};
// One flame, the whole fire, if its height is at least half its diameter. Returns the count.
uint32_t splitFire(float power, float diameter, std::array<Flamelet, kMaxFlamelets>& out) noexcept;

// Rise of the noise, in cells. Kept with a flame, because speeds change while it burns.
struct FlameScroll {
    std::array<double, gpu::kFlameOctaves> octaves{};
    double warp = 0.0, column = 0.0, smoke = 0.0, puff = 0.0;
};
void advanceScroll(FlameScroll& scroll, const FlameAppearance& appearance,
                   const gpu::FlameRecord& record, double seconds) noexcept;

struct FlameSize {
    float power = 0.0f;     // kW
    float diameter = 0.0f;  // m
    float height = 0.0f;    // m, visible, mean
    float pulse = 1.0f;     // factor of puffing on the height
};
// A record without its curve, bounds and light. `seed` shifts it in the noise.
gpu::FlameRecord describeFlame(const FlameAppearance& appearance, const FlameSize& size,
                               const FlameScroll& scroll, uint32_t seed) noexcept;

}  // namespace fw::volume
