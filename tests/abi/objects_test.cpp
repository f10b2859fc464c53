// Contexts, worlds and ids: lifetime, order of calls, messages, callbacks.
#include "abi/abi_support.h"

namespace {

using host::created;
using host::getState;
using host::Host;
using host::lastMessage;
using host::SheetWorld;

TEST(Objects, RefusesStaleIds) {
    SheetWorld w(host::evenMaterial(0.02f, 5));
    FwMaterialId id{};
    const FwMaterialDef def = fwDefaultMaterialDef();
    ASSERT_EQ(FW_OK, fwWorld_CreateMaterial(w.world, &def, &id));
    ASSERT_EQ(FW_OK, fwWorld_DestroyMaterial(w.world, id));
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_DestroyMaterial(w.world, id));
    EXPECT_EQ(
        "Material 2 (generation 1) is already destroyed; the slot is at generation 2.\n"
        " - While calling fwWorld_DestroyMaterial.",
        lastMessage(w.world));
    EXPECT_EQ(w.host.lastError, lastMessage(w.world));  // the log callback gets the same text
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_DestroyMaterial(w.world, FwMaterialId{}));
    EXPECT_EQ("Material id is null.\n - While calling fwWorld_DestroyMaterial.",
              lastMessage(w.world));
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_DestroyMaterial(w.world, FwMaterialId{77, 1}));
    EXPECT_EQ(
        "Material 77 does not exist; there are 2 slots.\n"
        " - While calling fwWorld_DestroyMaterial.",
        lastMessage(w.world));
    // The slot is reused and the old id stays invalid.
    const FwMaterialId again = created(fwWorld_CreateMaterial, w.world, def);
    EXPECT_EQ(id.index1, again.index1);
    EXPECT_NE(id.generation, again.generation);
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_DestroyMaterial(w.world, id));
}

TEST(Objects, EveryFunctionRefusesAStaleObject) {
    SheetWorld w(host::evenMaterial(0.02f, 5));
    const FwBurnableMeshId id = w.add(1);
    const float point[3] = {};
    float identity[16] = {};
    for (int i = 0; i < 4; ++i) identity[i * 5] = 1;
    FwQueryId query{};
    ASSERT_EQ(FW_OK, fwWorld_RequestPoint(w.world, id, point, &query));
    ASSERT_EQ(FW_OK, fwWorld_DestroyBurnableMesh(w.world, id));
    FwPointState pointState{};
    pointState.structSize = sizeof pointState;
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_FetchPoint(w.world, query, &pointState));
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_FetchPoint(w.world, query, &pointState));
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_DestroyBurnableMesh(w.world, id));
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_SetTransform(w.world, id, identity));
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_SetHidden(w.world, id, 1));
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_TagPoint(w.world, id, point, 1));
    FwObjectState state{};
    state.structSize = sizeof state;
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_GetObjectState(w.world, id, &state));
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_RequestPoint(w.world, id, point, &query));
    EXPECT_EQ(FW_ERROR_STALE_ID, fwDebug_RequestBurnMap(w.world, id));
    EXPECT_EQ(FW_ERROR_STALE_ID,
              fwDebug_FetchBurnMap(w.world, id, nullptr, 0, nullptr, nullptr, nullptr));
    EXPECT_EQ(FW_ERROR_STALE_ID, fwDebug_PushTexels(w.world, id, 0, nullptr, 0));
    FwIgnitionDef ignition = fwDefaultIgnitionDef();
    ignition.object = id;
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_Ignite(w.world, &ignition, nullptr));
    FwMeshInfo info{};
    info.structSize = sizeof info;
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_GetMeshInfo(w.world, FwMeshId{9, 9}, &info));
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_DestroyMesh(w.world, FwMeshId{9, 9}));
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_DestroyImage(w.world, FwImageId{9, 9}));
    FwBurnableMeshDef def = fwDefaultBurnableMeshDef();
    FwBurnableMeshId made{1, 1};
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_CreateBurnableMesh(w.world, &def, &made));
    EXPECT_EQ(0u, made.index1);  // a failed call returns a null id
    def.mesh = w.mesh;
    def.materials[3] = FwMaterialId{50, 1};
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_CreateBurnableMesh(w.world, &def, &made));
    def.materials[3] = {};
    def.baseColor = FwImageId{50, 1};
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_CreateBurnableMesh(w.world, &def, &made));
}

