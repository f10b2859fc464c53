// Which flags of the reference methods go together, and what of them the def tests check.
#include "flamewright_reference.h"
#include "support/own_world.h"

#include <gmock/gmock.h>

namespace fw::test::reference_flags_test {
namespace {

class ReferenceFlags : public OwnWorld {
 protected:
    void SetUp() override {
        OwnWorld::SetUp();
        if (IsSkipped()) return;
        makeWorld(1, 1);
        const Mesh cube = makeCube(0.2, 4);
        const FwMeshDef mesh = meshDefOf(cube);
        const FwMaterialDef wood = fwDefaultMaterialDef();
        ASSERT_EQ(fwWorld_CreateMesh(world_, &mesh, &def_.mesh), FW_OK);
        ASSERT_EQ(fwWorld_CreateMaterial(world_, &wood, &def_.materials[0]), FW_OK);
    }
    FwResult make(uint32_t flags) {
        def_.flags = flags;
        FwBurnableMeshId id{};
        return fwWorld_CreateBurnableMesh(world_, &def_, &id);
    }
    FwBurnableMeshDef def_ = fwDefaultBurnableMeshDef();
};

TEST_F(ReferenceFlags, DepthPeelNeedsWhatMovesWalls) {
    EXPECT_EQ(make(uint32_t{FW_BURNABLE_SHELL} | FW_BURNABLE_DEPTH_PEEL),
              FW_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(lastMessage(world_), testing::HasSubstr("FW_BURNABLE_DEPTH_PEEL needs"));
    EXPECT_EQ(make(uint32_t{FW_BURNABLE_RECEDE} | FW_BURNABLE_DEPTH_PEEL), FW_OK)
        << lastMessage(world_);
}

TEST_F(ReferenceFlags, SpringsMoveWallsAndExcludeOtherDeformations) {
    EXPECT_EQ(make(uint32_t{FW_BURNABLE_SPRINGS} | FW_BURNABLE_DEPTH_PEEL), FW_OK)
        << lastMessage(world_);
    for (const uint32_t other :
         {FW_BURNABLE_REFINE, FW_BURNABLE_RECEDE, FW_BURNABLE_SHELL, FW_BURNABLE_SKINNED}) {
        EXPECT_EQ(make(FW_BURNABLE_SPRINGS | other), FW_ERROR_INVALID_ARGUMENT) << other;
        EXPECT_THAT(lastMessage(world_), testing::HasSubstr("FwBurnableMeshDef::flags is 0x"));
    }
}

TEST_F(ReferenceFlags, RefinementExcludesWhatMovesVertices) {
    EXPECT_EQ(make(FW_BURNABLE_REFINE_PUBLISHED), FW_OK) << lastMessage(world_);
    for (const uint32_t other :
         {uint32_t{FW_BURNABLE_REFINE}, uint32_t{FW_BURNABLE_RECEDE}, uint32_t{FW_BURNABLE_SHELL},
          FW_BURNABLE_SPRINGS, uint32_t{FW_BURNABLE_SKINNED}}) {
        EXPECT_EQ(make(FW_BURNABLE_REFINE_PUBLISHED | other), FW_ERROR_INVALID_ARGUMENT) << other;
        EXPECT_THAT(lastMessage(world_), testing::HasSubstr("FwBurnableMeshDef::flags is 0x"));
    }
}

TEST_F(ReferenceFlags, PublishedKernelForecastsNoArrival) {
    def_.flags = FW_BURNABLE_PUBLISHED;
    FwBurnableMeshId id{};
    ASSERT_EQ(fwWorld_CreateBurnableMesh(world_, &def_, &id), FW_OK);
    const float middle[3] = {};
    FwQueryId query{};
    EXPECT_EQ(fwWorld_RequestArrival(world_, id, middle, &query), FW_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(lastMessage(world_), testing::HasSubstr("burns by an extension"));
}

TEST_F(ReferenceFlags, PublishedFieldRunsTenStepsASecond) {
    FwParticleFieldDef field = fwDefaultParticleFieldDef();
    ASSERT_EQ(fwInitFieldPreset(&field, FW_FIELD_FIRE), FW_OK);
    field.flags = FW_FIELD_AS_PUBLISHED;
    FwParticleFieldId id{};
    ASSERT_EQ(fwWorld_CreateParticleField(world_, &field, &id), FW_OK) << lastMessage(world_);
    run(3, 1.0f / 32);
    for (int i = 0; i < 4; ++i) fwWorld_Step(world_, 0);  // the state comes some frames late
    FwParticleFieldState state{};
    state.structSize = sizeof state;
    ASSERT_EQ(fwWorld_GetParticleFieldState(world_, id, &state), FW_OK);
    EXPECT_EQ(state.steps, 30u);
}

}  // namespace
}  // namespace fw::test::reference_flags_test
