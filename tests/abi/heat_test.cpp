// Heat, char and water through the C ABI, on the cpu and on the library's own device, and the
// features that FW_BURNABLE_LITE omits. Without a device the second half skips with a message.
#include "abi/abi_support.h"

#include <array>
#include <cmath>
#include <cstdlib>

namespace {

using host::created;
using host::getState;
using host::lastMessage;
using host::materialOf;

// A sheet of 0.1 m; `all` acts on the whole of it.
class HeatAndWater : public ::testing::TestWithParam<uint32_t> {
 protected:
    void SetUp() override {
        context_ = host::createContext(host_, GetParam());
        if (!context_) GTEST_SKIP() << "no Vulkan device";
    }
    void TearDown() override {
        fwDestroyContext(context_);
        EXPECT_EQ(0, host_.blocks);
    }

    void make(const FwMaterialDef& material, float pace, uint32_t flags = 0, float moisture = 0) {
        FwWorldDef def = fwDefaultWorldDef();
        def.paceFactor = pace;
        ASSERT_EQ(FW_OK, fwCreateWorld(context_, &def, &world_)) << lastMessage(context_);
        const host::Sheet sheet(0.1f, 0.1f);
        const FwMeshId mesh = created(fwWorld_CreateMesh, world_, sheet.def(64));
        mesh_ = mesh;
        const FwMaterialId id = created(fwWorld_CreateMaterial, world_, material);
        FwBurnableMeshDef object = fwDefaultBurnableMeshDef();
        object.mesh = mesh;
        object.materials[0] = id;
        object.flags = flags;
        object.moisture = moisture;
        ASSERT_EQ(FW_OK, fwWorld_CreateBurnableMesh(world_, &object, &object_))
            << lastMessage(world_);
    }
    void all(uint32_t kind, float water = 0) {
        FwIgnitionDef def = fwDefaultIgnitionDef();
        def.kind = kind;
        def.radius = 1;
        def.water = water;
        ASSERT_EQ(FW_OK, fwWorld_Ignite(world_, &def, nullptr)) << lastMessage(world_);
    }
    void run(double seconds) {
        for (double t = 0; t < seconds - 1e-9; t += 0.125)
            ASSERT_EQ(FW_OK, fwWorld_Step(world_, 0.125f)) << lastMessage(world_);
    }
    FwPointState point(float x = 0.05f, float z = 0.05f) {
        const float position[3] = {x, 0, z};
        FwQueryId query{};
        EXPECT_EQ(FW_OK, fwWorld_RequestPoint(world_, object_, position, &query));
        FwPointState made{};
        made.structSize = sizeof made;
        host::come(world_, [&] { return fwWorld_FetchPoint(world_, query, &made); });
        return made;
    }
    // Positions of the map's covered texels; `beside` receives the indices of the others.
    std::vector<std::array<float, 3>> texels(std::vector<uint32_t>* beside = nullptr) {
        uint64_t count = 0;
        EXPECT_EQ(FW_OK, fwDebug_GetTexelPositions(world_, mesh_, nullptr, nullptr, 0, &count));
        std::vector<float> positions(3 * count);
        std::vector<uint32_t> flags(count);
        EXPECT_EQ(FW_OK, fwDebug_GetTexelPositions(world_, mesh_, positions.data(), flags.data(),
                                                   count, &count));
        std::vector<std::array<float, 3>> real;
        for (uint32_t i = 0; i < count; ++i) {
            if (flags[i])
                real.push_back({positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]});
            else if (beside)
                beside->push_back(i);
        }
        return real;
    }
    // Hashes states, heat and water of the whole map.
    uint64_t mapHash() {
        uint64_t hash = 0;
        EXPECT_EQ(FW_OK, fwDebug_RequestBurnMap(world_, object_));
        host::come(world_, [&] {
            return fwDebug_FetchBurnMap(world_, object_, nullptr, 0, nullptr, &hash, nullptr);
        });
        return hash;
    }
    FwObjectState state() { return getState(fwWorld_GetObjectState, world_, object_); }
    FwEnergyLedger book() { return getState(fwWorld_GetEnergyLedger, world_); }
    FwWorldStats stats() { return getState(fwWorld_GetStats, world_); }
    // FwExtinguishCause of the last end of a fire since the last call; 0: burnt out; kNoEnd: none
    // ended.
    static constexpr uint32_t kNoEnd = 77;
    uint32_t endedBy() {
        uint32_t last = kNoEnd;
        FwEvent events[64];
        for (uint32_t i = 0, count = fwWorld_PollEvents(world_, events, 64); i < count; ++i)
            if (events[i].type == FW_EVENT_EXTINGUISHED || events[i].type == FW_EVENT_BURNT_OUT)
                last = events[i].tag;
        return last;
    }
    static FwMaterialDef preset(uint32_t which) { return materialOf(which); }

