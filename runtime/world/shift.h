// Helpers of systems whose places move with the world's origin. Offsets are whole metres, so that
// places counted in millimetres, and grids of a metre, move exactly.
#pragma once
#include "components/pose.h"
#include "core/error.h"
#include "gpu/backend.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <type_traits>

namespace fw::world {

constexpr double kFar = 1e6;  // m: of every place

template <class Place>
inline void moveBy(Place& place, const double (&by)[3]) noexcept {
    for (int i = 0; i < 3; ++i)
        place[i] = std::remove_reference_t<decltype(place[i])>(double(place[i]) + by[i]);
}
// Where something was: its owner may be elsewhere by now, and this leaves the limits of space.
template <class Place>
inline void movePast(Place& place, const double (&by)[3]) noexcept {
    for (int i = 0; i < 3; ++i) {
        auto& metres = place[i];
        metres = std::remove_reference_t<decltype(metres)>(std::clamp(
            double(metres) + by[i], -components::kFarthestPlace, components::kFarthestPlace));
    }
}
inline void movePast(int& millimetres, double metres) noexcept {
    constexpr double kMost = components::kFarthestPlace * 1000;
    millimetres = int(std::clamp(double(millimetres) + metres * 1000, -kMost, kMost));
}
// Wraps where a load goes to an origin so far off that only its save has places there.
template <class Whole>
inline void moveBy(std::array<Whole, 3>& place, const double (&by)[3]) noexcept {
    using Wraps = std::make_unsigned_t<Whole>;
    for (size_t i = 0; i < 3; ++i) place[i] = Whole(Wraps(place[i]) + Wraps(int64_t(by[i] * 1000)));
}
template <class Place>
void checkMoved(const Place& place, const double (&by)[3], const char* what, uint32_t slot) {
    for (int i = 0; i < 3; ++i)
        if (const double moved = double(place[i]) + by[i]; !(std::abs(moved) <= kFar))
            core::refuse("offset[%d] is " FW_LENGTH " " FW_LENGTH_UNIT
                         " and would put %s %u at " FW_LENGTH " " FW_LENGTH_UNIT
                         "; places lie within +-" FW_LENGTH " " FW_LENGTH_UNIT
                         ". Move or destroy it first.",
                         i, by[i], what, slot + 1, moved, kFar);
}
template <class Whole>
void checkMoved(const std::array<Whole, 3>& place, const double (&by)[3], const char* what,
                uint32_t slot) {
    double metres[3];
    for (size_t i = 0; i < 3; ++i) metres[i] = double(place[i]) / 1000;
    checkMoved(metres, by, what, slot);
}

}  // namespace fw::world
