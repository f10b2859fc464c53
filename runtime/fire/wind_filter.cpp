#include "fire/wind_filter.h"

#include "core/assert.h"
#include "shared/burn.h"

#include <algorithm>
#include <cmath>

namespace fw::fire {
namespace {

constexpr int kFractionBits = 24;

}  // namespace

WindVector windUnits(const float wind[3]) noexcept {
    WindVector units{};
    for (size_t i = 0; i < 3; ++i) {
        if (std::isnan(wind[i])) continue;
        units[i] = int32_t(std::lround(std::clamp(wind[i], -kMaxWind, kMaxWind) / kWindUnit));
    }
    return units;
}

void resetWind(WindFilter& filter, const WindVector& wind) noexcept {
    for (size_t i = 0; i < 3; ++i) {
        FW_ASSERT(wind[i] >= -kMaxWindUnits && wind[i] <= kMaxWindUnits, "%d units", wind[i]);
        filter.value[i] = int64_t(wind[i]) << kFractionBits;
    }
    filter.latched = wind;
}

void filterWind(WindFilter& filter, const WindVector& wind, uint32_t tauTicks) noexcept {
    const int64_t tau = std::max<int64_t>(tauTicks, gpu::kStepTicks);
    for (size_t i = 0; i < 3; ++i) {
        FW_ASSERT(wind[i] >= -kMaxWindUnits && wind[i] <= kMaxWindUnits, "%d units", wind[i]);
        const int64_t gap = (int64_t(wind[i]) << kFractionBits) - filter.value[i];
        filter.value[i] += gap * int64_t(gpu::kStepTicks) / tau;
    }
}

WindVector filteredWind(const WindFilter& filter) noexcept {
    WindVector wind;
    for (size_t i = 0; i < 3; ++i)
        wind[i] = int32_t((filter.value[i] + (int64_t(1) << (kFractionBits - 1))) >> kFractionBits);
    return wind;
}

bool latchWind(WindFilter& filter) noexcept {
    const WindVector wind = filteredWind(filter);
    FW_ASSERT(std::abs(wind[0]) <= kMaxWindUnits && std::abs(wind[1]) <= kMaxWindUnits &&
                  std::abs(wind[2]) <= kMaxWindUnits,
              "%d, %d, %d units", wind[0], wind[1], wind[2]);
    if (wind == filter.latched) return false;
    filter.latched = wind;
    return true;
}

bool isWindSteady(const WindFilter& filter, const WindVector& wind, uint32_t tauTicks) noexcept {
    WindFilter next = filter;
    filterWind(next, wind, tauTicks);
    return next.value == filter.value && filteredWind(filter) == filter.latched;
}

}  // namespace fw::fire
