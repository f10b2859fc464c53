// A host's vertex buffer in centimetres draws at the same place as one in metres.
#include "support/burn_scene.h"
#include "support/burnable.h"
#include "support/host_context.h"

#include <array>

namespace fw::test {
namespace {

class VertexUnits : public HostContext {
 protected:
    void SetUp() override {
        HostContext::SetUp();
        if (!context_) return;
        ASSERT_EQ(fwContext_Prepare(context_), FW_OK);
    }
    void TearDown() override {
        if (device_) vkDeviceWaitIdle(device_->device);
        HostContext::TearDown();
    }

    // Position of the strongest light of a burning ball that a vertex buffer moves by 2 m.
    // `vertexUnit`: m per unit of the buffer; `worldUnit`: m per unit of the world.
    std::array<float, 3> lightOf(float worldUnit, float vertexUnit) {
        HostFrames frames(*device_, 2);
        FwWorldDef worldDef = fwDefaultWorldDef();
        worldDef.metersPerUnit = worldUnit;
        FwWorld* world = nullptr;
        EXPECT_EQ(fwCreateWorld(context_, &worldDef, &world), FW_OK);
        Mesh ball = makeCube(1.0, 4, true, false);
        for (float& value : ball.positions) value /= vertexUnit;
        FwMeshDef mesh = fwDefaultMeshDef();
        mesh.metersPerUnit = vertexUnit;
        mesh.positions = ball.positions.data();
        mesh.indices = ball.indices.data();
        mesh.vertexCount = ball.vertexCount();
        mesh.indexCount = uint32_t(ball.indices.size());
        mesh.texelsPerMetre = 32;
        FwBurnableMeshDef object = fwDefaultBurnableMeshDef();
        object.flags = FW_BURNABLE_SKINNED;
        for (int i = 0; i < 15; i += 5) object.transform[i] = vertexUnit / worldUnit;
        const FwBurnableMeshId id = addBurnable(world, mesh, FW_MATERIAL_PAPER, object);
        FwIgnitionDef match = fwDefaultIgnitionDef();
        match.position[2] = 0.5f / worldUnit;
        match.radius = 0.25f / worldUnit;
        EXPECT_EQ(fwWorld_Ignite(world, &match, nullptr), FW_OK);
        const TestBuffer moved = device_->makeBuffer(ball.positions.size() * sizeof(float),
                                                     VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
        auto* places = static_cast<float*>(moved.mapped);
        for (size_t i = 0; i < ball.positions.size(); ++i)
            places[i] = ball.positions[i] + (i % 3 == 0 ? 2 / vertexUnit : 0.0f);
        FwVulkanVertices vertices = fwDefaultVulkanVertices();
        vertices.vertexCount = ball.vertexCount();
        vertices.buffer = moved.buffer;
        vertices.stageBefore = vertices.stageAfter = VK_PIPELINE_STAGE_HOST_BIT;
        vertices.accessBefore = vertices.accessAfter = VK_ACCESS_HOST_WRITE_BIT;
        const FwView view = fwDefaultView();
        for (int f = 0; f < 16; ++f) {
            EXPECT_EQ(fwWorld_SetVertexBuffer(world, id, &vertices), FW_OK);
            const FwVulkanFrame frame = frames.begin(0.125f);
            EXPECT_EQ(fwWorld_RecordOutside(world, &frame, &view), FW_OK);
            frames.submit();
        }
        frames.waitAll();
        FwLight light{};
        EXPECT_EQ(fwWorld_GetLights(world, &light, 1), 1u);
        fwDestroyWorld(world);
        return {light.position[0] * worldUnit, light.position[1] * worldUnit,
                light.position[2] * worldUnit};
    }
};

TEST_F(VertexUnits, BuffersAreInTheMeshesUnit) {
    if (!device_) return;
    const std::array<float, 3> metres = lightOf(1, 1);
    EXPECT_NEAR(metres[0], 2, 0.6) << "at the buffer's place";
    const std::array<float, 3> both = lightOf(0.01f, 0.01f), assets = lightOf(0.01f, 1);
    for (size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(metres[i], both[i], 0.01);
        EXPECT_NEAR(metres[i], assets[i], 0.01) << "a mesh in metres in a world in centimetres";
    }
}

}  // namespace
}  // namespace fw::test
