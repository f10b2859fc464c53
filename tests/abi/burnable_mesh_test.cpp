// Fire as a game sees it, on the cpu backend: events, states, points, tags, extinguishing, time.
#include "abi/abi_support.h"
#include "support/sanitized.h"

#include <algorithm>

namespace {

using host::created;
using host::getState;
using host::lastMessage;
using host::materialOf;
using host::SheetWorld;

constexpr float kRate = 0.02f;  // m/s

const FwEvent* find(const std::vector<FwEvent>& events, uint32_t type) {
    const auto found = std::find_if(events.begin(), events.end(),
                                    [&](const FwEvent& event) { return event.type == type; });
    return found == events.end() ? nullptr : &*found;
}

TEST(BurnableMesh, APlankBurnsFromEndToEnd) {
    SheetWorld w(host::evenMaterial(kRate, 4));
    // Lights a line across one end so that the front is straight.
    const float tagAt[3] = {0.8f, 0, 0.125f};
    ASSERT_EQ(FW_OK, fwWorld_TagPoint(w.world, w.object, tagAt, 42));
    uint32_t texels = 0;
    for (float z = 0; z <= 0.25f; z += 0.02f) texels += w.ball(FW_IGNITE, 0.02f, 0, z, 0.025f);
    EXPECT_LT(30u, texels);
    w.run(1.0);
    std::vector<FwEvent> events = w.events();
    const FwEvent* ignited = find(events, FW_EVENT_IGNITED);
    ASSERT_NE(nullptr, ignited);
    EXPECT_EQ(7u, ignited->userData);
    EXPECT_EQ(w.object.index1, ignited->object.index1);
    EXPECT_EQ(w.object.generation, ignited->object.generation);
    EXPECT_EQ(0.0f, ignited->value);
    EXPECT_NEAR(0.02f, ignited->position[0], 0.03f);
    EXPECT_LT(0u, ignited->frameIndex);

    FwObjectState state = w.state();
    EXPECT_LT(0u, state.burning);
    EXPECT_LT(0u, state.frontTiles);
    EXPECT_NEAR(double(state.burning) / 64 / 64, double(state.burningArea),
                0.05 * double(state.burningArea));
    EXPECT_LT(0.0f, state.power);

    w.run(41.0);
    events = w.events();
    const FwEvent* reached = find(events, FW_EVENT_TAG_REACHED);
    ASSERT_NE(nullptr, reached);
    EXPECT_EQ(42u, reached->tag);
    // The lit line ends 0.045 m from the end; texels are 1/64 m.
    const double expected = (double(reached->position[0]) - 0.045 + 0.5 / 64) / double(kRate);
    EXPECT_NEAR(expected, double(reached->value), 0.03 * expected);
    EXPECT_EQ(1, std::count_if(events.begin(), events.end(), [](const FwEvent& event) {
                  return event.type == FW_EVENT_TAG_REACHED;
              }));

    w.run(15.0);
    events = w.events();
    const FwEvent* out = find(events, FW_EVENT_BURNT_OUT);
    ASSERT_NE(nullptr, out);
    EXPECT_NEAR(1.0, double(out->value), 1e-3);
    EXPECT_EQ(nullptr, find(events, FW_EVENT_EXTINGUISHED));
    state = w.state();
    EXPECT_EQ(0u, state.burning);
    EXPECT_EQ(state.texels, state.ignited);
    EXPECT_EQ(1.0f, state.burntFraction);
    EXPECT_EQ(uint32_t(FW_POINT_BURNT), w.point(0.5f, 0, 0.1f).kind);
}

TEST(BurnableMesh, PointQueriesReportTheNearestTexel) {
    SheetWorld w(host::evenMaterial(kRate, 100));
    EXPECT_EQ(uint32_t(FW_POINT_UNBURNT), w.point(0.5f, 0, 0.1f).kind);
    EXPECT_GT(0.0f, w.point(0.5f, 0, 0.1f).age);
    w.ball(FW_IGNITE, 0.5f, 0, 0.125f, 0.03f);
    w.run(2.0);
    FwPointState state = w.point(0.5f, 0.01f, 0.125f);
    EXPECT_EQ(uint32_t(FW_POINT_BURNING), state.kind);
    EXPECT_NEAR(2.0f, state.age, 0.01f);
    EXPECT_NEAR(0.01f, state.distance, 0.012f);
    EXPECT_NEAR(0.5f, state.position[0], 0.02f);
    EXPECT_EQ(uint32_t(FW_POINT_UNBURNT), w.point(0.9f, 0, 0.125f).kind);
    EXPECT_LT(0u, w.ball(FW_WET, 0.9f, 0, 0.125f, 0.05f));
    EXPECT_LT(0u, w.ball(FW_EXTINGUISH, 0.5f, 0, 0.125f, 0.02f));
    w.run(0.1);
    EXPECT_EQ(uint32_t(FW_POINT_WET), w.point(0.9f, 0, 0.125f).kind);
    w.ball(FW_DRY, 0.9f, 0, 0.125f, 0.2f);
    w.run(0.1);
    EXPECT_EQ(uint32_t(FW_POINT_UNBURNT), w.point(0.9f, 0, 0.125f).kind);
}

TEST(BurnableMesh, ExtinguishingReportsAnEvent) {
    SheetWorld w(host::evenMaterial(kRate, 1000));
    w.ball(FW_IGNITE, 0.5f, 0, 0.125f, 0.03f);
    w.run(3.0);
    EXPECT_LT(0u, w.state().burning);
    (void)w.events();
    w.ball(FW_WET, 0.5f, 0, 0.125f, 0.5f);
    w.run(2.0);
    const std::vector<FwEvent> events = w.events();
    const FwEvent* out = find(events, FW_EVENT_EXTINGUISHED);
    ASSERT_NE(nullptr, out);
    EXPECT_EQ(uint32_t(FW_EXTINGUISHED_BY_WATER), out->tag);
    EXPECT_EQ(nullptr, find(events, FW_EVENT_BURNT_OUT));
    EXPECT_EQ(0u, w.state().burning);
    EXPECT_EQ(uint32_t(FW_POINT_EXTINGUISHED), w.point(0.5f, 0, 0.125f).kind);
    // Dried and lit again, it is a new fire with its own events.
    w.ball(FW_DRY, 0.5f, 0, 0.125f, 0.6f);
    w.run(1.0);
    EXPECT_EQ(nullptr, find(w.events(), FW_EVENT_IGNITED));
    w.ball(FW_IGNITE, 0.5f, 0, 0.125f, 0.03f);
    w.run(1.0);
    EXPECT_NE(nullptr, find(w.events(), FW_EVENT_IGNITED));
    w.ball(FW_EXTINGUISH, 0.5f, 0, 0.125f, 0.5f);
    w.run(1.0);
    const std::vector<FwEvent> last = w.events();
    ASSERT_NE(nullptr, find(last, FW_EVENT_EXTINGUISHED));
    EXPECT_EQ(uint32_t(FW_EXTINGUISHED_BY_CALL), find(last, FW_EVENT_EXTINGUISHED)->tag);
}

TEST(BurnableMesh, IgnitesOnlyTexelsInsideTheBall) {
    SheetWorld w(host::evenMaterial(kRate, 10));
    EXPECT_EQ(0u, w.ball(FW_IGNITE, 0.5f, 1.0f, 0.1f, 0.5f));  // half a metre above
    EXPECT_EQ(0u, w.ball(FW_IGNITE, 5.0f, 0.0f, 0.1f, 0.5f));  // beside
    EXPECT_EQ(1u, w.ball(FW_IGNITE, 0.5f, 0.0f, 0.1f, 0.0f));  // radius 0: the nearest texel
    const uint32_t centred = w.ball(FW_IGNITE, 0.5f, 0.0f, 0.125f, 0.1f);
    EXPECT_NEAR(3.14159 * 0.1 * 0.1 * 64 * 64, double(centred), 12);
    const uint32_t lifted = w.ball(FW_IGNITE, 0.5f, 0.08f, 0.125f, 0.1f);
    EXPECT_NEAR(3.14159 * 0.06 * 0.06 * 64 * 64, double(lifted), 10);
    // Null object: any object there.
    const FwBurnableMeshId second = w.add(8);
    float far[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 10, 0, 0, 1};
    ASSERT_EQ(FW_OK, fwWorld_SetTransform(w.world, second, far));
    FwIgnitionDef def = fwDefaultIgnitionDef();
    def.position[0] = 10.5f;
    def.position[2] = 0.1f;
    def.radius = 0.05f;
    uint32_t texels = 0;
    ASSERT_EQ(FW_OK, fwWorld_Ignite(w.world, &def, &texels));
    EXPECT_LT(10u, texels);
    w.run(1.0);
    const std::vector<FwEvent> events = w.events();
    EXPECT_EQ(2, std::count_if(events.begin(), events.end(), [](const FwEvent& event) {
                  return event.type == FW_EVENT_IGNITED;
              }));
}

TEST(BurnableMesh, AScaledObjectBurnsInWorldMetres) {
    SheetWorld w(host::evenMaterial(kRate, 1000), 0.25f, 0.0625f, 256);
    const float four[16] = {4, 0, 0, 0, 0, 4, 0, 0, 0, 0, 4, 0, 0, 0, 0, 1};
    ASSERT_EQ(FW_OK, fwWorld_SetTransform(w.world, w.object, four));
    const float tagAt[3] = {0.8f, 0, 0.125f};
    ASSERT_EQ(FW_OK, fwWorld_TagPoint(w.world, w.object, tagAt, 1));
    for (float z = 0; z <= 0.25f; z += 0.02f) w.ball(FW_IGNITE, 0.02f, 0, z, 0.025f);
    w.run(42.0);
    const std::vector<FwEvent> events = w.events();
    const FwEvent* reached = find(events, FW_EVENT_TAG_REACHED);
    ASSERT_NE(nullptr, reached);
    const double expected = (double(reached->position[0]) - 0.045 + 0.5 / 64) / double(kRate);
    EXPECT_NEAR(expected, double(reached->value), 0.03 * expected);
}

// A sheet stretched fourfold along one axis, mirrored and turned: fire covers equal world distances
// along both axes.
TEST(BurnableMesh, AStretchedObjectBurnsInWorldMetres) {
    SheetWorld w(host::evenMaterial(kRate, 1000), 0.25f, 1.0f, 256);
    for (const bool mirrored : {false, true}) {
        SCOPED_TRACE(mirrored ? "mirrored" : "stretched");
        FwBurnableMeshDef def = fwDefaultBurnableMeshDef();
        def.mesh = w.mesh;
        def.materials[0] = w.materialId;
        // Object x becomes world -z (z if mirrored); object y becomes world y.
        const float long_ = mirrored ? 4.0f : -4.0f;
        const float placed[16] = {0, 0, long_, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1};
        std::copy_n(placed, 16, def.transform);
        FwBurnableMeshId id = created(fwWorld_CreateBurnableMesh, w.world, def);
        std::swap(w.object, id);
        const float z = mirrored ? 0.5f : -0.5f;
        EXPECT_NEAR(3.14159 * 0.05 * 0.05 * 256 * 64, double(w.ball(FW_IGNITE, 0.5f, 0, z, 0.05f)),
                    16);
        w.run(0.3 / double(kRate));
        const float reach = 0.35f;
        for (const float side : {-1.0f, 1.0f}) {
            EXPECT_EQ(uint32_t(FW_POINT_BURNING),
                      w.point(0.5f + side * (reach - 0.02f), 0, z).kind);
            EXPECT_EQ(uint32_t(FW_POINT_UNBURNT),
                      w.point(0.5f + side * (reach + 0.02f), 0, z).kind);
            EXPECT_EQ(uint32_t(FW_POINT_BURNING),
                      w.point(0.5f, 0, z + side * (reach - 0.02f)).kind);
            EXPECT_EQ(uint32_t(FW_POINT_UNBURNT),
                      w.point(0.5f, 0, z + side * (reach + 0.02f)).kind);
        }
        const FwObjectState state = w.state();
        EXPECT_NEAR(3.14159 * 0.35 * 0.35, double(state.burningArea), 0.02);
        // A change of handedness is refused. Another ratio changes only queries and pictures.
        float moved[16];
        std::copy_n(placed, 16, moved);
        moved[2] = -moved[2];
        EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_SetTransform(w.world, w.object, moved));
        EXPECT_NE(std::string::npos, lastMessage(w.world).find("a mirror is settled"));
        moved[2] = placed[2] / 2;
        ASSERT_EQ(FW_OK, fwWorld_SetTransform(w.world, w.object, moved)) << lastMessage(w.world);
        EXPECT_EQ(uint32_t(FW_POINT_BURNING), w.point(0.5f, 0, (z + reach - 0.03f) / 2).kind);
        EXPECT_EQ(uint32_t(FW_POINT_UNBURNT), w.point(0.5f, 0, (z + reach + 0.03f) / 2).kind);
        w.events();
        std::swap(w.object, id);
    }
}

