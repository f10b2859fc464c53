// Walls of a solid that burnt from both sides, seen from the front. Bounds keep them from
// intersecting; without bounds the depth peel pass of the reference implementation hides
// intersections behind holes.
#include "flamewright_reference.h"
#include "support/own_world.h"

#include <cstring>

namespace fw::test::crossing_test {
namespace {

constexpr uint32_t kSide = 96;  // px, of 0.3 m

class Crossing : public OwnDevice {
 protected:
    // A board of 0.2 x 0.2 x 0.02 m that is almost consumed: 0.03 m from either side.
    FwWorld* board(uint32_t flags) {
        FwWorldDef worldDef = fwDefaultWorldDef();
        worldDef.maxStepsPerFrame = 8;
        worldDef.maxFlames = 0;
        FwWorld* world = nullptr;
        EXPECT_EQ(fwCreateWorld(context_, &worldDef, &world), FW_OK);
        Mesh mesh = makeCube(0.2, 10);
        for (size_t i = 2; i < mesh.positions.size(); i += 3) mesh.positions[i] *= 0.1f;
        FwMeshDef def = meshDefOf(mesh);
        def.normals = nullptr;
        def.uvs = nullptr;
        def.mapSize = 64;
        def.noiseAmplitude = 0;
        FwBurnableMeshDef object = fwDefaultBurnableMeshDef();
        object.flags = flags | FW_BURNABLE_NO_HOLES | FW_BURNABLE_LITE;
        FwMaterialDef wood = fwDefaultMaterialDef();
        wood.thickness = 0.03f;
        wood.recede = 1;
        wood.burnTime = 0.5f;
        (void)addBurnable(world, def, wood, object);
        FwIgnitionDef match = fwDefaultIgnitionDef();
        match.radius = 1;
        EXPECT_EQ(fwWorld_Ignite(world, &match, nullptr), FW_OK);
        return world;
    }
    static std::vector<uint8_t> picture(FwWorld* world, uint32_t switches) {
        EXPECT_EQ(fwDebug_SetSwitches(world, switches), FW_OK);
        for (int i = 0; i < 6; ++i) fwWorld_Step(world, 0.125f);
        std::vector<uint8_t> pixels(size_t{kSide} * kSide * 4);
        FwOffscreenDef shot = fwDefaultOffscreenDef();
        shot.width = shot.height = kSide;
        shot.pixels = pixels.data();
        shot.view = fwDefaultView();
        const float blue[4] = {0, 0, 1, 1};
        std::copy_n(blue, 4, shot.background);
        std::memset(shot.view.view, 0, sizeof shot.view.view);
        std::memset(shot.view.projection, 0, sizeof shot.view.projection);
        for (int i = 0; i < 4; ++i) shot.view.view[i * 5] = 1;
        shot.view.view[14] = -1;
        shot.view.projection[0] = 1 / 0.15f;  // orthographic, y up
        shot.view.projection[5] = -1 / 0.15f;
        shot.view.projection[10] = -0.25f;
        shot.view.projection[15] = 1;
        EXPECT_EQ(fwWorld_RenderOffscreen(world, &shot), FW_OK);
        return pixels;
    }
    static size_t covered(const std::vector<uint8_t>& pixels) {
        size_t sum = 0;
        for (size_t i = 2; i < pixels.size(); i += 4) sum += pixels[i] != 255;
        return sum;
    }
    static size_t different(const std::vector<uint8_t>& a, const std::vector<uint8_t>& b) {
        size_t sum = 0;
        for (size_t i = 0; i < a.size(); i += 4) sum += std::memcmp(&a[i], &b[i], 4) != 0;
        return sum;
    }
};

TEST_F(Crossing, BoundedWallsNeverIntersectAndDepthPeelingHidesOthers) {
    FwWorld* plain = board(FW_BURNABLE_RECEDE);
    FwWorld* passed = board(FW_BURNABLE_RECEDE | FW_BURNABLE_DEPTH_PEEL);
    const std::vector<uint8_t> bounded = picture(plain, 0);
    EXPECT_GT(covered(bounded), 1000u);
    // Nothing to hide: with the pass the picture is the same but for a few outline pixels.
    EXPECT_LE(different(bounded, picture(passed, 0)), 4u);

    // Without bounds the back wall's inner side is in front of the front wall.
    const std::vector<uint8_t> crossed = picture(plain, FW_DEBUG_SELF_INTERSECTION);
    const std::vector<uint8_t> front =
        picture(passed, FW_DEBUG_SELF_INTERSECTION | FW_DEBUG_NO_DEPTH_PEEL);
    const std::vector<uint8_t> hidden = picture(passed, FW_DEBUG_SELF_INTERSECTION);
    std::printf("[   FIGURE ] px: bounded %zu, crossed %zu, its front %zu, with the Z-pass %zu\n",
                covered(bounded), covered(crossed), covered(front), covered(hidden));
    EXPECT_GT(covered(crossed), 1000u);
    EXPECT_GT(covered(front), 1000u);
    EXPECT_GT(different(crossed, front), covered(crossed) / 2);
    EXPECT_LT(covered(hidden), covered(front) / 3);
    fwDestroyWorld(plain);
    fwDestroyWorld(passed);
}

// The springs of the reference implementation pull walls through each other.
TEST_F(Crossing, SpringsNeedTheDepthPeelPass) {
    FwWorld* world = board(FW_BURNABLE_SPRINGS | FW_BURNABLE_DEPTH_PEEL);
    const std::vector<uint8_t> front = picture(world, FW_DEBUG_NO_DEPTH_PEEL);
    const std::vector<uint8_t> hidden = picture(world, 0);
    std::printf("[   FIGURE ] px: %zu, with the Z-pass %zu\n", covered(front), covered(hidden));
    EXPECT_GT(covered(front), 1000u);
    EXPECT_LT(covered(hidden), covered(front) * 3 / 4);
    fwDestroyWorld(world);
}

}  // namespace
}  // namespace fw::test::crossing_test
