// Tests of pictures that need no host: a context of the library's own device, and one object that
// burns. Skipped where there is no device.
#pragma once
#include "support/mesh_def.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace fw::test {

class OwnDevice : public testing::Test {
 protected:
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
    void makeWorld(float pace, uint32_t maxSteps) {
        FwWorldDef def = fwDefaultWorldDef();
        def.paceFactor = pace;
        def.maxStepsPerFrame = maxSteps;
        def.maxFlames = 0;
        ASSERT_EQ(fwCreateWorld(context_, &def, &world_), FW_OK);
    }
    void add(const FwMeshDef& mesh, const FwMaterialDef& material, uint32_t flags) {
        FwBurnableMeshDef object = fwDefaultBurnableMeshDef();
        object.flags = flags;
        ASSERT_EQ(fwWorld_CreateMesh(world_, &mesh, &object.mesh), FW_OK);
        ASSERT_EQ(fwWorld_CreateMaterial(world_, &material, &object.materials[0]), FW_OK);
        FwBurnableMeshId id{};
        ASSERT_EQ(fwWorld_CreateBurnableMesh(world_, &object, &id), FW_OK);
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
};

}  // namespace fw::test
