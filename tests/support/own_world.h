// Picture tests without a host: a context on its own device and one burning object. Skipped without
// a device.
#pragma once
#include "golden/golden_image.h"
#include "support/burnable.h"
#include "support/mesh_def.h"
#include "support/views.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace fw::test {

class OwnDevice : public testing::Test {
 protected:
    static constexpr float kNoSurface[4] = {0.10f, 0.0f, 0.30f,
                                            1};  // linear, the colour of no surface

    // RGBA over that colour.
    static std::vector<uint8_t> shoot(FwWorld* world, const FwView& view, uint32_t width,
                                      uint32_t height, const float* background = kNoSurface) {
        std::vector<uint8_t> pixels(size_t{width} * height * 4);
        FwOffscreenDef shot = fwDefaultOffscreenDef();
        shot.width = width;
        shot.height = height;
        shot.pixels = pixels.data();
        shot.view = view;
        std::copy_n(background, 4, shot.background);
        EXPECT_EQ(fwWorld_RenderOffscreen(world, &shot), FW_OK);
        return pixels;
    }
    static Picture pictureOf(FwWorld* world, const FwView& view, uint32_t width, uint32_t height) {
        const std::vector<uint8_t> pixels = shoot(world, view, width, height);
        Picture picture{width, height, std::vector<uint8_t>(size_t{width} * height * 3)};
        for (size_t i = 0; i < size_t{width} * height; ++i)
            std::copy_n(&pixels[i * 4], 3, &picture.rgb[i * 3]);
        return picture;
    }

    void SetUp() override {
        const FwContextDef def = fwDefaultContextDef();
        FwErrorInfo info{};
        if (fwCreateContext(&def, &context_, &info) != FW_OK) GTEST_SKIP() << info.message;
    }
    void TearDown() override { fwDestroyContext(context_); }

    FwContext* context_ = nullptr;
};

class OwnWorld : public OwnDevice {
 protected:
    // Without flames.
    void makeWorld(float pace, uint32_t maxSteps, uint32_t flags = 0) {
        FwWorldDef def = fwDefaultWorldDef();
        def.flags |= flags;
        def.paceFactor = pace;
        def.maxStepsPerFrame = maxSteps;
        def.maxFlames = 0;
        ASSERT_EQ(fwCreateWorld(context_, &def, &world_), FW_OK);
    }
    void add(const FwMeshDef& mesh, const FwMaterialDef& material, uint32_t flags) {
        FwBurnableMeshDef object = fwDefaultBurnableMeshDef();
        object.flags = flags;
        added_ = addBurnable(world_, mesh, material, object);
    }
    void touch(uint32_t kind, float x, float y, float z, float radius) {
        FwIgnitionDef def = fwDefaultIgnitionDef();
        def.kind = kind;
        def.position[0] = x;
        def.position[1] = y;
        def.position[2] = z;
        def.radius = radius;
        uint32_t texels = 0;
        ASSERT_EQ(fwWorld_Ignite(world_, &def, &texels), FW_OK);
        ASSERT_GT(texels, 0u);
    }
    void run(float seconds, float step) {
        for (float t = 0; t < seconds; t += step) fwWorld_Step(world_, step);
    }

    FwWorld* world_ = nullptr;
    FwBurnableMeshId added_{};  // the last one added
};

}  // namespace fw::test
