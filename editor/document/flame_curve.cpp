// See flame_curve.h.
#include "document/flame_curve.h"

#include <algorithm>
#include <cmath>

namespace fwedit {
namespace {

constexpr float kZeroCelsius = 273.15f, kMostKelvin = 3000;
constexpr float kGlowFrom = 1000;  // K, soot glows above it
constexpr float kEdge = 0.22f,
                kSoftFoot = 0.12f;  // share of radius and height over which soot thins out

float smooth(float from, float to, float at) {
    const float t = std::clamp((at - from) / (to - from), 0.0f, 1.0f);
    return t * t * (3 - 2 * t);
}

// Slopes of a monotone cubic (Fritsch and Butland 1984): the harmonic mean of the neighbours'.
float slopeAt(const Keys& keys, size_t i) {
    const auto slope = [&](size_t k) {
        return (keys[k + 1].value - keys[k].value) / (keys[k + 1].time - keys[k].time);
    };
    if (i == 0) return slope(0);
    if (i + 1 == keys.size()) return slope(i - 1);
    const float before = slope(i - 1), after = slope(i);
    return before * after <= 0 ? 0 : 2 * before * after / (before + after);
}

}  // namespace

FlameCurve standardCurve() {
    return {{{0, 0.7f}, {0.14f, 0.78f}, {0.4f, 0.58f}, {0.72f, 0.32f}, {1, 0.02f}},
            {{0, 1000}, {0.35f, 1250}, {1, 1480}}};
}

FlameCurve curveOf(const Flame& flame) {
    FlameCurve curve = standardCurve();
    if (!flame.outline.empty()) curve.outline = flame.outline;
    if (!flame.stops.empty()) curve.stops = flame.stops;
    return curve;
}

float radiusAt(const Keys& outline, float height) {
    const auto end = std::find_if(outline.begin(), outline.end(),
                                  [&](const Key& key) { return key.time > height; });
    if (end == outline.begin() || end == outline.end()) return valueAt(outline, height);
    const auto i = static_cast<size_t>(end - outline.begin());
    const Key &a = outline[i - 1], &b = outline[i];
    const float span = b.time - a.time, t = (height - a.time) / span;
    const float m0 = span * slopeAt(outline, i - 1), m1 = span * slopeAt(outline, i);
    const float t2 = t * t, t3 = t2 * t;
    const float value = (2 * t3 - 3 * t2 + 1) * a.value + (t3 - 2 * t2 + t) * m0 +
                        (3 * t2 - 2 * t3) * b.value + (t3 - t2) * m1;
    return std::clamp(value, std::min(a.value, b.value), std::max(a.value, b.value));
}

std::vector<float> texelsOfCurve(const FlameCurve& curve) {
    std::vector<float> texels;
    texels.reserve(size_t{2} * kShapeWidth * kShapeHeight);
    for (uint32_t y = 0; y < kShapeHeight; ++y) {
        const float height = (static_cast<float>(y) + 0.5f) / kShapeHeight;
        const float radius = std::max(radiusAt(curve.outline, height), 1e-3f);
        for (uint32_t x = 0; x < kShapeWidth; ++x) {
            const float out = kShapeReach * (static_cast<float>(x) + 0.5f) / kShapeWidth;
            const float inside = 1 - out / radius;  // 0 edge, 1 core
            const float kelvin = std::min(valueAt(curve.stops, inside) + kZeroCelsius, kMostKelvin);
            // Regions too cold to glow become empty instead of blue gas.
            const float soot = smooth(0, kEdge, inside) * smooth(0, kSoftFoot, height) *
                               smooth(0.75f * kGlowFrom, kGlowFrom, kelvin);
            texels.push_back(soot > 0 ? std::max(kelvin, kGlowFrom) : 0);
            texels.push_back(soot);
        }
    }
    return texels;
}

}  // namespace fwedit
