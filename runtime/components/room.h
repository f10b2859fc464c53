// A room: its box, and the rates at which fires use its air and vents renew it. Integers once the
// def is read, so that fire starves equally on every machine. The backend keeps the air's state
// (shared/room.h).
#pragma once
#include "components/wind_zone.h"
#include "shared/room.h"

namespace fw::components {

struct Room {
    std::array<int64_t, 3> middle{};                     // mm
    std::array<int64_t, 3> half{};                       // mm, half of its sides
    std::array<int64_t, 9> axes{};                       // rows: its axes in the world, Q14
    uint64_t volume = 0;                                 // litres of air
    uint64_t vent = 0;                                   // ml/s of outside air
    uint32_t oxygen = 0;                                 // at the start, 2^-32 of the air
    [[nodiscard]] uint64_t flashPower() const noexcept;  // W of flashover
    bool operator==(const Room&) const = default;

    template <class A>
    void serialize(A& a) {
        a(middle, half, axes, volume, vent, oxygen);
        a.require(plausible(), "room");
    }
    [[nodiscard]] bool plausible() const noexcept;  // makeRoom may have made it
};

// Throws core::Error naming the field.
[[nodiscard]] Room makeRoom(const FwRoomDef& def);

[[nodiscard]] bool isIn(const Room& room, const WindPlace& place) noexcept;

// The backend's record, at the world's pace. `begins`: the air at the start of its epoch.
[[nodiscard]] gpu::Room roomRecord(const Room& room, float pace,
                                   const gpu::RoomAir& begins) noexcept;

}  // namespace fw::components
