// The world as every system may read it: rules, clock, frame and origin. The world alone writes it.
#pragma once
#include "core/error.h"
#include "core/log.h"
#include "gpu/backend.h"
#include "world/clock.h"
#include "world/event_queue.h"

#include <array>
#include <memory_resource>

namespace fw::world {

class Recorder;
struct Object;

// Moves of the world's origin. Readbacks of earlier frames speak of the places before a move.
struct OriginShifts {
    struct Shift {
        uint64_t frame = 0;  // the last one before it
        double by[3] = {};   // m
    };
    double moved[3] = {};            // m that all places moved since the world's beginning
    std::array<Shift, 8> pending{};  // of which readbacks are still on their way, oldest first
    uint32_t count = 0;              // of `pending`

    void add(const double (&by)[3], uint64_t lastFrame) noexcept;
    void forgetBefore(uint64_t readbackFrame) noexcept;
    // From where the readback of a frame saw it to where it is now.
    void movePlace(float (&place)[3], uint64_t frame) const noexcept;
    [[nodiscard]] bool movedAfter(uint64_t frame) const noexcept {
        return count > 0 && pending[count - 1].frame == frame;
    }
};

// A frame of the host's that is planned, and committed once the backend ran it.
struct HostFrame {
    uint64_t index = 0;
    float seconds = 0;
    uint64_t begin = 0;  // tick
    ClockAdvance time;
    [[nodiscard]] uint64_t end() const noexcept { return time.after.tick; }
};

// Throws where no more things fit.
template <class Pool>
void checkRoom(const Pool& pool, uint32_t most, const char* names) {
    if (pool.live() >= most)
        core::refuse("%u %s are there; the limit is %u.", pool.live(), names, most);
}

inline void setFlag(uint32_t& flags, uint32_t flag, bool on) noexcept {
    flags = (flags & ~flag) | (on ? flag : 0u);
}

struct WorldContext {
    std::pmr::memory_resource* memory;
    gpu::Backend& backend;
    const core::Log& log;
    FwWorldDef def;
    EventQueue& events;
    Recorder& recorder;  // of the host's commands

    Clock clock;
    OriginShifts origin;
    uint64_t lastFrame = 0;
    uint64_t frames = 0;                           // since the world's beginning
    uint64_t readbackFrame = 0, readbackTick = 0;  // of the last readback
    uint32_t switches = 0;                         // FwDebugSwitches
    uint64_t loadedFrame = 0;                      // readbacks up to this frame are of another past
    uint64_t loadedTick = ~0ull;                   // of the save that was loaded last

    // Queues an event. `object` null: it is the world's own.
    void raise(uint32_t type, const Object* object, uint32_t tag, uint64_t frameIndex,
               const float position[3], float value, FwBurnableMeshId other = {}) const noexcept;
};

}  // namespace fw::world
