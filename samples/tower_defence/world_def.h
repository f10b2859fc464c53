// Parameters of the village's world.
#pragma once

#include "flamewright/flamewright.h"

namespace tower {

// pace: time scale relative to real thatch.
inline FwWorldDef villageWorld(uint32_t seed, float pace) {
    FwWorldDef def = fwDefaultWorldDef();
    def.flags = FW_WORLD_RADIATION | FW_WORLD_PLUME | FW_WORLD_CONTACT | FW_WORLD_EMBERS;
    def.paceFactor = pace;
    def.seed = seed;
    return def;
}

}  // namespace tower
