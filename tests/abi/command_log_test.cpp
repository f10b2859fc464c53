// A log of a host's commands: with an earlier save it reproduces any tick bit for bit, on either
// backend and at any frame rate.
#include "abi/busy_world.h"

#include <map>

namespace {

using namespace host;

Bytes logOf(FwWorld* world) {
    uint64_t size = 0;
    EXPECT_EQ(FW_OK, fwWorld_FetchCommandLog(world, nullptr, &size)) << lastMessage(world);
    Bytes bytes(size);
    EXPECT_EQ(FW_OK, fwWorld_FetchCommandLog(world, bytes.data(), &size)) << lastMessage(world);
    return bytes;
}

uint64_t tickOf(FwWorld* world) {
    FwWorldStats stats{};
    stats.structSize = sizeof stats;
    EXPECT_EQ(FW_OK, fwWorld_GetStats(world, &stats));
    return stats.tick;
}

// Up to `tick`, in steps of at most `most` s.
void playTo(FwWorld* world, uint64_t tick, float most = 10) {
    float seconds = 0;
    for (int i = 0; i < 100000; ++i) {
        ASSERT_EQ(FW_OK, fwWorld_PlayCommandLog(world, tick, &seconds)) << lastMessage(world);
        if (seconds == 0) break;
        for (; seconds > most; seconds -= most) ASSERT_EQ(FW_OK, fwWorld_Step(world, most));
        ASSERT_EQ(FW_OK, fwWorld_Step(world, seconds)) << lastMessage(world);
    }
    EXPECT_EQ(tick, tickOf(world));
}

// Ticks of a busy world, each sought from an earlier save, in both directions.
void seeks(uint32_t recorder, uint32_t player) {
    struct Expected {
        uint64_t tick = 0, hash = 0;
    };
    BusyWorld first(recorder);
    if (!there(first)) GTEST_SKIP() << "there is no such backend here";
    ASSERT_EQ(FW_OK, fwWorld_StartCommandLog(first.world));
    std::map<uint32_t, Expected> expected;  // by frame
    std::map<uint32_t, Bytes> saves;
    uint32_t frame = 0;
    for (const uint32_t next : {1u, 30u, 61u, 75u, 92u, 110u, 131u, 155u}) {
        first.run(frame, next);
        frame = next;
        if (next == 1 || next == 75 || next == 110) saves[next] = first.save();
        expected[next] = {tickOf(first.world), first.hash()};
    }
    const Bytes log = logOf(first.world);
    BusyWorld other(player);
    if (!there(other)) GTEST_SKIP() << "there is no such backend here";
    ASSERT_EQ(FW_OK, fwWorld_OpenCommandLog(other.world, log.data(), log.size()))
        << lastMessage(other.world);
    for (const uint32_t wanted : {155u, 61u, 30u, 131u, 92u, 110u}) {
        auto save = saves.upper_bound(wanted);
        --save;
        ASSERT_EQ(FW_OK, other.load(save->second)) << lastMessage(other.world);
        playTo(other.world, expected[wanted].tick, wanted % 2 ? 10.0f : 0.02f);
        EXPECT_EQ(expected[wanted].hash, other.hash()) << "frame " << wanted;
    }
    // Without a save, from the beginning: the log holds the first commands, too.
    BusyWorld fresh(player);
    ASSERT_EQ(FW_OK, fwWorld_OpenCommandLog(fresh.world, log.data(), log.size()));
    playTo(fresh.world, expected[92].tick);
    EXPECT_EQ(expected[92].hash, fresh.hash());
}

TEST(CommandLog, SeeksAnyTick) { seeks(FW_BACKEND_CPU, FW_BACKEND_CPU); }
TEST(CommandLog, SeeksAnyTickOnADevice) { seeks(FW_BACKEND_CPU, FW_BACKEND_VULKAN); }
TEST(CommandLog, CpuPlaysALogOfADevice) { seeks(FW_BACKEND_VULKAN, FW_BACKEND_CPU); }

// A save holds the host's commands between its request and its frame, so the log does not repeat
// them. Commands after that frame, at the same tick, are in the log alone.
TEST(CommandLog, DoesNotRepeatCommandsOfTheSave) {
    BusyWorld w(FW_BACKEND_CPU);
    ASSERT_EQ(FW_OK, fwWorld_StartCommandLog(w.world));
    w.run(0, 40);
    FwIgnitionDef water = fwDefaultIgnitionDef();
    water.kind = FW_WET;
    water.water = 40;
    water.radius = 0.2f;
    water.position[0] = 0.5f;
    uint32_t texels = 0;
    ASSERT_EQ(FW_OK, fwWorld_RequestSave(w.world));
    ASSERT_EQ(FW_OK, fwWorld_Ignite(w.world, &water, &texels)) << lastMessage(w.world);
    EXPECT_GT(texels, 0u);
    ASSERT_EQ(FW_OK, fwWorld_Step(w.world, 0));
    uint64_t size = 0;
    ASSERT_EQ(FW_OK, fwWorld_FetchSave(w.world, nullptr, &size));
    Bytes save(size);
    ASSERT_EQ(FW_OK, fwWorld_FetchSave(w.world, save.data(), &size));
    water.kind = FW_IGNITE;
    water.water = 0;
    water.position[0] = 1.3f;
    ASSERT_EQ(FW_OK, fwWorld_Ignite(w.world, &water, &texels));
    w.run(41, 58);
    const uint64_t tick = tickOf(w.world), hash = w.hash();
    const Bytes log = logOf(w.world);
    BusyWorld other(FW_BACKEND_CPU);
    ASSERT_EQ(FW_OK, fwWorld_OpenCommandLog(other.world, log.data(), log.size()));
    ASSERT_EQ(FW_OK, other.load(save));
    playTo(other.world, tick);
    EXPECT_EQ(hash, other.hash());
}

void expectLogRefused(BusyWorld& w, const Bytes& log, const char* says) {
    EXPECT_EQ(FW_ERROR_BAD_DATA, fwWorld_OpenCommandLog(w.world, log.data(), log.size())) << says;
    EXPECT_NE(std::string::npos, lastMessage(w.world).find(says)) << lastMessage(w.world);
}

TEST(CommandLog, RefusesLogsOfOtherWorlds) {
    BusyWorld w(FW_BACKEND_CPU);
    uint64_t size = 0;
    float seconds = 0;
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_FetchCommandLog(w.world, nullptr, &size));
    EXPECT_NE(std::string::npos, lastMessage(w.world).find("fwWorld_StartCommandLog"));
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_PlayCommandLog(w.world, 1000, &seconds));
    EXPECT_NE(std::string::npos, lastMessage(w.world).find("fwWorld_OpenCommandLog"));
    ASSERT_EQ(FW_OK, fwWorld_StartCommandLog(w.world));
    w.run(0, 60);
    const Bytes log = logOf(w.world);
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_FetchCommandLog(w.world, nullptr, nullptr));
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_OpenCommandLog(w.world, nullptr, 5));
    unsigned char few[3];
    size = 3;
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_FetchCommandLog(w.world, few, &size));
    EXPECT_EQ(log.size(), size);
    Bytes wrong = log;
    wrong[0] ^= 1;
    expectLogRefused(w, wrong, "\"FWLG\"");
    wrong = log;
    wrong[4] = 9;
    expectLogRefused(w, wrong, "format version 9");
    wrong = log;
    wrong[log.size() / 2] ^= 0x10;
    expectLogRefused(w, wrong, "checksum");
    wrong.assign(log.begin(), log.end() - 1);
    expectLogRefused(w, wrong, "checksum");
    wrong.assign(log.begin(), log.begin() + 11);
    expectLogRefused(w, wrong, "log ends");
    BusyWorld fewer(FW_BACKEND_CPU, 12, 9);
    expectLogRefused(fewer, log, "other rules, objects or meshes");
    ASSERT_EQ(FW_OK, fwWorld_OpenCommandLog(w.world, log.data(), log.size()));
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_PlayCommandLog(w.world, 1000000, nullptr));
    ASSERT_EQ(FW_OK, fwWorld_PlayCommandLog(w.world, 5, &seconds));  // in its past
    EXPECT_EQ(0.0f, seconds);
    ASSERT_EQ(FW_OK, fwWorld_OpenCommandLog(w.world, nullptr, 0));
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_PlayCommandLog(w.world, 1000000, &seconds));
    ASSERT_EQ(FW_OK, fwWorld_StopCommandLog(w.world));
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_FetchCommandLog(w.world, nullptr, &size));
}

