// The flames of burning objects as bodies of fire, in worlds with flames on an own device.
#include "support/meshes.h"
#include "support/own_world.h"

#include <cmath>

namespace fw::test::bodies_test {
namespace {

constexpr uint32_t kWidth = 200, kHeight = 150;
constexpr uint32_t kTicks = 32;  // frames a second: one each step
constexpr uint32_t kReport = 4;  // frames between reports of what burns
constexpr float kBlack[4] = {0, 0, 0, 1};

class Bodies : public OwnWorld {
 protected:
    void makeFire(uint32_t maxFlames, FwWorld** world) {
        FwWorldDef def = fwDefaultWorldDef();
        def.paceFactor = 20;
        def.maxStepsPerFrame = 32;
        def.maxFlames = maxFlames;
        ASSERT_EQ(fwCreateWorld(context_, &def, &world_), FW_OK);
        const Mesh mesh = makeCube(1, 4);
        FwMeshDef meshDef = meshDefOf(mesh);
        FwMaterialDef material = fwDefaultMaterialDef();
        ASSERT_EQ(fwInitMaterialPreset(&material, FW_MATERIAL_PINE), FW_OK);
        add(meshDef, material, 0);
        touch(FW_IGNITE, 0, 0, 0.5f, 0.1f);
        run(1.5f, 1.0f / float(kTicks));
        *world = world_;
    }
    static FwView view(uint32_t frame) {
        FwView view = viewAt({0.6f, 0.5f, 2.6f}, {0, 0.3f, 0}, float(kWidth) / float(kHeight));
        view.time = 3 + float(frame) / float(kTicks);
        return view;
    }
    static std::vector<uint8_t> picture(FwWorld* world, uint32_t frame) {
        return shoot(world, view(frame), kWidth, kHeight, kBlack);
    }
    void TearDown() override {
        fwDestroyWorld(world_);
        OwnWorld::TearDown();
    }
};

TEST_F(Bodies, StandOnWhatBurnsAndOnlyThere) {
    FwWorld* world = nullptr;
    makeFire(4096, &world);
    if (!world) return;
    const std::vector<uint8_t> fire = picture(world, 0);
    fwDestroyWorld(world);
    makeFire(0, &world);
    const std::vector<uint8_t> bare = picture(world, 0);
    // By rows: what flames add. The front has come down to row 127.
    std::vector<double> rows(kHeight);
    uint32_t count = 0;
    for (uint32_t y = 0; y < kHeight; ++y)
        for (uint32_t x = 0; x < kWidth; ++x) {
            const size_t at = (size_t{y} * kWidth + x) * 4;
            const int more = fire[at] - bare[at];
            rows[y] += std::max(more, 0);
            count += more > 40;
        }
    std::printf("flames cover %u of %u pixels\n", count, kWidth * kHeight);
    EXPECT_GT(count, kWidth * kHeight / 50);
    EXPECT_LT(count, kWidth * kHeight / 3);
    constexpr uint32_t kFeet = 130;
    double above = 0, below = 0;
    for (uint32_t y = 0; y < kHeight; ++y) (y < kFeet ? above : below) += rows[y];
    EXPECT_LT(below, 0.02 * above) << "flames stand on their feet";
}

// A texel adds gas by its age, not by reports.
TEST_F(Bodies, DoNotJumpWithTheSimulationsReports) {
    FwWorld* world = nullptr;
    makeFire(4096, &world);
    if (!world) return;
    std::vector<double> changes;
    std::vector<uint8_t> before = picture(world, 0);
    for (uint32_t frame = 1; frame <= 6 * kReport; ++frame) {
        fwWorld_Step(world, 1.0f / float(kTicks));
        const std::vector<uint8_t> now = picture(world, frame);
        double change = 0;
        for (size_t i = 0; i < now.size(); ++i) change += std::abs(now[i] - before[i]);
        changes.push_back(change);
        before = now;
    }
    double most = 0;
    for (uint32_t phase = 0; phase < kReport; ++phase) {
        double own = 0, others = 0;
        for (uint32_t i = 0; i < changes.size(); ++i)
            (i % kReport == phase ? own : others) += changes[i];
        most = std::max(most, own * (kReport - 1) / others);
    }
    std::printf("the frame of a report changes %.3f times as much as its neighbours\n", most);
    EXPECT_LT(most, 1.15);
}

TEST_F(Bodies, AreTheSameFromRunToRun) {
    FwWorld* world = nullptr;
    makeFire(4096, &world);
    if (!world) return;
    const std::vector<uint8_t> first = picture(world, 0);
    fwDestroyWorld(world);
    makeFire(4096, &world);
    EXPECT_EQ(first, picture(world, 0));
}

}  // namespace
}  // namespace fw::test::bodies_test