TEST(Objects, QueriesEndWithTheirObject) {
    SheetWorld w(host::evenMaterial(0.02f, 5));
    const float point[3] = {};
    FwQueryId query{};
    for (int round = 0; round < 3; ++round) {
        const FwBurnableMeshId id = w.add(1);
        std::vector<FwQueryId> asked;
        for (uint32_t i = 0; i < 1024; ++i) {
            const FwResult result = i % 2 ? fwWorld_RequestPoint(w.world, id, point, &query)
                                          : fwWorld_RequestArrival(w.world, id, point, &query);
            ASSERT_EQ(FW_OK, result) << round << ", " << i << ": " << lastMessage(w.world);
            asked.push_back(query);
        }
        EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT,
                  fwWorld_RequestPoint(w.world, w.object, point, &query));
        ASSERT_EQ(FW_OK, fwWorld_DestroyBurnableMesh(w.world, id));
        FwPointState state{};
        state.structSize = sizeof state;
        EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_FetchPoint(w.world, asked[1], &state));
        EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_CancelQuery(w.world, asked[0]));
    }
    w.run(0.1);
}

TEST(Objects, EveryRequestCanBeCancelled) {
    SheetWorld w(host::evenMaterial(0.02f, 5));
    const float point[3] = {0.5f, 0, 0.1f};
    FwQueryId query{};
    for (int i = 0; i < 3000; ++i) {
        ASSERT_EQ(FW_OK, fwWorld_RequestPoint(w.world, w.object, point, &query)) << i;
        ASSERT_EQ(FW_OK, fwWorld_CancelQuery(w.world, query)) << i;
    }
    FwPointState state{};
    state.structSize = sizeof state;
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_FetchPoint(w.world, query, &state));
    ASSERT_EQ(FW_OK, fwWorld_RequestArrival(w.world, w.object, point, &query));
    EXPECT_EQ(FW_OK, fwWorld_CancelQuery(w.world, query));

    EXPECT_EQ(FW_OK, fwWorld_CancelSave(w.world)) << "none was requested";
    EXPECT_EQ(FW_OK, fwWorld_CancelBurn(w.world, w.object));
    uint64_t size = 0;
    for (const bool comes : {false, true}) {
        ASSERT_EQ(FW_OK, fwWorld_RequestSave(w.world));
        ASSERT_EQ(FW_OK, fwWorld_RequestBurn(w.world, w.object));
        if (comes) w.run(0.1);
        EXPECT_EQ(FW_OK, fwWorld_CancelSave(w.world));
        EXPECT_EQ(FW_OK, fwWorld_CancelBurn(w.world, w.object));
        w.run(0.1);
        EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_FetchSave(w.world, nullptr, &size));
        EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_FetchBurn(w.world, w.object, nullptr, &size));
    }
    ASSERT_EQ(FW_OK, fwWorld_RequestSave(w.world));
    w.run(0.1);
    EXPECT_EQ(FW_OK, fwWorld_FetchSave(w.world, nullptr, &size)) << "the next one arrives";

    for (const uint32_t tag : {3u, 4u})
        ASSERT_EQ(FW_OK, fwWorld_TagPoint(w.world, w.object, point, tag));
    EXPECT_EQ(FW_OK, fwWorld_UntagPoint(w.world, w.object, 3));
    EXPECT_EQ(FW_OK, fwWorld_UntagPoint(w.world, w.object, 99)) << "no point has this tag";
    w.ball(FW_IGNITE, 0.5f, 0, 0.1f, 0.05f);
    w.run(1);
    uint32_t reached = 0;
    for (const FwEvent& event : w.events())
        if (event.type == FW_EVENT_TAG_REACHED) reached |= 1u << event.tag;
    EXPECT_EQ(1u << 4, reached);
}

TEST(Objects, RefusesToDestroyAMeshInUse) {
    SheetWorld w(host::evenMaterial(0.02f, 5));
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_DestroyMesh(w.world, w.mesh));
    EXPECT_EQ(
        "Mesh 1 (generation 1) is used by 1 burnable mesh(es); destroy them first.\n"
        " - While calling fwWorld_DestroyMesh.",
        lastMessage(w.world));
    EXPECT_EQ(FW_OK, fwWorld_DestroyBurnableMesh(w.world, w.object));
    EXPECT_EQ(FW_OK, fwWorld_DestroyMesh(w.world, w.mesh)) << lastMessage(w.world);
}

TEST(Objects, ObjectsKeepACopyOfADestroyedMaterial) {
    SheetWorld w(host::evenMaterial(0.02f, 5));
    EXPECT_EQ(FW_OK, fwWorld_DestroyMaterial(w.world, w.materialId));
    EXPECT_LT(0u, w.ball(FW_IGNITE, 0.1f, 0, 0.1f, 0.03f));
    w.run(1.0);
    EXPECT_LT(0u, w.state().burning);
}

