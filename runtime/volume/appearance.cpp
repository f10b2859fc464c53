// Presets, painters of profiles, and the published laws of a flame's height and rhythm.
#include "volume/appearance.h"

#include "core/assert.h"
#include "core/hash.h"

#include <algorithm>
#include <cmath>

namespace fw::volume {
namespace {

using glm::mix;
using glm::smoothstep;

// Most displacement by an eddy, of its wavelength. More would fold flame tongues over themselves,
// into shreds smaller than a sample's step.
constexpr float kMaxWarp = 1.0f;

struct Paint {
    float kelvin, soot;
};

// A body of soot, denser in a sheet just inside its surface, narrowing to a point.
Paint paintFire(const FlameAppearance& l, float rho, float y) noexcept {
    const float half =
        0.86f * std::pow(1.0f - y, 0.75f) * mix(0.85f, 1.0f, smoothstep(0.0f, 0.12f, y));
    const float e = rho / std::max(half, 1e-3f);  // 0 axis, 1 surface
    const float g = (e - 1.0f + l.sheetWidth) / l.sheetWidth, band = std::exp(-g * g);
    float soot = (1.0f - smoothstep(1.0f - 0.6f * l.sheetWidth, 1.0f, e)) *
                 mix(1.0f, l.fill + band, l.sheet * (1.0f - 0.8f * smoothstep(0.3f, 0.9f, y)));
    soot *= smoothstep(0.0f, l.baseSoft, y - l.baseRound * rho * rho);  // a round, soft foot
    float kelvin = mix(l.core, l.tip, y) * (1.0f - 0.08f * smoothstep(0.7f, 1.0f, e));
    kelvin *= 1.0f - l.coolCore * (1.0f - smoothstep(0.0f, 0.75f, e)) *
                         (1.0f - smoothstep(0.15f, 0.55f, y));  // rich in fuel, short of air
    if (e > 1.03f && half > 0.1f) kelvin = 0.0f;                // no clean gas beside the soot
    return {kelvin, soot};
}

// A tear drop: dark around the wick, a blue cup below, luminous above.
Paint paintCandle(const FlameAppearance& l, float rho, float y) noexcept {
    const float half = 1.03f * smoothstep(-0.10f, 0.30f, y) * std::pow(1.0f - y, 0.62f);
    const float e = rho / std::max(half, 1e-3f);
    const float soot = (1.0f - smoothstep(0.55f, 1.0f, e)) *
                       smoothstep(0.03f, 0.30f, y + 0.08f * e * e) *
                       mix(0.75f, 1.0f, smoothstep(0.0f, 0.6f, e));
    const float q = (e - 0.85f) / 0.22f;
    const float cup =
        smoothstep(0.0f, 0.04f, y) * (1.0f - smoothstep(0.10f, 0.32f, y)) * std::exp(-q * q);
    const float kelvin =
        mix(l.core, l.tip, smoothstep(0.45f, 1.0f, y)) - 170.0f * smoothstep(0.45f, 1.0f, e);
    return {soot > 0.004f ? kelvin : 1000.0f * cup, soot};
}

// Premixed gas: a bright inner cone in a faint mantle, no soot but for a breath at the tip.
Paint paintBurner(const FlameAppearance& l, float rho, float y) noexcept {
    const float mantle = 0.80f * std::pow(1.0f - y, 0.6f);
    const float cone = 0.62f * (1.0f - y / 0.42f);
    const float q = (rho - cone) / 0.07f;
    float gas = y < 0.44f ? std::exp(-q * q) : 0.0f;
    gas *= 1.0f - smoothstep(0.36f, 0.44f, y);
    const float e = rho / std::max(mantle, 1e-3f);
    gas = std::max(gas, 0.16f * (1.0f - smoothstep(0.55f, 1.0f, e)) * (1.0f - 0.7f * y));
    gas *= smoothstep(0.0f, 0.03f, y);
    const float soot = 0.012f * (1.0f - smoothstep(0.2f, 0.6f, e)) * smoothstep(0.45f, 0.8f, y);
    return {soot > 1e-4f ? mix(l.core, l.tip, y) : 1000.0f * gas, soot};
}

double wrapped(double cells) noexcept {
    return cells - gpu::kFlameWrap * std::floor(cells / gpu::kFlameWrap);
}

}  // namespace

const char* presetName(FlamePreset preset) noexcept {
    static constexpr const char* kNames[] = {
        "camp fire",  "candle",     "torch",       "bonfire",      "house fire",
        "gas burner", "magic blue", "magic green", "dying embers", "unknown"};
    return kNames[std::min(uint32_t(preset), uint32_t(FlamePreset::Count))];
}

FlamePresetDef presetDef(FlamePreset preset) noexcept {
    FlamePresetDef d;
    FlameAppearance& l = d.appearance;
    const auto tint = [&](float r, float g, float b) {
        l.tint[0] = r, l.tint[1] = g, l.tint[2] = b, l.tint[3] = 1;
    };
    switch (preset) {
        case FlamePreset::Candle:
            d.power = 0.08f, d.diameter = 0.011f;
            l.painter = Painter::Candle;
            l.turbulence = 0.015f, l.radial = 0.0f, l.warp = 0.04f, l.columns = 0.0f,
            l.filament = 0.0f;
            l.erode = 0.0f, l.converge = 0.0f, l.puff = 0.03f, l.burn = 0.22f, l.octaves = 1,
            l.dispersion = 0.05f;
            l.core = 1830.0f, l.tip = 1640.0f, l.thickness = 0.77f, l.blue = 0.5f,
            l.blueHeight = 0.32f;
            l.lambda = 1.8f, l.lambdaWarp = 2.7f, l.smoke = 0.0f, l.smokeTop = 1.0f,
            l.flicker = 0.05f;
            l.heightFactor = 0.93f, l.heightSlope = 0.0f;
            break;
        case FlamePreset::Torch:
            d.power = 5.0f, d.diameter = 0.13f;
            l.stretch = 2.2f, l.converge = 0.55f, l.lambda = 0.36f, l.warp = 0.34f,
            l.columns = 1.1f;
            l.baseSoft = 0.10f, l.baseRound = 0.16f, l.coolCore = 0.02f, l.filamentHeight = 0.4f;
            l.puff = 0.08f, l.burn = 1.1f, l.smoke = 2.0f, l.smokeTop = 3.0f,
            l.heightFactor = 1.27f, l.heightSlope = 0.02f;
            break;
        case FlamePreset::Bonfire:
            d.power = 600.0f, d.diameter = 1.3f;
            l.octaves = 4, l.lambda = 0.34f, l.lambdaWarp = 0.40f, l.lambdaColumn = 0.30f,
            l.stretch = 2.3f;
            l.converge = 0.95f, l.radial = 0.15f, l.erode = 0.24f, l.smoke = 1.4f,
            l.smokeTop = 4.5f;
            break;
        case FlamePreset::HouseFire:
            d.power = 2000.0f, d.diameter = 2.9f;
            l.octaves = 4, l.lambda = 0.24f, l.lambdaWarp = 0.32f, l.lambdaColumn = 0.25f,
            l.stretch = 2.2f;
            l.converge = 0.95f, l.warp = 0.44f, l.radial = 0.12f, l.erode = 0.2f,
            l.thickness = 6.0f;
            l.smoke = 2.2f, l.smokeAlbedo = 0.5f, l.smokeTop = 5.5f;
            l.heightFactor = 1.58f;
            break;
        case FlamePreset::GasBurner:
            d.power = 0.6f, d.diameter = 0.045f;
            l.painter = Painter::Burner;
            l.turbulence = 0.05f, l.radial = 0.03f, l.warp = 0.05f, l.columns = 0.1f,
            l.filament = 0.0f;
            l.erode = 0.0f, l.converge = 0.0f, l.puff = 0.02f, l.burn = 1.5f, l.octaves = 2,
            l.dispersion = 0.03f;
            l.blue = 0.9f, l.blueHeight = 2.5f, l.thickness = 2.0f, l.smoke = 0.0f,
            l.smokeTop = 1.0f;
            l.core = 1750.0f, l.tip = 1500.0f, l.flicker = 0.03f, l.radiant = 0.12f;
            tint(0.10f, 0.32f, 1.0f);
            l.heightFactor = 0.95f, l.heightSlope = 0.0f;
            break;
        case FlamePreset::MagicBlue:
        case FlamePreset::MagicGreen:
            l.stretch = 3.2f, l.burn = 0.8f, l.blue = 0.6f, l.smoke = 0.0f, l.smokeTop = 1.0f;
            if (preset == FlamePreset::MagicBlue)
                tint(0.10f, 0.34f, 1.0f);
            else
                tint(0.10f, 1.0f, 0.20f);
            break;
        case FlamePreset::DyingEmbers:
            d.power = 2.5f, d.diameter = 0.45f;
            l.stretch = 2.3f, l.converge = 0.8f, l.core = 1500.0f, l.tip = 1180.0f,
            l.thickness = 3.0f;
            l.burn = 0.8f, l.columns = 2.0f, l.smoke = 2.0f, l.blue = 0.1f, l.puff = 0.2f,
            l.flicker = 0.3f;
            break;
        default:  // camp fire
            l.stretch = 2.3f, l.converge = 0.95f;
            break;
    }
    return d;
}

void paintDefaultProfile(const FlameAppearance& appearance, Profile& profile) {
    std::array<float, Profile::kTexels> kelvin, soot;
    for (uint32_t j = 0; j < gpu::kProfileHeight; ++j)
        for (uint32_t i = 0; i < gpu::kProfileWidth; ++i) {
            const float rho = (float(i) + 0.5f) / float(gpu::kProfileWidth) * gpu::kProfileReach;
            const float y = (float(j) + 0.5f) / float(gpu::kProfileHeight);
            const Paint p = appearance.painter == Painter::Candle ? paintCandle(appearance, rho, y)
                            : appearance.painter == Painter::Burner
                                ? paintBurner(appearance, rho, y)
                                : paintFire(appearance, rho, y);
            kelvin[j * gpu::kProfileWidth + i] = p.kelvin;
            soot[j * gpu::kProfileWidth + i] = p.soot;
        }
    paintProfile(kelvin, soot, gpu::kProfileWidth, gpu::kProfileHeight, profile);
}

float flameHeight(float power, float diameter) noexcept {
    return 0.235f * std::pow(std::max(power, 0.0f), 0.4f) - 1.02f * diameter;
}

float puffFrequency(float diameter) noexcept { return 1.5f / std::sqrt(std::max(diameter, 1e-3f)); }

float plumeSpeed(float power, float z) noexcept {
    const float q = std::max(power, 1e-3f), h = std::max(z, 0.0f), scaled = h / std::pow(q, 0.4f);
    if (scaled < 0.08f) return 6.84f * std::sqrt(h);
    if (scaled < 0.2f) return 1.93f * std::pow(q, 0.2f);
    return 1.12f * std::pow(scaled, -1.0f / 3.0f) * std::pow(q, 0.2f);
}

float plumeExcess(float power, float z) noexcept {
    const float scaled = std::max(z, 0.0f) / std::pow(std::max(power, 1e-3f), 0.4f);
    return scaled < 0.08f  ? 800.0f
           : scaled < 0.2f ? 63.0f / scaled
                           : 21.6f * std::pow(scaled, -5.0f / 3.0f);
}

float heightFactor(const FlameAppearance& appearance, float height, float diameter) noexcept {
    const float slender = std::log2(std::max(height, 1e-6f) / std::max(diameter, 1e-4f));
    // Jets, of more than sixteen diameters, taper later.
    return appearance.heightFactor +
           appearance.heightSlope * std::clamp(slender - 1.0f, 0.0f, 2.0f) +
           0.10f * std::clamp(slender - 4.0f, 0.0f, 2.0f);
}

uint32_t splitFire(float power, float diameter, std::array<Flamelet, kMaxFlamelets>& out) noexcept {
    const float q = std::max(power, 0.0f), d = std::max(diameter, 1e-3f);
    const float whole = flameHeight(q, d);
    if (whole >= 0.5f * d || q <= 0.0f) {
        out[0] = {0.0f, 0.0f, q, d, std::max(whole, 1e-3f)};
        return 1;
    }
    // The number that lie side by side if each is as wide as a single flame of the fire could be.
    const auto width = [&](float parts) { return 0.235f * std::pow(q / parts, 0.4f) / 2.02f; };
    const float ratio = d / std::max(width(1.0f), 1e-4f);
    const uint32_t n = uint32_t(std::clamp(0.6f * ratio * ratio, 2.0f, float(kMaxFlamelets)));
    FW_ASSERT(n >= 2 && n <= kMaxFlamelets, "%u flames", n);
    FW_ASSERT(width(float(n)) <= width(1.0f), "%g m", double(width(1.0f)));
    const float each = std::clamp(width(float(n)), 1e-4f, d);  // also of a power that underflows
    for (uint32_t k = 0; k < n; ++k) {                         // a sunflower's pattern
        const float r = 0.5f * std::max(d - each, 0.0f) * std::sqrt((float(k) + 0.5f) / float(n));
        const float a = 2.3999632f * float(k);
        out[k] = {r * std::cos(a), r * std::sin(a), q / float(n), each,
                  std::max(flameHeight(q / float(n), each), 1e-3f)};
    }
    return n;
}

void advanceScroll(FlameScroll& s, const FlameAppearance& appearance, const gpu::FlameRecord& r,
                   double seconds) noexcept {
    const double metres = double(r.speed) * double(appearance.burn) * seconds;
    const double cells = metres / double(r.stretch * r.lambda);
    FW_ASSERT(r.stretch > 0 && r.lambda > 0 && r.lambdaWarp > 0 && r.lambdaColumn > 0);
    for (uint32_t o = 0; o < gpu::kFlameOctaves; ++o)  // octaves differ in speed
        s.octaves[o] = wrapped(s.octaves[o] + cells * (double(1u << o) + 0.13 * double(o)));
    s.warp = wrapped(s.warp + metres / double(r.stretch * r.lambdaWarp));
    s.column = wrapped(s.column + 0.35 * metres / double(r.stretch * r.lambdaColumn));
    s.smoke = wrapped(s.smoke + metres / (0.75 * double(r.low.w)));
    s.puff += double(puffFrequency(r.low.w)) * seconds;
    s.puff -= std::floor(s.puff);
}

gpu::FlameRecord describeFlame(const FlameAppearance& l, const FlameSize& size,
                               const FlameScroll& scroll, uint32_t seed) noexcept {
    gpu::FlameRecord r{};
    const float d = std::max(size.diameter, 1e-4f);
    const float height = std::max(size.height, 1e-4f) / heightFactor(l, size.height, d);
    const float scale = std::min(d, height / 0.75f);
    FW_ASSERT(scale > 0, "%g m", double(scale));
    r.low.w = d;
    r.high.w = height * size.pulse;
    for (uint32_t o = 0; o < gpu::kFlameOctaves; ++o) r.scroll[int(o)] = float(scroll.octaves[o]);
    const auto cell = [&](uint32_t k) {
        return float(core::hash32(seed * 4u + k) >> 8) * (256.0f / 16777216.0f);
    };
    r.place = gpu::vec4(cell(0), cell(1), cell(2), float(scroll.puff));
    r.tint = gpu::vec4(l.tint[0], l.tint[1], l.tint[2], l.tint[3]);
    r.air = gpu::vec4(0.0f, 0.0f, 0.0f, 1.0f);
    r.warpScroll = float(scroll.warp), r.columnScroll = float(scroll.column);
    r.smokeScroll = float(scroll.smoke);
    r.speed = 6.84f * std::sqrt(0.54f * height);
    r.tauStart = 0.04f * height;
    r.tauFree = std::max(0.08f * std::pow(std::max(size.power, 0.0f), 0.4f), 0.5f * height);
    r.lambda = l.lambda * scale, r.lambdaWarp = l.lambdaWarp * scale;
    r.lambdaColumn = l.lambdaColumn * scale;
    r.stretch = l.stretch, r.turbulence = l.turbulence, r.radial = l.radial;
    r.warp = std::min(l.warp, kMaxWarp * r.lambdaWarp / d);
    r.columns = l.columns, r.ridge = l.ridge, r.converge = l.converge;
    r.puff = l.puff, r.soot = l.thickness / scale, r.blue = l.blue, r.blueHeight = l.blueHeight;
    r.erode = l.erode, r.filament = l.filament, r.filamentWidth = l.filamentWidth;
    r.filamentBase = l.filamentBase, r.filamentHeight = l.filamentHeight, r.tipFill = l.tipFill;
    r.smoke = l.smoke, r.smokeTop = l.smokeTop, r.smokeAlbedo = l.smokeAlbedo;
    const glm::vec3 hue(r.tint), own(l.coreTint[0], l.coreTint[1], l.coreTint[2]);
    const glm::vec3 core =
        glm::mix(glm::mix(hue, glm::vec3(1.0f), l.tintWhite), own, l.coreTint[3]);
    r.tintCore = glm::packUnorm4x8(gpu::vec4(glm::sqrt(core), 0.0f));
    r.tintLow = l.tip - 60.0f, r.tintHigh = l.core;
    r.octaves = std::clamp(l.octaves, 1u, gpu::kFlameOctaves);
    return r;
}

}  // namespace fw::volume
