// fwWorld_ShiftOrigin: a world whose origin moves burns and looks like one whose origin stays.
#include "abi/net_session.h"

#include <gmock/gmock.h>

namespace {

using namespace host;
using ::testing::HasSubstr;

// Jets and other features that depend on float results are only in worlds that are not exact.
struct ShiftedWorld : BusyWorld {
    enum Kind { exact, ordinary };
    explicit ShiftedWorld(uint32_t backend, Kind kind = exact)
        : BusyWorld(backend, 12, 10, kind == exact) {}
    void go(uint32_t frames) {
        run(frame, frame + frames);
        frame += frames;
    }
    std::vector<FwEvent> events() { return poll(); }
    // Sum of all lights: power and mean position.
    FwLight light() {
        FwLight lights[16] = {}, all{};
        const uint32_t count = fwWorld_GetLights(world, lights, 16);
        for (uint32_t i = 0; i < count; ++i) {
            all.power += lights[i].power;
            for (int k = 0; k < 3; ++k)
                all.position[k] += lights[i].power * (lights[i].position[k] - float(origin[k]));
        }
        for (int k = 0; k < 3; ++k)
            all.position[k] = all.position[k] / std::max(all.power, 1.0f) + float(origin[k]);
        return all;
    }
    FwVolumetricFireState fireState() {
        return getState(fwWorld_GetVolumetricFireState, world, fire);
    }
    FwFireEmitterState emitterState() { return getState(fwWorld_GetFireEmitterState, world, jet); }
    uint64_t tick() { return getState(fwWorld_GetStats, world).tick; }
    uint32_t ignited() {  // texels of all objects
        uint32_t all = 0;
        for (const FwBurnableMeshId id : ids) all += state(id).ignited;
        return all;
    }
    uint32_t frame = 0;
};

void burnsIdentically(uint32_t backend, uint32_t frames) {
    ShiftedWorld stays(backend), moves(backend);
    if (!there(stays)) GTEST_SKIP() << "there is no such backend here";
    stays.go(40);
    moves.go(40);
    moves.shift(-1000, 17, 523.6f);
    for (int part = 0; part < 4; ++part) {
        stays.go(frames / 4);
        moves.go(frames / 4);
        if (part == 1) moves.shift(777, 0, -20000);
        if (part == 2) {  // several shifts in one frame, one of them back
            moves.shift(0, -30, 0);
            moves.shift(5, 60, 1);
            moves.shift(-5, -30, -1);
        }
        ASSERT_EQ(stays.hash(), moves.hash()) << part;
        // Float rounding decides which of two equally near clusters a light joins, so sums are
        // compared.
        const FwLight here = stays.light(), there = moves.light();
        EXPECT_NEAR(double(here.power), double(there.power), 0.001 * double(here.power));
        for (int k = 0; k < 3 && part == 0; ++k)
            EXPECT_NEAR(double(here.position[k]) + moves.origin[k], double(there.position[k]),
                        0.02);
        const FwVolumetricFireState stood = stays.fireState(), moved = moves.fireState();
        for (int k = 0; k < 3 && part == 0; ++k)
            EXPECT_NEAR(double(stood.tip[k]) + moves.origin[k], double(moved.tip[k]), 0.02);
        EXPECT_EQ(stood.flames, moved.flames);
    }
    EXPECT_GE(stays.burning(), 4u);
    const std::vector<FwEvent> a = stays.events(), b = moves.events();
    ASSERT_EQ(a.size(), b.size());
    for (size_t i = 0; i < a.size(); ++i) {
        EXPECT_EQ(a[i].type, b[i].type);
        EXPECT_EQ(a[i].value, b[i].value);
        for (int k = 0; k < 3; ++k)
            EXPECT_NEAR(double(a[i].position[k]) + moves.origin[k], double(b[i].position[k]), 0.04)
                << "pending events move too";
    }
}
TEST(ShiftOrigin, DoesNotChangeTheBurn) { burnsIdentically(FW_BACKEND_CPU, 240); }
TEST(ShiftOrigin, DoesNotChangeTheBurnOnADevice) { burnsIdentically(FW_BACKEND_VULKAN, 120); }

// Hits of jets, igniting fires and wetting fields agree but for float rounding.
void hitsTheSamePlaces(uint32_t backend, uint32_t frames) {
    ShiftedWorld stays(backend, ShiftedWorld::ordinary), moves(backend, ShiftedWorld::ordinary);
    if (!there(stays)) GTEST_SKIP() << "there is no such backend here";
    for (uint32_t part = 0; part < 3; ++part) {
        stays.go(frames / 3);
        moves.go(frames / 3);
        moves.shift(part == 0 ? 300.0f : -150.0f, 0, 20);
    }
    stays.go(10);
    moves.go(10);
    EXPECT_EQ(stays.burning(), moves.burning());
    EXPECT_NEAR(double(stays.ignited()), double(moves.ignited()), 0.02 * stays.ignited());
    EXPECT_GT(stays.ignited(), 100u);
}
TEST(ShiftOrigin, JetsAndWaterHitTheSamePlaces) { hitsTheSamePlaces(FW_BACKEND_CPU, 120); }
TEST(ShiftOrigin, JetsAndWaterHitTheSamePlacesOnADevice) {
    hitsTheSamePlaces(FW_BACKEND_VULKAN, 60);
}

// A volumetric fire and an emitter continue in the next frame.
TEST(ShiftOrigin, FiresAndEmittersKeepTheirState) {
    ShiftedWorld w(FW_BACKEND_CPU);
    w.go(120);
    const FwVolumetricFireState before = w.fireState();
    const FwFireEmitterState particles = w.emitterState();
    w.shift(2000, 0, -300);
    const FwVolumetricFireState at = w.fireState();
    w.ok(fwWorld_Step(w.world, 1.0f / 60));
    const FwVolumetricFireState after = w.fireState();
    for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(double(before.tip[k]) + w.origin[k], double(at.tip[k]), 0.001);
        EXPECT_NEAR(double(before.tip[k]) + w.origin[k], double(after.tip[k]), 0.1);
    }
    const FwFireEmitterState now = w.emitterState();
    EXPECT_NEAR(double(particles.particles), double(now.particles), 3);
    EXPECT_NEAR(double(particles.lightPosition[0]) + 2000, double(now.lightPosition[0]), 0.05);
}

