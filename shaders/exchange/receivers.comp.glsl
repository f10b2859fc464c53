// Receivers of this exchange and their 64 strongest sources, found by halving. One thread per
// object slot.
#include "lib/compute.glsl"
FW_READ(OBJECTS) FW_READ(EXCHANGE_OBJECTS) FW_READ(SOURCES) FW_READ(NEIGHBOURS)
FW_READ_WRITE(COUNTERS) FW_READ_WRITE(OBJECT_COUNTERS) FW_WRITE(RECEIVERS) FW_PUSH(ExchangePush)
#include "lib/lists.glsl"
#define FW_PASS_GIVES
#include "shared/exchange_pass.h"

// Runs a statement for each source that may act on `slot`: at `source`, with a neighbour's `entry`
// and a `weight`.
#define FW_EACH_SOURCE(statement)                                                              \
    for (uint n = 0u; n < exchangeObjects[slot].neighbourCount; ++n) {                         \
        uint entry = neighbours[exchangeObjects[slot].neighbourFirst + n];                     \
        uint from = entry & 0xFFFFFFu;                                                         \
        if (entry >> 24u == 0u || !gives(from, slot)) continue;                                \
        uint source = exchangeObjects[from].sourceBase;                                        \
        for (uint end = source + exchangeObjects[from].sourceCount; source < end; ++source) {  \
            uint weight = sourceWeight(sources[source], middle);                               \
            if (weight == 0u) continue;                                                        \
            statement                                                                          \
        }                                                                                      \
    }

// Counts the object's sources by the highest bit of their weight.
uint weightBits[32];
uint countSources(uint slot, ivec3 middle) {
    uint count = 0u;
    FW_EACH_SOURCE(weightBits[findMSB(weight)] += 1u; ++count;)
    return count;
}

void listSource(uint slot, uint place, uint source, uint entry) {
    if (place < kSourcesPerReceiver)
        receivers[slot * kReceiverWords + 2u + place] = source | (entry & 0xFF000000u);
}
// Lists sources of weight >= low, of which there are `strong`, then those of at least half of it,
// up to the capacity. Returns the number of listed sources.
uint listSources(uint slot, ivec3 middle, uint low, uint strong) {
    uint listed = 0u, weak = strong;
    FW_EACH_SOURCE(if (weight >= low / 2u)
                       listSource(slot, weight >= low ? listed++ : weak++, source, entry);)
    return min(weak, kSourcesPerReceiver);
}

void gather(uint slot) {
    uint at = atomicAdd(counters[kRowExchange].runCount, 1u);
    FW_COVER(kRowExchange, run, at, 1u)
    receivers[at * kReceiverWords] = slot;
    ivec3 middle = boxMiddle(exchangeObjects[slot]);
    FW_UNROLL for (int bit = 0; bit < 32; ++bit) weightBits[bit] = 0u;
    uint count = countSources(slot, middle);
    // Least power of two above which few enough sources lie.
    uint least = 0u;
    while (count > kSourcesPerReceiver) {
        count -= weightBits[least];
        ++least;
    }
    receivers[slot * kReceiverWords + 1u] = listSources(slot, middle, 1u << least, count);
}

void main() {
    uint slot = gl_GlobalInvocationID.x;
    if (slot >= push.count) return;
    for (bool warm = objectCounters[slot].until >= push.now; warm; warm = false)
        if ((exchangeObjects[slot].flags & kExchangeLive) != 0u &&
            (objects[slot].flags & kObjectHeat) != 0u) {
            objectCounters[slot].held |= kHeldWarm;
            gather(slot);
        }
}
