// Gusts: how much stronger or weaker it blows here and now than on the whole. Value noise of two
// sizes on a lattice that drifts with the wind: a pure function of hashes and the clock, in whole
// numbers. Not turbulence: its direction stays.
#pragma once
#include "components/wind_zone.h"

namespace fw::components {

struct Gusts {
    int64_t strength = 0;  // Q14 of the wind; 0: none
    int64_t size = 0;      // mm
    // The lattice's drift up to `since`, 1/128 m/s * ticks, and from there on with the wind.
    std::array<int64_t, 3> drift{};
    uint32_t since = 0;  // tick
    bool operator==(const Gusts&) const = default;

    template <class A>
    void serialize(A& a) {
        a(strength, size, drift, since);
    }
};

// Throws core::Error naming the field. Its drift is the one that it had.
[[nodiscard]] Gusts makeGusts(const FwGustDef& def, const Gusts& before);

// Is it one that makeGusts may have made, by this tick?
[[nodiscard]] bool plausible(const Gusts& gusts, uint64_t tick) noexcept;

// From `tick` on another wind will blow than `wind`, which did until then.
void windChanges(Gusts& gusts, const fire::WindVector& wind, uint64_t tick) noexcept;

// They go along with a world whose places all move by whole metres.
void moveGusts(Gusts& gusts, const double by[3]) noexcept;

// `here`, as gusts have it at a place; `wind`: with which they drift. The same for a quarter of a
// second, as fronts hear of wind no more often.
[[nodiscard]] fire::WindVector gustOf(const Gusts& gusts, uint32_t seed,
                                      const fire::WindVector& wind, const fire::WindVector& here,
                                      const WindPlace& place, uint64_t tick) noexcept;

}  // namespace fw::components