// Saves hold the origin; loading restores it.
TEST(ShiftOrigin, SavesAndTimelinesRestoreTheirOrigin) {
    ShiftedWorld w(FW_BACKEND_CPU);
    FwTimelineDef timeline = fwDefaultTimelineDef();
    timeline.interval = 0.5f;
    w.ok(fwWorld_StartTimeline(w.world, &timeline));
    w.go(60);
    const Bytes old = w.save();
    const uint64_t then = w.hash(), thenTick = w.tick();
    w.shift(512, 0, 64);
    w.go(40);
    const Bytes shifted = w.save();
    const uint64_t later = w.hash(), end = w.tick();
    double origin[3] = {};
    float seconds = 0;
    while (fwWorld_Seek(w.world, thenTick - 128 * 10, &seconds) == FW_OK && seconds > 0)
        w.ok(fwWorld_Step(w.world, seconds));
    w.ok(fwWorld_GetOrigin(w.world, origin));
    EXPECT_EQ(0.0, origin[0]) << "before the shift";
    while (fwWorld_Seek(w.world, end, &seconds) == FW_OK && seconds > 0)
        w.ok(fwWorld_Step(w.world, seconds));
    w.ok(fwWorld_GetOrigin(w.world, origin));
    EXPECT_EQ(512.0, origin[0]);
    EXPECT_EQ(64.0, origin[2]);
    ShiftedWorld other(FW_BACKEND_CPU);
    ASSERT_EQ(FW_OK, other.load(shifted)) << lastMessage(other.world);
    EXPECT_EQ(later, other.hash());
    EXPECT_EQ(512.0, other.origin[0]);
    EXPECT_NEAR(512 + 1.8, double(other.fireState().lightPosition[0]), 1);
    EXPECT_EQ(shifted, other.save());
    ASSERT_EQ(FW_OK, other.load(old)) << lastMessage(other.world);
    EXPECT_EQ(then, other.hash());
    EXPECT_EQ(0.0, other.origin[0]);
}

