// With distance a burning object shows fewer and larger flames that keep most of its light.
// FLAMEWRIGHT_MOTION=<folder> keeps the pictures.
#include "support/own_world.h"
#include "support/refine_scene.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace fw::test::far_flames_test {
namespace {

constexpr uint32_t kSide = 160;  // px
constexpr int kTimes = 6;
constexpr float kHigh = 0.5f;  // m, size of a burning cube

class FarFlames : public OwnWorld {
 protected:
    // Linear light of all pixels, corrected for distance, at a size of `px`.
    double light(float px) {
        constexpr float kZoom = 3.4f;
        const float away = kHigh * kZoom * float(kSide) / (2 * px);
        const glm::vec3 middle(0.5f * kHigh, 0.8f * kHigh, 0.5f * kHigh);
        const glm::vec3 from = away * glm::normalize(glm::vec3(-0.8f, 0.3f, 1));
        FwView view = viewAt(middle + from, middle, 1, kZoom);
        view.emissionScale = 0.1f;  // nothing saturates
        for (float* lit : {view.sunColor, view.ambientSky, view.ambientGround})
            std::fill_n(lit, 3, 0.0f);
        const float black[4] = {0, 0, 0, 1};
        const std::vector<uint8_t> pixels = shoot(world_, view, kSide, kSide, black);
        for (size_t i = 0; i < size_t{kSide} * kSide; ++i)
            std::copy_n(&pixels[i * 4], 3, &picture_.rgb[i * 3]);
        double sum = 0;
        for (size_t i = 0; i < pixels.size(); i += 4)
            for (size_t c = 0; c < 3; ++c) sum += std::pow(pixels[i + c] / 255.0, 2.2);
        return sum / double(px * px);
    }
    Picture picture_{kSide, kSide, std::vector<uint8_t>(size_t{kSide} * kSide * 3)};
};

TEST_F(FarFlames, KeepTheirLight) {
    FwWorldDef worldDef = fwDefaultWorldDef();
    worldDef.paceFactor = 60;
    worldDef.maxStepsPerFrame = 64;
    ASSERT_EQ(fwCreateWorld(context_, &worldDef, &world_), FW_OK);
    const Mesh mesh = gridBox(kHigh, kHigh, kHigh, 1, 1, 1);
    FwMeshDef def = meshDefOf(mesh);
    def.mapSize = 256;
    def.texelsPerMetre = 96;
    FwMaterialDef wood = fwDefaultMaterialDef();
    ASSERT_EQ(fwInitMaterialPreset(&wood, FW_MATERIAL_PINE), FW_OK);
    add(def, wood, FW_BURNABLE_NO_DAMAGE);
    touch(FW_IGNITE, 0, 0.5f * kHigh, 0.5f * kHigh, 0.1f);
    run(8, 1.0f);
    constexpr float kPx[] = {80, 20, 10};
    double seen[3] = {};
    for (int moment = 0; moment < kTimes; ++moment) {
        fwWorld_Step(world_, 0.125f);
        for (int i = 0; i < 3; ++i) seen[i] += light(kPx[i]) / kTimes;
    }
    if (const char* folder = std::getenv("FLAMEWRIGHT_MOTION"))
        for (float px : kPx) {
            light(px);
            writePng(std::string(folder) + "/far_flames_" + std::to_string(int(px)) + ".png",
                     picture_);
        }
    ASSERT_GT(seen[0], 0.0);
    for (int i = 1; i < 3; ++i) {
        std::printf("[   FIGURE ] %g px high: light %.3f of that at %g px\n", double(kPx[i]),
                    seen[i] / seen[0], double(kPx[0]));
        // Both 0.725 as measured.
        EXPECT_GT(seen[i] / seen[0], 0.6) << kPx[i] << " px";
        EXPECT_LT(seen[i] / seen[0], 1.3) << kPx[i] << " px";
    }
}

}  // namespace
}  // namespace fw::test::far_flames_test
