// Removes embers whose path an occluder box or the heat-occlusion grid crosses. One thread per
// object slot.
#include "lib/compute.glsl"
FW_READ(OBJECTS) FW_READ(OBJECT_COUNTERS) FW_READ(EXCHANGE_OBJECTS) FW_READ(EXCHANGE_TILES)
FW_READ(HEAT_OCCLUDERS) FW_READ_WRITE(SOURCES) FW_PUSH(ExchangePush)
#include "lib/occlusion.glsl"
#define FW_PASS_EMBERS
#define FW_PASS_EMBER_PATHS
#include "shared/exchange_pass.h"
#include "lib/ember.glsl"

void main() { FW_EACH_EMBER(if (isEmberStopped(sources[at])) sources[at].ember = 0u;) }