    host::Host host_;
    FwContext* context_ = nullptr;
    FwWorld* world_ = nullptr;
    FwMeshId mesh_{};
    FwBurnableMeshId object_{};
};

TEST_P(HeatAndWater, CharDepthAfterAnHourMatchesEurocode5) {
    const float limits[2][2] = {{450, 0.65f},
                                {660, 0.50f}};  // kg/m^3, mm/min: EN 1995-1-2:2004, table 3.1
    for (const auto& [density, rate] : limits) {
        FwMaterialDef wood = preset(FW_MATERIAL_PINE);
        wood.density = density;
        wood.thickness = rate * 0.06f;  // m, charred in an hour
        wood.burningFlux = rate / 60000 * density;
        make(wood, 60);
        all(FW_IGNITE);
        run(30);
        const float half = (1 - point().fuel) * wood.thickness * 1000;
        run(30);
        const float whole = (1 - point().fuel) * wood.thickness * 1000;
        std::printf("%.0f kg/m^3: %.1f mm in half an hour, %.1f in one\n", double(density),
                    double(half), double(whole));
        EXPECT_NEAR(rate * 60, whole, 0.1f * rate * 60);
        EXPECT_LT(rate * 30, half);  // char slows it down
        EXPECT_LT(half, whole * 0.75f);
        EXPECT_NEAR(773.0f, point().temperature, 60.0f);
    }
}

TEST_P(HeatAndWater, EnergyLedgerIsExact) {
    for (const uint32_t which : {uint32_t(FW_MATERIAL_PAPER), uint32_t(FW_MATERIAL_PINE)}) {
        const bool pine = which == FW_MATERIAL_PINE;
        make(preset(which), pine ? 20 : 2);
        all(FW_IGNITE);
        for (int part = 0; part < 4; ++part) {
            run(part == 3 ? 90 : 0.25);
            if (part == 1 && pine) all(FW_WET, 3);
            uint64_t units = 0;
            for (const auto& at : texels())
                units += uint64_t(std::lround(65535 * (1 - double(point(at[0], at[2]).fuel))));
            const FwMaterialDef def = preset(which);
            const double fuel = double(def.burnTime > 0 ? def.burningFlux * def.burnTime
                                                        : def.density * def.thickness);  // kg/m^2
            const FwObjectState now = state();
            ASSERT_EQ(texels().size(), now.texels);
            EXPECT_LT(0u, units);
            const double book = now.energy * 1048576;
            EXPECT_EQ(std::floor(book), book);
            EXPECT_EQ(0u, uint64_t(book) % units) << "every unit is worth the same";
            EXPECT_NEAR(
                double(def.heatOfCombustion) * fuel * 0.01 * double(units) / 65535 / now.texels,
                now.energy, 0.01 * now.energy);
            if (part == 3) {
                EXPECT_EQ(now.texels * 65535, units);
                EXPECT_EQ(0u, now.burning);
                EXPECT_EQ(0.0f, now.power);
                EXPECT_EQ(FW_POINT_BURNT, int(point().kind));
            } else {
                EXPECT_EQ(now.texels, now.burning);
                EXPECT_LT(0.0f, now.power);
            }
        }
    }
}

