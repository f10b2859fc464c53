// Several threads use one library at once. A program of its own, so that the thread sanitizer
// builds little: tests/run --tsan --suite threads.
#include "abi/abi_support.h"

#include <thread>

namespace {

using host::created;
using host::getState;
using host::Host;
using host::lastMessage;

TEST(Threads, ContextsAndWorldsMayBeCreatedOnAnyThread) {
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
            (void)host::addBurnable(world, sheet.def(48), host::evenMaterial(0.02f, 3));
            FwIgnitionDef ignition = fwDefaultIgnitionDef();
            ignition.radius = 0.05f;
            ASSERT_EQ(FW_OK, fwWorld_Ignite(world, &ignition, nullptr));
            for (int i = 0; i < 20; ++i) {
                ASSERT_EQ(FW_OK, fwWorld_Step(world, 1.0f / 32));
                (void)getState(fwContext_GetInfo, context);
                // Failures in one context on several threads: whole messages, never mixed.
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

// One thread creates, steps and destroys; the others call every function tagged [any].
void besideCreateDestroyAndStep(FwContext* context, int rounds) {
    const host::Sheet sheet(0.3f, 0.2f);
    const FwWorldDef worldDef = fwDefaultWorldDef();
    FwWorld* world = nullptr;
    ASSERT_EQ(FW_OK, fwCreateWorld(context, &worldDef, &world)) << lastMessage(context);
    const FwMeshDef meshDef = sheet.def(48);
    const FwMeshId mesh = created(fwWorld_CreateMesh, world, meshDef);
    const FwMaterialDef materialDef = host::evenMaterial(0.02f, 3);
    const FwMaterialId material = created(fwWorld_CreateMaterial, world, materialDef);
    FwBurnableMeshDef def = fwDefaultBurnableMeshDef();
    def.mesh = mesh;
    def.materials[0] = material;
    const FwBurnableMeshId object = created(fwWorld_CreateBurnableMesh, world, def);

    std::atomic<bool> stop{false};
    std::atomic<uint64_t> asked{0};
    const auto reports = [&] {
        while (!stop) {
            FwMemoryRow rows[160];
            EXPECT_LT(0u, fwContext_GetMemoryReport(context, rows, 160));
            (void)getState(fwContext_GetInfo, context);
            (void)lastMessage(context);
            (void)lastMessage(world);
            EXPECT_EQ(FW_OK, fwContext_Prepare(context));
            (void)fwContext_Collect(context, 0);
            FwTargetId none{};
            (void)fwContext_UnregisterTarget(context, none);
            (void)fwContext_UnregisterTargetAfterFrame(context, none, 1);
            (void)fwTarget_IsReady(context, none, nullptr);
            (void)fwContext_RegisterTarget(context, nullptr, &none);
            ++asked;
        }
    };
    const auto reads = [&] {
        uint64_t size = 0;
        const std::vector<float> texels(2 * 8 * 8, 0.5f);
        FwFireProfileDef profile = fwDefaultFireProfileDef();
        profile.width = profile.height = 8;
        profile.texels = texels.data();
        EXPECT_EQ(FW_OK, fwCookFireProfile(context, &profile, nullptr, &size));
        while (!stop) {
            EXPECT_EQ(FW_OK, fwCookMesh(context, &meshDef, nullptr, &size));
            FwObjectState state{};
            state.structSize = sizeof state;
            EXPECT_LE(0, fwWorld_ReadObjectState(world, object, &state));
            FwLight lights[16];
            uint32_t count = 16;
            EXPECT_LE(0, fwWorld_ReadLights(world, lights, &count));
            FwEvent events[8];
            (void)fwWorld_PollEvents(world, events, 8);
            FwVulkanRequirements requests{};
            requests.structSize = sizeof requests;
            EXPECT_EQ(FW_OK, fwQueryVulkanRequirements(&requests));
            FwWorld* passing = nullptr;
            EXPECT_EQ(FW_OK, fwCreateWorld(context, &worldDef, &passing));
            EXPECT_EQ(FW_OK, fwWorld_DestroyAfterFrame(passing, 0));
            ++asked;
        }
    };
    std::thread first(reports), second(reads);
    for (int round = 0; round < rounds || asked < 2 * uint64_t(rounds); ++round) {
        std::vector<FwBurnableMeshId> ids(8);
        for (FwBurnableMeshId& id : ids)
            ASSERT_EQ(FW_OK, fwWorld_CreateBurnableMesh(world, &def, &id)) << lastMessage(world);
        FwIgnitionDef ignition = fwDefaultIgnitionDef();
        ignition.radius = 0.05f;
        ASSERT_EQ(FW_OK, fwWorld_Ignite(world, &ignition, nullptr));
        for (int i = 0; i < 4; ++i) ASSERT_EQ(FW_OK, fwWorld_Step(world, 1.0f / 32));
        for (size_t i = 0; i < ids.size(); ++i) {
            const FwObjectRef later{FW_OBJECT_BURNABLE_MESH, ids[i].index1, ids[i].generation, 0};
            ASSERT_EQ(FW_OK, i % 2 ? fwWorld_DestroyBurnableMesh(world, ids[i])
                                   : fwWorld_DestroyLater(world, &later));
        }
    }
    stop = true;
    first.join();
    second.join();
    fwDestroyContext(context);
}

TEST(Threads, EveryAnyFunctionRunsBesideCreateDestroyAndStep) {
    Host host;
    FwContext* context = host::createCpuContext(host);
    ASSERT_NE(nullptr, context);
    besideCreateDestroyAndStep(context, 8);
    EXPECT_EQ(0, host.blocks);
}

TEST(Threads, EveryAnyFunctionRunsBesideCreateDestroyAndStepOnADevice) {
    Host host;
    FwContextDef def = fwDefaultContextDef();
    def.callbacks = host.callbacks();
    FwContext* context = nullptr;
    FwErrorInfo error{};
    if (fwCreateContext(&def, &context, &error) != FW_OK)
        GTEST_SKIP() << "no Vulkan device: " << error.message;
    besideCreateDestroyAndStep(context, 2);
    EXPECT_EQ(0, host.blocks);
}

}  // namespace