TEST(BurnableMesh, ShapesAreSharedAndFreedWithTheirLastUser) {
    SheetWorld w(host::evenMaterial(kRate, 1000));
    FwBurnableMeshDef def = fwDefaultBurnableMeshDef();
    def.mesh = w.mesh;
    def.materials[0] = w.materialId;
    def.transform[0] = 2;
    FwWorldStats stats{};
    stats.structSize = sizeof stats;
    FwBurnableMeshId ids[3] = {};
    const auto bytes = [&] { return getState(fwContext_GetInfo, w.context).cpuMemoryUsed; };
    const uint64_t none = bytes();
    ASSERT_EQ(FW_OK, fwWorld_CreateBurnableMesh(w.world, &def, &ids[0])) << lastMessage(w.world);
    const uint64_t one = bytes();
    def.transform[5] = def.transform[10] = -1;  // turned; the same shape
    ASSERT_EQ(FW_OK, fwWorld_CreateBurnableMesh(w.world, &def, &ids[1]));
    const uint64_t two = bytes();
    EXPECT_LT(2 * (two - one), one - none) << "the shape is shared";
    ASSERT_EQ(FW_OK, fwWorld_GetStats(w.world, &stats));
    EXPECT_EQ(1u, stats.meshes);
    ASSERT_EQ(FW_OK, fwWorld_DestroyBurnableMesh(w.world, w.object));
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_DestroyMesh(w.world, w.mesh));
    for (int i = 0; i < 2; ++i) ASSERT_EQ(FW_OK, fwWorld_DestroyBurnableMesh(w.world, ids[i]));
    EXPECT_EQ(FW_OK, fwWorld_DestroyMesh(w.world, w.mesh)) << lastMessage(w.world);
}

