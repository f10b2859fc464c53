// Arrival predictions on a device equal those of the cpu backend, some frames later.
#include "support/own_world.h"

namespace fw::test {
namespace {

class Arrival : public OwnDevice {
 protected:
    struct Asked {
        FwWorld* world = nullptr;
        FwBurnableMeshId object{};
    };

    static Asked sheet(FwContext* context) {
        Asked made;
        FwWorldDef worldDef = fwDefaultWorldDef();
        worldDef.paceFactor = 10;
        worldDef.wind[0] = 1;
        worldDef.maxFlames = 0;
        EXPECT_EQ(fwCreateWorld(context, &worldDef, &made.world), FW_OK);
        const Mesh plane = makePlane(1, 0.5);
        FwMeshDef mesh = meshDefOf(plane);
        mesh.texelsPerMetre = 64;
        made.object = addBurnable(made.world, mesh, fwDefaultMaterialDef());
        FwIgnitionDef match = fwDefaultIgnitionDef();
        match.position[0] = 0.2f;
        match.position[1] = 0.25f;
        match.radius = 0.03f;
        EXPECT_EQ(fwWorld_Ignite(made.world, &match, nullptr), FW_OK);
        return made;
    }
    // World time (s) at which it will catch; kind.
    static std::pair<double, uint32_t> predict(const Asked& asked, float x, float y, int& frames) {
        const float point[3] = {x, y, 0};
        FwQueryId query{};
        EXPECT_EQ(fwWorld_RequestArrival(asked.world, asked.object, point, &query), FW_OK);
        FwArrivalState state{};
        state.structSize = sizeof state;
        FwResult result = FW_NOT_READY;
        for (frames = 0; frames < 200; ++frames) {
            result = fwWorld_FetchArrival(asked.world, query, &state);
            if (result != FW_NOT_READY) break;
            EXPECT_EQ(fwWorld_Step(asked.world, 1.0f / 32), FW_OK);
        }
        EXPECT_EQ(result, FW_OK);
        FwWorldStats stats{};
        stats.structSize = sizeof stats;
        EXPECT_EQ(fwWorld_GetStats(asked.world, &stats), FW_OK);
        return {double(stats.tick) / 4096 + double(state.seconds), state.kind};
    }
};

TEST_F(Arrival, BothBackendsAgree) {
    FwContextDef cpuDef = fwDefaultContextDef();
    cpuDef.backend = FW_BACKEND_CPU;
    FwContext* cpu = nullptr;
    ASSERT_EQ(fwCreateContext(&cpuDef, &cpu, nullptr), FW_OK);
    const Asked worlds[] = {sheet(context_), sheet(cpu)};
    const auto run = [&](float seconds) {
        for (const Asked& asked : worlds)
            for (float t = 0; t < seconds; t += 1.0f / 32)
                ASSERT_EQ(fwWorld_Step(asked.world, 1.0f / 32), FW_OK);
    };
    const auto compare = [&](float x, float y, uint32_t kind) {
        int frames[2];
        const auto onDevice = predict(worlds[0], x, y, frames[0]);
        const auto without = predict(worlds[1], x, y, frames[1]);
        EXPECT_EQ(onDevice.second, kind) << x << ' ' << y;
        EXPECT_EQ(without.second, kind) << x << ' ' << y;
        // Queried at other times, but about the same fire.
        if (kind != FW_ARRIVAL_NEVER) {
            EXPECT_NEAR(onDevice.first, without.first, 0.002) << x << ' ' << y;
        }
        EXPECT_LE(frames[0], 40);
        EXPECT_LE(frames[1], 40);
    };
    run(1);
    compare(0.5f, 0.25f, FW_ARRIVAL_AHEAD);
    compare(0.9f, 0.4f, FW_ARRIVAL_AHEAD);
    compare(0.2f, 0.25f, FW_ARRIVAL_PAST);
    for (const Asked& asked : worlds)
        for (float y = 0; y < 0.52f; y += 0.02f) {
            FwIgnitionDef water = fwDefaultIgnitionDef();
            water.kind = FW_WET;
            water.position[0] = 0.6f;
            water.position[1] = y;
            water.radius = 0.05f;
            ASSERT_EQ(fwWorld_Ignite(asked.world, &water, nullptr), FW_OK);
        }
    compare(0.9f, 0.4f, FW_ARRIVAL_NEVER);
    compare(0.4f, 0.1f, FW_ARRIVAL_AHEAD);
    fwDestroyContext(cpu);
}

}  // namespace
}  // namespace fw::test
