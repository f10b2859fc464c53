// flamewright.hpp as a host uses it: owners close their objects, failures are null with a reason.
#include "abi/abi_support.h"
#include "flamewright/flamewright.hpp"

namespace {

TEST(Wrapper, ClosesInOrderAndExplainsFailures) {
    host::Host host;
    {
        FwContextDef contextDef = fw::def<FwContextDef>();
        contextDef.backend = FW_BACKEND_CPU;
        contextDef.callbacks = host.callbacks();
        FwErrorInfo error{};
        const fw::Context context = fw::createContext(contextDef, &error);
        ASSERT_TRUE(context) << error.message;
        FwWorldDef bad = fw::def<FwWorldDef>();
        bad.paceFactor = 0;
        EXPECT_FALSE(fw::createWorld(context, bad));
        EXPECT_EQ(
            "FwWorldDef::paceFactor is 0; the limits are [0.1, 1000].\n"
            " - While calling fwCreateWorld.",
            fw::lastMessage(context));
        const fw::World world = fw::createWorld(context);
        ASSERT_TRUE(world);

        const host::Sheet sheet(0.2f, 0.2f);
        fw::Mesh mesh = fw::createMesh(world, fw::meshDef(sheet.positions, sheet.indices));
        ASSERT_TRUE(mesh) << fw::lastMessage(world);
        const fw::Material material = fw::createMaterial(world, fw::preset(FW_MATERIAL_PAPER));
        std::vector<std::byte> pixels(16);
        const fw::Image image = fw::createImage(world, 2, 2, pixels);
        EXPECT_TRUE(image);
        EXPECT_FALSE(fw::createImage(world, 3, 3, pixels));
        FwBurnableMeshDef def = fw::def<FwBurnableMeshDef>();
        def.mesh = mesh.get();
        def.materials[0] = material.get();
        def.baseColor = image.get();
        fw::BurnableMesh object = fw::createBurnableMesh(world, def);
        ASSERT_TRUE(object) << fw::lastMessage(world);
        fw::BurnableMesh moved = std::move(object);
        EXPECT_FALSE(object);
        EXPECT_TRUE(moved);

        FwHeatOcclusionDef shield = fw::def<FwHeatOcclusionDef>();
        shield.counts[0] = 3;
        uint32_t asked = 0;
        const auto ground = [&asked](const float* place) { return ++asked, place[1]; };
        EXPECT_EQ(FW_OK, fw::setHeatOcclusion(world, shield, ground)) << fw::lastMessage(world);
        EXPECT_EQ(3u, asked);

        FwIgnitionDef ignition = fw::def<FwIgnitionDef>();
        ignition.object = moved.get();
        ignition.radius = 0.05f;
        ASSERT_EQ(FW_OK, fwWorld_Ignite(world.get(), &ignition, nullptr));
        for (int i = 0; i < 20; ++i) ASSERT_EQ(FW_OK, fwWorld_Step(world.get(), 1.0f / 32));
        FwEvent room[8];
        const std::span<const FwEvent> events = fw::pollEvents(world, room);
        ASSERT_EQ(1u, events.size());
        EXPECT_TRUE(fw::same(events[0].object, moved.get()));
        FwLight lamps[4];
        EXPECT_EQ(1u, fw::lights(world, lamps).size());
        FwWorldStats stats = fw::info<FwWorldStats>();
        EXPECT_EQ(FW_OK, fwWorld_GetStats(world.get(), &stats));
        EXPECT_EQ(1u, stats.objects);
        moved.reset();
        EXPECT_EQ(FW_OK, fwWorld_GetStats(world.get(), &stats));
        EXPECT_EQ(0u, stats.objects);
        EXPECT_TRUE(fw::isNull(moved.get()));
        (void)fw::def<FwMaterialDef>();
        (void)fw::def<FwImageDef>();
        (void)fw::def<FwMeshDef>();
        (void)fw::def<FwView>();
        (void)fw::def<FwOffscreenDef>();
    }
    EXPECT_EQ(0, host.blocks);
}

}  // namespace
