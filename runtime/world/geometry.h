// Ids, places and distances as systems compare them.
#pragma once
#include "components/pose.h"
#include "mesh/burn_domain.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace fw::world {

template <class Id>
[[nodiscard]] bool same(const Id& a, const Id& b) noexcept {
    return a.index1 == b.index1 && a.generation == b.generation;
}

[[nodiscard]] inline float squaredDistance(const float a[3], const float b[3]) noexcept {
    float sum = 0;
    for (int i = 0; i < 3; ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
    return sum;
}

// Of the three axes of an object, world per object space.
[[nodiscard]] inline float shortestAxis(const components::Pose& pose) noexcept {
    return pose.scale * std::min({std::abs(pose.stretch[0]), pose.stretch[1], pose.stretch[2]});
}
[[nodiscard]] inline float longestAxis(const components::Pose& pose) noexcept {
    return pose.scale * std::max({std::abs(pose.stretch[0]), pose.stretch[1], pose.stretch[2]});
}

// Returns the entry of an object in a short list, or a free entry; null if the list is full.
template <class Touch, size_t N, class Id>
[[nodiscard]] Touch* touchOf(std::array<Touch, N>& touches, const Id& object) noexcept {
    Touch* free = nullptr;
    for (Touch& one : touches) {
        if (same(one.object, object)) return &one;
        if (!free && one.object.index1 == 0) free = &one;
    }
    return free;
}

// Of what an exchange sees: all are unseen before it, and what stayed so goes after it.
template <class Touches>
void beginTouches(Touches& touches) noexcept {
    for (auto& one : touches) one.seen = false;
}
template <class Touches>
void endTouches(Touches& touches) noexcept {
    for (auto& one : touches)
        if (!one.seen) one.object = {};
}
template <class Entries, class Id>
void forgetIn(Entries& entries, const Id& object) noexcept {  // an object that goes
    for (auto& one : entries)
        if (one.object.index1 == object.index1) one = {};
}

// m, object space: a texel at rest, and the middle of a mesh's box.
inline void restPlace(const mesh::BurnDomain& domain, uint32_t texel, float (&out)[3]) noexcept {
    FW_ASSERT(texel < domain.texels.size(), "texel %u of %zu", texel, domain.texels.size());
    const mesh::TexelPosition& p = domain.texels[texel];
    const uint16_t units[3] = {p.x, p.y, p.z};
    for (int i = 0; i < 3; ++i) out[i] = domain.origin[i] + domain.quantum * float(units[i]);
}
inline void middleOf(const mesh::BurnDomain& domain, float (&out)[3]) noexcept {
    for (int i = 0; i < 3; ++i) out[i] = 0.5f * (domain.boundsLow[i] + domain.boundsHigh[i]);
}

}  // namespace fw::world
