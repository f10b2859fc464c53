// Pictures of particle fields.
#include "support/own_world.h"

#include <algorithm>
#include <cmath>

namespace fw::test::field_picture_test {
namespace {

class FieldPicture : public OwnWorld {};

// A sheet of water falls into a pool in the sun. Neither its source nor the pool's surface, where
// the sheet ends within a cell or two, may be a row of white dots.
TEST_F(FieldPicture, SheetsOfWaterHaveNoWhiteDottedRims) {
    constexpr uint32_t kSide = 192;  // px
    for (const uint32_t cells : {32u, 64u}) {
        FwWorld* world = nullptr;
        const FwWorldDef worldDef = fwDefaultWorldDef();
        ASSERT_EQ(FW_OK, fwCreateWorld(context_, &worldDef, &world));
        FwParticleFieldDef def = fwDefaultParticleFieldDef();
        ASSERT_EQ(FW_OK, fwInitFieldPreset(&def, FW_FIELD_WATER));
        def.width = def.height = cells;
        def.life *= float(cells) / 32;  // speeds are in cells
        def.size[0] = 1.1f;
        def.size[1] = 1.3f;
        (void)created(fwWorld_CreateParticleField, world, def);
        for (int i = 0; i < 4 * 24; ++i) fwWorld_Step(world, 1.0f / 24);
        FwView view = frontView({0, 0.65f}, 1.5f, 1.5f);
        const float sun[3] = {0.28f, 0.58f, 0.76f};
        std::copy_n(sun, 3, view.sunDirection);
        for (int c = 0; c < 3; ++c) {
            view.sunColor[c] = 1.6f;
            view.ambientSky[c] = 0.5f;
            view.ambientGround[c] = 0.2f;
        }
        const float dark[4] = {0.02f, 0.02f, 0.02f, 1};
        const std::vector<uint8_t> pixels = shoot(world, view, kSide, kSide, dark);
        // For each row of the sheet, the white share.
        float worst = 0;
        int rows = 0;
        for (uint32_t y = 0; y < kSide; ++y) {
            int covered = 0, white = 0;
            for (uint32_t x = 0; x < kSide; ++x) {
                const uint8_t* p = &pixels[4 * (size_t(y) * kSide + x)];
                covered += p[2] > 60;
                white += std::min({p[0], p[1], p[2]}) > 200;
            }
            if (covered < 20) continue;
            ++rows;
            worst = std::max(worst, float(white) / float(covered));
        }
        std::printf("[   FIGURE ] %u cells: %d rows, of the worst %.3f is white\n", cells, rows,
                    double(worst));
        EXPECT_GT(rows, 100);
        EXPECT_LT(worst, 0.03f) << cells;
        fwDestroyWorld(world);
    }
}

}  // namespace
}  // namespace fw::test::field_picture_test
