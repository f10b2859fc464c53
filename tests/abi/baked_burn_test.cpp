// A baked burn replays a recorded fire front on every backend. Any disturbance switches the object
// to live simulation.
#include "abi/busy_world.h"

#include <ctime>
#include <map>

namespace fw::test::baked_burn_test {
namespace {

using namespace host;

struct Boards : HostedWorld {  // plywood, side by side; the first of each pair plays the burn
    explicit Boards(uint32_t backend, uint32_t count = 1, uint32_t flags = 0, float gap = 3,
                    float width = 0.5f)
        : HostedWorld(backend,
                      worldDef(FW_WORLD_RADIATION | FW_WORLD_PLUME | FW_WORLD_CONTACT, 40)),
          sheet(width, 0.3f) {
        if (!world) return;
        FwBurnableMeshDef board = fwDefaultBurnableMeshDef();
        board.flags |= flags;
        const FwMeshDef meshDef = sheet.def(64);
        ok(fwWorld_CreateMesh(world, &meshDef, &board.mesh));
        FwMaterialDef material = materialOf(FW_MATERIAL_PLYWOOD);
        ok(fwWorld_CreateMaterial(world, &material, &board.materials[0]));
        for (uint32_t i = 0; i < count; ++i) {
            board.transform[12] = float(i) * gap;
            ids.emplace_back();
            ok(fwWorld_CreateBurnableMesh(world, &board, &ids.back()));
        }
    }
    void touch(uint32_t kind, float x, float z, float radius = 0.02f, uint32_t which = 0) {
        touches(kind, ids[which], x, 0, z, radius);
    }
    void run(uint32_t steps, float deltaTime = 1.0f / 32) {
        for (uint32_t i = 0; i < steps; ++i) {
            ok(fwWorld_Step(world, deltaTime));
            for (const FwEvent& event : poll()) ++heard[event.type];
        }
    }
    Bytes bake(uint32_t which = 0) {
        ok(fwWorld_RequestBurn(world, ids[which]));
        uint64_t size = 0;
        come(world, [&] { return fwWorld_FetchBurn(world, ids[which], nullptr, &size); });
        Bytes bytes(size);
        ok(fwWorld_FetchBurn(world, ids[which], bytes.data(), &size));
        return bytes;
    }
    FwBurnId give(const Bytes& bytes) {
        FwBurnId burn{};
        ok(fwWorld_CreateBurn(world, bytes.data(), bytes.size(), &burn));
        return burn;
    }
    void play(FwBurnId burn, float delay = 0, float speed = 1) {
        for (const FwBurnableMeshId id : ids) ok(fwWorld_PlayBurn(world, id, burn, delay, speed));
    }
    std::vector<uint32_t> ticks(uint32_t which = 0, uint64_t* hash = nullptr) {
        ok(fwDebug_RequestBurnMap(world, ids[which]));
        uint64_t count = 0;
        come(world, [&] {
            return fwDebug_FetchBurnMap(world, ids[which], nullptr, 0, &count, hash, nullptr);
        });
        std::vector<uint32_t> map(count);
        ok(fwDebug_FetchBurnMap(world, ids[which], map.data(), count, nullptr, nullptr, nullptr));
        return map;
    }
    uint64_t hash() {
        uint64_t all = 0, one = 0;
        for (uint32_t i = 0; i < ids.size(); ++i) {
            (void)ticks(i, &one);
            all = all * 31 + one;
        }
        return all;
    }
    FwObjectState state(uint32_t which = 0) { return HostedWorld::state(ids[which]); }
    FwWorldStats stats() { return getState(fwWorld_GetStats, world); }
    Bytes save() { return saveOf(world); }
    void expectRefused(FwResult expected, FwResult result, const char* says) {
        EXPECT_EQ(expected, result) << says;
        EXPECT_NE(std::string::npos, lastMessage(world).find(says)) << lastMessage(world);
    }

