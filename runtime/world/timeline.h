// A burn's past, within a number of bytes: keyframes, which are saves that the world makes of
// itself now and then, and the host's commands since the first of them. The world can go back to
// any tick of it.
#pragma once
#include "world/command_log.h"

namespace fw::world {

struct Keyframe {
    uint64_t tick = 0;
    size_t commands = 0;  // of the timeline's, that are in its save
    std::pmr::vector<std::byte> save;
};

struct Timeline {
    explicit Timeline(std::pmr::memory_resource* memory) : keyframes(memory), commands(memory) {}
    std::pmr::vector<Keyframe> keyframes;  // by tick
    CommandLog commands;                   // from the first keyframe on
    size_t applied = 0;                    // of these, that are in the world as it is
    size_t captured = 0;                   // that are in the keyframe under way
    uint64_t most = 0;                     // bytes
    uint64_t apart = 0, farthest = 0;      // ticks from one keyframe to the next: now, and at most
    uint64_t end = 0;                      // tick that the burn has come to
    uint64_t granted = 0;                  // tick that it may be played to again
    bool seeks = false;                    // commands are the timeline's own

    [[nodiscard]] uint64_t bytes() const noexcept;
    // Removes keyframes until the rest fits: every second one while those left are near enough to
    // each other, then the oldest. The last one stays.
    void fit() noexcept;
    // Another future begins: `now` is the burn's end.
    void forget(uint64_t now) noexcept;
    // Another past altogether.
    void restart(uint64_t now) noexcept;
};

}  // namespace fw::world
