// The air of rooms: what fires take of its oxygen, what comes in from outside, how strongly fire
// burns in what is left, and when a room flashes over. Integers only, one text for C++ and GLSL;
// it loads nothing. Not what a texel makes of it (heat.h).
// GLSL too, and laid out by hand.
// clang-format off
#ifndef FW_SHARED_ROOM_H
#define FW_SHARED_ROOM_H
#include "shared/front.h"

FW_SHARED_BEGIN

FW_SHARED_CONST uint kMaxRooms = 64u;
// Oxygen by volume, 2^-32 of the air.
FW_SHARED_CONST uint kAirOutside = 899795648u;  // 20.95 %
FW_SHARED_CONST uint kAirLeast = 515396076u;    // 12 %: nothing burns in less
FW_SHARED_CONST uint kAirStep = 503316u;        // from there on it burns stronger by 1/256 with each: 3 % to full
FW_SHARED_CONST uint kRoomPeriod = kHeatSteps * kStepTicks;  // of their steps, which come before heat's

struct Room {     // as the host has it
    uint takes;   // of the oxygen, by a J of fire, Q20
    uint mixes;   // part of what it lacks that comes from outside in a period, Q32
    uint starts;  // oxygen that it begins with
    uint epoch;   // which beginning that is; 0: there is no such room
    uint flashes; // J of fire in a period, as a mean, at which it flashes over; 0: it never does
    uint power;   // RoomAir::power and flash that it begins with
    uint flash;
    uint reserved;
};
FW_SHARED_SIZE(Room, 32)

struct RoomAir {  // and what has become of it
    uint oxygen;
    uint epoch;   // as its room's, once it has begun
    uint drawn;   // J of fire in the last period
    uint stirs;   // 1: something of it changed in that
    uint power;   // kRoomMeans - 1 times the mean of what was drawn, over about so many periods
    uint flash;   // how often it has flashed over, times 2; odd: it burns so now
    uint flashTick; // when it last did
    uint reserved;
};
FW_SHARED_SIZE(RoomAir, 32)
FW_SHARED_CONST uint kRoomMeans = 8u;
FW_SHARED_CONST uint kFlashMost = (1u << 28u) - 1u;  // J in a period: the mean's bits hold as much

// Whole J that an object's fire gave off since the last time, when it stood at `drawn`; what is left
// over waits there. Both in 2^-20 J.
FW_SHARED_FN uint energySince(uint low, uint high, FW_INOUT(uint) drawnLow, FW_INOUT(uint) drawnHigh) {
    uint restLow = low - drawnLow;
    uint restHigh = high - drawnHigh - (low < drawnLow ? 1u : 0u);
    uint joules = (restHigh << 12u) | (restLow >> 20u);
    uint part = joules << 20u;
    drawnLow += part;
    drawnHigh += (joules >> 12u) + (drawnLow < part ? 1u : 0u);
    return joules;
}

// A period's part in the mean, which ends at nothing; and whether that is a flashover: told again
// only once it has been half as much.
FW_SHARED_FN void roomFlashes(FW_INOUT(RoomAir) air, FW_IN(Room) room, uint joules, uint now) {
    air.power += (joules < kFlashMost ? joules : kFlashMost);
    air.power -= divide(air.power + kRoomMeans - 1u, kRoomMeans);
    bool over = (air.flash & 1u) != 0u;
    uint most = room.flashes * (kRoomMeans - 1u);
    if (over && (room.flashes == 0u || air.power < most / 2u)) air.flash += 1u;
    if (over || room.flashes == 0u || air.power < most) return;
    air.flash += 1u;
    air.flashTick = now;
}

// One period of a room, up to `now`, in which fires gave off so many J.
FW_SHARED_FN void roomBreathes(FW_INOUT(RoomAir) air, FW_IN(Room) room, uint joules, uint now) {
    if (air.epoch != room.epoch) {  // it begins
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
    roomFlashes(air, room, joules, now);
    air.stirs = joules != 0u || air.oxygen != before || air.power != power ? 1u : 0u;
}

// How strongly fire burns in it, Q8.
FW_SHARED_FN uint roomStrength(uint oxygen) {
    if (oxygen <= kAirLeast) return 0u;
    uint strength = divide(oxygen - kAirLeast, kAirStep);
    return strength < kAirFull ? strength : kAirFull;
}

FW_SHARED_END
#endif
