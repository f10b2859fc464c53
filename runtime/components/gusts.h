// Gusts: a factor on the wind's speed by place and time; its direction stays. Value noise of two
// sizes on a lattice that drifts with the wind: a pure function of hashes and the clock, in
// integers.
#pragma once
#include "components/wind_zone.h"

namespace fw::components {

struct Gusts {
    int64_t strength = 0;  // Q14 of the wind; 0: none
    int64_t size = 0;      // mm
    // The lattice's drift until `since`, 1/128 m/s * ticks; from then on it drifts with the wind.
    std::array<int64_t, 3> drift{};
    uint32_t since = 0;  // tick
    bool operator==(const Gusts&) const = default;

    template <class A>
    void serialize(A& a) {
        a(strength, size, drift, since);
    }
};

// Throws core::Error naming the field. The drift continues from `before`.
[[nodiscard]] Gusts makeGusts(const FwGustDef& def, const Gusts& before);

// Whether makeGusts may have made it, by this tick.
[[nodiscard]] bool plausible(const Gusts& gusts, uint64_t tick) noexcept;

// Adds the drift of `wind`, which blew until `tick`. Called before the wind changes.
void windChanges(Gusts& gusts, const fire::WindVector& wind, uint64_t tick) noexcept;

// Moves the lattice with a world whose places all move by whole metres.
void moveGusts(Gusts& gusts, const double by[3]) noexcept;

// The wind `here` at a place, with gusts. `wind`: moves the gusts. Constant for a quarter of a
// second: fronts latch wind no more often.
[[nodiscard]] fire::WindVector gustOf(const Gusts& gusts, uint32_t seed,
                                      const fire::WindVector& wind, const fire::WindVector& here,
                                      const WindPlace& place, uint64_t tick) noexcept;

}  // namespace fw::components
