#include "components/room.h"

#include "components/pose.h"
#include "core/assert.h"
#include "core/error.h"

#include <algorithm>
#include <cmath>

namespace fw::components {
namespace {

constexpr double kQ14 = 16384;
constexpr double kWholeAir = 4294967296.0;  // of RoomAir::oxygen
constexpr float kFarthestRoom = 1e6f;       // m
constexpr float kMaxHalf = 1000, kMinHalf = 0.05f;
constexpr float kMaxVolume = 1e6f, kMinVolume = 0.1f;  // m^3
constexpr float kMaxVent = 1e4f;                       // m^3/s
constexpr uint32_t kKnownRoomFlags = FW_ROOM_REFILL;
// m^3 of oxygen per J of fire: 13.1 MJ/kg (Huggett), 1.330 kg/m^3 at 293 K.
constexpr double kOxygenPerJoule = 1 / (13.1e6 * 1.330);
constexpr double kPeriod = double(gpu::kRoomPeriod) / gpu::kTicksPerSecond;  // s

}  // namespace

Room makeRoom(const FwRoomDef& def) {
    if ((def.flags & ~kKnownRoomFlags) != 0 || def.reserved != 0)
        core::refuse(
            "FwRoomDef::flags is 0x%x and reserved is %u; the known flags are 0x%x, and "
            "reserved is zero.",
            def.flags, def.reserved, kKnownRoomFlags);
    checkLengths(def.position, 3, "FwRoomDef::position", -kFarthestRoom, kFarthestRoom);
    checkRotation(def.rotation, "FwRoomDef::rotation");
    checkLengths(def.halfSize, 3, "FwRoomDef::halfSize", kMinHalf, kMaxHalf);
    checkValue(def.volume, "FwRoomDef::volume", 0, kMaxVolume);
    checkValue(def.vent, "FwRoomDef::vent", 0, kMaxVent);
    checkValue(def.oxygen, "FwRoomDef::oxygen", 0, 1);
    const double box =
        8.0 * double(def.halfSize[0]) * double(def.halfSize[1]) * double(def.halfSize[2]);
    const double volume = def.volume != 0 ? double(def.volume) : box;
    if (!(volume >= double(kMinVolume) && volume <= double(kMaxVolume)))
        core::refuse("FwRoomDef::volume is %g m^3 and its box has %g; the limits are [%g, %g].",
                     double(def.volume), box, double(kMinVolume), double(kMaxVolume));
    const double x = double(def.rotation[0]), y = double(def.rotation[1]),
                 z = double(def.rotation[2]), w = double(def.rotation[3]);
    const double axes[9] = {
        1 - 2 * (y * y + z * z), 2 * (x * y + w * z),     2 * (x * z - w * y),
        2 * (x * y - w * z),     1 - 2 * (x * x + z * z), 2 * (y * z + w * x),
        2 * (x * z + w * y),     2 * (y * z - w * x),     1 - 2 * (x * x + y * y)};
    Room room;
    for (size_t i = 0; i < 3; ++i) {
        room.middle[i] = millimetres(double(def.position[i]));
        room.half[i] = std::llround(double(def.halfSize[i]) * 1000);
    }
    for (size_t i = 0; i < 9; ++i) room.axes[i] = std::llround(axes[i] * kQ14);
    room.volume = uint64_t(std::llround(volume * 1000));
    room.vent = uint64_t(std::llround(double(def.vent) * 1e6));
    room.oxygen = uint32_t(std::min(double(def.oxygen) * kWholeAir, kWholeAir - 1));
    return room;
}

bool Room::plausible() const noexcept {
    const auto within = [](int64_t value, double low, double high) {
        return double(value) >= low && double(value) <= high;
    };
    const double far = double(kFarthestRoom) * 1000;
    bool fine = within(int64_t(volume), double(kMinVolume) * 1000, double(kMaxVolume) * 1000);
    fine &= within(int64_t(vent), 0, double(kMaxVent) * 1e6);
    for (size_t i = 0; i < 3; ++i)
        fine &= within(middle[i], -far, far) &&
                within(half[i], double(kMinHalf) * 1000, double(kMaxHalf) * 1000);
    for (const int64_t axis : axes) fine &= within(axis, -1.01 * kQ14, 1.01 * kQ14);
    return fine;
}

bool isIn(const Room& room, const WindPlace& place) noexcept {
    FW_ASSERT(room.half[0] > 0 && room.half[1] > 0 && room.half[2] > 0);
    const int64_t off[3] = {place.x - room.middle[0], place.y - room.middle[1],
                            place.z - room.middle[2]};
    // No room reaches as far; the products below fit 64 bits.
    const auto far = int64_t(kMaxHalf) * 2000;
    for (const int64_t value : off)
        if (std::abs(value) > far) return false;
    for (size_t i = 0; i < 3; ++i) {
        const int64_t* axis = room.axes.data() + 3 * i;
        const int64_t along = off[0] * axis[0] + off[1] * axis[1] + off[2] * axis[2];
        if (std::abs(along) > room.half[i] * int64_t(kQ14)) return false;
    }
    return true;
}

// Thomas (1981): 7.8 kW for each m^2 of walls, floor and ceiling, and 378 kW for each m^2.5 of
// A sqrt(h) of the opening, through which 0.4 m^3/s enter (Kawagoe; see FwRoomDef::vent).
uint64_t Room::flashPower() const noexcept {
    const auto a = uint64_t(half[0]), b = uint64_t(half[1]), c = uint64_t(half[2]);
    const uint64_t walls = 8 * (a * b + b * c + c * a);  // mm^2
    return walls * 78 / 10000 + vent * 945 / 1000;
}

gpu::Room roomRecord(const Room& room, float pace, const gpu::RoomAir& begins) noexcept {
    const double volume = double(room.volume) / 1000;
    FW_ASSERT(room.volume > 0 && pace > 0, "%g m^3, pace %g", volume, double(pace));
    FW_ASSERT(room.volume > 0, "a room without air");
    // An implicit step: stable for any vent.
    const double changes = double(room.vent) / 1e6 / volume * kPeriod * double(pace);
    gpu::Room record{};
    record.takes = uint32_t(std::llround(kOxygenPerJoule * kWholeAir * 1048576 / volume));
    record.mixes = uint32_t(std::min(changes / (1 + changes) * kWholeAir, kWholeAir - 1));
    record.starts = begins.oxygen;
    record.epoch = begins.epoch;
    record.power = begins.power;
    record.flash = begins.flash;
    // Powers beyond the range of the mean never occur.
    const double flashes = double(room.flashPower()) * kPeriod * double(pace);
    if (flashes <= double(gpu::kMaxFlash))
        record.flashes = std::max(uint32_t(std::llround(flashes)), 1u);
    return record;
}

}  // namespace fw::components