TEST(BurnableMesh, PaceMultipliesSpreadAndBurnOut) {
    FwWorldDef def = fwDefaultWorldDef();
    def.paceFactor = 8;
    SheetWorld w(host::evenMaterial(kRate / 8, 32), 1.0f, 0.25f, 64, def);
    const float tagAt[3] = {0.5f, 0, 0.125f};
    ASSERT_EQ(FW_OK, fwWorld_TagPoint(w.world, w.object, tagAt, 1));
    for (float z = 0; z <= 0.25f; z += 0.02f) w.ball(FW_IGNITE, 0.02f, 0, z, 0.025f);
    w.run(3.9);
    EXPECT_EQ(uint32_t(FW_POINT_BURNING), w.point(0.02f, 0, 0.125f).kind);
    w.run(0.2);
    EXPECT_EQ(uint32_t(FW_POINT_BURNT), w.point(0.02f, 0, 0.125f).kind);
    w.run(22);
    const std::vector<FwEvent> events = w.events();
    const FwEvent* reached = find(events, FW_EVENT_TAG_REACHED);
    ASSERT_NE(nullptr, reached);
    const double expected = (double(reached->position[0]) - 0.045 + 0.5 / 64) / double(kRate);
    EXPECT_NEAR(expected, double(reached->value), 0.03 * expected);
}

