// Landing of the remaining embers: whether each lights its target. A thread per object slot handles
// its sources; embers are rare.
#include "lib/light.glsl"
FW_READ(EXCHANGE_TILES) FW_READ(SOURCES)
#include "lib/tile.glsl"
#define FW_PASS_EMBERS
#define FW_PASS_EMBER_LANDINGS
#include "shared/exchange_pass.h"
#include "lib/ember.glsl"

void main() { FW_EACH_EMBER(landEmber(sources[at]);) }
