// Fire emitters through the C ABI on the cpu backend: state, refusals, and frames without
// allocations.
#include "abi/fire_world.h"
#include "abi/panels.h"

#include <gmock/gmock.h>

#include <array>
#include <vector>

namespace {

using host::created;
using host::FireWorld;
using host::getState;
using host::lastMessage;
using ::testing::HasSubstr;

FwFireEmitterId makeEmitter(FireWorld& w, const FwFireEmitterDef& def) {
    return created(fwWorld_CreateFireEmitter, w.world, def);
}

FwFireEmitterState stateOf(FireWorld& w, FwFireEmitterId id) {
    return getState(fwWorld_GetFireEmitterState, w.world, id);
}

TEST(FireEmitter, BurnsLightsAndBurnsOut) {
    FireWorld w;
    FwFireEmitterDef def = fwDefaultFireEmitterDef();
    def.userData = 77;
    def.position[1] = 1;
    const FwFireEmitterId id = makeEmitter(w, def);
    EXPECT_EQ(0u, stateOf(w, id).particles);
    w.run(4);
    const FwFireEmitterState state = stateOf(w, id);
    EXPECT_EQ(77u, state.userData);
    EXPECT_EQ(60, state.power);
    EXPECT_NEAR(float(state.particles), float(state.capacity), 8.0f);
    EXPECT_GT(state.lightPosition[1], 1.1f);
    FwLight lights[4];
    ASSERT_EQ(1u, fwWorld_GetLights(w.world, lights, 4));
    EXPECT_EQ(0x40000000u, lights[0].id & 0xC0000000u);
    EXPECT_EQ(60000, lights[0].power);
    // 30 % of the power leaves as radiation.
    EXPECT_NEAR(lights[0].intensity, 60000 * 0.3f / 12.566f, 400);
    ASSERT_EQ(FW_OK, fwWorld_SetFireEmitterHidden(w.world, id, 1));
    EXPECT_EQ(0u, fwWorld_GetLights(w.world, lights, 4));
    ASSERT_EQ(FW_OK, fwWorld_SetFireEmitterHidden(w.world, id, 0));
    ASSERT_EQ(FW_OK, fwWorld_SetFireEmitterPower(w.world, id, 0));
    w.run(2 * state.life);
    EXPECT_EQ(0, stateOf(w, id).lightIntensity);
    w.run(8 * state.life);
    EXPECT_EQ(0u, stateOf(w, id).particles);
    EXPECT_EQ(0u, fwWorld_GetLights(w.world, lights, 4));
}

TEST(FireEmitter, RefusesInvalidDefs) {
    FireWorld w;
    FwFireEmitterId id{};
    FwFireEmitterDef def = fwDefaultFireEmitterDef();
    const auto refuses = [&](const char* text) {
        EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_CreateFireEmitter(w.world, &def, &id));
        EXPECT_THAT(lastMessage(w.world), HasSubstr(text));
        def = fwDefaultFireEmitterDef();
    };
    def.flags = 1u << 20;
    refuses("FwFireEmitterDef::flags is 0x100000");
    def.shape = 4;
    refuses("FwFireEmitterDef::shape is 4");
    def.shape = FW_EMITTER_MESH;
    def.flags = FW_EMITTER_JET;
    refuses("FwFireEmitterDef::shape is FW_EMITTER_MESH and FwFireEmitterDef::flags is 0x10");
    def.shape = FW_EMITTER_MESH;
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_CreateFireEmitter(w.world, &def, &id));
    def = fwDefaultFireEmitterDef();
    def.direction[1] = 0;
    refuses("FwFireEmitterDef::direction has length 0");
    def.extent[2] = 200;
    refuses("FwFireEmitterDef::extent[2] is 200");
    def.reserved = 1;
    refuses("FwFireEmitterDef::reserved is 1");
    def.maxParticles = 20000;
    refuses("needs 20000 particles in a row; FwWorldDef::maxParticles is 16384");
    const FwFireEmitterId live = makeEmitter(w, def);
    const float nowhere[3] = {0, 0, 0}, far[3] = {1e9f, 0, 0};
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_MoveFireEmitter(w.world, live, nowhere, nowhere));
    EXPECT_THAT(lastMessage(w.world), HasSubstr("direction has length 0"));
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_MoveFireEmitter(w.world, live, far, nullptr));
    EXPECT_THAT(lastMessage(w.world), HasSubstr("position[0] is 1e+09"));
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_SetFireEmitterPower(w.world, live, -1));
    EXPECT_THAT(lastMessage(w.world), HasSubstr("power is -1"));
    ASSERT_EQ(FW_OK, fwWorld_DestroyFireEmitter(w.world, live));
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_SetFireEmitterPower(w.world, live, 1));
    EXPECT_THAT(lastMessage(w.world), HasSubstr("Fire emitter 1"));
}