TEST(BurnableMesh, WindDrivesTheFrontDownwind) {
    FwMaterialDef material = host::evenMaterial(0.01f, 1000);
    material.windGain = 1;
    material.headGain = 1;
    material.backGain = 1;
    material.driveMax = 8;
    FwWorldDef def = fwDefaultWorldDef();
    def.wind[0] = 2;
    SheetWorld w(material, 1.0f, 0.5f, 64, def);
    w.ball(FW_IGNITE, 0.4f, 0, 0.25f, 0.03f);
    w.run(6.0);
    EXPECT_EQ(uint32_t(FW_POINT_BURNING), w.point(0.4f + 0.16f, 0, 0.25f).kind);
    EXPECT_EQ(uint32_t(FW_POINT_UNBURNT), w.point(0.4f - 0.12f, 0, 0.25f).kind);
    // The wind turns; later the other side is the head.
    const float back[3] = {-2, 0, 0};
    ASSERT_EQ(FW_OK, fwWorld_SetWind(w.world, back));
    w.run(10.0);
    EXPECT_EQ(uint32_t(FW_POINT_BURNING), w.point(0.4f - 0.2f, 0, 0.25f).kind);
}

TEST(BurnableMesh, GravityFollowsAPoseAtTheNextLatch) {
    FwMaterialDef material = host::evenMaterial(0.01f, 1000);
    material.upGain = 1;
    material.headGain = 3;
    material.backGain = 1;
    material.driveMax = 4;
    SheetWorld w(material, 1.0f, 0.25f);
    w.ball(FW_IGNITE, 0.3f, 0, 0.125f, 0.03f);
    w.run(2.0);
    // Object x becomes world y: the far end is up.
    const float upright[16] = {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    ASSERT_EQ(FW_OK, fwWorld_SetTransform(w.world, w.object, upright));
    w.run(6.0);
    EXPECT_EQ(uint32_t(FW_POINT_BURNING), w.point(0, 0.3f + 0.2f, 0.125f).kind);
    EXPECT_EQ(uint32_t(FW_POINT_UNBURNT), w.point(0, 0.3f - 0.15f, 0.125f).kind);
}

TEST(BurnableMesh, FireDoesNotCrossAZeroSpreadMultiplier) {
    SheetWorld w(host::evenMaterial(kRate, 1000));
    std::vector<uint8_t> multiplier(64 * 16, 128);
    for (int y = 0; y < 16; ++y)
        for (int x = 30; x < 34; ++x) multiplier[size_t(y * 64 + x)] = 0;
    const FwMeshInfo info = getState(fwWorld_GetMeshInfo, w.world, w.mesh);
    // The map is as wide as the atlas whatever the chart's direction: paint by rest position.
    std::vector<float> positions(size_t(info.mapWidth) * info.mapHeight * 3);
    uint64_t count = 0;
    ASSERT_EQ(FW_OK, fwDebug_GetTexelPositions(w.world, w.mesh, positions.data(), nullptr,
                                               positions.size() / 3, &count));
    multiplier.assign(count, 128);
    for (size_t i = 0; i < count; ++i)
        if (std::fabs(positions[3 * i] - 0.5f) < 0.04f) multiplier[i] = 0;
    FwBurnableMeshDef def = fwDefaultBurnableMeshDef();
    def.mesh = w.mesh;
    def.materials[0] = w.materialId;
    def.multiplier = multiplier.data();
    def.multiplierWidth = info.mapWidth;
    def.multiplierHeight = info.mapHeight;
    FwBurnableMeshId id = created(fwWorld_CreateBurnableMesh, w.world, def);
    w.object = id;
    w.ball(FW_IGNITE, 0.1f, 0, 0.125f, 0.03f);
    w.run(60.0);
    EXPECT_EQ(uint32_t(FW_POINT_BURNING), w.point(0.3f, 0, 0.1f).kind);
    EXPECT_EQ(uint32_t(FW_POINT_INERT), w.point(0.5f, 0, 0.1f).kind);
    EXPECT_EQ(uint32_t(FW_POINT_UNBURNT), w.point(0.7f, 0, 0.1f).kind);
    EXPECT_GT(0.51f, w.state().burntFraction);
}

TEST(BurnableMesh, NonCombustibleDoesNotBurnAndRaisesNothing) {
    FwMaterialDef stone = materialOf(FW_MATERIAL_NONCOMBUSTIBLE);
    SheetWorld w(stone);
    EXPECT_LT(0u, w.ball(FW_IGNITE, 0.5f, 0, 0.125f, 0.05f));
    w.run(3.0);
    EXPECT_EQ(0u, w.state().ignited);
    EXPECT_EQ(0u, w.state().texels);
    EXPECT_TRUE(w.events().empty());
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwInitMaterialPreset(&stone, FW_MATERIAL_PRESET_COUNT));
}

