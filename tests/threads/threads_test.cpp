// What several threads do with one library at the same time. A program of its own, so that the
// thread sanitizer has little to build: tests/run --tsan --suite threads.
#include "abi/abi_support.h"

#include <thread>

namespace {

using host::Host;
using host::lastMessage;

TEST(Threads, ContextsAndWorldsAreMadeAnywhere) {
    Host host;
    FwContext* context = host::createCpuContext(host);
    ASSERT_NE(nullptr, context);
    const host::Sheet sheet(0.3f, 0.2f);
    const auto work = [&](int number) {
        FwContext* own = nullptr;
        Host ownHost;
        FwContextDef contextDef = fwDefaultContextDef();
        contextDef.backend = FW_BACKEND_CPU;
        contextDef.callbacks = ownHost.callbacks();
        for (int round = 0; round < 3; ++round) {
            ASSERT_EQ(FW_OK, fwCreateContext(&contextDef, &own, nullptr));
            FwWorld* world = nullptr;
            const FwWorldDef worldDef = fwDefaultWorldDef();
            ASSERT_EQ(FW_OK, fwCreateWorld(number % 2 ? context : own, &worldDef, &world));
            const FwMeshDef meshDef = sheet.def(48);
            FwMeshId mesh{};
            ASSERT_EQ(FW_OK, fwWorld_CreateMesh(world, &meshDef, &mesh));
            FwMaterialDef materialDef = host::evenMaterial(0.02f, 3);
            FwMaterialId material{};
            ASSERT_EQ(FW_OK, fwWorld_CreateMaterial(world, &materialDef, &material));
            FwBurnableMeshDef def = fwDefaultBurnableMeshDef();
            def.mesh = mesh;
            def.materials[0] = material;
            FwBurnableMeshId object{};
            ASSERT_EQ(FW_OK, fwWorld_CreateBurnableMesh(world, &def, &object));
            FwIgnitionDef ignition = fwDefaultIgnitionDef();
            ignition.radius = 0.05f;
            ASSERT_EQ(FW_OK, fwWorld_Ignite(world, &ignition, nullptr));
            for (int i = 0; i < 20; ++i) {
                ASSERT_EQ(FW_OK, fwWorld_Step(world, 1.0f / 32));
                FwContextInfo info{};
                info.structSize = sizeof info;
                ASSERT_EQ(FW_OK, fwContext_GetInfo(context, &info));
                // Failures on one context from several threads: whole messages, no mixture.
                FwWorld* none = nullptr;
                EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwCreateWorld(context, nullptr, &none));
                EXPECT_EQ("FwWorldDef is null.\n - While calling fwCreateWorld.",
                          lastMessage(context));
            }
            fwDestroyWorld(world);
            fwDestroyContext(own);
            own = nullptr;
        }
        EXPECT_EQ(0, ownHost.blocks);
    };
    std::vector<std::thread> threads;
    for (int i = 0; i < 4; ++i) threads.emplace_back(work, i);
    for (std::thread& thread : threads) thread.join();
    fwDestroyContext(context);
    EXPECT_EQ(0, host.blocks);
    EXPECT_EQ(0, host.bytes);
}

}  // namespace
