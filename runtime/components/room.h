// A room of the host's: where it is, and how fires use its air and get it back. Integers once the
// def is read, so that fire starves alike on every machine. Not what has become of its air: that
// is the backend's (shared/room.h).
#pragma once
#include "components/wind_zone.h"
#include "shared/room.h"

namespace fw::components {

struct Room;
// Whether makeRoom may have made it.
[[nodiscard]] bool plausible(const Room& room) noexcept;

struct Room {
    std::array<int64_t, 3> middle{};                     // mm
    std::array<int64_t, 3> half{};                       // mm, half of its sides
    std::array<int64_t, 9> axes{};                       // rows: its axes in the world, Q14
    uint64_t volume = 0;                                 // litres of air
    uint64_t vent = 0;                                   // of it that comes from outside, ml/s
    uint32_t oxygen = 0;                                 // that it is filled with, 2^-32 of the air
    [[nodiscard]] uint64_t flashPower() const noexcept;  // W at which it flashes over
    bool operator==(const Room&) const = default;

    template <class A>
    void serialize(A& a) {
        a(middle, half, axes, volume, vent, oxygen);
        a.require(plausible(*this), "room");
    }
};

// Throws core::Error naming the field.
[[nodiscard]] Room makeRoom(const FwRoomDef& def);

[[nodiscard]] bool isIn(const Room& room, const WindPlace& place) noexcept;

// As backends have it, at that pace. `begins`: the air that its beginning, of that epoch, has.
[[nodiscard]] gpu::Room roomRecord(const Room& room, float pace,
                                   const gpu::RoomAir& begins) noexcept;

}  // namespace fw::components