uint64_t hashAfter(float deltaTime, double seconds) {
    FwMaterialDef material = host::evenMaterial(kRate, 6);
    material.windGain = 1;
    material.headGain = 1;
    material.backGain = 0.5f;
    material.driveMax = 8;
    FwWorldDef def = fwDefaultWorldDef();
    def.wind[0] = 1;
    def.wind[2] = -0.5f;
    SheetWorld w(material, 1.0f, 0.25f, 64, def);
    w.ball(FW_IGNITE, 0.2f, 0, 0.1f, 0.03f);
    w.ball(FW_IGNITE, 0.8f, 0, 0.2f, 0.03f, 2.3f);
    w.ball(FW_WET, 0.5f, 0, 0.1f, 0.1f, 3.1f);
    w.ball(FW_DRY, 0.5f, 0, 0.1f, 0.2f, 5.7f);
    // Every frame rate runs the same number of steps.
    const uint64_t wanted = uint64_t(seconds * 32);
    uint64_t ran = 0;
    FwWorldStats stats{};
    stats.structSize = sizeof stats;
    while (ran < wanted) {
        const float most = float(double(wanted - ran) / 32) + 1e-4f;
        EXPECT_EQ(FW_OK, fwWorld_Step(w.world, std::min(deltaTime, most)));
        EXPECT_EQ(FW_OK, fwWorld_GetStats(w.world, &stats));
        ran = stats.tick / 128;
    }
    uint64_t tick = 0;
    const uint64_t hash = w.hash(&tick);
    EXPECT_EQ(wanted * 128, tick);
    return hash;
}

