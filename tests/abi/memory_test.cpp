// Memory: the host's allocator fails at each allocation in turn, once or for good. Nothing crashes
// or leaks, failed calls change nothing, and existing objects still work.
#include "abi/abi_support.h"

namespace {

using host::Host;

// One game session in which every call may fail. Returns the results in order.
struct Session {
    Host host;
    FwContext* context = nullptr;
    FwWorld* world = nullptr;
    FwMaterialId material{};
    FwMeshId mesh{};
    FwImageId image{};
    FwBurnableMeshId object{};
    std::vector<FwResult> results;
    ::host::Sheet sheet{0.3f, 0.2f};

    FwResult note(FwResult result) {
        results.push_back(result);
        return result;
    }

    // Steps depend on earlier ones; those that cannot run are skipped.
    void run() {
        FwContextDef contextDef = fwDefaultContextDef();
        contextDef.backend = FW_BACKEND_CPU;
        contextDef.callbacks = host.callbacks();
        FwErrorInfo error{};
        if (note(fwCreateContext(&contextDef, &context, &error)) != FW_OK) {
            EXPECT_EQ(nullptr, context);
            EXPECT_EQ(results.back(), error.result);
            if (fwCreateContext(&contextDef, &context, &error) != FW_OK) return;
        }
        const FwWorldDef worldDef = fwDefaultWorldDef();
        if (note(fwCreateWorld(context, &worldDef, &world)) != FW_OK) {
            EXPECT_EQ(nullptr, world);
            if (fwCreateWorld(context, &worldDef, &world) != FW_OK) return;
        }
        const FwMaterialDef materialDef = ::host::evenMaterial(0.05f, 0.4f);
        retry([&] { return fwWorld_CreateMaterial(world, &materialDef, &material); });
        const FwMeshDef meshDef = sheet.def(40);
        retry([&] { return fwWorld_CreateMesh(world, &meshDef, &mesh); });
        uint64_t cookedSize = 0;
        retry([&] { return fwCookMesh(context, &meshDef, nullptr, &cookedSize); });
        const uint32_t pixels[4] = {};
        FwImageDef imageDef = fwDefaultImageDef();
        imageDef.width = imageDef.height = 2;
        imageDef.pixels = pixels;
        retry([&] { return fwWorld_CreateImage(world, &imageDef, &image); });
        FwBurnableMeshDef def = fwDefaultBurnableMeshDef();
        def.mesh = mesh;
        def.materials[0] = material;
        def.baseColor = image;
        def.breakArea = 1e-3f;
        retry([&] { return fwWorld_CreateBurnableMesh(world, &def, &object); });
        FwIgnitionDef ignition = fwDefaultIgnitionDef();
        ignition.object = object;
        ignition.position[0] = 0.1f;
        ignition.position[2] = 0.1f;
        ignition.radius = 0.03f;
        retry([&] { return fwWorld_Ignite(world, &ignition, nullptr); });
        fires();
        fields();
        const float point[3] = {0.1f, 0, 0.1f};
        const float far[3] = {0.2f, 0, 0.1f};
        retry([&] { return fwWorld_TagPoint(world, object, far, 1); });
        for (int i = 0; i < 40; ++i) {
            const float wind[3] = {0.1f * float(i), 0, 0};
            retry([&] { return fwWorld_SetWind(world, wind); });
            retry([&] { return fwWorld_Step(world, 1.0f / 32); });
        }
        FwQueryId query{};
        retry([&] { return fwWorld_RequestPoint(world, object, point, &query); });
        FwPointState state{};
        state.structSize = sizeof state;
        retry([&] { return fwWorld_FetchPoint(world, query, &state); });
        retry([&] { return fwWorld_RequestArrival(world, object, far, &query); });
        FwArrivalState arrival{};
        arrival.structSize = sizeof arrival;
        retry([&] { return fwWorld_FetchArrival(world, query, &arrival); });
        retry([&] { return fwDebug_RequestBurnMap(world, object); });
        (void)fwContext_GetMemoryReport(context, nullptr, 0);
    }

