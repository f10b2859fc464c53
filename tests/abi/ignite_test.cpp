// fwWorld_Ignite reports whether the match lit something, or why not.
#include "abi/abi_support.h"

#include <gmock/gmock.h>

#include <set>
#include <vector>

namespace {

using host::created;
using host::lastMessage;
using host::SheetWorld;
using ::testing::HasSubstr;

FwIgnitionDef matchAt(float x, float y, float z, float radius) {
    FwIgnitionDef def = fwDefaultIgnitionDef();
    def.position[0] = x;
    def.position[1] = y;
    def.position[2] = z;
    def.radius = radius;
    return def;
}

TEST(Ignite, AnObjectWithoutMaterialsBurnsAsPine) {
    SheetWorld w(fwDefaultMaterialDef());
    FwBurnableMeshDef def = fwDefaultBurnableMeshDef();
    def.mesh = w.mesh;
    ASSERT_EQ(FW_OK, fwWorld_CreateBurnableMesh(w.world, &def, &w.object)) << lastMessage(w.world);
    FwIgnitionDef match = matchAt(0.5f, 0, 0.125f, 0.05f);
    match.object = w.object;
    uint32_t texels = 0;
    EXPECT_EQ(FW_OK, fwWorld_Ignite(w.world, &match, &texels)) << lastMessage(w.world);
    EXPECT_GT(texels, 0u);
    w.run(2);
    EXPECT_GT(w.state().burning, 0u);
    EXPECT_GT(w.state().texels, 0u);
}

TEST(Ignite, UnsetMaterialSlotsAreNoncombustibleIfOneIsSet) {
    SheetWorld w(fwDefaultMaterialDef());
    FwBurnableMeshDef def = fwDefaultBurnableMeshDef();
    def.mesh = w.mesh;
    def.materials[3] = w.materialId;  // a slot of no triangle
    const FwBurnableMeshId id = created(fwWorld_CreateBurnableMesh, w.world, def);
    FwIgnitionDef match = matchAt(0.5f, 0, 0.125f, 0.05f);
    match.object = id;
    uint32_t texels = 0;
    EXPECT_EQ(FW_NOTHING_THERE, fwWorld_Ignite(w.world, &match, &texels));
    EXPECT_GT(texels, 0u);
    EXPECT_THAT(lastMessage(w.world), HasSubstr("noncombustible"));
}

TEST(Ignite, AMissReportsTheNearestObjectAndItsDistance) {
    SheetWorld w(fwDefaultMaterialDef());
    const FwIgnitionDef match = matchAt(0.5f, 3.0f, 0.125f, 0.05f);
    uint32_t texels = 7;
    EXPECT_EQ(FW_NOTHING_THERE, fwWorld_Ignite(w.world, &match, &texels));
    EXPECT_EQ(0u, texels);
    EXPECT_THAT(lastMessage(w.world), HasSubstr("the nearest burnable mesh, 1, is 3 m away"));
    EXPECT_TRUE(w.host.errors.empty());
    EXPECT_STREQ("FW_NOTHING_THERE", fwResultName(FW_NOTHING_THERE));
}

TEST(Ignite, ReportsTheNearestObjectAtAnyDistance) {
    SheetWorld w(fwDefaultMaterialDef());
    const FwBurnableMeshId other = w.add(8);
    const float above[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 8, 0, 1};
    ASSERT_EQ(FW_OK, fwWorld_SetTransform(w.world, other, above));
    const FwIgnitionDef far = matchAt(0.5f, 9e5f, 0.125f, 0.05f),
                        between = matchAt(0.5f, 6, 0.125f, 0.05f);
    EXPECT_EQ(FW_NOTHING_THERE, fwWorld_Ignite(w.world, &far, nullptr));
    EXPECT_THAT(lastMessage(w.world), HasSubstr("is 900000 m away"));
    EXPECT_EQ(FW_NOTHING_THERE, fwWorld_Ignite(w.world, &between, nullptr));
    EXPECT_THAT(lastMessage(w.world),
                HasSubstr("mesh, " + std::to_string(other.index1) + ", is 2 m away"));
}

// A ball around a whole object is one event, listed with those of single texels.
TEST(Ignite, WholeObjectEventsAgreeOnBothBackends) {
    std::vector<uint64_t> hashes[2];
    for (const uint32_t backend : {FW_BACKEND_CPU, FW_BACKEND_VULKAN}) {
        host::HostedWorld w(backend);
        if (!w.world) GTEST_SKIP() << "there is no such backend here";
        FwWorld* const world = w.world;
        const host::Sheet sheet(1, 1);
        const FwMeshDef meshDef = sheet.def(128);
        FwBurnableMeshDef made = fwDefaultBurnableMeshDef();
        ASSERT_EQ(FW_OK, fwWorld_CreateMesh(world, &meshDef, &made.mesh)) << lastMessage(world);
        FwBurnableMeshId ids[4] = {};
        for (FwBurnableMeshId& id : ids)
            ASSERT_EQ(FW_OK, fwWorld_CreateBurnableMesh(world, &made, &id));
        const auto ball = [&](uint32_t kind, FwBurnableMeshId id, float radius) {
            FwIgnitionDef one = matchAt(0.5f, 0, 0.5f, radius);
            one.kind = kind;
            one.object = id;
            EXPECT_EQ(FW_OK, fwWorld_Ignite(world, &one, nullptr)) << lastMessage(world);
        };
        ball(FW_IGNITE, ids[0], 2);
        ball(FW_IGNITE, ids[1], 0.4f);
        ball(FW_WET, ids[2], 2);
        ball(FW_EXTINGUISH, ids[3], 0.4f);
        for (int i = 0; i < 8; ++i) ASSERT_EQ(FW_OK, fwWorld_Step(world, 1.0f / 32));
        ball(FW_EXTINGUISH, ids[0], 2);
        for (int i = 0; i < 8; ++i) ASSERT_EQ(FW_OK, fwWorld_Step(world, 1.0f / 32));
        for (const FwBurnableMeshId id : ids)
            hashes[backend == FW_BACKEND_VULKAN].push_back(w.hash(id));
    }
    EXPECT_EQ(hashes[0], hashes[1]);
    EXPECT_EQ(4u, std::set<uint64_t>(hashes[0].begin(), hashes[0].end()).size());
}

TEST(Ignite, ReportsAnEmptyWorld) {
    SheetWorld w(fwDefaultMaterialDef());
    ASSERT_EQ(FW_OK, fwWorld_DestroyBurnableMesh(w.world, w.object));
    const FwIgnitionDef match = matchAt(0, 0, 0, 1);
    EXPECT_EQ(FW_NOTHING_THERE, fwWorld_Ignite(w.world, &match, nullptr));
    EXPECT_THAT(lastMessage(w.world), HasSubstr("no burnable mesh"));
}

TEST(Ignite, QueuedWaterPreventsIgnition) {
    for (const float radius : {0.05f, 5.0f}) {  // some texels; the whole object
        SheetWorld w(fwDefaultMaterialDef());
        FwIgnitionDef ball = matchAt(0.5f, 0, 0.125f, radius);
        ball.kind = FW_WET;
        ASSERT_EQ(FW_OK, fwWorld_Ignite(w.world, &ball, nullptr)) << lastMessage(w.world);
        ball.kind = FW_IGNITE;
        EXPECT_EQ(FW_NOTHING_THERE, fwWorld_Ignite(w.world, &ball, nullptr));
        EXPECT_THAT(lastMessage(w.world), HasSubstr("water is on its way"));
        w.run(1);
        EXPECT_EQ(0u, w.state().burning);
        // Water elsewhere has no effect.
        ball.kind = FW_WET;
        ball.position[0] = 0;
        ball.radius = 0.05f;
        ASSERT_EQ(FW_OK, fwWorld_Ignite(w.world, &ball, nullptr));
        ball.kind = FW_IGNITE;
        ball.position[0] = 0.9f;
        EXPECT_EQ(FW_OK, fwWorld_Ignite(w.world, &ball, nullptr)) << lastMessage(w.world);
    }
}

TEST(Ignite, MissedWaterAndExtinguishingReachNothing) {
    SheetWorld w(fwDefaultMaterialDef());
    for (const uint32_t kind : {FW_WET, FW_DRY, FW_EXTINGUISH}) {
        FwIgnitionDef ball = matchAt(0.5f, 3.0f, 0.125f, 0.05f);
        ball.kind = kind;
        EXPECT_EQ(FW_NOTHING_THERE, fwWorld_Ignite(w.world, &ball, nullptr));
        ball.position[1] = 0;
        EXPECT_EQ(FW_OK, fwWorld_Ignite(w.world, &ball, nullptr));
    }
}

}  // namespace