TEST(WorldTime, BurnIsIndependentOfTheFrameRate) {
    const uint64_t golden = hashAfter(1.0f / 60, 12);
    EXPECT_EQ(golden, hashAfter(1.0f / 120, 12));
    EXPECT_EQ(golden, hashAfter(1.0f / 7, 12));
    EXPECT_EQ(golden, hashAfter(1.0f / 32, 12));
    EXPECT_NE(golden, hashAfter(1.0f / 60, 11));
}

TEST(WorldTime, DoesNotDriftOverAnHour) {
    SheetWorld w(host::evenMaterial(kRate, 4));
    for (int i = 0; i < 60 * 3600; ++i) ASSERT_EQ(FW_OK, fwWorld_Step(w.world, 1.0f / 60));
    const FwWorldStats stats = getState(fwWorld_GetStats, w.world);
    const double exact = double(60 * 3600) * double(1.0f / 60);  // the host's own float rounding
    EXPECT_NEAR(exact, double(stats.tick) / 4096, 1.01 / 32);
    EXPECT_EQ(0u, stats.steps);  // nothing burns, so no step runs
    EXPECT_EQ(0u, stats.droppedSteps);
}

TEST(WorldTime, DropsExcessTimeAndReportsIt) {
    FwWorldDef def = fwDefaultWorldDef();
    def.maxStepsPerFrame = 4;
    SheetWorld w(host::evenMaterial(kRate, 4), 1.0f, 0.25f, 64, def);
    ASSERT_EQ(FW_OK, fwWorld_Step(w.world, 1.0f));
    const std::vector<FwEvent> events = w.events();
    ASSERT_EQ(1u, events.size());
    EXPECT_EQ(uint32_t(FW_EVENT_TIME_DROPPED), events[0].type);
    EXPECT_FLOAT_EQ(28.0f / 32, events[0].value);
    const FwWorldStats stats = getState(fwWorld_GetStats, w.world);
    EXPECT_EQ(28u, stats.droppedSteps);
    EXPECT_EQ(4u * 128, stats.tick);
}

