// Rooms, before a heat step: oxygen consumption, ventilation, burning strength of each object, and
// flashover. One group: sums per room use shared memory, in any order.
#include "lib/compute.glsl"
#include "shared/room.h"
FW_READ(OBJECTS) FW_READ(ROOMS) FW_READ_WRITE(OBJECT_COUNTERS) FW_READ_WRITE(ROOM_AIR)
FW_PUSH(StepPush)

shared uint ofRoom[kMaxRooms];  // J drawn in each room, then its burning strength

uint roomOf(uint slot) {  // plus 1
    uint flags = objects[slot].flags;
    return (flags & kObjectLive) != 0u ? (flags >> kObjectRoomShift) & 0xFFu : 0u;
}

void main() {
    uint thread = gl_LocalInvocationID.x;
    ofRoom[thread] = 0u;
    barrier();
    for (uint slot = thread; slot < push.count; slot += kMaxRooms) {
        uint room = roomOf(slot);
        if (room == 0u) continue;
        uint low = objectCounters[slot].energyLow, high = objectCounters[slot].energyHigh;
        uint drawnLow = objectCounters[slot].drawnLow, drawnHigh = objectCounters[slot].drawnHigh;
        // It has entered the room: earlier heat does not count.
        if ((objectCounters[slot].air & kAirKnown) == 0u) {
            drawnLow = low;
            drawnHigh = high;
        }
        uint joules = takeWholeJoules(low, high, drawnLow, drawnHigh);
        objectCounters[slot].drawnLow = drawnLow;
        objectCounters[slot].drawnHigh = drawnHigh;
        if (joules != 0u) atomicAdd(ofRoom[room - 1u], joules);
    }
    barrier();
    RoomAir air = roomAir[thread];
    stepRoomAir(air, rooms[thread], ofRoom[thread], push.now);
    roomAir[thread] = air;
    ofRoom[thread] = burnStrengthOfOxygen(air.oxygen);
    barrier();
    for (uint slot = thread; slot < push.count; slot += kMaxRooms) {
        uint room = roomOf(slot);
        objectCounters[slot].air = room != 0u ? ofRoom[room - 1u] | kAirKnown : 0u;
    }
}