    Sheet sheet;
    std::vector<FwBurnableMeshId> ids;
    std::map<uint32_t, int> heard;
};

constexpr uint32_t kNever = 0xFFFFFFFFu, kLiveEnd = 0xFFFFFFF0u;  // ticks of burn maps

struct Baked {
    Bytes bytes;
    std::vector<uint32_t> ticks;  // from the first step; kNever: the texel does not catch
    uint32_t lit = 0, last = 0;
};
// The burn of a board that was lit at a corner, after `steps` steps.
Baked bakeBoard(uint32_t steps, uint32_t flags = 0) {
    Boards boards(FW_BACKEND_CPU, 1, flags);
    boards.touch(FW_IGNITE, 0.05f, 0.05f);
    boards.run(steps);
    Baked baked{boards.bake(), boards.ticks()};
    uint32_t first = kNever;
    for (const uint32_t t : baked.ticks) first = std::min(first, t);
    for (uint32_t& t : baked.ticks) {
        t = t < kLiveEnd ? t - first : kNever;
        if (t == kNever) continue;
        ++baked.lit;
        baked.last = std::max(baked.last, t);
    }
    return baked;
}
constexpr uint32_t kSome = 130, kAll = 700;  // steps: part of a board has burnt; all of it

TEST(BakedBurn, CatchesAtBakedTicksWithoutAFront) {
    for (const uint32_t flags : {0u, uint32_t(FW_BURNABLE_LITE)}) {
        const Baked baked = bakeBoard(kAll, flags);
        Boards boards(FW_BACKEND_CPU, 1, flags);
        ASSERT_EQ(boards.ticks().size(), baked.ticks.size());
        boards.play(boards.give(baked.bytes), 0.5f);
        EXPECT_EQ(1u, boards.state().playsBakedBurn);
        uint64_t ran = 0;
        uint32_t before = 0;
        for (uint32_t i = 0; i < kAll && boards.state().playsBakedBurn; ++i) {
            boards.run(1);
            if (boards.state().playsBakedBurn) ran += boards.stats().runTiles;
            EXPECT_GE(boards.state().ignited, before);
            before = boards.state().ignited;
        }
        EXPECT_EQ(0u, ran);
        EXPECT_EQ(0u, boards.state().playsBakedBurn);
        EXPECT_EQ(baked.lit, before);
        const std::vector<uint32_t> map = boards.ticks();
        for (size_t i = 0; i < map.size(); ++i)
            if (baked.ticks[i] != kNever) {
                ASSERT_EQ(4096u / 2 + baked.ticks[i], map[i]) << "texel " << i;
            }
        boards.run(kAll);
        EXPECT_EQ(1, boards.heard[FW_EVENT_IGNITED]);
        EXPECT_EQ(1, boards.heard[FW_EVENT_WENT_LIVE]);
        EXPECT_EQ(1, boards.heard[FW_EVENT_BURNT_OUT]);
    }
}

TEST(BakedBurn, ConsumesFuelLikeASimulatedBurn) {
    Boards simulated(FW_BACKEND_CPU), played(FW_BACKEND_CPU);
    const Baked baked = bakeBoard(kAll);
    simulated.touch(FW_IGNITE, 0.05f, 0.05f);
    played.play(played.give(baked.bytes));
    simulated.run(kAll);
    played.run(kAll + 1);
    EXPECT_EQ(simulated.state().ignited, played.state().ignited);
    EXPECT_GT(played.state().energy, 0);
    EXPECT_NEAR(simulated.state().energy, played.state().energy, 0.02 * played.state().energy);
}

// Interrupted halfway under the same wind, the front continues where the burn would have gone.
TEST(BakedBurn, GoesLiveFromItsCurrentState) {
    const Baked baked = bakeBoard(kAll, FW_BURNABLE_LITE);
    Boards boards(FW_BACKEND_CPU, 1, FW_BURNABLE_LITE);
    boards.play(boards.give(baked.bytes));
    boards.run(60);
    boards.ok(fwWorld_StopBurn(boards.world, boards.ids[0]));
    const uint32_t before = boards.state().ignited;
    boards.run(kAll);
    EXPECT_LT(before, baked.lit / 2);
    EXPECT_EQ(baked.lit, boards.state().ignited);
    const std::vector<uint32_t> map = boards.ticks();
    for (size_t i = 0; i < map.size(); ++i)
        if (baked.ticks[i] != kNever) {
            ASSERT_NEAR(128.0 + baked.ticks[i], double(map[i]), 128) << "texel " << i;
        }
}

TEST(BakedBurn, FollowsThePace) {
    const Baked baked = bakeBoard(kSome);
    for (const float speed : {0.5f, 3.0f}) {
        Boards boards(FW_BACKEND_CPU);
        boards.play(boards.give(baked.bytes), 1, speed);
        boards.run(32 + uint32_t(double(baked.last) / 128 / double(speed)));
        const std::vector<uint32_t> map = boards.ticks();
        uint32_t compared = 0;
        for (size_t i = 0; i < map.size(); ++i) {
            const double at = 4096 + double(baked.ticks[i]) / double(speed);
            if (baked.ticks[i] == kNever || baked.ticks[i] == baked.last) continue;
            if (map[i] >= kLiveEnd) continue;
            EXPECT_NEAR(at, double(map[i]), 1) << "texel " << i;
            ++compared;
        }
        EXPECT_GT(compared, baked.lit * 9 / 10);
    }
}

TEST(BakedBurn, ContinuesLiveWhenTheBakedBurnEnds) {
    const Baked some = bakeBoard(kSome);
    ASSERT_LT(some.lit, some.ticks.size() / 2);
    Boards boards(FW_BACKEND_CPU);
    boards.play(boards.give(some.bytes));
    boards.run(kAll);
    EXPECT_EQ(1, boards.heard[FW_EVENT_WENT_LIVE]);
    EXPECT_GT(boards.state().ignited, some.lit * 2);
}

TEST(BakedBurn, PredictsBakedArrivals) {
    const Baked baked = bakeBoard(kAll);
    Boards boards(FW_BACKEND_CPU);
    boards.play(boards.give(baked.bytes));
    boards.run(20);
    const float there[3] = {0.4f, 0, 0.2f};
    const auto ask = [&] {
        FwQueryId query{};
        boards.ok(fwWorld_RequestArrival(boards.world, boards.ids[0], there, &query));
        FwArrivalState arrival{};
        arrival.structSize = sizeof arrival;
        come(boards.world, [&] { return fwWorld_FetchArrival(boards.world, query, &arrival); });
        return arrival;
    };
    const FwArrivalState arrival = ask();
    EXPECT_EQ(uint32_t(FW_ARRIVAL_AHEAD), arrival.kind);
    const auto steps = uint32_t(double(arrival.seconds) * 32);
    ASSERT_GT(steps, 32u);
    const auto kindOf = [&] {
        FwQueryId query{};
        boards.ok(fwWorld_RequestPoint(boards.world, boards.ids[0], there, &query));
        FwPointState point{};
        point.structSize = sizeof point;
        come(boards.world, [&] { return fwWorld_FetchPoint(boards.world, query, &point); });
        return point.kind;
    };
    boards.run(steps - 1);
    EXPECT_EQ(uint32_t(FW_POINT_UNBURNT), kindOf());
    boards.run(3);
    EXPECT_EQ(uint32_t(FW_POINT_BURNING), kindOf());
    EXPECT_EQ(uint32_t(FW_ARRIVAL_PAST), ask().kind);
}

struct Disturbance {
    const char* name;
    void (*does)(Boards&);
    uint32_t steps;  // steps within which it goes live
    bool disturbs = true;
};
void turnBy(Boards& boards, float angle, float x) {
    float at[16] = {};
    at[0] = 1, at[5] = at[10] = std::cos(angle), at[6] = std::sin(angle), at[9] = 0 - at[6];
    at[12] = x, at[15] = 1;
    boards.ok(fwWorld_SetTransform(boards.world, boards.ids[0], at));
}
const Disturbance kDisturbances[] = {
    {"ignition", [](Boards& b) { b.touch(FW_IGNITE, 0.45f, 0.25f); }, 2},
    {"water", [](Boards& b) { b.touch(FW_WET, 0.45f, 0.25f); }, 2},
    {"dousing", [](Boards& b) { b.touch(FW_EXTINGUISH, 0.05f, 0.05f, 0.1f); }, 2},
    {"wind",
     [](Boards& b) {
         const float wind[3] = {6, 0, 0};
         b.ok(fwWorld_SetWind(b.world, wind));
     },
     64},
    {"turn", [](Boards& b) { turnBy(b, 1.2f, 0); }, 64},
    {"call", [](Boards& b) { b.ok(fwWorld_StopBurn(b.world, b.ids[0])); }, 2},
    {"others' heat",
     [](Boards& b) {  // another object burns close below
         const float at[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -0.1f, 0, 1};
         b.ok(fwWorld_SetTransform(b.world, b.ids[1], at));
         FwIgnitionDef ball = fwDefaultIgnitionDef();
         ball.object = b.ids[1];
         ball.position[1] = -0.1f;
         ball.radius = 0.6f;
         b.ok(fwWorld_Ignite(b.world, &ball, nullptr));
     },
     200},
    {"nothing", [](Boards&) {}, 64, false},
    {"a move", [](Boards& b) { turnBy(b, 0, 0.1f); }, 64, false},
};

TEST(BakedBurn, GoesLiveWhenDisturbed) {
    const Baked baked = bakeBoard(kAll);
    for (const Disturbance& one : kDisturbances) {
        Boards boards(FW_BACKEND_CPU, 2);
        boards.ok(fwWorld_PlayBurn(boards.world, boards.ids[0], boards.give(baked.bytes), 0, 1));
        boards.run(60);
        ASSERT_EQ(1u, boards.state().playsBakedBurn) << one.name;
        EXPECT_EQ(0u, boards.stats().runTiles) << one.name;
        one.does(boards);
        uint64_t ran = 0;
        for (uint32_t i = 0; i < one.steps + 2; ++i) {
            boards.run(1);
            ran += boards.stats().runTiles;
        }
        EXPECT_EQ(one.disturbs ? 0u : 1u, boards.state().playsBakedBurn) << one.name;
        EXPECT_EQ(one.disturbs, boards.heard[FW_EVENT_WENT_LIVE] == 1) << one.name;
        EXPECT_EQ(one.disturbs, ran > 0) << one.name;
    }
}

// The same commands on both backends at different frame rates give equal hashes at every step.
TEST(BakedBurn, BothBackendsAgree) {
    const Baked baked = bakeBoard(kAll);
    for (const Disturbance& one : kDisturbances) {
        Boards cpu(FW_BACKEND_CPU, 2), device(FW_BACKEND_VULKAN, 2);
        if (!device.world) GTEST_SKIP() << "there is no such backend here";
        for (Boards* boards : {&cpu, &device}) {
            const FwBurnId burn = boards->give(baked.bytes);
            boards->ok(fwWorld_PlayBurn(boards->world, boards->ids[0], burn, 0, 1.5f));
        }
        cpu.run(40), device.run(10, 4.0f / 32);
        EXPECT_EQ(cpu.hash(), device.hash()) << one.name << ", played";
        EXPECT_EQ(1u, device.state().playsBakedBurn) << one.name;
        one.does(cpu), one.does(device);
        for (uint32_t part = 0; part < 3; ++part) {
            cpu.run(36), device.run(12, 3.0f / 32);
            EXPECT_EQ(cpu.hash(), device.hash()) << one.name << ", part " << part;
        }
    }
}

TEST(BakedBurn, ContinuesFromASave) {
    const Baked baked = bakeBoard(kAll);
    for (const uint32_t backend : {FW_BACKEND_CPU, FW_BACKEND_VULKAN}) {
        Boards first(FW_BACKEND_CPU, 2), other(backend, 2);
        if (!other.world) continue;
        first.play(first.give(baked.bytes), 0.25f);
        first.run(50);
        const Bytes save = first.save();
        EXPECT_EQ(FW_ERROR_BAD_DATA, fwWorld_Load(other.world, save.data(), save.size()));
        EXPECT_NE(std::string::npos, lastMessage(other.world).find("baked burn 1"));
        (void)other.give(baked.bytes);
        other.run(9);
        other.ok(fwWorld_Load(other.world, save.data(), save.size()));
        EXPECT_EQ(1u, other.state().playsBakedBurn);
        EXPECT_EQ(save, other.save());
        for (Boards* boards : {&first, &other}) {
            boards->run(40);
            boards->touch(FW_WET, 0.3f, 0.2f, 0.05f);
            boards->run(60);
        }
        EXPECT_EQ(0u, other.state(0).playsBakedBurn);
        EXPECT_EQ(1u, other.state(1).playsBakedBurn);
        EXPECT_EQ(first.hash(), other.hash());
    }
}

TEST(BakedBurn, IsRecordedInCommandLogs) {
    const Baked baked = bakeBoard(kAll);
    Boards first(FW_BACKEND_CPU, 2), other(FW_BACKEND_CPU, 2);
    first.ok(fwWorld_StartCommandLog(first.world));
    first.run(5);
    first.play(first.give(baked.bytes), 0.1f, 2);
    first.run(50);
    first.ok(fwWorld_StopBurn(first.world, first.ids[1]));
    first.run(45);
    uint64_t size = 0;
    first.ok(fwWorld_FetchCommandLog(first.world, nullptr, &size));
    Bytes log(size);
    first.ok(fwWorld_FetchCommandLog(first.world, log.data(), &size));
    (void)other.give(baked.bytes);
    other.ok(fwWorld_OpenCommandLog(other.world, log.data(), log.size()));
    float seconds = 1;
    while (seconds > 0) {
        other.ok(fwWorld_PlayCommandLog(other.world, 100 * 128, &seconds));
        if (seconds > 0) other.ok(fwWorld_Step(other.world, seconds));
    }
    EXPECT_EQ(first.stats().tick, other.stats().tick);
    EXPECT_EQ(first.hash(), other.hash());
    EXPECT_EQ(0u, other.state(1).playsBakedBurn);
}

TEST(BakedBurn, RefusesInvalidData) {
    const Baked baked = bakeBoard(kSome);
    Boards boards(FW_BACKEND_CPU);
    FwBurnId burn{};
    uint64_t size = 0;
    const auto create = [&](const Bytes& bytes) {
        return fwWorld_CreateBurn(boards.world, bytes.data(), bytes.size(), &burn);
    };
    const auto play = [&](FwBurnId id, float delay, float speed) {
        return fwWorld_PlayBurn(boards.world, boards.ids[0], id, delay, speed);
    };
    Bytes wrong = baked.bytes;
    wrong[0] ^= 1;
    boards.expectRefused(FW_ERROR_BAD_DATA, create(wrong), "\"FWBB\"");
    wrong = baked.bytes;
    wrong[4] = 9;
    boards.expectRefused(FW_ERROR_BAD_DATA, create(wrong), "format version 9");
    wrong = baked.bytes;
    wrong[wrong.size() / 2] ^= 0x10;
    boards.expectRefused(FW_ERROR_BAD_DATA, create(wrong), "checksum");
    wrong.assign(baked.bytes.begin(), baked.bytes.end() - 1);
    boards.expectRefused(FW_ERROR_BAD_DATA, create(wrong), "checksum");
    wrong.resize(11);
    boards.expectRefused(FW_ERROR_BAD_DATA, create(wrong), "baked burn ends");
    boards.expectRefused(FW_ERROR_INVALID_ARGUMENT,
                         fwWorld_CreateBurn(boards.world, nullptr, 9, &burn), "bytes is null");
    boards.expectRefused(FW_ERROR_INVALID_ARGUMENT,
                         fwWorld_FetchBurn(boards.world, boards.ids[0], nullptr, &size),
                         "request it first");
    boards.ok(fwWorld_RequestBurn(boards.world, boards.ids[0]));
    boards.expectRefused(FW_ERROR_INVALID_ARGUMENT,
                         fwWorld_FetchBurn(boards.world, boards.ids[0], nullptr, &size),
                         "has burnt");
    burn = boards.give(baked.bytes);
    boards.expectRefused(FW_ERROR_INVALID_ARGUMENT, play(burn, -1, 1), "delay is -1");
    boards.expectRefused(FW_ERROR_INVALID_ARGUMENT, play(burn, 0, 0.01f), "speed is 0.01");
    boards.expectRefused(FW_ERROR_INVALID_ARGUMENT, play(burn, 0, NAN), "speed");
    boards.expectRefused(FW_ERROR_STALE_ID, play({7, 1}, 0, 1), "Baked burn 7");
    Boards wider(FW_BACKEND_CPU, 1, 0, 3, 0.8f);
    const FwBurnId others = wider.give(baked.bytes);
    wider.expectRefused(FW_ERROR_INVALID_ARGUMENT,
                        fwWorld_PlayBurn(wider.world, wider.ids[0], others, 0, 1), "mesh of hash");
    boards.ok(play(burn, 0, 1));
    boards.expectRefused(FW_ERROR_INVALID_ARGUMENT, fwWorld_DestroyBurn(boards.world, burn),
                         "is played by");
    boards.ok(fwWorld_StopBurn(boards.world, boards.ids[0]));
    boards.run(2);
    boards.ok(fwWorld_DestroyBurn(boards.world, burn));
    boards.expectRefused(FW_ERROR_STALE_ID, play(burn, 0, 1), "already destroyed");
}

// With a valid checksum, damaged data either plays or is refused with a message.
TEST(BakedBurn, DamagedDataNeverCrashes) {
    const Baked baked = bakeBoard(kSome);
    Boards boards(FW_BACKEND_CPU);
    uint32_t taken = 0, refused = 0, random = 1;
    for (uint32_t i = 0; i < 300; ++i) {
        Bytes wrong = baked.bytes;
        for (uint32_t k = 0; k < 1 + i % 3; ++k) {
            random = random * 1664525u + 1013904223u;
            wrong[16 + random % (wrong.size() - 16)] = uint8_t(random >> 24);
        }
        if (i % 5 == 0) wrong.resize(16 + random % (wrong.size() - 16));
        uint64_t hash = 1469598103934665603ull;
        for (size_t b = 16; b < wrong.size(); ++b) hash = (hash ^ wrong[b]) * 1099511628211ull;
        std::memcpy(&wrong[8], &hash, 8);
        FwBurnId burn{};
        if (fwWorld_CreateBurn(boards.world, wrong.data(), wrong.size(), &burn) != FW_OK) {
            EXPECT_FALSE(lastMessage(boards.world).empty());
            ++refused;
            continue;
        }
        ++taken;
        if (fwWorld_PlayBurn(boards.world, boards.ids[0], burn, 0, 16) == FW_OK) boards.run(3);
        boards.ok(fwWorld_StopBurn(boards.world, boards.ids[0]));
        boards.run(2);
        boards.ok(fwWorld_DestroyBurn(boards.world, burn));
    }
    EXPECT_GT(taken, 0u);
    EXPECT_GT(refused, 20u);
}

// Processor time of played boards over that of simulated ones, on the cpu backend.
double ratioOf(uint32_t flags) {
    const Baked baked = bakeBoard(kAll, flags);
    double least[2] = {1e9, 1e9};
    for (int turn = 0; turn < 3; ++turn)
        for (const bool plays : {false, true}) {
            Boards boards(FW_BACKEND_CPU, 24, flags, 30);
            if (plays) boards.play(boards.give(baked.bytes));
            for (uint32_t i = 0; i < boards.ids.size() && !plays; ++i)
                boards.touch(FW_IGNITE, float(i) * 30 + 0.05f, 0.05f, 0.02f, i);
            const std::clock_t begin = std::clock();
            boards.run(200);
            least[plays] = std::min(least[plays], double(std::clock() - begin));
        }
    return least[1] / least[0];
}
TEST(BakedBurn, CostsLessThanSimulation) {
    const double lite = ratioOf(FW_BURNABLE_LITE), heat = ratioOf(0);
    std::printf("played / simulated: %.2f without heat, %.2f with heat\n", lite, heat);
    EXPECT_LT(lite, 0.6);
    EXPECT_LT(heat, 0.8);
}

}  // namespace
}  // namespace fw::test::baked_burn_test
