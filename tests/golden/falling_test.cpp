// Unsupported burnt pieces fall to ash. A tall strip of wood burns through in the middle: the upper
// part must vanish long before it is consumed, or stay if something unburnt above holds it.
#include "support/own_world.h"

namespace fw::test::falling_test {
namespace {

constexpr uint32_t kWidth = 64, kHeight = 256;  // px: a strip of 0.15 x 1.2 m fills the height

class Falling : public OwnWorld {
 protected:
    // Burns from the middle for `seconds` with a wet foot. Returns the visible share of the upper
    // part.
    double upperPart(bool wetTop, float seconds) {
        makeWorld(1, 8);
        const Mesh mesh = makePlane(0.15, 1.2, 0, 1, 0, 4);
        FwMeshDef def = meshDefOf(mesh);
        def.texelsPerMetre = 128;
        def.noiseAmplitude = 0;
        FwMaterialDef pine = fwDefaultMaterialDef();
        pine.upGain = 0;
        pine.spreadRate = 0.06f;  // an appearance second is 10 ms: holes come after 6.2 s
        add(def, pine, FW_BURNABLE_TWO_SIDED);
        touch(FW_WET, 0.075f, 0.0f, 0, 0.25f);
        if (wetTop) touch(FW_WET, 0.075f, 1.2f, 0, 0.12f);
        touch(FW_IGNITE, 0.075f, 0.45f, 0, 0.08f);
        fwWorld_Step(world_, 0);
        run(seconds, 1.0f / 32);
        const float blue[4] = {0, 0, 1, 1};
        const std::vector<uint8_t> pixels =
            shoot(world_, frontView({0.075f, 0.6f}, 0.3f, 1.2f), kWidth, kHeight, blue);
        uint32_t seen = 0, all = 0;
        for (uint32_t y = 0; y < kHeight * 2 / 5; ++y) {  // above 0.72 m
            for (uint32_t x = kWidth / 4 + 1; x < kWidth * 3 / 4 - 1; ++x, ++all)
                seen += pixels[(size_t{y} * kWidth + x) * 4 + 2] != 255;
        }
        fwDestroyWorld(world_);
        return double(seen) / double(all);
    }
};

TEST_F(Falling, UnsupportedPiecesFallToAsh) {
    // The front reaches the top after 12.5 s. By then the middle is gone and everything above
    // stands.
    EXPECT_GT(upperPart(false, 9), 0.9);
    // On its own the top would burn away after some 19 s.
    EXPECT_LT(upperPart(false, 15.5f), 0.02);
}

TEST_F(Falling, SupportedPiecesStay) { EXPECT_GT(upperPart(true, 13.0f), 0.4); }

}  // namespace
}  // namespace fw::test::falling_test
