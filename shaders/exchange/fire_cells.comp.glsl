// Sums burning tiles into the fire sources of their objects, in any order. 64 of the tiles found by
// `reduce` per group.
#include "lib/compute.glsl"
FW_READ(COUNTERS) FW_READ(OBJECTS) FW_READ(BURN_TILES) FW_READ(EXCHANGE_OBJECTS)
FW_READ(EXCHANGE_TILES) FW_READ_WRITE(SOURCES) FW_PUSH(ExchangePush)

#define FW_PASS_FIRE_CELLS
#include "shared/exchange_pass.h"

void main() { FW_STRIDE(counters[kRowBurn + push.burnParity].runCount, sumTile) }