TEST(WorldTime, RefusesTimeBeyondTwelveDays) {
    if (fw::test::kSanitized) {
        GTEST_SKIP() << "thirty million idle steps take too long under a sanitizer";
    }
    FwWorldDef def = fwDefaultWorldDef();
    def.maxStepsPerFrame = 64;
    SheetWorld w(host::evenMaterial(kRate, 4), 0.25f, 0.25f, 32, def);
    constexpr int kSeconds = 1048560;
    for (int s = 0; s < kSeconds - 2; s += 2) ASSERT_EQ(FW_OK, fwWorld_Step(w.world, 2));
    // A fire that reaches the end keeps its state.
    w.ball(FW_IGNITE, 0.1f, 0, 0.1f, 0.05f);
    ASSERT_EQ(FW_OK, fwWorld_Step(w.world, 1));
    ASSERT_EQ(FW_OK, fwWorld_Step(w.world, 1.5f));  // room for one second
    const FwWorldStats stats = getState(fwWorld_GetStats, w.world);
    EXPECT_EQ(uint64_t(kSeconds) * 4096, stats.tick);
    EXPECT_EQ(uint32_t(FW_POINT_BURNING), w.point(0.1f, 0, 0.1f).kind);
    EXPECT_EQ(1u, w.host.warnings.size());
    const uint64_t burnt = w.hash();
    w.ball(FW_IGNITE, 0.2f, 0, 0.2f, 0.02f);  // due after the end of time
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_Step(w.world, 1));
    EXPECT_NE(std::string::npos, lastMessage(w.world).find("1048560 s")) << lastMessage(w.world);
    EXPECT_EQ(FW_OK, fwWorld_Step(w.world, 0));
    EXPECT_EQ(burnt, w.hash());
}

TEST(WorldTime, DelayedCommandsRunAtTheirTime) {
    SheetWorld w(host::evenMaterial(kRate, 100));
    w.ball(FW_IGNITE, 0.5f, 0, 0.125f, 0.03f, 1.5f);
    w.run(1.4);
    EXPECT_EQ(0u, w.state().ignited);
    w.run(0.6);
    const std::vector<FwEvent> events = w.events();
    const FwEvent* ignited = find(events, FW_EVENT_IGNITED);
    ASSERT_NE(nullptr, ignited);
    EXPECT_NEAR(1.5f, ignited->value, 1e-3f);
    EXPECT_NEAR(0.5f, w.point(0.5f, 0, 0.125f).age, 0.05f);
}