// The overlay's figures add up at every step, and the unburnt share equals the texels' fuel.
TEST_P(HeatAndWater, EnergyLedgerOfAWorldCloses) {
    for (const uint32_t which : {uint32_t(FW_MATERIAL_PAPER), uint32_t(FW_MATERIAL_PINE)}) {
        const bool pine = which == FW_MATERIAL_PINE;
        make(preset(which), pine ? 20 : 2);
        const FwEnergyLedger whole = book();
        EXPECT_EQ(1u, whole.objects);
        EXPECT_LT(0u, whole.fuel);
        EXPECT_EQ(whole.fuel, whole.unburnt);
        EXPECT_EQ(0u, whole.radiated + whole.convected);
        EXPECT_EQ(0u, whole.fuel % (texels().size() * 65535));
        const uint64_t unit = whole.fuel / (texels().size() * 65535);
        all(FW_IGNITE);
        for (int part = 0; part < 4; ++part) {
            run(part == 3 ? 90 : 0.25);
            if (part == 1 && pine) all(FW_WET, 3);
            uint64_t left = 0;
            for (const auto& at : texels())
                left += uint64_t(std::lround(65535 * double(point(at[0], at[2]).fuel)));
            const FwEnergyLedger now = book();
            EXPECT_EQ(whole.fuel, now.fuel);
            EXPECT_EQ(left * unit, now.unburnt);
            EXPECT_EQ(now.fuel, now.unburnt + now.radiated + now.convected);
            const uint64_t released = now.radiated + now.convected;
            EXPECT_EQ(state().energy, double(released) / 1048576);
            EXPECT_NEAR(0.33 * double(released), double(now.radiated), 1);
            if (part == 3) {
                EXPECT_EQ(0u, now.unburnt);
                EXPECT_EQ(0.0f, now.power);
            } else {
                EXPECT_LT(0u, released);
                EXPECT_LT(0.0f, now.power);
                EXPECT_LT(0.0f, now.burningArea);
            }
        }
    }
}

// A LITE object keeps no fuel per texel, so its ledger counts texels that burnt out. It closes at
// every step, never decreases while nothing is extinguished, and ends with nothing unburnt.
TEST_P(HeatAndWater, EnergyLedgerOfALiteObjectCloses) {
    make(preset(FW_MATERIAL_PAPER), 4, FW_BURNABLE_LITE);
    const FwEnergyLedger whole = book();
    EXPECT_EQ(1u, whole.objects);
    EXPECT_EQ(0u, whole.fuel % (texels().size() * 65535)) << "all texels are unburnt";
    EXPECT_LT(0u, whole.fuel);
    EXPECT_EQ(whole.fuel, whole.unburnt);
    FwIgnitionDef match = fwDefaultIgnitionDef();
    match.radius = 0.01f;
    ASSERT_EQ(FW_OK, fwWorld_Ignite(world_, &match, nullptr)) << lastMessage(world_);
    uint64_t unburnt = whole.unburnt;
    int between = 0;
    for (int i = 0; i < 1600 && unburnt > 0; ++i) {
        ASSERT_EQ(FW_OK, fwWorld_Step(world_, 1.0f / 32)) << lastMessage(world_);
        const FwEnergyLedger now = book();
        EXPECT_EQ(whole.fuel, now.fuel);
        EXPECT_EQ(now.fuel, now.unburnt + now.radiated + now.convected);
        EXPECT_LE(now.unburnt, unburnt);
        const double released = double(now.radiated + now.convected);
        EXPECT_EQ(state().energy, released / 1048576);
        EXPECT_LE(released, double(whole.fuel) * double(state().burntFraction) * (1 + 1e-6));
        between += now.unburnt < unburnt ? 1 : 0;
        unburnt = now.unburnt;
    }
    EXPECT_EQ(0u, unburnt);
    EXPECT_LT(5, between) << "it decreases gradually";
    run(1);
    EXPECT_EQ(0.0f, book().power);
}

TEST_P(HeatAndWater, ExtinguishedTexelsOfALiteObjectKeepTheirFuel) {
    make(preset(FW_MATERIAL_PINE), 1, FW_BURNABLE_LITE);
    const FwEnergyLedger whole = book();
    all(FW_IGNITE);
    run(1);
    EXPECT_LT(0.0f, book().power);
    EXPECT_EQ(whole.fuel, book().unburnt) << "nothing has burnt out yet";
    all(FW_EXTINGUISH);
    run(1);
    EXPECT_EQ(0.0f, book().power);
    EXPECT_EQ(whole.fuel, book().unburnt);
}

