// fwWorld_TransferBurn: a burn continues on another mesh of the same shape.
#include "abi/busy_world.h"

#include <gmock/gmock.h>

#include <cmath>

namespace {

using namespace host;
using ::testing::HasSubstr;

// A fine and a coarse board of the same shape; the coarse one has other triangles.
struct Boards : HostedWorld {
    explicit Boards(uint32_t backend, uint32_t preset = FW_MATERIAL_PAPER, uint32_t flags = 0)
        : HostedWorld(backend, pacedDef(preset == FW_MATERIAL_PAPER ? 1.0f : 10.0f)),
          fine(0.6f, 0.4f, 6),
          coarse(0.6f, 0.4f, 1) {
        if (!world) return;
        FwMaterialDef material = materialOf(preset);
        const FwMaterialId materialId = created(fwWorld_CreateMaterial, world, material);
        for (const bool isFine : {true, false}) {
            FwMeshDef meshDef = (isFine ? fine : coarse).def(isFine ? 96.0f : 40.0f);
            FwBurnableMeshDef made = fwDefaultBurnableMeshDef();
            ok(fwWorld_CreateMesh(world, &meshDef, &made.mesh));
            made.materials[0] = materialId;
            made.flags = flags;
            ok(fwWorld_CreateBurnableMesh(world, &made, isFine ? &from : &to));
        }
    }
    void ball(uint32_t kind, FwBurnableMeshId id, float x, float z, float radius) {
        FwResult result{};
        touch(kind, id, x, 0, z, radius, 0, &result);
        ok(result);
    }
    void run(float seconds) {
        for (float t = 0; t < seconds - 1e-6f; t += 1.0f / 32) ok(fwWorld_Step(world, 1.0f / 32));
    }
    FwPointState point(FwBurnableMeshId id, float x, float z) {
        return HostedWorld::point(id, x, 0, z);
    }
    FwEnergyLedger book() { return getState(fwWorld_GetEnergyLedger, world); }
    uint64_t hash(FwBurnableMeshId id) {
        uint64_t tick = 0;
        return HostedWorld::hash(id, &tick) + tick;
    }

