// Per object: who lit it, whether it may continue, world positions of its sources, and which of
// them send an ember. Wakes the objects that they may heat. One thread per object slot.
#include "lib/compute.glsl"
FW_READ(COUNTERS) FW_READ(EXCHANGE_OBJECTS) FW_READ(NEIGHBOURS) FW_READ_WRITE(OBJECT_COUNTERS)
FW_READ_WRITE(SOURCES) FW_PUSH(ExchangePush)

#define FW_PASS_FIRE_SOURCES
#include "shared/exchange_pass.h"

void main() {
    uint slot = gl_GlobalInvocationID.x;
    if (slot < push.count) settleObject(slot);
}
