// Heat from sources to the tiles of the objects that they may heat, an eighth of the tiles per
// exchange. One group per receiver, one thread per tile. FW_HEAT_OCCLUSION: with a heat-occlusion
// grid; a variant, as a software device executes loop bodies once even without active lanes.
#include "lib/compute.glsl"
FW_READ(OBJECTS) FW_READ(EXCHANGE_OBJECTS) FW_READ(EXCHANGE_TILES) FW_READ(SOURCES)
FW_READ(RECEIVERS) FW_READ(HEAT_OCCLUDERS) FW_READ_WRITE(COUNTERS) FW_READ_WRITE(OBJECT_COUNTERS)
FW_READ_WRITE(TILE_STATE) FW_READ_WRITE(TILE_HEAT) FW_PUSH(ExchangePush)
#include "lib/hot_list.glsl"
#define FW_PASS_EXCHANGE
#ifdef FW_HEAT_OCCLUSION
#include "lib/occlusion.glsl"
#endif
#include "shared/exchange_pass.h"

void main() {
    uint count = counters[kRowExchange].runCount;
    uint turn = (push.now / kExchangeTicks) % kExchangeRounds;
    for (uint g = gl_WorkGroupID.x; g < count; g += gl_NumWorkGroups.x) {
        uint slot = receivers[g * kReceiverWords];
        for (uint local = turn + gl_LocalInvocationID.x * kExchangeRounds;
             local < objects[slot].tileCount; local += 64u * kExchangeRounds)
            warmTile(slot, local);
    }
}
