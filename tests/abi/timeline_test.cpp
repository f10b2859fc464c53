// A world's timeline reaches any tick of its burn again in the same world, in both directions, bit
// for bit; a command in the past starts another future; memory stays within the limit.
#include "abi/busy_world.h"
#include "flamewright/flamewright.hpp"

#include <map>

namespace fw::test::timeline_test {
namespace {

using namespace host;
using host::lastMessage;  // not that of the wrapper

uint64_t tickOf(FwWorld* world) {
    FwWorldStats stats{};
    stats.structSize = sizeof stats;
    EXPECT_EQ(FW_OK, fwWorld_GetStats(world, &stats));
    return stats.tick;
}

FwTimelineState stateOf(FwWorld* world) {
    FwTimelineState state{};
    state.structSize = sizeof state;
    EXPECT_EQ(FW_OK, fwWorld_GetTimelineState(world, &state)) << lastMessage(world);
    return state;
}

void start(FwWorld* world, float interval = 1, float longest = 32, uint64_t bytes = 1 << 26) {
    FwTimelineDef def = fwDefaultTimelineDef();
    def.interval = interval;
    def.maxInterval = longest;
    def.bytes = bytes;
    EXPECT_EQ(FW_OK, fwWorld_StartTimeline(world, &def)) << lastMessage(world);
}

// In steps of at most `most` s.
void seek(FwWorld* world, uint64_t tick, float most = 10) {
    float seconds = 0;
    for (int i = 0; i < 100000; ++i) {
        ASSERT_EQ(FW_OK, fwWorld_Seek(world, tick, &seconds)) << lastMessage(world);
        if (seconds == 0) break;
        for (; seconds > most; seconds -= most) ASSERT_EQ(FW_OK, fwWorld_Step(world, most));
        ASSERT_EQ(FW_OK, fwWorld_Step(world, seconds)) << lastMessage(world);
    }
    EXPECT_EQ(tick, tickOf(world));
}

void douse(FwWorld* world, uint32_t kind = FW_WET, float x = 0.5f) {
    FwIgnitionDef ball = fwDefaultIgnitionDef();
    ball.kind = kind;
    ball.water = kind == FW_WET ? 40.0f : 0.0f;
    ball.radius = 0.2f;
    ball.position[0] = x;
    uint32_t texels = 0;
    EXPECT_EQ(FW_OK, fwWorld_Ignite(world, &ball, &texels)) << lastMessage(world);
    EXPECT_GT(texels, 0u);
}

void steps(FwWorld* world, int count) {
    for (int i = 0; i < count; ++i)
        ASSERT_EQ(FW_OK, fwWorld_Step(world, 1.0f / 32)) << lastMessage(world);
}

// Heat, water, holes, wind, rooms and jets: at each tick the world equals one on the cpu backend
// without a timeline, in whichever order it is reached.
void seeks(uint32_t backend) {
    BusyWorld straight(FW_BACKEND_CPU), w(backend);
    if (!there(w)) GTEST_SKIP() << "there is no such backend here";
    start(w.world);
    struct Expected {
        uint64_t tick = 0, hash = 0;
    };
    std::map<uint32_t, Expected> expected;  // by frame
    uint32_t frame = 0;
    for (const uint32_t next : {1u, 30u, 61u, 75u, 92u, 110u, 131u, 155u}) {
        straight.run(frame, next);
        w.run(frame, next);
        frame = next;
        expected[next] = {tickOf(straight.world), straight.hash()};
        ASSERT_EQ(expected[next].tick, tickOf(w.world));
        EXPECT_EQ(expected[next].hash, w.hash()) << "keeping a timeline changed frame " << next;
    }
    EXPECT_GE(stateOf(w.world).keyframes, 4u);
    EXPECT_EQ(expected[155].tick, stateOf(w.world).endTick);
    for (const uint32_t wanted : {61u, 131u, 30u, 110u, 92u, 1u, 155u, 75u}) {
        seek(w.world, expected[wanted].tick, wanted % 2 ? 10.0f : 0.02f);
        EXPECT_EQ(expected[wanted].hash, w.hash()) << "frame " << wanted;
    }
    EXPECT_EQ(expected[155].tick, stateOf(w.world).endTick) << "seeking drops nothing";
    // A new command drops the future and keeps the past.
    douse(w.world);
    EXPECT_EQ(expected[75].tick, stateOf(w.world).endTick);
    steps(w.world, 40);
    const uint64_t end = tickOf(w.world), other = w.hash();
    EXPECT_EQ(end, stateOf(w.world).endTick);
    seek(w.world, expected[61].tick);
    EXPECT_EQ(expected[61].hash, w.hash());
    seek(w.world, end);
    EXPECT_EQ(other, w.hash());
}

TEST(Timeline, SeeksAnyTick) { seeks(FW_BACKEND_CPU); }
TEST(Timeline, SeeksAnyTickOnADevice) { seeks(FW_BACKEND_VULKAN); }

// At the end of its timeline the world is as it was left, including commands after the last step,
// and continues.
TEST(Timeline, ContinuesFromItsEnd) {
    BusyWorld straight(FW_BACKEND_CPU, 12, 6), w(FW_BACKEND_CPU, 12, 6);
    start(w.world);
    for (BusyWorld* one : {&straight, &w}) {
        one->run(0, 70);
        douse(one->world);
        douse(one->world, FW_IGNITE, 1.35f);
    }
    const uint64_t end = tickOf(w.world);
    seek(w.world, 2048);
    seek(w.world, end);
    for (BusyWorld* one : {&straight, &w}) steps(one->world, 48);
    EXPECT_EQ(tickOf(straight.world), tickOf(w.world));
    EXPECT_EQ(straight.hash(), w.hash());
    // A step from the past is another future, too.
    seek(w.world, end);
    EXPECT_LT(end, stateOf(w.world).endTick);
    steps(w.world, 1);
    EXPECT_EQ(end + 128, stateOf(w.world).endTick);
}

// A baked burn that plays, and goes live in the middle.
TEST(Timeline, IncludesBakedBurnsThatWentLive) {
    for (const uint32_t backend : {FW_BACKEND_CPU, FW_BACKEND_VULKAN}) {
        BusyWorld w(backend, 12, 3);
        if (!there(w)) continue;
        w.run(0, 75);
        ASSERT_EQ(FW_OK, fwWorld_RequestBurn(w.world, w.ids[1]));
        uint64_t size = 0;
        come(w.world, [&] { return fwWorld_FetchBurn(w.world, w.ids[1], nullptr, &size); });
        Bytes bytes(size);
        ASSERT_EQ(FW_OK, fwWorld_FetchBurn(w.world, w.ids[1], bytes.data(), &size));
        BusyWorld other(backend, 12, 3);
        FwBurnId burn{};
        ASSERT_EQ(FW_OK, fwWorld_CreateBurn(other.world, bytes.data(), size, &burn));
        start(other.world, 0.5f);
        ASSERT_EQ(FW_OK, fwWorld_PlayBurn(other.world, other.ids[1], burn, 0.1f, 1));
        std::map<uint64_t, uint64_t> hashes;  // by tick
        bool played = false, lives = false;
        for (int k = 0; k < 6; ++k) {
            steps(other.world, 13);
            hashes[tickOf(other.world)] = other.hash();
            FwObjectState state{};
            state.structSize = sizeof state;
            ASSERT_EQ(FW_OK, fwWorld_GetObjectState(other.world, other.ids[1], &state));
            played |= state.playsBakedBurn != 0;
            lives |= played && state.playsBakedBurn == 0;
            if (k == 2) {
                ASSERT_EQ(FW_OK, fwWorld_StopBurn(other.world, other.ids[1]));
            }
        }
        EXPECT_TRUE(played && lives);
        for (const uint64_t tick : {26u * 128, 65u * 128, 13u * 128, 78u * 128, 52u * 128}) {
            seek(other.world, tick);
            EXPECT_EQ(hashes[tick], other.hash()) << "tick " << tick;
        }
    }
}

TEST(Timeline, StaysWithinItsByteLimit) {
    constexpr uint64_t kBytes = 3 << 16;
    BusyWorld w(FW_BACKEND_CPU);
    start(w.world, 1.0f / 32, 0.25f, kBytes);
    FwTimelineState state{};
    uint64_t first = 0;
    bool spread = false;
    for (uint32_t frame = 0; frame < 160; frame += 10) {
        w.run(frame, frame + 10);
        state = stateOf(w.world);
        EXPECT_LE(state.bytes, kBytes);
        EXPECT_GE(state.firstTick, first);
        first = state.firstTick;
        spread |= first == 0 && state.interval > 0.1f;
    }
    EXPECT_TRUE(spread) << "first there are fewer";
    EXPECT_GT(state.firstTick, 0u) << "the timeline drops its beginning";
    EXPECT_LE(state.interval, 0.25f);
    EXPECT_GE(state.keyframes, 2u) << "of " << state.bytes << " bytes";
    const uint64_t hash = w.hash();
    seek(w.world, state.firstTick);
    seek(w.world, state.endTick);
    EXPECT_EQ(hash, w.hash());
}

TEST(Timeline, RefusesBadCallsByName) {
    BusyWorld w(FW_BACKEND_CPU, 12, 3);
    const auto refused = [&](FwResult expected, FwResult result, const char* says) {
        EXPECT_EQ(expected, result) << says;
        EXPECT_NE(std::string::npos, lastMessage(w.world).find(says)) << lastMessage(w.world);
    };
    float seconds = 1;
    refused(FW_ERROR_INVALID_ARGUMENT, fwWorld_Seek(w.world, 0, &seconds), "fwWorld_StartTimeline");
    EXPECT_EQ(0u, stateOf(w.world).keyframes);
    const auto started = [&](float interval, float longest, uint64_t bytes) {
        FwTimelineDef def = fwDefaultTimelineDef();
        def.interval = interval;
        def.maxInterval = longest;
        def.bytes = bytes;
        return fwWorld_StartTimeline(w.world, &def);
    };
    refused(FW_ERROR_INVALID_ARGUMENT, started(0, 32, 1 << 20), "FwTimelineDef::interval is 0");
    refused(FW_ERROR_INVALID_ARGUMENT, started(2, 4000, 1 << 20),
            "FwTimelineDef::maxInterval is 4000");
    refused(FW_ERROR_INVALID_ARGUMENT, started(3, 2, 1 << 20), "below its interval of 3 s");
    refused(FW_ERROR_INVALID_ARGUMENT, started(2, 32, 100), "FwTimelineDef::bytes is 100");
    w.run(0, 40);
    start(w.world);
    EXPECT_EQ(FW_NOT_READY, fwWorld_Seek(w.world, 128, &seconds));
    EXPECT_EQ(0.0f, seconds);
    refused(FW_ERROR_INVALID_ARGUMENT, fwWorld_Seek(w.world, 0, nullptr), "seconds");
    w.run(40, 41);
    const uint64_t first = tickOf(w.world);
    w.run(41, 60);
    EXPECT_EQ(first, stateOf(w.world).firstTick);
    refused(FW_ERROR_INVALID_ARGUMENT, fwWorld_Seek(w.world, first - 1, &seconds),
            "the timeline has");
    refused(FW_ERROR_INVALID_ARGUMENT, fwWorld_Seek(w.world, 1u << 20, &seconds),
            "untilTick is 1048576");
    // Another past: the timeline starts again here.
    const Bytes save = w.save();
    w.run(60, 70);
    ASSERT_EQ(FW_OK, w.load(save));
    EXPECT_EQ(0u, stateOf(w.world).keyframes);
    EXPECT_EQ(tickOf(w.world), stateOf(w.world).endTick);
    w.run(60, 80);
    ASSERT_EQ(1u, stateOf(w.world).keyframes);
    // Destroyed objects are not on it.
    const uint64_t hash = w.hash();
    ASSERT_EQ(FW_OK, fwWorld_RemoveHeatOccluder(w.world, w.occluder));
    refused(FW_ERROR_BAD_DATA, fwWorld_Seek(w.world, stateOf(w.world).firstTick, &seconds),
            "1 occluders; this world has 0");
    EXPECT_EQ(hash, w.hash());
    EXPECT_EQ(FW_OK, fwWorld_StopTimeline(w.world));
    EXPECT_EQ(0u, stateOf(w.world).endTick);
    w.run(80, 82);
}

TEST(Timeline, WrapperSeeks) {
    const fw::Context context = [] {
        FwContextDef def = fw::def<FwContextDef>();
        def.backend = FW_BACKEND_CPU;
        return fw::createContext(def);
    }();
    const fw::World world = fw::createWorld(context);
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fw::seek(world, 0));
    start(world.get());
    steps(world.get(), 100);
    EXPECT_EQ(FW_OK, fw::seek(world, 1000));
    EXPECT_EQ(896u, tickOf(world.get()));
    EXPECT_EQ(FW_OK, fw::seek(world, 12800));
    EXPECT_EQ(12800u, tickOf(world.get()));
}

}  // namespace
}  // namespace fw::test::timeline_test