// A save holds the origin of its frame; the loading world may shift at once.
void savedAndShiftedInOneFrame(uint32_t backend) {
    ShiftedWorld w(backend), other(backend);
    if (!there(w)) GTEST_SKIP() << "there is no such backend here";
    w.go(30);
    w.shift(64, 0, 0);
    w.ok(fwWorld_RequestSave(w.world));
    w.go(1);
    w.shift(4096, 0, -8);  // the save may be pending
    uint64_t size = 0;
    come(w.world, [&] { return fwWorld_FetchSave(w.world, nullptr, &size); });
    Bytes bytes(size);
    w.ok(fwWorld_FetchSave(w.world, bytes.data(), &size));
    ASSERT_EQ(FW_OK, other.load(bytes)) << lastMessage(other.world);
    EXPECT_EQ(64.0, other.origin[0]);
    EXPECT_EQ(w.hash(), other.hash());
    ASSERT_EQ(FW_OK, other.load(bytes));
    other.shift(-64, 0, 0);
    other.frame = w.frame;
    w.go(60);
    other.go(60);
    EXPECT_EQ(w.hash(), other.hash());
    const std::vector<FwEvent> a = w.events(), b = other.events();
    ASSERT_EQ(a.size(), b.size());
    for (size_t i = 0; i < a.size(); ++i)
        for (int k = 0; k < 3; ++k)
            EXPECT_NEAR(double(a[i].position[k]) - w.origin[k], double(b[i].position[k]), 0.01);
}
TEST(ShiftOrigin, ASaveHoldsTheOriginOfItsFrame) { savedAndShiftedInOneFrame(FW_BACKEND_CPU); }
TEST(ShiftOrigin, ASaveHoldsTheOriginOfItsFrameOnADevice) {
    savedAndShiftedInOneFrame(FW_BACKEND_VULKAN);
}