    Sheet fine, coarse;
    FwBurnableMeshId from{}, to{};
};

// Burnt share, burning texels, remaining fuel and water stay, and the fire spreads from there.
void goesOn(uint32_t preset, uint32_t flags, float before) {
    Boards w(FW_BACKEND_CPU, preset, flags);
    w.ball(FW_IGNITE, w.from, 0.15f, 0.2f, 0.05f);
    w.ball(FW_WET, w.from, 0.5f, 0.2f, 0.06f);
    w.run(before);
    const FwObjectState was = w.state(w.from);
    ASSERT_GT(was.burntFraction, 0.05f);
    ASSERT_LT(was.burntFraction, 0.9f);
    const FwEnergyLedger all = w.book();
    FwEvent events[64];
    (void)fwWorld_PollEvents(w.world, events, 64);
    w.ok(fwWorld_TransferBurn(w.world, w.from, w.to));
    w.run(1.0f / 32);
    w.ok(fwWorld_DestroyBurnableMesh(w.world, w.from));
    w.run(0.25f);
    const FwObjectState now = w.state(w.to);
    EXPECT_NEAR(was.burntFraction, now.burntFraction, 0.03f);
    EXPECT_NEAR(was.burningArea, now.burningArea, 0.1f * was.burningArea + 0.002f);
    EXPECT_EQ(uint32_t(FW_POINT_WET), w.point(w.to, 0.5f, 0.2f).kind);
    EXPECT_EQ(uint32_t(FW_POINT_UNBURNT), w.point(w.to, 0.59f, 0.01f).kind);
    EXPECT_NE(uint32_t(FW_POINT_UNBURNT), w.point(w.to, 0.15f, 0.2f).kind);
    if (!(flags & FW_BURNABLE_LITE)) {
        const FwEnergyLedger left = w.book();
        const double share = double(all.radiated + all.convected) / (0.5 * double(all.fuel));
        EXPECT_NEAR(share, double(left.radiated + left.convected) / double(left.fuel), 0.02);
        EXPECT_EQ(left.fuel, left.unburnt + left.radiated + left.convected);
        EXPECT_LT(now.power, 2 * was.power + 1)
            << "transferred fuel is not counted as released power";
    }
    w.run(2);
    EXPECT_GT(w.state(w.to).ignited, now.ignited) << "the front moves on";
    const uint32_t count = fwWorld_PollEvents(w.world, events, 64);
    for (uint32_t i = 0; i < count; ++i) EXPECT_NE(uint32_t(FW_EVENT_IGNITED), events[i].type);
}
TEST(TransferBurn, ContinuesPaperOnTheOtherMesh) { goesOn(FW_MATERIAL_PAPER, 0, 8); }
TEST(TransferBurn, ContinuesWoodOnTheOtherMesh) { goesOn(FW_MATERIAL_PINE, 0, 20); }
TEST(TransferBurn, ContinuesALiteObjectOnTheOtherMesh) {
    goesOn(FW_MATERIAL_PAPER, FW_BURNABLE_LITE, 8);
}

// Equal bit for bit on every backend, in saves taken before its step, and in logs.
TEST(TransferBurn, BothBackendsAgree) {
    uint64_t hashes[2] = {};
    for (const uint32_t backend : {FW_BACKEND_CPU, FW_BACKEND_VULKAN}) {
        Boards w(backend);
        if (!w.world) GTEST_SKIP() << "there is no such backend here";
        w.ball(FW_IGNITE, w.from, 0.15f, 0.2f, 0.05f);
        w.ball(FW_WET, w.from, 0.5f, 0.2f, 0.06f);
        w.run(6);
        w.ok(fwWorld_TransferBurn(w.world, w.from, w.to));
        w.ball(FW_IGNITE, w.to, 0.55f, 0.05f, 0.03f);  // waits until the transfer is applied
        w.run(3);
        hashes[backend == FW_BACKEND_VULKAN] = w.hash(w.to) * 31 + w.hash(w.from);
    }
    EXPECT_EQ(hashes[1], hashes[0]);
}

TEST(TransferBurn, IsRecordedInSavesAndCommandLogs) {
    Boards w(FW_BACKEND_CPU), loaded(FW_BACKEND_CPU), played(FW_BACKEND_CPU);
    w.ball(FW_IGNITE, w.from, 0.15f, 0.2f, 0.05f);
    w.run(5);
    const Bytes start = saveOf(w.world);
    w.ok(fwWorld_StartCommandLog(w.world));
    w.ok(fwWorld_TransferBurn(w.world, w.from, w.to));
    w.run(2);
    const uint64_t end = w.hash(w.to);
    uint64_t size = 0;
    w.ok(fwWorld_FetchCommandLog(w.world, nullptr, &size));
    Bytes log(size);
    w.ok(fwWorld_FetchCommandLog(w.world, log.data(), &size));
    loaded.ok(fwWorld_Load(loaded.world, start.data(), start.size()));
    loaded.ok(fwWorld_TransferBurn(loaded.world, loaded.from, loaded.to));
    const Bytes between =
        saveOf(loaded.world);  // saved with deltaTime 0: the step is still to come
    Boards after(FW_BACKEND_CPU);
    after.ok(fwWorld_Load(after.world, between.data(), between.size()));
    after.run(2);
    EXPECT_EQ(end, after.hash(after.to));
    loaded.run(2);
    EXPECT_EQ(end, loaded.hash(loaded.to));
    FwWorldStats stats{};
    stats.structSize = sizeof stats;
    w.ok(fwWorld_GetStats(w.world, &stats));
    played.ok(fwWorld_Load(played.world, start.data(), start.size()));
    played.ok(fwWorld_OpenCommandLog(played.world, log.data(), log.size()));
    float seconds = 0;
    while (fwWorld_PlayCommandLog(played.world, stats.tick, &seconds) == FW_OK && seconds > 0)
        played.ok(fwWorld_Step(played.world, seconds));
    EXPECT_EQ(end, played.hash(played.to));
}

// A damaged save with a valid checksum: every texel that waits for a transfer and its source are
// checked before use.
TEST(TransferBurn, RefusesSavesWithInvalidTransfers) {
    Boards w(FW_BACKEND_CPU);
    const FwMeshDef meshDef = w.fine.def(96);
    FwBurnableMeshDef made = fwDefaultBurnableMeshDef();
    w.ok(fwWorld_CreateMesh(w.world, &meshDef, &made.mesh));
    made.flags = FW_BURNABLE_LITE;
    FwBurnableMeshId lite{};
    w.ok(fwWorld_CreateBurnableMesh(w.world, &made, &lite));
    w.ball(FW_IGNITE, w.from, 0.15f, 0.2f, 0.05f);
    w.run(2);
    w.ok(fwWorld_TransferBurn(w.world, w.from, w.to));
    const Bytes bytes = saveOf(w.world);
    // Words of its first event: object, texel, kind, tick, texel of the other object.
    constexpr uint32_t kCarry = 8;  // the slot + 1 is above bit 8
    const auto word = [&](size_t at) {
        uint32_t value = 0;
        std::memcpy(&value, &bytes[at], 4);
        return value;
    };
    size_t at = 24;
    while (at + 20 <= bytes.size() && (word(at) != 1 || word(at + 8) != (kCarry | 1u << 8))) ++at;
    ASSERT_LE(at + 20, bytes.size());
    ASSERT_EQ(2u * 4096, word(at + 12));
    const auto refused = [&](size_t field, uint32_t value) {
        Bytes wrong = bytes;
        std::memcpy(&wrong[at + field], &value, 4);
        signSave(wrong);
        EXPECT_EQ(FW_ERROR_BAD_DATA, fwWorld_Load(w.world, wrong.data(), wrong.size()))
            << field << " " << value;
    };
    refused(4, 0xFFFFFFFFu);       // all texels
    refused(8, kCarry);            // no source object
    refused(8, kCarry | 2u << 8);  // itself as the source
    refused(8, kCarry | 3u << 8);  // an object without heat as the source
    refused(8, kCarry | 4u << 8);  // a missing object as the source
    refused(12, 3u * 4096);        // later than the next step
    refused(16, 0xFFFFFFF0u);      // no source texel
    EXPECT_EQ(FW_OK, fwWorld_Load(w.world, bytes.data(), bytes.size())) << lastMessage(w.world);
}

TEST(TransferBurn, RefusesImpossibleTransfersByName) {
    Boards w(FW_BACKEND_CPU);
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_TransferBurn(w.world, w.from, w.from));
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_TransferBurn(w.world, w.from, FwBurnableMeshId{}));
    w.ok(fwWorld_TransferBurn(w.world, w.from, w.to));
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_TransferBurn(w.world, w.to, w.from));
    EXPECT_THAT(lastMessage(w.world), HasSubstr("part of another transfer"));
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_DestroyBurnableMesh(w.world, w.from));
    EXPECT_THAT(lastMessage(w.world), HasSubstr("with the next step"));
    w.run(1.0f / 32);
    w.ok(fwWorld_DestroyBurnableMesh(w.world, w.from));
    const Sheet other(3, 3);
    const FwMeshDef meshDef = other.def(16);
    FwBurnableMeshDef made = fwDefaultBurnableMeshDef();
    w.ok(fwWorld_CreateMesh(w.world, &meshDef, &made.mesh));
    FwBurnableMeshId large{};
    w.ok(fwWorld_CreateBurnableMesh(w.world, &made, &large));
    EXPECT_EQ(FW_ERROR_BAD_DATA, fwWorld_TransferBurn(w.world, w.to, large));
    EXPECT_THAT(lastMessage(w.world), HasSubstr("at least half of them must"));
}

}  // namespace
