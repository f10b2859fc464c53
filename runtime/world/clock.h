// Host time to simulation steps without drift: a frame's time is summed as an integer of 2^-44 s.
#pragma once
#include "core/assert.h"
#include "shared/burn.h"

#include <cstdint>

namespace fw::world {

struct Clock {
    static constexpr int kFractionBits = 44;
    static constexpr uint64_t kStepUnits = uint64_t(1) << (kFractionBits - 5);  // 1/32 s
    // Ticks end well before the codes of a texel's state: 1048560 s, twelve days of fire.
    static constexpr uint64_t kLastTick = 0xFFFF0000u;
    static constexpr uint64_t kWarnTick = kLastTick - uint64_t(86400) * 4096;  // a day before

    uint64_t tick = 0;      // of the next step's start; a multiple of gpu::kStepTicks
    uint64_t fraction = 0;  // host time past `tick`, 2^-44 s, below kStepUnits

    template <class A>
    void serialize(A& a) {
        a(tick, fraction);
        a.range("tick", tick, 0, double(kLastTick));
        a.range("part of a step", fraction, 0, double(kStepUnits - 1));
        a.require(tick % gpu::kStepTicks == 0, "tick");
    }

    // Tick that the host's present falls on.
    [[nodiscard]] uint64_t hostTick() const noexcept {
        return tick + (fraction >> (kFractionBits - 12));
    }
};

struct ClockAdvance {
    uint32_t steps = 0;    // to run
    uint32_t dropped = 0;  // due, but beyond the limit
    Clock after;
};

// deltaTime: s, [0, 10], checked by the caller.
inline ClockAdvance advance(const Clock& clock, float deltaTime, uint32_t maxSteps) noexcept {
    FW_ASSERT(
        clock.fraction < Clock::kStepUnits && clock.tick % gpu::kStepTicks == 0 && deltaTime >= 0,
        "%g s", double(deltaTime));
    ClockAdvance result;
    result.after = clock;
    const double units = double(deltaTime) * double(uint64_t(1) << Clock::kFractionBits);
    const uint64_t total = clock.fraction + uint64_t(units);
    uint64_t due = total / Clock::kStepUnits;
    result.after.fraction = total % Clock::kStepUnits;
    if (due > maxSteps) {
        result.dropped = uint32_t(due - maxSteps);
        due = maxSteps;
    }
    const uint64_t left =
        clock.tick >= Clock::kLastTick ? 0 : (Clock::kLastTick - clock.tick) / gpu::kStepTicks;
    result.steps = uint32_t(due < left ? due : left);
    result.after.tick = clock.tick + uint64_t(result.steps) * gpu::kStepTicks;
    return result;
}

// Heat steps and reductions take a step each of four, so that none has the work of both.
constexpr uint32_t kReduceEvery = 4;  // steps
constexpr uint32_t kReducePhase = 3;  // as exchanges, which come with it
constexpr uint32_t kHeatPhase = 1;
static_assert(kHeatPhase < gpu::kHeatSteps && kReducePhase < kReduceEvery);
constexpr bool reducesAt(uint64_t tick) noexcept {
    return tick / gpu::kStepTicks % kReduceEvery == kReducePhase;
}
// When flames were counted last, by then.
constexpr uint64_t lastReduced(uint64_t tick) noexcept {
    constexpr uint64_t kPeriod = uint64_t(kReduceEvery) * gpu::kStepTicks;
    constexpr uint64_t kFirst = uint64_t(kReducePhase + 1) * gpu::kStepTicks;
    return tick < kFirst ? 0 : (tick - kFirst) / kPeriod * kPeriod + kFirst;
}
constexpr bool heatsAt(uint64_t tick) noexcept {
    return tick / gpu::kStepTicks % gpu::kHeatSteps == kHeatPhase;
}
// How many heat steps began before that tick.
constexpr uint64_t heatStepsBefore(uint64_t tick) noexcept {
    return (tick / gpu::kStepTicks + gpu::kHeatSteps - 1 - kHeatPhase) / gpu::kHeatSteps;
}

}  // namespace fw::world