    // Volumetric fires with a profile, a collider and a script.
    void fires() {
        const std::vector<float> texels(2 * 8 * 8, 0.5f);
        FwFireProfileDef profileDef = fwDefaultFireProfileDef();
        profileDef.width = profileDef.height = 8;
        profileDef.texels = texels.data();
        FwFireProfileId profile{};
        retry([&] { return fwWorld_CreateFireProfile(world, &profileDef, &profile); });
        uint64_t size = 0;
        retry([&] { return fwCookFireProfile(context, &profileDef, nullptr, &size); });
        const float heights[4] = {};
        FwFireColliderDef ground = fwDefaultFireColliderDef();
        ground.kind = FW_COLLIDER_HEIGHT_FIELD;
        ground.columns = ground.rows = 2;
        ground.heights = heights;
        FwFireColliderId collider{};
        retry([&] { return fwWorld_AddFireCollider(world, &ground, &collider); });
        FwVolumetricFireDef def = fwDefaultVolumetricFireDef();
        FwVolumetricFireId fire{};
        retry([&] { return fwWorld_CreateVolumetricFire(world, &def, &fire); });
        def.profile = profile;
        retry([&] { return fwWorld_CreateVolumetricFire(world, &def, &fire); });
        retry([&] { return fwWorld_SetVolumetricFirePower(world, fire, 1); });
        const FwFireEmitterDef emitterDef = fwDefaultFireEmitterDef();
        FwFireEmitterId emitter{};
        retry([&] { return fwWorld_CreateFireEmitter(world, &emitterDef, &emitter); });
        const float time = 0;
        const FwFirePoint line[2] = {{{0, 0, 0}, 0.1f}, {{0, 1, 0}, 0.1f}};
        FwFireTrackDef track = fwDefaultFireTrackDef();
        track.keyCount = 1;
        track.pointsPerKey = 2;
        track.times = &time;
        track.points = line;
        retry([&] { return fwWorld_SetVolumetricFireTrack(world, fire, &track); });
    }

    void fields() {
        FwParticleFieldDef def = fwDefaultParticleFieldDef();
        def.width = def.height = 32;
        FwParticleFieldId field{};
        retry([&] { return fwWorld_CreateParticleField(world, &def, &field); });
        def.shape = FW_FIELD_SPHEROID;
        retry([&] { return fwWorld_CreateParticleField(world, &def, &field); });
        const std::vector<uint8_t> walls(32 * 32, 1);
        retry([&] { return fwWorld_PaintParticleField(world, field, nullptr, walls.data()); });
    }

    // Repeats a call that failed for memory; the second call must succeed.
    template <class Call>
    void retry(const Call& call) {
        if (note(call()) == FW_OK) return;
        if (!host.failAlways) {
            EXPECT_EQ(FW_OK, note(call()));
        }
    }

