// Particle fields through the C ABI on the cpu backend: counts, motion, walls, fixed ticks,
// refusals.
#include "abi/fire_world.h"

#include <gmock/gmock.h>

#include <cmath>
#include <vector>

namespace {

using host::created;
using host::FireWorld;
using host::getState;
using host::lastMessage;
using ::testing::HasSubstr;

struct FieldWorld : FireWorld {
    using FireWorld::FireWorld;
    FwParticleFieldId add(const FwParticleFieldDef& def) {
        return created(fwWorld_CreateParticleField, world, def);
    }
    FwParticleFieldState of(FwParticleFieldId id) {
        const FwParticleFieldState state = getState(fwWorld_GetParticleFieldState, world, id);
        EXPECT_EQ(state.emitted, state.inside + state.dead + state.out);
        return state;
    }
};

FwParticleFieldDef presetOf(uint32_t preset) {
    FwParticleFieldDef def = fwDefaultParticleFieldDef();
    EXPECT_EQ(FW_OK, fwInitFieldPreset(&def, preset));
    return def;
}

TEST(ParticleField, PresetsCountTheirParticles) {
    FieldWorld w;
    for (uint32_t preset = 0; preset < FW_FIELD_PRESET_COUNT; ++preset)
        for (const uint32_t shape : {FW_FIELD_BILLBOARD, FW_FIELD_SPHEROID}) {
            FwParticleFieldDef def = presetOf(preset);
            def.shape = shape;
            def.userData = preset + 70;
            const FwParticleFieldId id = w.add(def);
            EXPECT_EQ(0u, w.of(id).emitted);
            w.run(2);
            const FwParticleFieldState state = w.of(id);
            EXPECT_EQ(48u, state.steps);
            EXPECT_EQ(preset + 70, state.userData);
            EXPECT_GT(state.inside, 1000u) << fwFieldPresetName(preset);
            EXPECT_GT(state.dead, 0u);
            EXPECT_GT(state.bytes, 64u * 64 * 8);
            EXPECT_EQ(FW_OK, fwWorld_DestroyParticleField(w.world, id));
        }
    EXPECT_STREQ("fire", fwFieldPresetName(FW_FIELD_FIRE));
    EXPECT_NE(nullptr, fwFieldPresetName(99));
    FwParticleFieldDef def = fwDefaultParticleFieldDef();
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwInitFieldPreset(&def, FW_FIELD_PRESET_COUNT));
}

// Frames of any length run the same steps at the same ticks.
TEST(ParticleField, StepsDependOnTicksAlone) {
    FwParticleFieldState ends[2];
    for (int way = 0; way < 2; ++way) {
        FieldWorld w(2);
        FwParticleFieldDef def = presetOf(FW_FIELD_SMOKE);
        def.stepRate = 30;
        def.seed = 4;
        const FwParticleFieldId id = w.add(def);
        for (int i = 0; i < (way ? 192 : 24); ++i)
            ASSERT_EQ(FW_OK, fwWorld_Step(w.world, way ? 1.0f / 64 : 1.0f / 8));
        ends[way] = w.of(id);
    }
    EXPECT_EQ(90u, ends[0].steps);
    EXPECT_EQ(ends[0].steps, ends[1].steps);
    EXPECT_EQ(ends[0].inside, ends[1].inside);
    EXPECT_EQ(ends[0].dead, ends[1].dead);
    EXPECT_EQ(ends[0].out, ends[1].out);
}

TEST(ParticleField, RefusesTheReservedFlag) {
    FieldWorld w;
    FwParticleFieldDef def = presetOf(FW_FIELD_FIRE);
    def.flags = 2;
    FwParticleFieldId id{};
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_CreateParticleField(w.world, &def, &id));
    EXPECT_NE(std::string::npos, lastMessage(w.world).find("FW_FIELD_AS_PUBLISHED is not in"));
}

