// Air of rooms: oxygen that fires consume, ventilation, burning strength, and flashover. Integers
// only, for C++ and GLSL; no buffer access. A texel's response is in heat.h.
// clang-format off
#ifndef FW_SHARED_ROOM_H
#define FW_SHARED_ROOM_H
#include "shared/front.h"

FW_SHARED_BEGIN

FW_CONST uint kMaxRooms = 64u;
// Oxygen by volume, 2^-32 of the air.
FW_CONST uint kAirOutside = 899795648u;  // 20.95 %
FW_CONST uint minKAir = 515396076u;    // 12 %: nothing burns below
FW_CONST uint kAirStep = 503316u;  // burning strength grows by 1/256 per step; 3 % to full
// Of room steps, which precede heat steps.
FW_CONST uint kRoomPeriod = kHeatSteps * kStepTicks;

struct Room {     // as the host defines it
    uint takes;   // oxygen consumed per J of fire, Q20
    uint mixes;   // share of the oxygen deficit that flows in per period, Q32
    uint starts;  // oxygen at its start
    uint epoch;   // counts its restarts; 0: no room
    uint flashes; // J per period, mean, at which it flashes over; 0: never
    uint power;   // RoomAir::power and flash at its start
    uint flash;
    uint reserved;
};
FW_SIZE(Room, 32)

struct RoomAir {  // state
    uint oxygen;
    uint epoch;   // as Room::epoch once it has started
    uint drawn;   // J of fire in the last period
    uint stirs;   // 1: it changed in the last period
    uint power;   // kRoomMeans - 1 times the mean heat, over about that many periods
    uint flash;   // twice the number of flashovers; odd: flashed over now
    uint flashTick; // of the last flashover
    uint reserved;
};
FW_SIZE(RoomAir, 32)
FW_CONST uint kRoomMeans = 8u;
FW_CONST uint kMaxFlash = (1u << 28u) - 1u;  // J per period: limit of the mean's bits

// Whole J that an object's fire released since `drawn`; the remainder waits there. Both in 2^-20 J.
FW_FN uint takeWholeJoules(uint low, uint high, FW_INOUT(uint) drawnLow, FW_INOUT(uint) drawnHigh) {
    uint restLow = low - drawnLow;
    uint restHigh = high - drawnHigh - (low < drawnLow ? 1u : 0u);
    uint joules = (restHigh << 12u) | (restLow >> 20u);
    uint part = joules << 20u;
    drawnLow += part;
    drawnHigh += (joules >> 12u) + (drawnLow < part ? 1u : 0u);
    return joules;
}

// Updates the mean and the flashover state. A flashover is reported again only after the mean fell
// to half.
FW_FN void updateFlashover(FW_INOUT(RoomAir) air, FW_IN(Room) room, uint joules, uint now) {
    air.power += (joules < kMaxFlash ? joules : kMaxFlash);
    air.power -= divide(air.power + kRoomMeans - 1u, kRoomMeans);
    bool over = (air.flash & 1u) != 0u;
    uint most = room.flashes * (kRoomMeans - 1u);
    if (over && (room.flashes == 0u || air.power < most / 2u)) air.flash += 1u;
    if (over || room.flashes == 0u || air.power < most) return;
    air.flash += 1u;
    air.flashTick = now;
}

// One period of a room, up to `now`, in which fires gave off so many J.
FW_FN void stepRoomAir(FW_INOUT(RoomAir) air, FW_IN(Room) room, uint joules, uint now) {
    if (air.epoch != room.epoch) {  // it starts
        air.oxygen = room.starts;
        air.power = room.power;
        air.flash = room.flash;
    }
    air.epoch = room.epoch;
    uint before = air.oxygen, power = air.power;
    uint high, low;
    umulExtended(joules, room.takes, high, low);
    uint taken = (high >> 20u) != 0u ? 0xFFFFFFFFu : (high << 12u) | (low >> 20u);
    air.oxygen -= taken < air.oxygen ? taken : air.oxygen;
    bool less = air.oxygen < kAirOutside;
    uint off = less ? kAirOutside - air.oxygen : air.oxygen - kAirOutside;
    uint comes = mulHighRound(off, room.mixes) + (room.mixes != 0u ? 1u : 0u);  // so that it ends
    comes = comes < off ? comes : off;
    air.oxygen = less ? air.oxygen + comes : air.oxygen - comes;
    air.drawn = joules;
    updateFlashover(air, room, joules, now);
    air.stirs = joules != 0u || air.oxygen != before || air.power != power ? 1u : 0u;
}

// Burning strength, Q8.
FW_FN uint burnStrengthOfOxygen(uint oxygen) {
    if (oxygen <= minKAir) return 0u;
    uint strength = divide(oxygen - minKAir, kAirStep);
    return strength < kAirFull ? strength : kAirFull;
}

FW_SHARED_END
#endif