TEST_P(HeatAndWater, WaterExtinguishesAndMustEvaporateBeforeReignition) {
    make(preset(FW_MATERIAL_COTTON), 1);
    all(FW_IGNITE);
    run(3);
    EXPECT_EQ(FW_POINT_BURNING, int(point().kind));
    EXPECT_LT(600.0f, point().temperature);
    const float before = point().fuel;
    EXPECT_LT(0.3f, before);
    EXPECT_GT(0.95f, before);
    all(FW_WET, 1000);
    run(1);
    FwPointState wet = point();
    EXPECT_EQ(FW_POINT_EXTINGUISHED, int(wet.kind));
    EXPECT_GE(373.2f, wet.temperature);
    EXPECT_LT(200.0f, wet.water);
    EXPECT_GE(400.0f, wet.water) << "the surplus runs off";
    EXPECT_EQ(0u, state().burning);
    EXPECT_NEAR(before, wet.fuel, 0.1f);
    EXPECT_EQ(uint32_t(FW_EXTINGUISHED_BY_WATER), endedBy());
    // Wet texels do not catch.
    all(FW_IGNITE);
    run(1);
    EXPECT_EQ(FW_POINT_EXTINGUISHED, int(point().kind));
    EXPECT_EQ(0u, state().burning);
    all(FW_DRY);
    run(0.5);
    EXPECT_EQ(0.0f, point().water);
    all(FW_IGNITE);
    run(1);
    EXPECT_EQ(FW_POINT_BURNING, int(point().kind));
    EXPECT_GT(wet.fuel, point().fuel) << "it burns its remaining fuel";
    run(6);
    EXPECT_EQ(FW_POINT_BURNT, int(point().kind)) << "it ends earlier than a new fire";
    run(2);
    EXPECT_EQ(0u, endedBy()) << "it burnt out";
}

TEST_P(HeatAndWater, ALittleWaterEvaporates) {
    make(preset(FW_MATERIAL_PINE), 4);
    all(FW_IGNITE);
    run(20);
    all(FW_WET, 5);
    run(1);
    EXPECT_EQ(FW_POINT_BURNING, int(point().kind));
    EXPECT_EQ(0.0f, point().water);
    all(FW_WET);
    run(1);
    EXPECT_EQ(FW_POINT_EXTINGUISHED, int(point().kind));
}

// A steady spray extinguishes wood if it takes more heat than the flame's feedback leaves above the
// losses of a surface at the flaming temperature. A weaker spray does not.
TEST_P(HeatAndWater, SprayAboveTheCriticalRateExtinguishes) {
    constexpr double kSigma = 5.67e-8, kAmbient = 293, kLatent = 2.26e6;
    constexpr float kPace = 8;  // a spray every second of burn time
    const FwMaterialDef wood = preset(FW_MATERIAL_PINE);
    const double dies = double(wood.ignitionTemperature) - 50;
    const double loses =
        0.9 * kSigma * (std::pow(dies, 4) - std::pow(kAmbient, 4)) + 15 * (dies - kAmbient);
    const double critical = 1000 * (double(wood.flameFeedback) - loses) / kLatent;  // g/m^2/s
    for (const double part : {0.7, 1.3}) {
        make(wood, kPace);
        all(FW_IGNITE);
        run(20);
        ASSERT_EQ(FW_POINT_BURNING, int(point().kind));
        double fed = 0, given = 0;  // g/m^2; events take whole grams
        for (int i = 0; i < 200 && state().burning > 0; ++i) {
            fed += critical * part * 0.125 * double(kPace);
            all(FW_WET, float(std::floor(fed - given)));
            given += std::floor(fed - given);
            run(0.125);
        }
        const FwPointState after = point();
        std::printf("spray of %.1f g/m^2/s, %.2f of the critical rate: %s, %.0f K\n",
                    critical * part, part, state().burning ? "burns" : "out",
                    double(after.temperature));
        EXPECT_EQ(part > 1 ? FW_POINT_EXTINGUISHED : FW_POINT_BURNING, int(after.kind));
        EXPECT_EQ(part > 1, state().burning == 0);
    }
}

TEST_P(HeatAndWater, WetSurfacesDryInAir) {
    FwMaterialDef paper = preset(FW_MATERIAL_PAPER);
    make(paper, 100);
    all(FW_WET, 60);
    run(10);
    const float water = point().water;
    EXPECT_EQ(FW_POINT_WET, int(point().kind));
    EXPECT_LT(0.0f, water);
    EXPECT_GT(59.0f, water);
    EXPECT_LT(0u, stats().hotTiles);
    run(20);
    EXPECT_EQ(FW_POINT_UNBURNT, int(point().kind));
    EXPECT_EQ(0.0f, point().water);
    EXPECT_EQ(0u, stats().hotTiles);
    const uint64_t steps = stats().steps;
    run(4);
    EXPECT_EQ(steps, stats().steps) << "a dry, cold world is idle";
    all(FW_IGNITE);
    run(0.5);
    EXPECT_EQ(state().texels, state().ignited);
}