// The burning area feeds it: nothing at first, more as more burns, nothing in the end.
TEST(FireEmitter, OnAMeshFollowsTheBurningArea) {
    host::Panels panels(fwDefaultWorldDef(), 6);
    const FwBurnableMeshId sheet = panels.add(0, 0, 0), other = panels.add(3, 0, 0);
    FwFireEmitterDef def = fwDefaultFireEmitterDef();
    def.shape = FW_EMITTER_MESH;
    def.object = sheet;
    def.power = 2;
    def.rate = 400;
    def.life = 0.5f;
    def.smoke = 0;
    const FwFireEmitterId id = created(fwWorld_CreateFireEmitter, panels.world, def);
    const auto alive = [&] {
        return getState(fwWorld_GetFireEmitterState, panels.world, id).particles;
    };
    panels.ignite(other, 3.2f, 0, 0.1f);  // not the emitter's object
    panels.run(1);
    EXPECT_EQ(0u, alive());
    panels.ignite(sheet, 0.2f, 0, 0.1f);
    panels.run(0.5);
    const uint32_t few = alive();
    EXPECT_GT(few, 0u);
    panels.run(2.5);
    EXPECT_GT(alive(), 2 * few);
    FwLight lights[8];
    for (uint32_t i = 0, n = fwWorld_GetLights(panels.world, lights, 8); i < n; ++i)
        EXPECT_NE(0x40000000u, lights[i].id & 0xC0000000u);  // a light of the mesh's own
    panels.run(30);
    EXPECT_EQ(0u, alive());
    ASSERT_EQ(FW_OK, fwWorld_DestroyBurnableMesh(panels.world, sheet));
    panels.run(0.5);
    EXPECT_EQ(0u, alive());
}

TEST(FireEmitter, ReusesSlotsOfDestroyedEmitters) {
    FireWorld w;
    FwFireEmitterDef def = fwDefaultFireEmitterDef();
    def.maxParticles = 4096;
    std::array<FwFireEmitterId, 4> ids{};
    for (FwFireEmitterId& id : ids) id = makeEmitter(w, def);
    FwFireEmitterId more{};
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_CreateFireEmitter(w.world, &def, &more));
    EXPECT_THAT(lastMessage(w.world), HasSubstr("16384 of them are not free"));
    ASSERT_EQ(FW_OK, fwWorld_DestroyFireEmitter(w.world, ids[1]));
    w.run(0.1f);
    (void)makeEmitter(w, def);
    def.maxParticles = 1;
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_CreateFireEmitter(w.world, &def, &more));
    // Up to the limit and not one more.
    for (const FwFireEmitterId id : {ids[0], ids[2], ids[3]})
        ASSERT_EQ(FW_OK, fwWorld_DestroyFireEmitter(w.world, id));
    for (int i = 0; i < 255; ++i) (void)makeEmitter(w, def);
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_CreateFireEmitter(w.world, &def, &more));
    EXPECT_THAT(lastMessage(w.world), HasSubstr("256 fire emitters are there; the limit is 256."));
}

TEST(FireEmitter, FramesAllocateNothing) {
    FireWorld w;
    std::vector<FwFireEmitterId> ids;
    FwFireEmitterDef def = fwDefaultFireEmitterDef();
    for (int i = 0; i < 20; ++i) {
        def.flags = i % 2 ? uint32_t(FW_EMITTER_JET) : 0u;
        def.power = 10.0f + 20.0f * float(i);
        ids.push_back(makeEmitter(w, def));
    }
    w.run(4.0f / 32);
    const int64_t before = w.host.allocations;
    for (int k = 0; k < 20; ++k) {
        const float place[3] = {0.1f * float(k), 0, 0}, way[3] = {1, 0.1f * float(k), 0};
        ASSERT_EQ(FW_OK, fwWorld_MoveFireEmitter(w.world, ids[size_t(k)], place, way));
        ASSERT_EQ(FW_OK,
                  fwWorld_SetFireEmitterPower(w.world, ids[size_t(k)], 100.0f * float(k % 3)));
        w.run(1.0f / 32);
        FwLight lights[64];
        (void)fwWorld_GetLights(w.world, lights, 64);
        (void)stateOf(w, ids[size_t(k)]);
    }
    EXPECT_EQ(before, w.host.allocations);
}

}  // namespace