// Old positions of an object, a jet or its stream may then lie beyond the limits of space. The
// world saves and loads all the same.
TEST(ShiftOrigin, SavesWithOldPositionsBeyondTheLimits) {
    ShiftedWorld w(FW_BACKEND_CPU, ShiftedWorld::ordinary);
    ShiftedWorld fresh(FW_BACKEND_CPU, ShiftedWorld::ordinary);
    w.go(30);
    float at[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    const auto moveAll = [&](float x) {
        at[12] = x;
        for (const FwBurnableMeshId id : w.ids) w.ok(fwWorld_SetTransform(w.world, id, at));
        w.ok(fwWorld_MoveHeatOccluder(w.world, w.occluder, at));
        w.ok(fwWorld_MoveFireEmitter(w.world, w.jet, at + 12, nullptr));
        w.ok(fwWorld_MoveVolumetricFire(w.world, w.fire, at + 12));
        w.ok(fwWorld_MoveParticleField(w.world, w.field, at + 12, nullptr));
    };
    for (const FwWindZoneId zone : w.zones) w.ok(fwWorld_DestroyWindZone(w.world, zone));
    for (const FwWindZoneId zone : fresh.zones) w.ok(fwWorld_DestroyWindZone(fresh.world, zone));
    w.ok(fwWorld_DestroyRoom(w.world, w.room));
    w.ok(fwWorld_DestroyRoom(fresh.world, fresh.room));
    w.ok(fwWorld_SetHeatOcclusion(w.world, nullptr));
    w.ok(fwWorld_SetWindGrid(w.world, nullptr));
    moveAll(999000);
    for (int i = 0; i < 20; ++i) w.ok(fwWorld_Step(w.world, 1.0f / 16));
    moveAll(-999000);
    for (const float metres : {1998000.0f, -1998000.0f, 1998000.0f, 0.0f}) {
        const float by[3] = {metres, 0, 0};
        w.ok(fwWorld_ShiftOrigin(w.world, by, nullptr));
        const Bytes bytes = w.save();
        ASSERT_EQ(FW_OK, fresh.load(bytes)) << lastMessage(fresh.world);
        EXPECT_EQ(w.hash(), fresh.hash());
    }
    for (int i = 0; i < 20; ++i)
        for (ShiftedWorld* one : {&w, &fresh}) one->ok(fwWorld_Step(one->world, 1.0f / 16));
    EXPECT_EQ(w.hash(), fresh.hash());
    EXPECT_TRUE(w.save() == fresh.save());
}

// A host's sight answers stay valid: it is not asked again, and a changed answer is not used.
TEST(ShiftOrigin, KeepsTheHostsVisibilityAnswers) {
    struct Asked {
        int times = 0;
        float answer = 0.5f;
        static float FW_CALL sees(void* data, FwBurnableMeshId, FwBurnableMeshId) {
            auto* asked = static_cast<Asked*>(data);
            ++asked->times;
            return asked->answer;
        }
    };
    uint64_t hashes[2] = {};
    for (const bool shifts : {false, true}) {
        Asked asked;
        FwWorldDef def = fwDefaultWorldDef();
        def.flags = FW_WORLD_RADIATION | FW_WORLD_CONTACT;
        def.paceFactor = 10;
        def.visibility = Asked::sees;
        def.visibilityData = &asked;
        FwMaterialDef paper = materialOf(FW_MATERIAL_PAPER);
        SheetWorld w(paper, 0.5f, 0.25f, 64, def);
        const FwBurnableMeshId second = w.add(8);
        FwBurnableMeshDef at = fwDefaultBurnableMeshDef();
        at.transform[13] = 0.0625f;
        ASSERT_EQ(FW_OK, fwWorld_SetTransform(w.world, second, at.transform));
        w.ball(FW_IGNITE, 0.1f, 0, 0.1f, 0.05f);
        w.run(1);
        const int times = asked.times;
        EXPECT_GT(times, 0);
        asked.answer = 1;
        const float by[3] = {100, 0, 0};
        if (shifts) {
            ASSERT_EQ(FW_OK, fwWorld_ShiftOrigin(w.world, by, nullptr));
        }
        w.run(3);
        EXPECT_EQ(times, asked.times) << (shifts ? "with" : "without") << " a shift";
        hashes[shifts] = hashOf(w.world, std::vector{w.object, second});
    }
    EXPECT_EQ(hashes[0], hashes[1]);
}

// A burning object, another that moves next to it after the shift, and water on it.
void meetsWhatComes(uint32_t backend) {
    ShiftedWorld stays(backend), moves(backend);
    if (!there(stays)) GTEST_SKIP() << "there is no such backend here";
    for (ShiftedWorld* w : {&stays, &moves}) {
        w->go(60);
        const FwBurnableMeshId far = w->ids.back();
        float at[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -50, 0, 1};
        at[13] += float(w->origin[1]);
        w->ok(fwWorld_SetTransform(w->world, far, at));
        w->go(6);
        if (w == &moves) w->shift(131, -2, -77);
        const float next[3] = {0.4375f, 0.0625f, 0.140625f};  // next to a burning object
        for (int i = 0; i < 3; ++i) at[12 + i] = float(double(next[i]) + w->origin[i]);
        w->ok(fwWorld_SetTransform(w->world, far, at));
        FwIgnitionDef water = fwDefaultIgnitionDef();
        water.kind = FW_WET;
        water.radius = 0.25f;
        water.water = 60;
        for (int i = 0; i < 3; ++i)
            water.position[i] = float((i == 0 ? 1.5 : 0.125) + w->origin[i]);
        w->ok(fwWorld_Ignite(w->world, &water, nullptr));
        w->go(40);
    }
    EXPECT_EQ(stays.hash(), moves.hash());
    FwObjectState state{};
    state.structSize = sizeof state;
    stays.ok(fwWorld_GetObjectState(stays.world, stays.ids.back(), &state));
    EXPECT_GT(state.ignited, 0u) << "the object next to the fire caught";
}
TEST(ShiftOrigin, AnObjectMovedNextToAFireCatches) { meetsWhatComes(FW_BACKEND_CPU); }
TEST(ShiftOrigin, AnObjectMovedNextToAFireCatchesOnADevice) { meetsWhatComes(FW_BACKEND_VULKAN); }

// Pending point queries are answered at the new places.
void answersWhereItIs(uint32_t backend) {
    ShiftedWorld w(backend);
    if (!there(w)) GTEST_SKIP() << "there is no such backend here";
    w.go(40);
    const float at[3] = {0.3f, 0.0f, 0.1f};
    FwQueryId point{};
    w.ok(fwWorld_RequestPoint(w.world, w.ids[0], at, &point));
    w.go(1);
    w.shift(1000, 0, 2);
    FwPointState state{};
    state.structSize = sizeof state;
    come(w.world, [&] { return fwWorld_FetchPoint(w.world, point, &state); });
    EXPECT_NEAR(1000.3, double(state.position[0]), 0.1);
    EXPECT_NEAR(2.1, double(state.position[2]), 0.1);
}
TEST(ShiftOrigin, PendingQueriesAnswerInTheNewPlaces) {
    answersWhereItIs(FW_BACKEND_CPU);
    answersWhereItIs(FW_BACKEND_VULKAN);
}

// Packets hold the server's places. Clients shift at the step of the server's shift, and a late
// client joins at the server's origin.
TEST(ShiftOrigin, ClientsFollowTheirServer) {
    using Session = NetSession<ShiftedWorld>;
    Session session(std::make_unique<ShiftedWorld>(FW_BACKEND_CPU, ShiftedWorld::ordinary));
    ShiftedWorld& server = *session.server;
    session.join(std::make_unique<ShiftedWorld>(FW_BACKEND_CPU, ShiftedWorld::ordinary));
    const auto play = [&](uint32_t frames) {
        for (uint32_t i = 0; i < frames; ++i) {
            server.go(1);
            session.pass(double(BusyWorld::timeOf(server.frame - 1)));
        }
    };
    play(40);
    server.shift(1024, 0, -500);
    play(30);
    session.expectEqual("after a shift");
    session.join(std::make_unique<ShiftedWorld>(FW_BACKEND_CPU, ShiftedWorld::ordinary));
    play(20);
    server.shift(-24, 7, 0);
    play(20);
    session.expectEqual("after a late join");
    for (const auto& client : session.clients) {
        double origin[3] = {};
        server.ok(fwWorld_GetOrigin(client->world->world, origin));
        for (int i = 0; i < 3; ++i) EXPECT_EQ(server.origin[i], origin[i]);
        EXPECT_EQ(0u, Session::stateOf(client->world->world).desyncs);
        const float by[3] = {1, 0, 0};
        EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT,
                  fwWorld_ShiftOrigin(client->world->world, by, nullptr));
        EXPECT_THAT(lastMessage(client->world->world), HasSubstr("follows a server"));
    }
    EXPECT_GE(server.burning(), 2u);
}

