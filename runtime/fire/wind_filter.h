// Low pass for wind on its way to a slow front: without it a gust that lasts a hundredth of a link
// time would move the whole front, because the least arrival is kept. Integers; one per material of
// an object. Not a wind model.
#pragma once
#include <array>
#include <cstdint>

namespace fw::fire {

using WindVector = std::array<int32_t, 3>;  // 1/128 m/s

constexpr uint32_t kWindLatchTicks = 1024;  // latches are at least 1/4 s apart
constexpr float kWindUnit = 1.0f / 128.0f;  // m/s
constexpr float kMostWind = 120;            // m/s along an axis, of any wind
constexpr int32_t kMostWindUnits = int32_t(kMostWind / kWindUnit);

struct WindFilter {
    std::array<int64_t, 3> value{};  // 1/128 m/s with 24 more bits
    WindVector latched{};            // what the front sees

    template <class A>
    void serialize(A& a) {
        a(value, latched);
        a.range("filtered wind", value, -kMostWindUnits * 16777216.0 - 1,
                kMostWindUnits * 16777216.0 + 1);
        a.range("latched wind", latched, -kMostWindUnits, kMostWindUnits);
    }
};

// m/s, |component| <= kMostWind, to units; not a number becomes 0.
WindVector windUnits(const float wind[3]) noexcept;

// As if `wind` had blown for ever.
void resetWind(WindFilter& filter, const WindVector& wind) noexcept;
// One step of 1/32 s. tauTicks: the material's link time (see linkTicks), ticks.
void filterWind(WindFilter& filter, const WindVector& wind, uint32_t tauTicks) noexcept;
// True, and `latched` is new, if the filtered wind is another one by a unit or more.
bool latchWind(WindFilter& filter) noexcept;
// Would a step and a latch leave it exactly as it is?
bool windAtRest(const WindFilter& filter, const WindVector& wind, uint32_t tauTicks) noexcept;
// What latchWind would latch.
WindVector filteredWind(const WindFilter& filter) noexcept;

}  // namespace fw::fire