TEST(ParticleField, FollowsSourcesWindAndWalls) {
    FieldWorld still, windy(8);
    FwParticleFieldDef def = presetOf(FW_FIELD_SMOKE);
    def.seed = 9;
    const FwParticleFieldId a = still.add(def), b = windy.add(def);
    still.run(4);
    windy.run(4);
    EXPECT_GT(windy.of(b).out, still.of(a).out + 1000) << "blown over the border";
    // Turned by a quarter, the same wind misses the opening.
    def.rotation[1] = def.rotation[3] = std::sqrt(0.5f);
    const FwParticleFieldId turned = windy.add(def);
    windy.run(4);
    EXPECT_LT(windy.of(turned).out, windy.of(b).out / 2);

    EXPECT_EQ(FW_OK, fwWorld_SetParticleFieldAmount(still.world, a, 0));
    const uint64_t emitted = still.of(a).emitted;
    still.run(1);
    EXPECT_EQ(emitted, still.of(a).emitted);

    // Half the source strength emits the same count.
    def = presetOf(FW_FIELD_SMOKE);
    def.source = FW_FIELD_SOURCE_PAINTED;
    const FwParticleFieldId painted = still.add(def);
    std::vector<uint8_t> paint(64 * 64), walls(64 * 64);
    still.run(1);
    EXPECT_EQ(0u, still.of(painted).emitted);
    for (int x = 20; x < 40; ++x) paint[5 * 64 + size_t(x)] = 255;
    EXPECT_EQ(FW_OK, fwWorld_PaintParticleField(still.world, painted, paint.data(), nullptr));
    still.run(1);
    const uint64_t full = still.of(painted).emitted;
    EXPECT_NEAR(double(full), 20 * 24 * 0.6 * 255 / 12, 0.02 * double(full));
    for (uint8_t& p : paint) p /= 2;
    EXPECT_EQ(FW_OK, fwWorld_PaintParticleField(still.world, painted, paint.data(), nullptr));
    still.run(1);
    EXPECT_NEAR(double(still.of(painted).emitted - full), 0.5 * double(full), 0.02 * double(full));
    // Walls everywhere: no particle is left.
    std::fill(walls.begin(), walls.end(), uint8_t(1));
    EXPECT_EQ(FW_OK, fwWorld_PaintParticleField(still.world, painted, nullptr, walls.data()));
    still.run(0.1f);
    EXPECT_EQ(0u, still.of(painted).inside);
    EXPECT_EQ(still.of(painted).emitted, still.of(painted).dead);

    // A disc source in a box.
    def = presetOf(FW_FIELD_SMOKE);
    def.source = FW_FIELD_SOURCE_DISC;
    def.open = 0;
    const FwParticleFieldId boxed = still.add(def);
    still.run(3);
    EXPECT_EQ(0u, still.of(boxed).out);
    EXPECT_GT(still.of(boxed).inside, 1000u);
}

TEST(ParticleField, RefusesInvalidDefsByName) {
    FieldWorld w;
    const auto said = [&](const FwParticleFieldDef& def) {
        FwParticleFieldId id{};
        EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_CreateParticleField(w.world, &def, &id));
        return lastMessage(w.world);
    };
    FwParticleFieldDef def = fwDefaultParticleFieldDef();
    def.width = 300;
    EXPECT_THAT(said(def), HasSubstr("FwParticleFieldDef::width is 300; the limits are [32, 256]"));
    def.width = 34;
    EXPECT_THAT(said(def), HasSubstr("FwParticleFieldDef::width is 34; it is a multiple of 4"));
    def = fwDefaultParticleFieldDef();
    def.stepRate = 60;
    EXPECT_THAT(said(def), HasSubstr("stepRate is 60; the limits are [20, 30]"));
    def = fwDefaultParticleFieldDef();
    def.rotation[3] = 0.5f;
    EXPECT_THAT(said(def), HasSubstr("rotation has length 0.5"));
    def = fwDefaultParticleFieldDef();
    def.flags = 64;
    EXPECT_THAT(said(def), HasSubstr("flags is 0x40"));
    const FwParticleFieldId id = w.add(fwDefaultParticleFieldDef());
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_SetParticleFieldAmount(w.world, id, -1));
    const float nan[3] = {0, std::nanf(""), 0};
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_MoveParticleField(w.world, id, nan, nullptr));
    EXPECT_THAT(lastMessage(w.world), HasSubstr("position[1]"));
    EXPECT_EQ(FW_OK, fwWorld_DestroyParticleField(w.world, id));
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_SetParticleFieldHidden(w.world, id, 1));
    EXPECT_THAT(lastMessage(w.world), HasSubstr("Particle field 1"));
}

TEST(ParticleField, AllowsAtMost256) {
    FieldWorld w;
    FwParticleFieldDef def = fwDefaultParticleFieldDef();
    def.width = def.height = 32;
    std::vector<FwParticleFieldId> ids;
    for (int i = 0; i < 256; ++i) ids.push_back(w.add(def));
    FwParticleFieldId more{};
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_CreateParticleField(w.world, &def, &more));
    EXPECT_THAT(lastMessage(w.world), HasSubstr("256 particle fields are there; the limit is 256"));
    w.run(0.1f);
    EXPECT_GT(w.of(ids[255]).emitted, 0u);
    EXPECT_EQ(FW_OK, fwWorld_DestroyParticleField(w.world, ids[7]));
    EXPECT_EQ(FW_OK, fwWorld_CreateParticleField(w.world, &def, &more));
    EXPECT_EQ(0u, w.of(more).emitted) << "it is a new field";
    w.run(0.1f);
    EXPECT_LT(w.of(more).emitted, w.of(ids[255]).emitted);
}

}  // namespace
