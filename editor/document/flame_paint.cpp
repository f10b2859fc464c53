// See flame_paint.h.
#include "document/flame_paint.h"

#include <algorithm>
#include <cmath>

namespace fwedit {
namespace {

constexpr int kWidth = ProfilePaint::kWidth, kHeight = ProfilePaint::kHeight;

using Plane = std::vector<float>;

size_t texelOf(int x, int y) { return size_t(y * kWidth + x); }

float meanAround(const Plane& plane, int x, int y) {
    float sum = 0, count = 0;
    for (int v = std::max(0, y - 1); v <= std::min(kHeight - 1, y + 1); ++v) {
        for (int u = std::max(0, x - 1); u <= std::min(kWidth - 1, x + 1); ++u) {
            sum += plane[texelOf(u, v)];
            ++count;
        }
    }
    return sum / count;
}

// Samples between texels. The flame is axially symmetric, so negative x mirrors positive x.
float valueAt(const Plane& plane, float x, float y) {
    const float u = std::clamp(std::fabs(x) - 0.5f, 0.0f, float(kWidth - 1));
    const float v = std::clamp(y - 0.5f, 0.0f, float(kHeight - 1));
    const int x0 = std::min(int(u), kWidth - 2), y0 = std::min(int(v), kHeight - 2);
    const float right = u - float(x0), up = v - float(y0);
    const float low = std::lerp(plane[texelOf(x0, y0)], plane[texelOf(x0 + 1, y0)], right);
    const float high = std::lerp(plane[texelOf(x0, y0 + 1)], plane[texelOf(x0 + 1, y0 + 1)], right);
    return std::lerp(low, high, up);
}

}  // namespace

void paintDab(ProfilePaint& paint, const Dab& dab) {
    const bool ofSoot = dab.plane == ProfilePlane::kSoot;
    Plane& plane = ofSoot ? paint.soot : paint.kelvin;
    const bool looksAround = dab.tool == ProfileTool::kSmooth || dab.tool == ProfileTool::kSmear;
    const ProfilePaint before = looksAround ? paint : ProfilePaint{{}, {}};
    const float most = ofSoot ? ProfilePaint::kMostSoot : ProfilePaint::kMostKelvin;
    const float alongX = dab.x < 0 ? -dab.alongX : dab.alongX;
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            // The flame is axially symmetric: the left side mirrors the right one.
            const float atX = float(x) + 0.5f, atY = float(y) + 0.5f;
            const float dy = (atY - dab.y) / dab.radiusY;
            const float dx = (atX - std::fabs(dab.x)) / dab.radiusX;
            const float away = std::sqrt(dx * dx + dy * dy);
            if (away >= 1) continue;
            const float fall =
                dab.hardness >= 1 ? 1 : std::clamp((1 - away) / (1 - dab.hardness), 0.0f, 1.0f);
            const float share = dab.strength * fall * fall * (3 - 2 * fall);
            const size_t texel = texelOf(x, y);
            const auto goTo = [&](float& value, float wanted, float limit) {
                value = std::clamp(value + share * (wanted - value), 0.0f, limit);
            };
            const auto smeared = [&](const Plane& from) {
                return valueAt(from, atX - alongX, atY - dab.alongY);
            };
            const Plane& was = ofSoot ? before.soot : before.kelvin;
            goTo(plane[texel],
                 dab.tool == ProfileTool::kErase    ? 0
                 : dab.tool == ProfileTool::kSmooth ? meanAround(was, x, y)
                 : dab.tool == ProfileTool::kSmear  ? smeared(was)
                                                    : dab.value,
                 most);
            // Soot shows heat, so paint and smear change both, and erase removes both.
            if (ofSoot) continue;
            float& soot = paint.soot[texel];
            if (dab.tool == ProfileTool::kPaint) soot = std::max(soot, 0.6f * share);
            if (dab.tool == ProfileTool::kErase) soot *= 1 - share;
            if (dab.tool == ProfileTool::kSmear)
                goTo(soot, smeared(before.soot), ProfilePaint::kMostSoot);
        }
    }
}

void paintGradient(ProfilePaint& paint, const Gradient& gradient) {
    const bool ofSoot = gradient.plane == ProfilePlane::kSoot;
    Plane& plane = ofSoot ? paint.soot : paint.kelvin;
    const float most = ofSoot ? ProfilePaint::kMostSoot : ProfilePaint::kMostKelvin;
    // A line left of the axis is mirrored to the right.
    const float side = gradient.fromX < 0 || (gradient.fromX == 0 && gradient.toX < 0) ? -1.0f : 1;
    const float fromX = side * gradient.fromX;
    const float wayX = (side * gradient.toX - fromX) * gradient.aspect;
    const float wayY = gradient.toY - gradient.fromY;
    const float length2 = wayX * wayX + wayY * wayY;
    if (!(length2 > 0)) return;
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            const size_t texel = texelOf(x, y);
            if (paint.kelvin[texel] <= 0 && paint.soot[texel] <= 0) continue;
            const float atX = (float(x) + 0.5f - fromX) * gradient.aspect;
            const float atY = float(y) + 0.5f - gradient.fromY;
            const float along = std::clamp((atX * wayX + atY * wayY) / length2, 0.0f, 1.0f);
            const float wanted = std::lerp(gradient.fromValue, gradient.toValue, along);
            plane[texel] =
                std::clamp(std::lerp(plane[texel], wanted, gradient.strength), 0.0f, most);
        }
    }
}

}  // namespace fwedit
