// A flame's shape as an image of temperature and soot over radius and height, with brush
// operations: paint, erase, smooth, smear and gradients.
#pragma once

#include <cstddef>
#include <vector>

namespace fwedit {

// 64 x 128 texels in the plugin's layout; rows from the base up.
struct ProfilePaint {
    static constexpr int kWidth = 64, kHeight = 128;
    static constexpr float kMostKelvin = 3000, kMostSoot = 2;
    std::vector<float> kelvin = std::vector<float>(size_t(kWidth) * kHeight);  // [0, kMostKelvin]
    std::vector<float> soot = std::vector<float>(size_t(kWidth) * kHeight);    // [0, kMostSoot]
    bool operator==(const ProfilePaint&) const = default;
};

enum class ProfileTool : int { kPaint, kErase, kSmooth, kSmear, kGradient, kPick };
enum class ProfilePlane : int { kTemperature, kSoot };

// A dab of the brush at (x, y), in texels; symmetric about the axis. `value`: target in K or soot.
// `hardness`, `strength`: [0, 1]. `alongX`, `alongY`: texels since the previous dab, for smearing.
struct Dab {
    ProfileTool tool = ProfileTool::kPaint;
    ProfilePlane plane = ProfilePlane::kTemperature;
    float x = 0, y = 0, radiusX = 4, radiusY = 4;
    float alongX = 0, alongY = 0;
    float value = 1600, strength = 0.6f, hardness = 0.3f;
};
void paintDab(ProfilePaint& paint, const Dab& dab);

// A gradient along a line between two points, in texels; constant beyond its ends, and only inside
// the flame. `aspect`: width of a texel relative to its height on the canvas.
struct Gradient {
    ProfilePlane plane = ProfilePlane::kTemperature;
    float fromX = 0, fromY = 0, toX = 0, toY = 0;
    float fromValue = 1600, toValue = 900, strength = 1;
    float aspect = 1;
};
void paintGradient(ProfilePaint& paint, const Gradient& gradient);

}  // namespace fwedit
