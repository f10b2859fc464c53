// A burn's own past, so that the world can be at any moment of it again: saves that the world makes
// of itself now and then, and what the host did since the first of them. Within a number of bytes.
#pragma once
#include "world/deed_log.h"

namespace fw::world {

struct Moment {
    uint64_t tick = 0;
    size_t deeds = 0;  // of the timeline's, that are in its save
    std::pmr::vector<std::byte> save;
};

struct Timeline {
    explicit Timeline(std::pmr::memory_resource* memory) : moments(memory), deeds(memory) {}
    std::pmr::vector<Moment> moments;  // by tick
    DeedLog deeds;                     // of the host, from the first moment on
    size_t done = 0;                   // of these, that are in the world as it is
    size_t captured = 0;               // that are in the moment on its way
    uint64_t most = 0;                 // bytes
    uint64_t apart = 0, farthest = 0;  // ticks from one moment to the next: now, and at most
    uint64_t end = 0;                  // tick that the burn has come to
    uint64_t granted = 0;              // tick that it may be played to again
    bool seeks = false;                // what is done now is the timeline's own

    [[nodiscard]] uint64_t bytes() const noexcept;
    // Takes moments out until the rest fits: every second one while those left are near enough to
    // each other, then the oldest. The last one stays.
    void fit() noexcept;
    // From here on something else happens: `now` is the burn's end.
    void forget(uint64_t now) noexcept;
    // Another past altogether.
    void restart(uint64_t now) noexcept;
};

}  // namespace fw::world
