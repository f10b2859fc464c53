// Zeroes the per-object counts and fire sources that the next passes sum up.
#include "lib/compute.glsl"
FW_READ(EXCHANGE_OBJECTS) FW_READ_WRITE(OBJECT_COUNTERS) FW_WRITE(SOURCES) FW_PUSH(StepPush)

void main() {
    uint object = gl_GlobalInvocationID.x;
    if (object >= push.count) return;
    uint count =
        objectCounters[object].burningTiles != 0u ? exchangeObjects[object].sourceCount : 0u;
    for (uint i = 0u; i < count; ++i) {
        uint source = exchangeObjects[object].sourceBase + i;
        sources[source].power = 0u;
        sources[source].texels = 0u;
        sources[source].tiles = 0u;
        sources[source].sumX = 0u;
        sources[source].sumY = 0u;
        sources[source].sumZ = 0u;
        sources[source].watts = 0u;
        sources[source].ember = 0u;
    }
    objectCounters[object].burning = 0u;
    objectCounters[object].burningTiles = 0u;
    objectCounters[object].frontTiles = 0u;
}