TEST(Objects, ImagesAreValidatedAndMayBeDestroyedBeforeTheirUsers) {
    SheetWorld w(host::evenMaterial(0.02f, 5));
    const std::vector<uint32_t> pixels(16, 0xFF808080u);
    FwImageDef def = fwDefaultImageDef();
    def.width = 4;
    def.height = 4;
    FwImageId id{};
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_CreateImage(w.world, &def, &id));
    EXPECT_NE(std::string::npos, lastMessage(w.world).find("pixels is null"));
    def.pixels = pixels.data();
    for (const uint32_t bad : {0u, 8193u}) {
        FwImageDef wrong = def;
        wrong.width = bad;
        EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_CreateImage(w.world, &wrong, &id));
        EXPECT_NE(std::string::npos, lastMessage(w.world).find("FwImageDef::width is "));
    }
    ASSERT_EQ(FW_OK, fwWorld_CreateImage(w.world, &def, &id)) << lastMessage(w.world);
    FwBurnableMeshDef object = fwDefaultBurnableMeshDef();
    object.mesh = w.mesh;
    object.baseColor = id;
    const FwBurnableMeshId user = created(fwWorld_CreateBurnableMesh, w.world, object);
    EXPECT_EQ(FW_OK, fwWorld_DestroyImage(w.world, id));
    (void)created(fwWorld_CreateImage, w.world, def);
    EXPECT_EQ(FW_OK, fwWorld_DestroyBurnableMesh(w.world, user));
    w.run(0.1);
}

TEST(Objects, CreationRefusesUnsupportedDefs) {
    Host host;
    FwContext* context = reinterpret_cast<FwContext*>(&host);
    FwErrorInfo error{};
    FwContextDef def = fwDefaultContextDef();
    def.callbacks = host.callbacks();
    def.backend = FW_BACKEND_CPU;
    def.abiVersion = 1;
    EXPECT_EQ(FW_ERROR_VERSION, fwCreateContext(&def, &context, &error));
    EXPECT_EQ(nullptr, context);
    EXPECT_EQ(FW_ERROR_VERSION, error.result);
    EXPECT_STREQ(
        "FwContextDef::abiVersion is 1; this library serves version 2.\n"
        " - While calling fwCreateContext.",
        error.message);
    def.abiVersion = FW_ABI_VERSION;
    def.backend = 9;
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwCreateContext(&def, &context, &error));
    EXPECT_NE(nullptr, std::strstr(error.message, "FwContextDef::backend is 9"));
    EXPECT_EQ(host.lastError, error.message);
    def.backend = FW_BACKEND_CPU;
    def.callbacks.release = nullptr;
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwCreateContext(&def, &context, &error));
    EXPECT_NE(nullptr, std::strstr(error.message, "FwCallbacks::release is null"));
    def.callbacks = host.callbacks();
    def.flags = 1;
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwCreateContext(&def, &context, &error));
    def.flags = 0;
    FwVulkanHost vulkan = fwDefaultVulkanHost();
    def.vulkan = &vulkan;
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwCreateContext(&def, &context, &error));
    def.backend = FW_BACKEND_VULKAN;  // a host device without content
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwCreateContext(&def, &context, &error));
    EXPECT_NE(nullptr, std::strstr(error.message, "getInstanceProcAddr is null"));
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwCreateContext(&def, nullptr, &error));
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwCreateContext(nullptr, &context, nullptr));
    EXPECT_EQ(0, host.blocks);
}

TEST(Objects, RefusesCallsOfAnotherBackend) {
    SheetWorld w(host::evenMaterial(0.02f, 5));
    const FwVulkanFrame frame = fwDefaultVulkanFrame();
    const FwView view = fwDefaultView();
    EXPECT_EQ(FW_ERROR_WRONG_BACKEND, fwWorld_RecordOutside(w.world, &frame, &view));
    const VkViewport viewport{0, 0, 16, 16, 0, 1};
    EXPECT_EQ(FW_ERROR_WRONG_BACKEND,
              fwWorld_RecordInside(w.world, &frame, FwTargetId{1, 1}, &view, &viewport));
    const FwVulkanComposite images = fwDefaultVulkanComposite();
    EXPECT_EQ(FW_ERROR_WRONG_BACKEND,
              fwWorld_RecordComposite(w.world, &frame, FwTargetId{1, 1}, &view, &images));
    FwTargetId target{};
    const FwVulkanTargetDef targetDef = fwDefaultVulkanTargetDef();
    EXPECT_EQ(FW_ERROR_WRONG_BACKEND, fwContext_RegisterTarget(w.context, &targetDef, &target));
    EXPECT_EQ(FW_ERROR_WRONG_BACKEND, fwContext_UnregisterTarget(w.context, target));
    FwOffscreenDef offscreen = fwDefaultOffscreenDef();
    uint32_t pixel = 0;
    offscreen.width = offscreen.height = 1;
    offscreen.pixels = &pixel;
    EXPECT_EQ(FW_ERROR_WRONG_BACKEND, fwWorld_RenderOffscreen(w.world, &offscreen));
    fwContext_NotifyDeviceLost(w.context);
    EXPECT_EQ(FW_OK, fwWorld_Step(w.world, 0.1f)) << lastMessage(w.world);
}

