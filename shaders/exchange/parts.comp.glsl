// Fire between parts of one mesh, over gaps of a few centimetres. 64 of the tiles found by `reduce`
// per group.
#include "lib/light.glsl"
#include "lib/tile.glsl"
FW_READ(BURN_TILES) FW_READ(EXCHANGE_TILES) FW_READ(MATERIALS)
#define FW_PASS_PARTS
#include "shared/exchange_pass.h"

void main() { FW_STRIDE(counters[kRowBurn + push.burnParity].runCount, lightParts) }
