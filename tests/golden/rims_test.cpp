// Rims of holes are cut as geometry near the camera and found per pixel far away. A camera crosses
// the switch in both directions in front of a half-burnt box: no frame may differ from the previous
// one much more than its neighbours do. FLAMEWRIGHT_MOTION=<folder> keeps the frames.
#include "support/own_world.h"
#include "support/refine_scene.h"
#include "support/sanitized.h"

#include <cstdlib>

namespace fw::test::rims_test {
namespace {

constexpr uint32_t kWidth = 320, kHeight = 240;
constexpr uint32_t kPlaces = rounds(6, 2);

class Rims : public OwnWorld {
 protected:
    Picture draw(float distance) {
        const glm::vec3 target(0.4f, 0.4f, 0.4f);
        const glm::vec3 eye = target + distance * glm::normalize(glm::vec3(-1.2f, 0.7f, 1));
        return pictureOf(world_, viewAt(eye, target, float(kWidth) / float(kHeight)), kWidth,
                         kHeight);
    }
};

// In 1/255. sum: differences of the pixels that the object covers. glow: brightness change of the
// 16 x 16 block that changes most.
struct Difference {
    double sum = 0, glow = 0;
};
Difference differenceOf(const Picture& a, const Picture& b) {
    constexpr uint32_t kBlock = 16, kAcross = kWidth / kBlock;
    std::vector<double> blocks(size_t{kAcross} * (kHeight / kBlock));
    double sum = 0, covered = 1;
    for (uint32_t y = 0; y < kHeight; ++y)
        for (uint32_t x = 0; x < kWidth; ++x) {
            const size_t at = (size_t{y} * kWidth + x) * 3;
            int most = 0, all = 0;
            for (size_t c = 0; c < 3; ++c) {
                const int d = int(a.rgb[at + c]) - int(b.rgb[at + c]);
                most = std::max(most, std::abs(d));
                all += d;
            }
            covered += !std::equal(&b.rgb[at], &b.rgb[at] + 3, b.rgb.data());
            sum += most;
            blocks[size_t{y / kBlock} * kAcross + x / kBlock] += all / double(3 * kBlock * kBlock);
        }
    Difference d;
    d.sum = sum / covered;
    for (const double block : blocks) d.glow = std::max(d.glow, std::abs(block));
    return d;
}

TEST_F(Rims, CutAndPerPixelRimsAgreeAtTheSwitch) {
    FwWorld* worlds[2];
    for (FwWorld*& world : worlds) {
        makeWorld(1, 32);
        world = world_;
        const Mesh mesh = gridBox(0.8, 0.8, 0.8, 1, 1, 1);
        FwMeshDef def = meshDefOf(mesh);
        def.mapSize = 1024;
        def.texelsPerMetre = 96;
        FwMaterialDef wood = fwDefaultMaterialDef();
        wood.spreadRate = 0.05f;
        wood.windGain = wood.upGain = wood.headGain = wood.ceilingGain = 0;
        wood.burnTime = 6;
        add(def, wood, FW_BURNABLE_LITE | FW_BURNABLE_REFINE);
        touch(FW_IGNITE, 0, 0.45f, 0.45f, 0.03f);
        run(12, 0.25f);
        for (int i = 0; i < 24; ++i) fwWorld_Step(world_, 0);
        draw(6.0f);  // from here on the world knows the picture's size
    }
    for (uint32_t i = 0; i < kPlaces; ++i) {
        // Both switches lie outside: coming from afar holes are still per pixel, coming from nearby
        // still cut.
        const float distance = 4.95f - 0.13f * float(i);
        Picture pictures[2];
        for (const int nearby : {0, 1}) {
            world_ = worlds[nearby];
            fwWorld_Step(world_, 1.0f / 60);
            draw(nearby ? 3.0f : 6.0f);
            pictures[nearby] = draw(distance);
            if (const char* folder = std::getenv("FLAMEWRIGHT_MOTION"))
                writePng(std::string(folder) + "/rims" + std::to_string(i) +
                             (nearby ? "_cut.png" : "_discarded.png"),
                         pictures[nearby]);
        }
        const Difference switched = differenceOf(pictures[0], pictures[1]);
        const Difference moved = differenceOf(draw(0.996f * distance), pictures[1]);
        std::printf(
            "%.2f m: the switch changes %.2f, a block's light by %.1f; 0.4 %% nearer %.2f, %.1f\n",
            double(distance), switched.sum, switched.glow, moved.sum, moved.glow);
        EXPECT_GT(switched.sum, 0.5) << "nothing switched";
        EXPECT_LT(switched.sum, 1.5 * moved.sum);
        EXPECT_LT(switched.glow, 5.5);
    }
}

}  // namespace
}  // namespace fw::test::rims_test
