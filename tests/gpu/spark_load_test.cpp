// Sparks are functions of the clock: a loaded world shows exactly the sparks at the save, in the
// same world later or in another one. They bounce off the host's heightfield.
#include "support/own_world.h"
#include "support/views.h"

#include <cstdlib>

namespace fw::test {
namespace {

constexpr uint32_t kSide = 160;      // px
constexpr float kFrame = 1.0f / 16;  // s, whole ticks
constexpr int kFrames = 5 * 16, kLater = 3 * 16;

class SparksLoaded : public OwnDevice {
 protected:
    // A fire of 150 kW that shows only sparks, on black.
    FwWorld* fireWorld() {
        FwWorldDef worldDef = fwDefaultWorldDef();
        worldDef.maxFlames = 0;
        FwWorld* world = nullptr;
        EXPECT_EQ(fwCreateWorld(context_, &worldDef, &world), FW_OK);
        FwFireEmitterDef def = fwDefaultFireEmitterDef();
        def.flags = FW_EMITTER_NO_SMOKE;
        def.seed = 3;
        def.power = 150;
        def.sparks = 0.5f;
        def.rate = 1e-3f;
        EXPECT_EQ(fwWorld_CreateFireEmitter(world, &def, &emitter_), FW_OK);
        return world;
    }
    static void step(FwWorld* world, int frames) {
        for (int i = 0; i < frames; ++i) EXPECT_EQ(fwWorld_Step(world, kFrame), FW_OK);
    }
    static std::vector<uint8_t> picture(FwWorld* world) {
        const FwView view = viewAt({0, 1.5f, 7}, {0, 1.5f, 0}, 1, 3);
        const float black[4] = {0, 0, 0, 1};
        return shoot(world, view, kSide, kSide, black);
    }
    // Pixels lit by sparks.
    static size_t lit(const std::vector<uint8_t>& pixels) {
        size_t count = 0;
        for (size_t i = 0; i < pixels.size(); i += 4) count += pixels[i] > 24;
        return count;
    }
    // Light is summed in the order in which quads were counted, so the last bit may differ.
    static void expectSame(const std::vector<uint8_t>& a, const std::vector<uint8_t>& b) {
        ASSERT_EQ(a.size(), b.size());
        int most = 0;
        for (size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
        EXPECT_LE(most, 1);
        EXPECT_EQ(lit(a), lit(b));
    }
    std::vector<uint8_t> saved(FwWorld* world) {
        EXPECT_EQ(fwWorld_RequestSave(world), FW_OK);
        uint64_t size = 0;
        FwResult result = fwWorld_FetchSave(world, nullptr, &size);
        for (int i = 0; i < 8 && result == FW_NOT_READY; ++i) {
            EXPECT_EQ(fwWorld_Step(world, 0), FW_OK);
            result = fwWorld_FetchSave(world, nullptr, &size);
        }
        std::vector<uint8_t> bytes(size);
        EXPECT_EQ(fwWorld_FetchSave(world, bytes.data(), &size), FW_OK);
        return bytes;
    }

    FwFireEmitterId emitter_{};
};

TEST_F(SparksLoaded, MatchThoseAtTheSave) {
    FwWorld* world = fireWorld();
    step(world, kFrames);
    const std::vector<uint8_t> bytes = saved(world);
    step(world, 1);
    const std::vector<uint8_t> then = picture(world);
    EXPECT_GT(lit(then), 60u) << "too few sparks to compare";
    step(world, kLater);
    const std::vector<uint8_t> later = picture(world);
    size_t other = 0;
    for (size_t i = 0; i < then.size(); i += 4) other += std::abs(then[i] - later[i]) > 24;
    EXPECT_GT(other, 60u) << "they stand still";

    ASSERT_EQ(fwWorld_Load(world, bytes.data(), bytes.size()), FW_OK);
    step(world, 1);
    expectSame(then, picture(world));
    step(world, kLater);  // and they continue their paths
    expectSame(later, picture(world));

    FwWorld* another = fireWorld();
    ASSERT_EQ(fwWorld_Load(another, bytes.data(), bytes.size()), FW_OK);
    step(another, 1);
    expectSame(then, picture(another));
    fwDestroyWorld(another);
    fwDestroyWorld(world);
}

// A slope from its side: sparks show above its line only.
TEST_F(SparksLoaded, BounceOffTheHostsHeightfield) {
    constexpr uint32_t kCorners = 33;  // 16 m in each direction
    constexpr float kSteep = 0.6f;
    float heights[kCorners * kCorners];
    for (uint32_t i = 0; i < kCorners * kCorners; ++i)
        heights[i] = kSteep * 0.5f * float(i % kCorners);
    const auto below = [&](bool field) {
        FwWorld* world = fireWorld();
        if (field) {
            FwFireColliderDef def = fwDefaultFireColliderDef();
            def.kind = FW_COLLIDER_HEIGHT_FIELD;
            def.position[0] = def.position[2] = -8;
            def.position[1] = -8 * kSteep;
            def.cellSize = 0.5f;
            def.columns = def.rows = kCorners;
            def.heights = heights;
            FwFireColliderId id{};
            EXPECT_EQ(fwWorld_AddFireCollider(world, &def, &id), FW_OK);
        }
        step(world, kFrames);
        size_t count = 0, above = 0;
        const float black[4] = {0, 0, 0, 1};
        constexpr float kMetre = kSide / 6.0f;  // px
        for (int i = 0; i < 8; ++i) {
            step(world, 5);
            const std::vector<uint8_t> pixels =
                shoot(world, frontView({0, 0}, 6, 6), kSide, kSide, black);
            for (uint32_t k = 0; k < kSide * kSide; ++k) {
                if (pixels[4 * k] <= 24) continue;
                const float x = (float(k % kSide) + 0.5f - kSide / 2.0f) / kMetre;
                const float y = (kSide / 2.0f - float(k / kSide) - 0.5f) / kMetre;
                ++(y < kSteep * x - 1.5f / kMetre ? count : above);
            }
        }
        EXPECT_GT(above, 100u);
        fwDestroyWorld(world);
        return count;
    };
    EXPECT_EQ(0u, below(true));
    EXPECT_LT(40u, below(false)) << "no spark flies there without the slope";
}

}  // namespace
}  // namespace fw::test