TEST_P(HeatAndWater, DampSurfacesDoNotCatch) {
    FwMaterialDef paper = preset(FW_MATERIAL_PAPER);
    make(paper, 1, 0, 0.5f);
    EXPECT_LT(30u, state().texels) << "it catches once dry";
    all(FW_IGNITE);
    run(1);
    EXPECT_EQ(0u, state().ignited);
    EXPECT_EQ(FW_POINT_WET, int(point().kind));
}

// Water in such a texel would never dry and would keep its tile awake.
TEST_P(HeatAndWater, EventsOfUncoveredTexelsChangeNothing) {
    make(preset(FW_MATERIAL_PAPER), 1);
    std::vector<uint32_t> beside;
    EXPECT_FALSE(texels(&beside).empty());
    ASSERT_FALSE(beside.empty());
    run(0.25);
    const uint64_t before = mapHash();
    for (const uint32_t kind : {FW_WET, FW_IGNITE, FW_EXTINGUISH, FW_DRY}) {
        EXPECT_EQ(FW_OK, fwDebug_PushTexels(world_, object_, kind, beside.data(),
                                            uint32_t(beside.size())));
        run(0.5);
        EXPECT_EQ(0u, stats().hotTiles) << kind;
        EXPECT_EQ(before, mapHash()) << kind;
    }
}

TEST_P(HeatAndWater, GoesOutWithoutHeatFeedback) {
    for (const float feedback : {25000.0f, 4000.0f}) {
        FwMaterialDef wood = preset(FW_MATERIAL_PINE);
        wood.flameFeedback = feedback;
        make(wood, 20);
        all(FW_IGNITE);
        run(50);
        EXPECT_EQ(feedback > 10000 ? FW_POINT_BURNING : FW_POINT_EXTINGUISHED, int(point().kind))
            << point().temperature << " K";
        EXPECT_EQ(feedback > 10000 ? kNoEnd : uint32_t(FW_EXTINGUISHED_BY_COLD), endedBy());
    }
}

// A corner extinguished early does not decide the cause reported for the last flames.
TEST_P(HeatAndWater, ReportsTheCauseOfTheLastFlames) {
    make(preset(FW_MATERIAL_COTTON), 1);
    all(FW_IGNITE);
    run(2);
    FwIgnitionDef corner = fwDefaultIgnitionDef();
    corner.kind = FW_EXTINGUISH;
    corner.radius = 0.02f;
    ASSERT_EQ(FW_OK, fwWorld_Ignite(world_, &corner, nullptr));
    run(20);
    EXPECT_EQ(0u, state().burning);
    EXPECT_EQ(0u, endedBy());
}

TEST_P(HeatAndWater, LiteObjectsBurnForTheirBurnTime) {
    make(preset(FW_MATERIAL_PAPER), 1, FW_BURNABLE_LITE);
    all(FW_IGNITE);
    run(3.5);
    EXPECT_EQ(0.0f, point().temperature);
    EXPECT_NEAR(0.5f, point().fuel, 0.05f);
    EXPECT_EQ(0.0, state().energy);
    EXPECT_NEAR(15.6e6f * 0.017f * 0.01f, state().power, 0.1f * 2652);
    EXPECT_EQ(0u, stats().hotTiles);
    all(FW_WET);
    run(0.25);
    EXPECT_EQ(FW_POINT_EXTINGUISHED, int(point().kind));
}

TEST_P(HeatAndWater, RefusesInvalidWater) {
    make(preset(FW_MATERIAL_PAPER), 1);
    FwIgnitionDef def = fwDefaultIgnitionDef();
    def.kind = FW_WET;
    def.water = 2000;
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_Ignite(world_, &def, nullptr));
    EXPECT_NE(std::string::npos, lastMessage(world_).find("FwIgnitionDef::water is 2000"))
        << lastMessage(world_);
    FwMaterialDef material = preset(FW_MATERIAL_PINE);
    material.autoIgnitionTemperature = 500;
    FwMaterialId id{};
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_CreateMaterial(world_, &material, &id));
    EXPECT_NE(std::string::npos, lastMessage(world_).find("autoIgnitionTemperature is 500"));
}

std::string backendName(const ::testing::TestParamInfo<uint32_t>& backend) {
    return backend.param == FW_BACKEND_CPU ? "Cpu" : "OwnDevice";
}
INSTANTIATE_TEST_SUITE_P(Backends, HeatAndWater,
                         ::testing::Values(uint32_t(FW_BACKEND_CPU), uint32_t(FW_BACKEND_VULKAN)),
                         backendName);

}  // namespace