TEST(WorldTime, IdleWorldsSkipSteps) {
    SheetWorld w(host::evenMaterial(0.2f, 0.5f), 0.25f, 0.25f, 32);
    w.run(3.0);
    FwWorldStats stats = getState(fwWorld_GetStats, w.world);
    EXPECT_EQ(0u, stats.steps);
    w.ball(FW_IGNITE, 0.1f, 0, 0.1f, 0.05f);
    w.run(26.0);  // burns out and cools down
    ASSERT_EQ(FW_OK, fwWorld_GetStats(w.world, &stats));
    EXPECT_LT(32u, stats.steps);
    EXPECT_EQ(0u, stats.hotTiles);
    const uint64_t ran = stats.steps;
    w.run(6.0);
    ASSERT_EQ(FW_OK, fwWorld_GetStats(w.world, &stats));
    EXPECT_EQ(ran, stats.steps);
    EXPECT_EQ(35u * 4096, stats.tick);
    EXPECT_EQ(0u, stats.burningTiles);
}

TEST(EventQueueLimits, DropsTheOldestWhenNotPolled) {
    FwWorldDef def = fwDefaultWorldDef();
    def.maxStepsPerFrame = 1;
    SheetWorld w(host::evenMaterial(kRate, 4), 0.1f, 0.1f, 64, def);
    for (int i = 0; i < 5000; ++i) ASSERT_EQ(FW_OK, fwWorld_Step(w.world, 0.25f));
    std::vector<FwEvent> events(8192);
    EXPECT_EQ(4096u, fwWorld_PollEvents(w.world, events.data(), 8192));
    EXPECT_EQ(uint64_t(5000 - 4096 + 1), events[0].frameIndex);
    EXPECT_EQ(0u, fwWorld_PollEvents(w.world, events.data(), 8192));
    EXPECT_EQ(0u, fwWorld_PollEvents(w.world, nullptr, 0));
}

TEST(EventQueueLimits, LimitsOpenQueriesAndTags) {
    SheetWorld w(host::evenMaterial(kRate, 4));
    const float point[3] = {0.5f, 0, 0.1f};
    FwQueryId query{};
    for (int i = 0; i < 1024; ++i)
        ASSERT_EQ(FW_OK, fwWorld_RequestPoint(w.world, w.object, point, &query));
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_RequestPoint(w.world, w.object, point, &query));
    EXPECT_NE(std::string::npos, lastMessage(w.world).find("the limit is 1024"));
    for (int i = 0; i < 4096; ++i)
        ASSERT_EQ(FW_OK, fwWorld_TagPoint(w.world, w.object, point, uint32_t(i)));
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_TagPoint(w.world, w.object, point, 1));
    w.ball(FW_IGNITE, 0.5f, 0, 0.1f, 0.03f);
    w.run(0.1);
    std::vector<FwEvent> events(8192);
    events.resize(fwWorld_PollEvents(w.world, events.data(), 8192));
    EXPECT_LT(4000u, events.size());
}

TEST(FireLights, LightsOfAFireKeepTheirIds) {
    SheetWorld w(host::evenMaterial(kRate, 1000));
    FwLight lights[64];
    EXPECT_EQ(0u, fwWorld_GetLights(w.world, lights, 64));
    w.ball(FW_IGNITE, 0.5f, 0, 0.125f, 0.05f);
    w.run(1.0);
    ASSERT_LT(0u, fwWorld_GetLights(w.world, lights, 64));
    const uint32_t id = lights[0].id;
    EXPECT_NE(0u, id);
    EXPECT_LT(0.0f, lights[0].power);
    EXPECT_NEAR(0.5f, lights[0].position[0], 0.2f);
    w.run(0.5);
    ASSERT_LT(0u, fwWorld_GetLights(w.world, lights, 64));
    EXPECT_EQ(id, lights[0].id);
}

}  // namespace