// The checksum in a log's head, so that the reader goes on.
void sign(Bytes& log) {
    uint64_t hash = 1469598103934665603ull;
    for (size_t i = 24; i < log.size(); ++i) hash = (hash ^ log[i]) * 1099511628211ull;
    std::memcpy(&log[16], &hash, 8);
}

// With a correct checksum it is opened and played, or refused with a message; the world continues.
TEST(CommandLog, DamagedLogsNeverCrash) {
    BusyWorld w(FW_BACKEND_CPU, 12, 5);
    ASSERT_EQ(FW_OK, fwWorld_StartCommandLog(w.world));
    w.run(0, 70);
    const Bytes log = logOf(w.world);
    Bytes plain = log;
    sign(plain);
    ASSERT_EQ(log, plain);
    BusyWorld other(FW_BACKEND_CPU, 12, 5);
    const Bytes begin = other.save();
    uint32_t random = 5, refused = 0;
    const auto next = [&](uint32_t most) {
        random = random * 1664525u + 1013904223u;
        return uint32_t((uint64_t(random) * most) >> 32);
    };
    for (int i = 0; i < 300; ++i) {
        Bytes wrong = log;
        if (next(6) == 0) wrong.resize(28 + next(uint32_t(log.size() - 28)));
        for (uint32_t k = 1 + next(4); k > 0; --k)
            wrong[24 + next(uint32_t(wrong.size() - 24))] ^= (unsigned char)(1u << next(8));
        sign(wrong);
        ASSERT_EQ(FW_OK, other.load(begin)) << lastMessage(other.world);
        const FwResult result = fwWorld_OpenCommandLog(other.world, wrong.data(), wrong.size());
        if (result != FW_OK) {
            EXPECT_EQ(FW_ERROR_BAD_DATA, result);
            EXPECT_FALSE(lastMessage(other.world).empty());
            ++refused;
            continue;
        }
        float seconds = 1;
        for (int k = 0; k < 20 && seconds > 0; ++k) {
            EXPECT_EQ(FW_OK, fwWorld_PlayCommandLog(other.world, 4096, &seconds));
            EXPECT_EQ(FW_OK, fwWorld_Step(other.world, seconds)) << lastMessage(other.world);
        }
    }
    EXPECT_GT(refused, 40u);
}

}  // namespace
