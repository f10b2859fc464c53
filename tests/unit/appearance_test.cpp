// Data of the appearance: presets, textures, the view's uniform block. tests/golden covers the
// pictures.
#include "components/appearance_table.h"
#include "components/appearance_textures.h"
#include "gpu/passes/draw.h"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <cmath>
#include <cstring>

namespace fw::components {
namespace {

using gpu::MaterialAppearance;

TEST(AppearanceTable, EveryPresetIsComplete) {
    for (uint32_t preset = 0; preset < FW_MATERIAL_PRESET_COUNT; ++preset) {
        const MaterialAppearance m = materialAppearance(preset);
        SCOPED_TRACE(preset);
        EXPECT_EQ(m.spreadRate > 0, preset != FW_MATERIAL_NONCOMBUSTIBLE);
        // Shaders divide by these.
        for (const float divisor :
             {m.charTime, m.facePeak, m.faceDecay, m.crackLife, m.cellX, m.cellY, m.rimWidth,
              m.thickness, m.drip, m.ashEnd - m.ashStart})
            EXPECT_GT(divisor, 0.0f);
        EXPECT_LE(m.holeVariation, m.holeTime);
        if (m.crackDepth > 0) {
            EXPECT_GT(m.crackWidth, 0.0f);
        }
        // Char lies between soot and slate.
        EXPECT_GT(m.charColor.x, 0.01f);
        EXPECT_LT(m.charColor.x, 0.05f);
        EXPECT_LE(m.ashMax, 1.0f);
    }
}

TEST(AppearanceTable, OutOfRangePresetsDoNotBurn) {
    EXPECT_EQ(materialAppearance(FW_MATERIAL_PRESET_COUNT).spreadRate, 0.0f);
    EXPECT_EQ(materialAppearance(0xFFFFFFFFu).spreadRate, 0.0f);
    EXPECT_EQ(materialAppearance(FW_MATERIAL_PRESET_COUNT).base, gpu::kBaseStone);
}

TEST(AppearanceTable, CracksOpenWhileTheyGlow) {
    for (uint32_t preset = 0; preset < FW_MATERIAL_PRESET_COUNT; ++preset) {
        const MaterialAppearance m = materialAppearance(preset);
        if (m.crackDepth > 0) {
            EXPECT_LT(m.crackTime, 0.6f * m.crackLife) << preset;
        }
    }
}

class AppearanceTextures : public testing::Test {
 protected:
    static void SetUpTestSuite() {
        bytes_ = new std::pmr::vector<std::byte>(
            bakeAppearanceTextures(std::pmr::new_delete_resource()));
    }
    static void TearDownTestSuite() { delete bytes_; }
    static int at(uint32_t layer, uint32_t mip, uint32_t x, uint32_t y, uint32_t channel) {
        const uint32_t side = kAppearanceTextureSide >> mip;
        return int((*bytes_)[appearanceTextureOffset(layer, mip) +
                             size_t{(y % side) * side + x % side} * 4 + channel]);
    }
    static std::pmr::vector<std::byte>* bytes_;
};
std::pmr::vector<std::byte>* AppearanceTextures::bytes_ = nullptr;

TEST_F(AppearanceTextures, HaveTheirSizesAndOffsets) {
    EXPECT_EQ(bytes_->size(), appearanceTextureOffset(kAppearanceTextureLayers, 0));
    EXPECT_EQ(appearanceTextureOffset(0, 1), size_t{512 * 512 * 4});
    EXPECT_EQ(appearanceTextureOffset(1, 0), size_t{349525 * 4});
}

TEST_F(AppearanceTextures, AreDeterministic) {
    const auto again = bakeAppearanceTextures(std::pmr::new_delete_resource());
    EXPECT_EQ(again, *bytes_);
}

TEST_F(AppearanceTextures, TileWithoutASeam) {
    // Across the edge the smooth channels change no more than elsewhere.
    for (const auto& [layer, channel] : {std::pair{0u, 0u}, {0u, 2u}, {1u, 3u}}) {
        double inside = 0, edge = 0;
        for (uint32_t i = 0; i < kAppearanceTextureSide; ++i) {
            inside += std::abs(at(layer, 0, 256, i, channel) - at(layer, 0, 257, i, channel)) +
                      std::abs(at(layer, 0, i, 100, channel) - at(layer, 0, i, 101, channel));
            edge += std::abs(at(layer, 0, 511, i, channel) - at(layer, 0, 0, i, channel)) +
                    std::abs(at(layer, 0, i, 511, channel) - at(layer, 0, i, 0, channel));
        }
        EXPECT_LT(edge, 4 * inside + 512) << layer << " " << channel;
    }
}

TEST_F(AppearanceTextures, MipsKeepTheMean) {
    for (uint32_t layer = 0; layer < kAppearanceTextureLayers; ++layer) {
        for (uint32_t c = 0; c < 4; ++c) {
            double mean = 0;
            for (uint32_t y = 0; y < 512; ++y)
                for (uint32_t x = 0; x < 512; ++x) mean += at(layer, 0, x, y, c);
            EXPECT_NEAR(mean / (512 * 512), at(layer, 9, 0, 0, c), 2) << layer << " " << c;
        }
    }
}

TEST_F(AppearanceTextures, NoiseIsCentred) {
    // fBm has mean 0.5, which the shaders subtract.
    EXPECT_NEAR(at(0, 9, 0, 0, 0), 128, 14);
    EXPECT_NEAR(at(0, 9, 0, 0, 2), 128, 14);
    // Slopes of tiling reliefs sum to zero.
    for (uint32_t c = 0; c < 4; ++c) EXPECT_NEAR(at(2, 9, 0, 0, c), 128, 3);
}

TEST(ViewParamsTest, ProjectsPointsLikeTheHost) {
    FwView view{};
    const glm::vec3 eye(1000.0f, 3.0f, -2000.0f), target(1001.0f, 2.0f, -2004.0f);
    const glm::mat4 look = glm::lookAt(eye, target, glm::vec3(0, 1, 0));
    glm::mat4 projection(0.0f);
    projection[0][0] = 1.2f;
    projection[1][1] = -2.0f;
    projection[2][3] = -1.0f;
    projection[3][2] = 0.1f;  // infinite, reversed
    std::memcpy(view.view, glm::value_ptr(look), sizeof view.view);
    std::memcpy(view.projection, glm::value_ptr(projection), sizeof view.projection);
    gpu::ViewInput input;
    input.view = &view;
    input.viewport[2] = 1280;
    input.viewport[3] = 720;
    input.flameCapacity = 1u << 30;
    const gpu::ViewParams p = gpu::makeViewParams(input);
    EXPECT_NEAR(p.eye.x, eye.x, 1e-3);
    EXPECT_NEAR(p.eye.z, eye.z, 1e-3);
    EXPECT_NEAR(p.eye.w, 2.0 / (2.0 * 720), 1e-7);
    EXPECT_EQ(p.forward.w, 1.0f);
    const glm::vec3 forward = glm::normalize(target - eye);
    EXPECT_NEAR(glm::dot(forward, glm::vec3(p.forward)), 1.0f, 1e-5);
    const glm::vec4 there = p.clip0 * (target.x - p.eye.x) + p.clip1 * (target.y - p.eye.y) +
                            p.clip2 * (target.z - p.eye.z) + p.clip3;
    EXPECT_NEAR(there.x / there.w, 0.0f, 1e-3);
    EXPECT_NEAR(there.y / there.w, 0.0f, 1e-3);
    EXPECT_NEAR(there.w, glm::length(target - eye), 1e-3);
    EXPECT_EQ(p.flameCapacity, gpu::kFlameCapacity);
}

TEST(ViewParamsTest, AcceptsViewsAlongPlusZ) {
    FwView view{};
    glm::mat4 look(1.0f), projection(0.0f);
    projection[0][0] = projection[1][1] = projection[2][2] = projection[2][3] = 1.0f;
    std::memcpy(view.view, glm::value_ptr(look), sizeof view.view);
    std::memcpy(view.projection, glm::value_ptr(projection), sizeof view.projection);
    gpu::ViewInput input;
    input.view = &view;
    const gpu::ViewParams p = gpu::makeViewParams(input);
    EXPECT_NEAR(p.forward.z, 1.0f, 1e-6);
}

// The room's index shares bits with draw flags; a house in the second room must be drawn like any
// other.
TEST(SurfaceDrawTest, IgnoresTheRoomOfAnObject) {
    gpu::BurnObject object{};
    const gpu::BurnMaterial material{};
    const gpu::HeatMaterial heat{};
    for (uint32_t room = 0; room <= 0xFF; ++room) {
        object.flags = gpu::kObjectLive | gpu::kObjectTwoSided | room << gpu::kObjectRoomShift;
        const gpu::SurfaceDraw draw =
            gpu::surfaceDraw(object, material, heat, 1.0f, 0, false, false);
        EXPECT_EQ(gpu::kObjectLive | gpu::kObjectTwoSided, draw.flags) << room;
    }
    EXPECT_EQ(gpu::kDrawVertexLight,
              gpu::surfaceDraw({}, material, heat, 1e-3f, 0, false, false).flags);
}

}  // namespace
}  // namespace fw::components