TEST(Objects, LastMessageReportsItsLength) {
    SheetWorld w(host::evenMaterial(0.02f, 5));
    EXPECT_EQ(0u, fwWorld_GetLastMessage(w.world, nullptr, 0));
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_SetWind(w.world, nullptr));
    const std::string whole = "wind is null.\n - While calling fwWorld_SetWind.";
    ASSERT_EQ(whole.size(), fwWorld_GetLastMessage(w.world, nullptr, 0));
    char text[128];
    for (size_t capacity = 0; capacity <= whole.size() + 2; ++capacity) {
        std::memset(text, 0x7E, sizeof text);
        EXPECT_EQ(whole.size(), fwWorld_GetLastMessage(w.world, text, capacity));
        EXPECT_EQ(0x7E, text[capacity]) << "past the end at " << capacity;
        if (capacity > 0) {
            EXPECT_EQ(whole.substr(0, capacity - 1), text);
        }
    }
    // A success keeps the message; a context has its own.
    const float calm[3] = {};
    EXPECT_EQ(FW_OK, fwWorld_SetWind(w.world, calm));
    EXPECT_EQ(whole, lastMessage(w.world));
    EXPECT_EQ("", lastMessage(w.context));
    FwWorld* world = nullptr;
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwCreateWorld(w.context, nullptr, &world));
    EXPECT_EQ("FwWorldDef is null.\n - While calling fwCreateWorld.", lastMessage(w.context));
}

TEST(Objects, TwoContextsShareNothing) {
    SheetWorld a(host::evenMaterial(0.02f, 5));
    {
        SheetWorld b(host::evenMaterial(0.02f, 5));
        EXPECT_LT(0u, b.ball(FW_IGNITE, 0.1f, 0, 0.1f, 0.03f));
        b.run(1);
        a.run(1);
        EXPECT_LT(0u, b.state().ignited);
        EXPECT_EQ(0u, a.state().ignited);
        EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_SetWind(b.world, nullptr));
        EXPECT_EQ("", lastMessage(a.world));
        EXPECT_TRUE(a.host.errors.empty());
    }
    a.run(0.1);
}

TEST(Objects, DefsAreCopiedByTheCall) {
    SheetWorld w(host::evenMaterial(0.02f, 5), 0.5f, 0.25f, 64);
    uint64_t hashes[2] = {};
    for (int round = 0; round < 2; ++round) {
        auto sheet = std::make_unique<host::Sheet>(0.5f, 0.25f);
        auto mesh = std::make_unique<FwMeshDef>(sheet->def(64));
        std::vector<uint8_t> multiplier(64, 128);
        FwMeshId meshId{};
        ASSERT_EQ(FW_OK, fwWorld_CreateMesh(w.world, mesh.get(), &meshId));
        FwMaterialDef material = host::evenMaterial(0.02f, 5);
        const FwMaterialId materialId = created(fwWorld_CreateMaterial, w.world, material);
        FwBurnableMeshDef def = fwDefaultBurnableMeshDef();
        def.mesh = meshId;
        def.materials[0] = materialId;
        def.multiplier = multiplier.data();
        def.multiplierWidth = def.multiplierHeight = 8;
        const FwBurnableMeshId id = created(fwWorld_CreateBurnableMesh, w.world, def);
        FwIgnitionDef ignition = fwDefaultIgnitionDef();
        ignition.object = id;
        ignition.position[0] = 0.25f;
        ignition.position[2] = 0.12f;
        ignition.radius = 0.03f;
        ASSERT_EQ(FW_OK, fwWorld_Ignite(w.world, &ignition, nullptr));
        if (round == 1) {  // everything the host passed is freed or overwritten
            std::memset(mesh.get(), 0xCD, sizeof(FwMeshDef));
            std::fill(sheet->positions.begin(), sheet->positions.end(), 1e30f);
            std::fill(sheet->indices.begin(), sheet->indices.end(), 0xCDCDCDCDu);
            sheet.reset();
            mesh.reset();
            std::fill(multiplier.begin(), multiplier.end(), uint8_t(0));
            std::memset(&material, 0xCD, sizeof material);
            std::memset(&def, 0xCD, sizeof def);
            std::memset(&ignition, 0xCD, sizeof ignition);
        }
        for (int i = 0; i < 64; ++i) ASSERT_EQ(FW_OK, fwWorld_Step(w.world, 1.0f / 32));
        ASSERT_EQ(FW_OK, fwDebug_RequestBurnMap(w.world, id));
        uint64_t tick = 0;
        std::vector<uint32_t> ticks(1 << 16);
        uint64_t count = 0;
        ASSERT_EQ(FW_OK, fwDebug_FetchBurnMap(w.world, id, ticks.data(), ticks.size(), &count,
                                              nullptr, &tick));
        uint64_t burnt = 0, sum = 0;
        const uint32_t start = uint32_t(tick) - 64 * 128;
        for (uint64_t i = 0; i < count; ++i)
            if (ticks[i] < 0xFFFFFFF0u) {
                ++burnt;
                sum += (ticks[i] - start) * (i + 1);
            }
        EXPECT_LT(20u, burnt);
        hashes[round] = sum;
    }
    EXPECT_EQ(hashes[0], hashes[1]);
}