    // The map's hash once all of `run` has succeeded; 0 before.
    uint64_t finish() {
        uint64_t hash = 0;
        if (world && object.index1) {
            if (fwDebug_RequestBurnMap(world, object) == FW_OK)
                (void)fwDebug_FetchBurnMap(world, object, nullptr, 0, nullptr, &hash, nullptr);
            EXPECT_EQ(FW_OK, fwWorld_DestroyBurnableMesh(world, object));
            EXPECT_EQ(FW_OK, fwWorld_DestroyMesh(world, mesh));
        }
        fwDestroyContext(context);
        EXPECT_EQ(0, host.blocks);
        EXPECT_EQ(0, host.bytes);
        return hash;
    }
};

TEST(HostMemory, SurvivesOneFailureAtEveryAllocation) {
    uint64_t golden = 0;
    int64_t allocations = 0;
    {
        Session session;
        session.run();
        for (const FwResult result : session.results) EXPECT_EQ(FW_OK, result);
        allocations = session.host.allocations;
        golden = session.finish();
        EXPECT_NE(0u, golden);
    }
    ASSERT_LT(100, allocations);
    RecordProperty("allocations", std::to_string(allocations));
    uint32_t refused = 0;
    for (int64_t at = 0; at < allocations; ++at) {
        SCOPED_TRACE("allocation " + std::to_string(at));
        Session session;
        session.host.failAt = at;
        session.run();
        uint32_t failures = 0;
        for (const FwResult result : session.results) {
            EXPECT_TRUE(result == FW_OK || result == FW_ERROR_OUT_OF_MEMORY)
                << fwResultName(result) << ": " << session.host.lastError;
            failures += result == FW_ERROR_OUT_OF_MEMORY ? 1 : 0;
        }
        EXPECT_GE(1u, failures);
        refused += failures;
        if (failures) {
            EXPECT_NE(std::string::npos, session.host.lastError.find("Memory is exhausted"))
                << session.host.lastError;
        }
        // The result must equal a session without failures.
        EXPECT_EQ(golden, session.finish());
        if (HasFailure()) break;
    }
    EXPECT_LT(uint32_t(allocations) * 9 / 10, refused);
}

TEST(HostMemory, SurvivesPermanentFailureFromEveryAllocation) {
    int64_t allocations = 0;
    {
        Session session;
        session.run();
        allocations = session.host.allocations;
        (void)session.finish();
    }
    for (int64_t at = 0; at < allocations; at += 3) {
        SCOPED_TRACE("allocation " + std::to_string(at));
        Session session;
        session.host.failAt = at;
        session.host.failAlways = true;
        session.run();
        for (const FwResult result : session.results)
            EXPECT_TRUE(result == FW_OK || result == FW_NOTHING_THERE ||
                        result == FW_ERROR_OUT_OF_MEMORY || result == FW_ERROR_STALE_ID ||
                        result == FW_ERROR_INVALID_ARGUMENT)
                << fwResultName(result) << ": " << session.host.lastError;
        (void)session.finish();
        if (HasFailure()) break;
    }
}

TEST(HostMemory, WarmFramesAllocateNothing) {
    ::host::SheetWorld w(::host::evenMaterial(0.02f, 5));
    FwBurnableMeshDef asked =
        fwDefaultBurnableMeshDef();  // FW_EVENT_STRUCTURE_BROKE is checked on it
    asked.mesh = w.mesh;
    asked.materials[0] = w.materialId;
    asked.breakArea = 1e-3f;
    ASSERT_EQ(FW_OK, fwWorld_CreateBurnableMesh(w.world, &asked, &w.object));
    w.ball(FW_IGNITE, 0.2f, 0, 0.1f, 0.03f);
    w.run(2.0);
    const int64_t before = w.host.allocations;
    for (int i = 0; i < 300; ++i) {
        const float wind[3] = {0.02f * float(i), 0, 0};
        ASSERT_EQ(FW_OK, fwWorld_SetWind(w.world, wind));
        ASSERT_EQ(FW_OK, fwWorld_Step(w.world, 1.0f / 60));
    }
    EXPECT_EQ(before, w.host.allocations);
}

// A row of touching sheets, of which each in turn lies on its neighbour, so that each time another
// pair has many contacts. Memory must follow the sum at one time, not the sum of each pair's
// maximum.
TEST(HostMemory, PastContactsHoldNoMemory) {
    Host host;
    FwContext* context = ::host::createCpuContext(host);
    FwWorldDef worldDef = fwDefaultWorldDef();
    worldDef.flags = FW_WORLD_CONTACT;
    FwWorld* world = nullptr;
    ASSERT_EQ(FW_OK, fwCreateWorld(context, &worldDef, &world));
    const ::host::Sheet sheet(0.5f, 0.5f);
    const FwMeshDef meshDef = sheet.def(64);
    const FwMaterialDef material = ::host::evenMaterial(0.02f, 5);
    FwBurnableMeshDef def = fwDefaultBurnableMeshDef();
    ASSERT_EQ(FW_OK, fwWorld_CreateMesh(world, &meshDef, &def.mesh));
    ASSERT_EQ(FW_OK, fwWorld_CreateMaterial(world, &material, &def.materials[0]));
    constexpr int kSheets = 8;
    FwBurnableMeshId ids[kSheets];
    const auto place = [&](int i, float x, float y) {
        float at[16];
        std::memcpy(at, def.transform, sizeof at);
        at[12] = x;
        at[13] = y;
        EXPECT_EQ(FW_OK, fwWorld_SetTransform(world, ids[i], at));
    };
    const auto steps = [&] {
        for (int i = 0; i < 12; ++i) EXPECT_EQ(FW_OK, fwWorld_Step(world, 1.0f / 32));
    };
    for (int i = 0; i < kSheets; ++i)
        ASSERT_EQ(FW_OK, fwWorld_CreateBurnableMesh(world, &def, &ids[i]));
    for (int i = 0; i < kSheets; ++i) place(i, 0.51f * float(i), 0);
    FwIgnitionDef ball = fwDefaultIgnitionDef();
    ball.object = ids[0];
    ball.radius = 0.01f;
    ASSERT_EQ(FW_OK, fwWorld_Ignite(world, &ball, nullptr));
    steps();
    const int64_t flat = host.bytes;
    int64_t first = 0, last = 0;
    for (int i = 0; i + 1 < kSheets; ++i) {
        place(i, 0.51f * float(i + 1), 0.01f);
        steps();
        place(i, 0.51f * float(i), 0);
        steps();
        last = host.bytes;
        if (i == 2) first = last;  // by now every list length has been seen
    }
    EXPECT_LT(flat, first);
    EXPECT_EQ(first, last);
    fwDestroyContext(context);
    EXPECT_EQ(0, host.bytes);
}

}  // namespace
