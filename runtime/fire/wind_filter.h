// Low pass of the wind for a slow front. Without it, a gust that lasts a hundredth of a link time
// would move the whole front, because the front keeps the least arrival. Integers; one per material
// of an object.
#pragma once
#include <array>
#include <cstdint>

namespace fw::fire {

using WindVector = std::array<int32_t, 3>;  // 1/128 m/s

constexpr uint32_t kWindLatchTicks = 1024;  // latches are at least 1/4 s apart
constexpr float kWindUnit = 1.0f / 128.0f;  // m/s
constexpr float kMaxWind = 120;             // m/s along an axis, of any wind
constexpr int32_t kMaxWindUnits = int32_t(kMaxWind / kWindUnit);

struct WindFilter {
    std::array<int64_t, 3> value{};  // 1/128 m/s with 24 more bits
    WindVector latched{};            // the front's wind

    template <class A>
    void serialize(A& a) {
        a(value, latched);
        a.range("filtered wind", value, -kMaxWindUnits * 16777216.0 - 1,
                kMaxWindUnits * 16777216.0 + 1);
        a.range("latched wind", latched, -kMaxWindUnits, kMaxWindUnits);
    }
};

// m/s to units, clamped to +-kMaxWind; NaN becomes 0.
WindVector windUnits(const float wind[3]) noexcept;

// Sets the filter as if `wind` had always blown.
void resetWind(WindFilter& filter, const WindVector& wind) noexcept;
// One step of 1/32 s. tauTicks: the material's link time (see linkTicks), ticks.
void filterWind(WindFilter& filter, const WindVector& wind, uint32_t tauTicks) noexcept;
// Latches the filtered wind. True: it differs by a unit or more.
bool latchWind(WindFilter& filter) noexcept;
// Whether a step and a latch would change nothing.
bool isWindSteady(const WindFilter& filter, const WindVector& wind, uint32_t tauTicks) noexcept;
// The wind that latchWind would latch.
WindVector filteredWind(const WindFilter& filter) noexcept;

}  // namespace fw::fire
