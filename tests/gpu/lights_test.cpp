// Lights on a device sum to the power of all fires for every count that the host allows.
#include "abi/panels.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using host::getState;
using host::Panels;

class LightsOnDevice : public testing::TestWithParam<bool> {};

// Sheets that burn here and there in a row of 40 m, as one light, few and many.
TEST_P(LightsOnDevice, ConservesPower) {
    for (const uint32_t most : {1u, 4u, 64u}) {
        FwContext* context = nullptr;
        if (GetParam()) {
            FwErrorInfo info{};
            const FwContextDef own = fwDefaultContextDef();
            if (fwCreateContext(&own, &context, &info) != FW_OK) GTEST_SKIP() << info.message;
        }
        FwWorldDef def = fwDefaultWorldDef();
        def.maxLights = most;
        def.paceFactor = 20;
        Panels panels(def, 1000, 64, context);
        std::vector<FwBurnableMeshId> ids;
        for (int i = 0; i < 30; ++i) {
            const float x = 0.3f * float(i * i % 97), z = float(i % 5);
            ids.push_back(panels.add(x, 0, z));
            panels.ignite(ids.back(), x + 0.2f, 0, z + 0.1f, 0.05f);
        }
        panels.run(2);
        // By then each sheet burns completely, so nothing grows while readbacks and filter follow.
        double power = 0;
        for (const FwBurnableMeshId id : ids) {
            const FwObjectState state = getState(fwWorld_GetObjectState, panels.world, id);
            power += double(state.power);
        }
        FwLight lights[64];
        const uint32_t count = fwWorld_GetLights(panels.world, lights, 64);
        EXPECT_LE(count, most);
        EXPECT_GT(count, 0u);
        double shines = 0, intensity = 0;
        for (uint32_t i = 0; i < count; ++i) {
            shines += double(lights[i].power);
            intensity += double(lights[i].intensity);
        }
        EXPECT_NEAR(shines / power, 1, 0.01) << "of " << most;
        EXPECT_GT(intensity, 0.0);
    }
}
INSTANTIATE_TEST_SUITE_P(Backends, LightsOnDevice, testing::Bool(),
                         [](const auto& backend) { return backend.param ? "device" : "cpu"; });

}  // namespace
