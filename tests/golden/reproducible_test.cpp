// The same fire in two contexts gives byte-equal pictures: nothing visible may depend on the
// device's thread order or on a clock.
#include "support/burnable.h"
#include "support/own_world.h"

#include <array>

namespace fw::test::reproducible_test {
namespace {

constexpr uint32_t kWidth = 320, kHeight = 180;

class Reproducible : public OwnDevice {
 protected:
    // A standing sheet of `side` m, lit near a corner and wet in its middle.
    static void addSheet(FwWorld* world, uint32_t preset, float side, float x, uint32_t flags) {
        const Mesh sheet = makeSheet(double(side), 6);
        FwMeshDef mesh = meshDefOf(sheet);
        mesh.texelsPerMetre = 256;
        FwBurnableMeshDef object = fwDefaultBurnableMeshDef();
        object.flags = flags | FW_BURNABLE_TWO_SIDED;
        object.transform[12] = x - 0.5f * side;
        object.transform[13] = -0.5f * side;
        const FwBurnableMeshId id = addBurnable(world, mesh, preset, object);
        FwIgnitionDef touch = fwDefaultIgnitionDef();
        touch.object = id;
        touch.position[0] = x - 0.2f * side;
        touch.position[1] = -0.3f * side;
        touch.radius = 0.03f;
        uint32_t texels = 0;
        ASSERT_EQ(fwWorld_Ignite(world, &touch, &texels), FW_OK);
        ASSERT_GT(texels, 0u);
        touch.kind = FW_WET;
        touch.position[0] = x + 0.1f * side;
        touch.position[1] = 0.1f * side;
        touch.radius = 0.2f * side;
        ASSERT_EQ(fwWorld_Ignite(world, &touch, nullptr), FW_OK);
    }

    static void film(FwContext* context, std::vector<Picture>& pictures) {
        FwWorldDef def = fwDefaultWorldDef();
        def.maxStepsPerFrame = 32;
        FwWorld* world = nullptr;
        ASSERT_EQ(fwCreateWorld(context, &def, &world), FW_OK);
        addSheet(world, FW_MATERIAL_NEWSPAPER, 0.4f, -0.22f, 0);
        addSheet(world, FW_MATERIAL_PAPER, 0.4f, 0.22f, FW_BURNABLE_REFINE);
        FwView view = viewAt({0.2f, 0.15f, 1.1f}, {0, 0, 0}, float(kWidth) / float(kHeight));
        for (int frame = 0; frame < 120; ++frame) {
            ASSERT_EQ(fwWorld_Step(world, 1.0f / 24), FW_OK);
            view.time = float(frame) / 24;
            if (frame % 15 == 14) pictures.push_back(pictureOf(world, view, kWidth, kHeight));
        }
        fwDestroyWorld(world);
    }
};

TEST_F(Reproducible, TwoContextsGiveByteEqualPictures) {
    std::array<std::vector<Picture>, 2> films;
    for (std::vector<Picture>& pictures : films) {
        film(context_, pictures);
        fwDestroyContext(context_);
        context_ = nullptr;
        const FwContextDef def = fwDefaultContextDef();
        ASSERT_EQ(fwCreateContext(&def, &context_, nullptr), FW_OK);
    }
    ASSERT_EQ(films[0].size(), 8u);
    ASSERT_EQ(films[1].size(), films[0].size());
    for (size_t k = 0; k < films[0].size(); ++k) {
        size_t differ = 0;
        for (size_t i = 0; i < films[0][k].rgb.size(); ++i)
            differ += films[0][k].rgb[i] != films[1][k].rgb[i];
        EXPECT_EQ(differ, 0u) << "in picture " << k;
    }
    EXPECT_NE(films[0].front().rgb, films[0].back().rgb) << "it burns";
}

}  // namespace
}  // namespace fw::test::reproducible_test
