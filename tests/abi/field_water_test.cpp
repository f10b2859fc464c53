// Water of particle fields on the cpu backend: it wets what it touches and puts it out, at ticks
// independent of the frame rate.
#include "abi/panels.h"

namespace {

using host::created;
using host::getState;
using host::lastMessage;
using host::Panels;

// A wooden panel of 2 x 1 m stands across z; water falls along it.
struct Fountain : Panels {
    Fountain() : Panels(fwDefaultWorldDef(), 60) {}
    FwBurnableMeshId panel(float x, bool heat = true) {
        FwBurnableMeshDef made = def(0, 0, 0);
        made.flags = FW_BURNABLE_TWO_SIDED | (heat ? 0u : uint32_t(FW_BURNABLE_LITE));
        constexpr float kScale = 5;
        const float turned[16] = {kScale, 0, 0, 0, 0, 0, -kScale, 0, 0, kScale, 0, 0, x, 0, 0, 1};
        std::copy(std::begin(turned), std::end(turned), made.transform);
        return add(made);
    }
    FwParticleFieldId water(float x, uint32_t flags = FW_FIELD_WETS) {
        FwParticleFieldDef made = fwDefaultParticleFieldDef();
        EXPECT_EQ(FW_OK, fwInitFieldPreset(&made, FW_FIELD_WATER));
        made.flags = flags;
        made.seed = 7;
        made.position[0] = x + 1;
        made.size[0] = 2.2f;
        made.size[1] = 1.4f;
        made.sourceSize = 1;
        made.width = made.height = 32;
        return created(fwWorld_CreateParticleField, world, made);
    }
    FwPointState at(size_t i, float x, float y) {
        FwQueryId query{};
        const float there[3] = {x, y, 0};
        EXPECT_EQ(FW_OK, fwWorld_RequestPoint(world, ids[i], there, &query));
        return getState(fwWorld_FetchPoint, world, query);
    }
    uint32_t burning(size_t i) { return state(ids[i]).burning; }
};

TEST(FieldWater, ExtinguishesOnlyWhereItHits) {
    Fountain w;
    w.panel(0);
    w.panel(6);
    for (size_t i = 0; i < 2; ++i) w.ignite(w.ids[i], i ? 7.0f : 1.0f, 0.5f, 0, 0.4f);
    w.run(1);
    const uint32_t before = w.burning(0);
    ASSERT_LT(20u, before);
    w.water(0);
    w.run(12);
    EXPECT_EQ(0u, w.burning(0));
    EXPECT_LT(50, w.at(0, 0.5f, 0.5f).water);
    EXPECT_LT(before, w.burning(1));
    EXPECT_EQ(0, w.at(1, 6.5f, 0.5f).water);
}

// Wet surfaces do not catch. Without the flag the water is cosmetic.
TEST(FieldWater, WetSurfacesDoNotCatch) {
    for (const bool heat : {true, false}) {
        for (const bool wets : {true, false}) {
            Fountain w;
            w.panel(0, heat);
            w.water(0, wets ? uint32_t(FW_FIELD_WETS) : 0u);
            w.run(6);
            w.ignite(w.ids[0], 1, 0.5f, 0, 0.2f);
            w.run(2);
            EXPECT_EQ(wets, w.burning(0) == 0) << heat;
        }
    }
}

TEST(FieldWater, WettingIsIndependentOfTheFrameRate) {
    std::vector<uint64_t> hashes;
    for (const float dt : {1 / 64.0f, 1 / 32.0f, 1 / 16.0f, 1 / 8.0f}) {
        Fountain w;
        w.panel(0);
        w.ignite(w.ids[0], 1, 0.5f, 0, 0.3f);
        w.water(0);
        w.run(4, dt);
        hashes.push_back(w.hash());
    }
    for (const uint64_t hash : hashes) EXPECT_EQ(hashes[0], hash);
    Fountain dry;
    dry.panel(0);
    dry.ignite(dry.ids[0], 1, 0.5f, 0, 0.3f);
    dry.run(4);
    EXPECT_NE(hashes[0], dry.hash());
}

}  // namespace
