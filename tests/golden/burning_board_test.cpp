// Properties of pictures of burning boards that a golden would not check.
#include "support/own_world.h"
#include "support/refine_scene.h"

namespace fw::test::burning_board_test {
namespace {

constexpr uint32_t kWidth = 192, kHeight = 192;
constexpr float kSide = 0.5f;  // m

class BurningBoard : public OwnWorld {
 protected:
    Picture draw(float zoom = 12) {
        const glm::vec3 target(0.5f * kSide, 0.5f * kSide, 0);
        return pictureOf(world_, viewAt(target + glm::vec3(0, 0, 4), target, 1, zoom), kWidth,
                         kHeight);
    }
    void addBoard(const Mesh& mesh, const std::vector<float>& details, float spreadRate,
                  uint32_t flags = 0) {
        FwMeshDef def = meshDefOf(mesh);
        def.details = details.data();
        def.mapSize = 512;
        def.texelsPerMetre = 128;
        FwMaterialDef plastic = fwDefaultMaterialDef();
        ASSERT_EQ(fwInitMaterialPreset(&plastic, FW_MATERIAL_PLASTIC), FW_OK);
        plastic.spreadRate = spreadRate;
        plastic.windGain = plastic.upGain = plastic.headGain = plastic.ceilingGain = 0;
        add(def, plastic, FW_BURNABLE_LITE | flags);
    }
};

// Detail coordinates run around the board, so its back mirrors its front. Holes that followed them
// would open both walls at the same places, like an inkblot.
TEST_F(BurningBoard, HolesAreNotMirrored) {
    makeWorld(1, 32);
    const Mesh mesh = gridBox(double(kSide), double(kSide), 0.012, 1, 1, 1);
    std::vector<float> details;
    for (size_t i = 0; i < mesh.positions.size(); i += 3) {
        const float x = mesh.positions[i], y = mesh.positions[i + 1];
        details.insert(details.end(), {mesh.positions[i + 2] > 0.006f ? x : kSide - x, y});
    }
    addBoard(mesh, details, 0.3f);
    const Picture whole = draw();
    touch(FW_IGNITE, 0.5f * kSide, 0.5f * kSide, 0, 2 * kSide);
    run(0.28f, 0.03125f);
    uint32_t open = 0, twice = 0;
    const auto seenThrough = [&](const Picture& picture, uint32_t x, uint32_t y) {
        const uint8_t* pixel = &picture.rgb[(size_t{y} * kWidth + x) * 3];
        return std::equal(pixel, pixel + 3, picture.rgb.data());
    };
    const Picture burnt = draw();
    uint32_t covered = 0;
    for (uint32_t y = 0; y < kHeight; ++y)
        for (uint32_t x = 0; x < kWidth; ++x) {
            if (seenThrough(whole, x, y)) continue;
            ++covered;
            if (!seenThrough(burnt, x, y)) continue;
            ++open;
            twice += seenThrough(burnt, kWidth - 1 - x, y);
        }
    std::printf("%.3f of the board is open, %.3f of that on both sides of its middle\n",
                open / double(covered), twice / double(open));
    EXPECT_GT(open, covered / 10);
    EXPECT_LT(open, covered * 6 / 10);
    // Chance gives the product of the open shares; a mirror image would have all.
    EXPECT_LT(twice, open * 8 / 10);
}

// Browning ahead of a front is several texels wide. When a board catches, all of it shows in the
// same frame instead of ending at the prediction's first round.
TEST_F(BurningBoard, ScorchShowsInTheFirstFrame) {
    makeWorld(1, 32);
    const Mesh mesh = gridBox(double(kSide), double(kSide), 0.012, 1, 1, 1);
    addBoard(mesh, std::vector<float>(mesh.positions.size() / 3 * 2, 0), 0.02f);
    const Picture whole = draw();
    touch(FW_IGNITE, 0.5f * kSide, 0.5f * kSide, 0.012f, 0.02f);
    fwWorld_Step(world_, 0.03125f);
    const auto changed = [&](const Picture& picture) {
        uint32_t count = 0;
        for (size_t i = 0; i < picture.rgb.size(); i += 3)
            count += std::abs(int(picture.rgb[i]) - int(whole.rgb[i])) +
                         std::abs(int(picture.rgb[i + 2]) - int(whole.rgb[i + 2])) >
                     6;
        return count;
    };
    const uint32_t first = changed(draw());
    for (int i = 0; i < 12; ++i) fwWorld_Step(world_, 1.0f / 512);
    const uint32_t later = changed(draw());
    std::printf("%u pixels at once, %u some frames later\n", first, later);
    EXPECT_GT(first, 200u);
    EXPECT_GT(first, later * 3 / 4);
}

// Only the back burns; its holes are the front's. Near the camera they are cut, far away they are
// per-pixel holes: the open share must agree.
TEST_F(BurningBoard, HolesBurntFromBehindAreOpenNearAndFar) {
    makeWorld(1, 32);
    const Mesh mesh = gridBox(double(kSide), double(kSide), 0.012, 1, 1, 1);
    addBoard(mesh, std::vector<float>(mesh.positions.size() / 3 * 2, 0), 0.3f, FW_BURNABLE_REFINE);
    constexpr float kNear = 12, kFar = 3.5f;
    const Picture whole[] = {draw(kNear), draw(kFar)};
    touch(FW_IGNITE, 0.5f * kSide, 0.5f * kSide, 0, 0.13f);
    double open[2] = {};
    const auto isBackground = [](const Picture& picture, size_t at) {
        return std::equal(&picture.rgb[at], &picture.rgb[at] + 3, picture.rgb.data());
    };
    for (int moment = 0; moment < 3; ++moment) {
        run(moment == 0 ? 0.32f : 0.04f, 0.01f);
        for (const int far : {0, 1}) {
            (void)draw(far ? kFar : kNear);
            fwWorld_Step(world_, 1.0f / 512);
            const Picture burnt = draw(far ? kFar : kNear);
            uint32_t covered = 0, seen = 0;
            for (size_t at = 0; at < burnt.rgb.size(); at += 3) {
                if (isBackground(whole[far], at)) continue;
                ++covered;
                seen += isBackground(burnt, at);
            }
            open[far] = double(seen) / double(covered);
        }
        std::printf("open: %.3f near, %.3f far\n", open[0], open[1]);
        EXPECT_NEAR(open[0], open[1], 0.05);
    }
    EXPECT_GT(open[0], 0.1);
}

}  // namespace
}  // namespace fw::test::burning_board_test
