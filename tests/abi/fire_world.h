// A cpu world for the ABI tests of volumetric fires.
#pragma once
#include "abi/abi_support.h"

namespace host {

struct FireWorld : HostedWorld {
    explicit FireWorld(float windX = 0) : HostedWorld(FW_BACKEND_CPU, windy(windX)) {}
    static FwWorldDef windy(float x) {
        FwWorldDef def = fwDefaultWorldDef();
        def.wind[0] = x;
        return def;
    }
    FwVolumetricFireId make(const FwVolumetricFireDef& def) {
        return created(fwWorld_CreateVolumetricFire, world, def);
    }
    void run(float seconds) {
        for (float t = 0; t < seconds; t += 1.0f / 32)
            ASSERT_EQ(FW_OK, fwWorld_Step(world, 1.0f / 32)) << lastMessage(world);
    }
    FwVolumetricFireState state(FwVolumetricFireId id) {
        return getState(fwWorld_GetVolumetricFireState, world, id);
    }
};

inline FwVolumetricFireDef presetDef(uint32_t preset) {
    FwVolumetricFireDef def = fwDefaultVolumetricFireDef();
    EXPECT_EQ(FW_OK, fwInitFirePreset(&def, preset));
    return def;
}

}  // namespace host