TEST(Objects, InfoAndReports) {
    SheetWorld w(host::evenMaterial(0.02f, 5));
    const FwContextInfo info = getState(fwContext_GetInfo, w.context);
    EXPECT_EQ(uint32_t(FW_BACKEND_CPU), info.backend);
    EXPECT_EQ(0u, info.apiVersion);
    EXPECT_LT(0u, info.cpuMemoryUsed);
    EXPECT_LE(int64_t(info.cpuMemoryUsed), w.host.bytes);
    EXPECT_STREQ("cpu", info.deviceName);
    EXPECT_EQ(FW_OK, fwContext_Prepare(w.context));
    FwMemoryRow rows[64];
    EXPECT_GE(64u, fwContext_GetMemoryReport(w.context, rows, 64));
    const FwMeshInfo mesh = getState(fwWorld_GetMeshInfo, w.world, w.mesh);
    EXPECT_NEAR(0.25f, mesh.area, 0.001f);
    EXPECT_NEAR(0.25f, mesh.texelArea, 0.0025f);
    EXPECT_EQ(0u, mesh.mapWidth % 8);
    EXPECT_EQ(2u, mesh.triangles);
    const FwWorldStats stats = getState(fwWorld_GetStats, w.world);
    EXPECT_EQ(1u, stats.objects);
    EXPECT_EQ(1u, stats.meshes);
    EXPECT_EQ(1u, stats.materials);
    EXPECT_EQ(mesh.texels, stats.texels);
}

TEST(Objects, CookedMeshesEqualTheirSource) {
    SheetWorld w(host::evenMaterial(0.02f, 5));
    const FwMeshDef def = w.sheet.def(64);
    uint64_t size = 0;
    ASSERT_EQ(FW_OK, fwCookMesh(w.context, &def, nullptr, &size)) << lastMessage(w.context);
    ASSERT_LT(0u, size);
    std::vector<unsigned char> bytes(size, 0xCD);
    uint64_t little = size - 1;
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwCookMesh(w.context, &def, bytes.data(), &little));
    EXPECT_EQ(0xCD, bytes[0]);
    ASSERT_EQ(FW_OK, fwCookMesh(w.context, &def, bytes.data(), &size)) << lastMessage(w.context);
    FwMeshDef cooked = fwDefaultMeshDef();
    cooked.cooked = bytes.data();
    cooked.cookedSize = size;
    FwMeshId id = created(fwWorld_CreateMesh, w.world, cooked);
    FwMeshInfo a{}, b{};
    a.structSize = b.structSize = sizeof a;
    ASSERT_EQ(FW_OK, fwWorld_GetMeshInfo(w.world, w.mesh, &a));
    ASSERT_EQ(FW_OK, fwWorld_GetMeshInfo(w.world, id, &b));
    a.bakeMilliseconds = b.bakeMilliseconds = 0;
    EXPECT_EQ(0, std::memcmp(&a, &b, sizeof a));
    FwMeshDef twice = cooked;
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwCookMesh(w.context, &twice, nullptr, &size));
    cooked.cookedSize = size / 2;
    EXPECT_EQ(FW_ERROR_BAD_DATA, fwWorld_CreateMesh(w.world, &cooked, &id));
    EXPECT_EQ(0u, id.index1);
}

}  // namespace