// From one end of space to the other: no place of the loading world overflows in between.
TEST(ShiftOrigin, LoadsASaveWithADistantOrigin) {
    ShiftedWorld w(FW_BACKEND_CPU);
    w.shift(512, 0, 64);
    w.go(40);
    Bytes bytes = saveOf(w.world);
    const double origin[3] = {512, 0, 64}, far[3] = {1e9, 0, -1e9};
    const auto* begin = reinterpret_cast<const unsigned char*>(origin);
    const auto at = std::search(bytes.begin(), bytes.end(), begin, begin + sizeof origin);
    ASSERT_NE(bytes.end(), at);
    std::memcpy(&*at, far, sizeof far);
    signSave(bytes);
    ShiftedWorld other(FW_BACKEND_CPU);
    other.shift(-900000, 0, 0);
    other.ok(fwWorld_Load(other.world, bytes.data(), bytes.size()));
    double now[3] = {};
    other.ok(fwWorld_GetOrigin(other.world, now));
    EXPECT_EQ(1e9, now[0]);
    EXPECT_EQ(w.hash(), other.hash());
    // Objects that the host places are where the save has them.
    std::copy_n(w.origin, 3, other.origin);
    other.frame = w.frame;
    w.go(20);
    other.go(20);
    EXPECT_EQ(w.hash(), other.hash());
}

TEST(ShiftOrigin, IsRecordedInCommandLogs) {
    ShiftedWorld w(FW_BACKEND_CPU), other(FW_BACKEND_CPU);
    const Bytes start = w.save();
    w.ok(fwWorld_StartCommandLog(w.world));
    w.go(30);
    w.shift(-300, 2, 40);
    w.go(30);
    uint64_t size = 0;
    w.ok(fwWorld_FetchCommandLog(w.world, nullptr, &size));
    Bytes log(size);
    w.ok(fwWorld_FetchCommandLog(w.world, log.data(), &size));
    ASSERT_EQ(FW_OK, other.load(start)) << lastMessage(other.world);
    other.ok(fwWorld_OpenCommandLog(other.world, log.data(), log.size()));
    float seconds = 0;
    while (fwWorld_PlayCommandLog(other.world, w.tick(), &seconds) == FW_OK && seconds > 0)
        other.ok(fwWorld_Step(other.world, seconds));
    double origin[3] = {};
    other.ok(fwWorld_GetOrigin(other.world, origin));
    EXPECT_EQ(-300.0, origin[0]);
    EXPECT_EQ(2.0, origin[1]);
    EXPECT_EQ(40.0, origin[2]);
    EXPECT_EQ(w.hash(), other.hash());
}

TEST(ShiftOrigin, RefusesObjectsBeyondTheLimitsByName) {
    ShiftedWorld w(FW_BACKEND_CPU);
    const float far[3] = {999999, 0, 0}, bad[3] = {0, NAN, 0}, further[3] = {3e6f, 0, 0};
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_ShiftOrigin(w.world, nullptr, nullptr));
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_ShiftOrigin(w.world, bad, nullptr));
    EXPECT_THAT(lastMessage(w.world), HasSubstr("offset[1]"));
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_ShiftOrigin(w.world, further, nullptr));
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_ShiftOrigin(w.world, far, nullptr));
    EXPECT_THAT(lastMessage(w.world), HasSubstr("burnable mesh 4"));
    double origin[3] = {1, 1, 1};
    w.ok(fwWorld_GetOrigin(w.world, origin));
    EXPECT_EQ(0.0, origin[0]) << "nothing moved";
}

}  // namespace
