// A cpu world for volumetric fires, as the ABI's tests use it.
#pragma once
#include "abi/abi_support.h"

namespace host {

struct FireWorld {
    Host host;
    FwContext* context = createCpuContext(host);
    FwWorld* world = nullptr;
    explicit FireWorld(float windX = 0) {
        FwWorldDef def = fwDefaultWorldDef();
        def.wind[0] = windX;
        EXPECT_EQ(FW_OK, fwCreateWorld(context, &def, &world));
    }
    FireWorld(const FireWorld&) = delete;
    FireWorld& operator=(const FireWorld&) = delete;
    ~FireWorld() { fwDestroyContext(context); }
    FwVolumetricFireId make(const FwVolumetricFireDef& def) {
        FwVolumetricFireId id{};
        EXPECT_EQ(FW_OK, fwWorld_CreateVolumetricFire(world, &def, &id)) << lastMessage(world);
        return id;
    }
    void run(float seconds) {
        for (float t = 0; t < seconds; t += 1.0f / 32)
            ASSERT_EQ(FW_OK, fwWorld_Step(world, 1.0f / 32)) << lastMessage(world);
    }
    FwVolumetricFireState state(FwVolumetricFireId id) {
        FwVolumetricFireState state{};
        state.structSize = sizeof state;
        EXPECT_EQ(FW_OK, fwWorld_GetVolumetricFireState(world, id, &state)) << lastMessage(world);
        return state;
    }
};

inline FwVolumetricFireDef presetDef(uint32_t preset) {
    FwVolumetricFireDef def = fwDefaultVolumetricFireDef();
    EXPECT_EQ(FW_OK, fwInitFirePreset(&def, preset));
    return def;
}

}  // namespace host
