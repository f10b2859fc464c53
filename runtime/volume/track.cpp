// Recorded curves, and blends of two curves.
#include "core/assert.h"
#include "core/error.h"
#include "volume/motion.h"

#include <algorithm>
#include <cmath>

namespace fw::volume {

void checkControlPoints(std::span<const ControlPoint> points) {
    if (points.empty() || points.size() > kMaxControlPoints)
        core::refuse("the curve has %zu control points; it needs 1 to %u.", points.size(),
                     kMaxControlPoints);
    for (size_t k = 0; k < points.size(); ++k) {
        const vec3 p = points[k].position;
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
            core::refuse("position of control point %zu is (%g, %g, %g); it must be finite.", k,
                         double(p.x), double(p.y), double(p.z));
        if (!(points[k].radius >= 0.0f && points[k].radius <= 1e4f))
            core::refuse("radius of control point %zu is %g m; it must lie in [0, 1e4].", k,
                         double(points[k].radius));
    }
}

void setTrack(Track& track, std::span<const float> times, std::span<const ControlPoint> points,
              uint32_t pointsPerKey, bool loops) {
    if (times.empty()) core::refuse("the track has no keys; it needs at least 1.");
    if (pointsPerKey == 0 || pointsPerKey > kMaxControlPoints)
        core::refuse("pointsPerKey is %u; it must lie in [1, %u].", pointsPerKey,
                     kMaxControlPoints);
    if (points.size() != times.size() * pointsPerKey)
        core::refuse("the track has %zu points; %zu keys of %u need %zu.", points.size(),
                     times.size(), pointsPerKey, times.size() * pointsPerKey);
    for (size_t k = 0; k < times.size(); ++k) {
        if (!std::isfinite(times[k]) || (k > 0 && times[k] <= times[k - 1]))
            core::refuse(
                "time of key %zu is %g s; times must be finite and increase (before it: %g).", k,
                double(times[k]), double(k > 0 ? times[k - 1] : 0.0f));
        checkControlPoints(points.subspan(k * pointsPerKey, pointsPerKey));
    }
    std::pmr::vector<float> keptTimes(times.begin(), times.end(), track.times.get_allocator());
    std::pmr::vector<ControlPoint> keptPoints(points.begin(), points.end(),
                                              track.points.get_allocator());
    track.times.swap(keptTimes);
    track.points.swap(keptPoints);
    track.pointsPerKey = pointsPerKey;
    track.loops = loops;
}

uint32_t sampleTrack(const Track& track, double time,
                     std::array<ControlPoint, kMaxControlPoints>& points) noexcept {
    const size_t keys = track.times.size();
    if (keys == 0) return 0;
    const double first = double(track.times.front()), last = double(track.times.back());
    double t = std::isfinite(time) ? time : first;
    if (track.loops && last > first)
        t = first + std::fmod(std::fmod(t - first, last - first) + (last - first), last - first);
    t = std::clamp(t, first, last);
    const auto after = std::upper_bound(track.times.begin(), track.times.end(), float(t));
    const size_t k =
        keys < 2
            ? 0
            : std::min(size_t(std::max<ptrdiff_t>(after - track.times.begin() - 1, 0)), keys - 2);
    const float span = keys < 2 ? 1.0f : track.times[k + 1] - track.times[k];
    const float w = keys < 2 ? 0.0f : std::clamp((float(t) - track.times[k]) / span, 0.0f, 1.0f);
    FW_ASSERT(k < keys && track.points.size() == keys * track.pointsPerKey, "key %zu of %zu", k,
              keys);
    const auto key = [&](ptrdiff_t i) {  // a loop's last key equals its first
        const ptrdiff_t n = ptrdiff_t(keys);
        if (track.loops && n > 2) i = i < 0 ? n - 2 : i >= n ? 1 : i;
        return size_t(std::clamp<ptrdiff_t>(i, 0, n - 1));
    };
    const size_t at[4] = {key(ptrdiff_t(k) - 1), key(ptrdiff_t(k)), key(ptrdiff_t(k) + 1),
                          key(ptrdiff_t(k) + 2)};
    for (uint32_t p = 0; p < track.pointsPerKey; ++p) {
        vec4 v[4];
        for (int c = 0; c < 4; ++c) {
            const ControlPoint& q = track.points[at[c] * track.pointsPerKey + p];
            v[c] = vec4(q.position, q.radius);
        }
        const vec4 m =
            v[1] + 0.5f * w *
                       ((v[2] - v[0]) + w * ((2.0f * v[0] - 5.0f * v[1] + 4.0f * v[2] - v[3]) +
                                             w * (3.0f * (v[1] - v[2]) + v[3] - v[0])));
        points[p] = {vec3(m), std::max(m.w, 0.0f)};
    }
    return track.pointsPerKey;
}

uint32_t blendPoints(std::span<const ControlPoint> a, std::span<const ControlPoint> b, float weight,
                     vec3 up, std::array<ControlPoint, kMaxControlPoints>& out) noexcept {
    const auto copy = [&](std::span<const ControlPoint> from) {
        const size_t n = std::min<size_t>(from.size(), kMaxControlPoints);
        std::array<ControlPoint, kMaxControlPoints> kept;
        std::copy_n(from.begin(), n, kept.begin());
        out = kept;
        return uint32_t(n);
    };
    if (weight <= 0.0f || b.empty()) return copy(a);
    if (weight >= 1.0f || a.empty()) return copy(b);
    Curve ca, cb;
    ca.set(a, up);
    cb.set(b, up);
    constexpr uint32_t kPoints = 16;
    FW_ASSERT(std::isfinite(weight), "weight %g", double(weight));
    for (uint32_t k = 0; k < kPoints; ++k) {
        const float u = float(k) / float(kPoints - 1);
        const CurveSample pa = ca.at(u * ca.length()), pb = cb.at(u * cb.length());
        out[k] = {glm::mix(pa.position, pb.position, weight),
                  glm::mix(pa.radius, pb.radius, weight)};
    }
    return kPoints;
}

}  // namespace fw::volume
