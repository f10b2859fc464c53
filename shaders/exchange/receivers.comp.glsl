// Receivers of this exchange and their 64 strongest sources, found by halving. One thread per
// object slot.
#include "lib/compute.glsl"
FW_READ(OBJECTS) FW_READ(EXCHANGE_OBJECTS) FW_READ(SOURCES) FW_READ(NEIGHBOURS)
FW_READ_WRITE(COUNTERS) FW_READ_WRITE(OBJECT_COUNTERS) FW_WRITE(RECEIVERS) FW_PUSH(ExchangePush)
#include "lib/lists.glsl"
#define FW_PASS_GIVES
#define FW_PASS_RECEIVERS

void listSource(uint slot, uint place, uint from, uint source, uint entry) {
    if (place < kSourcesPerReceiver)
        receivers[slot * kReceiverWords + 2u + place] = source | (entry & 0xFF000000u);
}

#include "shared/exchange_pass.h"

void main() {
    uint slot = gl_GlobalInvocationID.x;
    if (slot >= push.count) return;
    for (bool warm = objectCounters[slot].until >= push.now; warm; warm = false)
        if ((exchangeObjects[slot].flags & kExchangeLive) != 0u &&
            (objects[slot].flags & kObjectHeat) != 0u) {
            objectCounters[slot].held |= kHeldWarm;
            uint at = atomicAdd(counters[kRowExchange].runCount, 1u);
            FW_COVER(kRowExchange, run, at, 1u)
            receivers[at * kReceiverWords] = slot;
            receivers[slot * kReceiverWords + 1u] = gatherSources(slot);
        }
}
