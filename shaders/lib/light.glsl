// Ignition of a texel by another object.
#include "lib/compute.glsl"
FW_READ(OBJECTS) FW_READ(TEXELS) FW_READ(EXCHANGE_OBJECTS) FW_READ_WRITE(STATE)
FW_READ_WRITE(TILE_STATE) FW_READ_WRITE(COUNTERS) FW_READ_WRITE(OBJECT_COUNTERS)
FW_PUSH(ExchangePush)
#include "lib/burn_budget.glsl"
#include "lib/change.glsl"
#include "lib/hot_list.glsl"
#define FW_PASS_LIGHT
