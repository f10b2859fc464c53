// fwWorld_RequestArrival: its predictions come true. After a change of wind, water or fire the next
// query predicts the new course.
#include "abi_support.h"

#include <gmock/gmock.h>

#include <cfloat>
#include <cmath>

namespace {

using namespace host;

double timeOf(FwWorld* world) {  // s
    const FwWorldStats stats = getState(fwWorld_GetStats, world);
    return double(stats.tick) / 4096;
}

FwQueryId ask(SheetWorld& w, float x, float z) {
    const float point[3] = {x, 0, z};
    FwQueryId query{};
    EXPECT_EQ(FW_OK, fwWorld_RequestArrival(w.world, w.object, point, &query))
        << lastMessage(w.world);
    return query;
}

struct Prediction {
    FwArrivalState state{};
    double time = 0;  // s, world time at which it catches
};
Prediction fetch(SheetWorld& w, FwQueryId query, double most = 20) {
    Prediction predicted;
    predicted.state.structSize = sizeof predicted.state;
    FwResult result = FW_NOT_READY;
    for (double t = 0; t < most; t += 1.0 / 32) {
        result = fwWorld_FetchArrival(w.world, query, &predicted.state);
        if (result != FW_NOT_READY) break;
        w.run(1.0 / 32);
    }
    EXPECT_EQ(FW_OK, result) << lastMessage(w.world);
    predicted.time = timeOf(w.world) + double(predicted.state.seconds);
    return predicted;
}
Prediction predict(SheetWorld& w, float x, float z) { return fetch(w, ask(w, x, z)); }

// World time (s) at which the point catches; < 0 if it does not within `most` s.
double catches(SheetWorld& w, float x, float z, double most) {
    for (double t = 0; t < most; t += 0.25) {
        const float age = w.point(x, 0, z).age;
        if (age >= 0) return timeOf(w.world) - double(age);
        w.run(0.25);
    }
    return -1;
}

FwWorldDef windy(float x, float pace = 10, uint32_t arrivalTiles = 1024) {
    FwWorldDef def = fwDefaultWorldDef();
    def.wind[0] = x;
    def.paceFactor = pace;
    def.arrivalTiles = arrivalTiles;
    return def;
}

FwMaterialDef preset(uint32_t which) { return materialOf(which); }

TEST(Arrival, PredictionsComeTrueForRealMaterials) {
    for (const uint32_t which : {FW_MATERIAL_PINE, FW_MATERIAL_PAPER, FW_MATERIAL_THATCH}) {
        SheetWorld w(preset(which), 1.0f, 0.5f, 64, windy(1.5f, 3));
        w.ball(FW_IGNITE, 0.2f, 0, 0.25f, 0.02f);
        w.run(2);
        const float points[][2] = {{0.3f, 0.25f}, {0.5f, 0.2f}, {0.7f, 0.4f}, {0.05f, 0.1f}};
        double predicted[4], asked = timeOf(w.world);
        bool comes[4];
        for (int i = 0; i < 4; ++i) {
            const Prediction answer = predict(w, points[i][0], points[i][1]);
            predicted[i] = answer.time;
            comes[i] = answer.state.kind != FW_ARRIVAL_NEVER;
        }
        EXPECT_LT(predicted[0], predicted[1]);
        EXPECT_LT(predicted[1], predicted[2]);
        for (int i = 0; i < 4; ++i) {
            const double came = catches(w, points[i][0], points[i][1], 400);
            EXPECT_EQ(came >= 0, comes[i]) << which << " " << i;
            if (came < 0 || !comes[i]) continue;  // it burns out before it arrives against the wind
            std::printf("%s, point %d: predicted %.2f s, came at %.2f s\n",
                        fwMaterialPresetName(which), i, predicted[i] - asked, came - asked);
            EXPECT_NEAR(predicted[i], came, std::max(0.05 * (came - asked), 0.02))
                << which << " " << i;
        }
    }
}

TEST(Arrival, ReportsPastArrivalsAndNever) {
    SheetWorld w(evenMaterial(0.05f, 100), 1, 0.25f);
    Prediction predicted = predict(w, 0.9f, 0.1f);
    EXPECT_EQ(predicted.state.kind, FW_ARRIVAL_NEVER) << "nothing burns";
    EXPECT_EQ(predicted.state.seconds, FLT_MAX);
    w.ball(FW_IGNITE, 0.1f, 0, 0.125f, 0.03f);
    w.run(1);
    predicted = predict(w, 0.1f, 0.125f);
    EXPECT_EQ(predicted.state.kind, FW_ARRIVAL_PAST);
    EXPECT_NEAR(predicted.state.seconds, -1, 0.05);
    predicted = predict(w, 0.8f, 0.125f);
    EXPECT_EQ(predicted.state.kind, FW_ARRIVAL_AHEAD);
    EXPECT_NEAR(predicted.state.seconds, 0.67 / 0.05 - 1, 0.4);
    EXPECT_NEAR(predicted.state.position[0], 0.8f, 0.02f);
    EXPECT_LT(predicted.state.distance, 0.02f);
}

TEST(Arrival, IncludesCommandsOfTheSameFrame) {
    SheetWorld w(evenMaterial(0.05f, 1000), 1, 0.25f);
    w.ball(FW_IGNITE, 0.05f, 0, 0.125f, 0.02f);
    w.run(0.5);
    EXPECT_GT(predict(w, 0.9f, 0.125f).state.seconds, 12);
    w.ball(FW_IGNITE, 0.95f, 0, 0.125f, 0.02f);
    EXPECT_LT(predict(w, 0.9f, 0.125f).state.seconds, 2) << "asked before the next frame";
    const double before = predict(w, 0.5f, 0.125f).time;
    for (float z = 0.0f; z <= 0.26f; z += 0.01f) {
        w.ball(FW_WET, 0.3f, 0, z, 0.04f);
        w.ball(FW_WET, 0.7f, 0, z, 0.04f);
    }
    EXPECT_EQ(predict(w, 0.5f, 0.125f).state.kind, FW_ARRIVAL_NEVER) << "was " << before;
    EXPECT_EQ(predict(w, 0.2f, 0.125f).state.kind, FW_ARRIVAL_AHEAD);
}

// At half the oxygen strength fire is slower; in worse air it never arrives.
TEST(Arrival, DependsOnTheAirOfTheRoom) {
    SheetWorld w(preset(FW_MATERIAL_PAPER), 1.0f, 0.5f, 64, windy(0, 3));
    FwRoomDef hall = fwDefaultRoomDef();
    hall.volume = 1000;  // one sheet does not change the air of so large a room
    hall.vent = 0;
    const FwRoomId room = created(fwWorld_CreateRoom, w.world, hall);
    w.ball(FW_IGNITE, 0.1f, 0, 0.25f, 0.03f);
    w.run(1);
    const double good = predict(w, 0.8f, 0.25f).state.seconds;
    const auto breathe = [&](float oxygen) {
        hall.oxygen = oxygen;
        hall.flags = FW_ROOM_REFILL;
        ASSERT_EQ(FW_OK, fwWorld_SetRoom(w.world, room, &hall)) << lastMessage(w.world);
        w.run(0.5);  // until the event is reported
    };
    breathe(0.135f);
    const FwRoomState air = getState(fwWorld_GetRoomState, w.world, room);
    EXPECT_NEAR(0.5f, air.strength, 0.02f);
    const double asked = timeOf(w.world), predicted = predict(w, 0.8f, 0.25f).time - asked;
    EXPECT_LT(1.5 * good, predicted);
    const double came = catches(w, 0.8f, 0.25f, 400) - asked;
    std::printf("in half of the air: predicted %.2f s, came at %.2f s\n", predicted, came);
    EXPECT_NEAR(predicted, came, 0.05 * came);
    breathe(0.11f);
    EXPECT_EQ(FW_ARRIVAL_NEVER, predict(w, 0.98f, 0.02f).state.kind);
}

TEST(Arrival, DependsOnTheWind) {
    FwMaterialDef grass = preset(FW_MATERIAL_THATCH);
    SheetWorld w(grass, 1.0f, 0.5f, 64, windy(0, 1));
    w.ball(FW_IGNITE, 0.3f, 0, 0.25f, 0.02f);
    w.run(1);
    const double still = predict(w, 0.8f, 0.25f).time;
    const float wind[3] = {2, 0, 0};
    ASSERT_EQ(FW_OK, fwWorld_SetWind(w.world, wind));
    const double asked = timeOf(w.world);
    const double predicted = predict(w, 0.8f, 0.25f).time;
    EXPECT_LT(predicted - asked, 0.7 * (still - asked));
    const double came = catches(w, 0.8f, 0.25f, 200);
    std::printf("in still air %.2f s, predicted %.2f s, came at %.2f s\n", still - asked,
                predicted - asked, came - asked);
    // The front answers to wind one link later.
    EXPECT_NEAR(predicted, came, 0.05 * (came - asked) + 0.1);
}

// A smaller budget delays answers; near points are answered before far ones.
TEST(Arrival, StaysWithinItsBudget) {
    const FwMaterialDef even = evenMaterial(0.02f, 1000);
    SheetWorld fast(even, 1, 0.5f, 128), slow(even, 1, 0.5f, 128, windy(0, 10, 8));
    for (SheetWorld* w : {&fast, &slow}) w->ball(FW_IGNITE, 0.1f, 0, 0.25f, 0.03f);
    fast.run(1);
    slow.run(0.1);
    const FwQueryId near = ask(slow, 0.25f, 0.25f), far = ask(slow, 0.95f, 0.25f);
    FwArrivalState state{};
    state.structSize = sizeof state;
    EXPECT_EQ(FW_NOT_READY, fwWorld_FetchArrival(slow.world, near, &state));
    // Ten times the pace: the same burn in a tenth of the time.
    const double soon = fetch(slow, near, 100).time;
    const double asked = timeOf(slow.world);
    EXPECT_EQ(FW_NOT_READY, fwWorld_FetchArrival(slow.world, far, &state));
    const double late = fetch(slow, far, 100).time;
    EXPECT_GT(timeOf(slow.world), asked);
    EXPECT_LT(soon, late);
    const double came = catches(slow, 0.95f, 0.25f, 100);
    EXPECT_NEAR(came, late, 0.05 * came);
    EXPECT_NEAR(came,
                0.1 * (timeOf(fast.world) + double(predict(fast, 0.95f, 0.25f).state.seconds)),
                0.05 * came);
}

TEST(Arrival, WarmFramesAllocateNothing) {
    SheetWorld w(evenMaterial(0.02f, 1000), 1, 0.5f);
    w.ball(FW_IGNITE, 0.1f, 0, 0.25f, 0.03f);
    for (int i = 0; i < 4; ++i) {
        const FwQueryId open = ask(w, 0.9f, 0.25f);
        w.run(2);
        (void)fetch(w, open);
    }
    const FwQueryId query =
        ask(w, 0.9f, 0.3f);  // more than a second later, so it is computed again
    const int64_t blocks = w.host.allocations;
    w.run(0.5);
    EXPECT_EQ(blocks, w.host.allocations);
    EXPECT_EQ(fetch(w, query).state.kind, FW_ARRIVAL_AHEAD);
}

TEST(Arrival, RefusesBadQueriesByName) {
    SheetWorld w(evenMaterial(0.02f, 1000));
    const float nowhere[3] = {NAN, 0, 0}, middle[3] = {0.5f, 0, 0.1f};
    FwQueryId query{};
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT,
              fwWorld_RequestArrival(w.world, w.object, nowhere, &query));
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT,
              fwWorld_RequestArrival(w.world, w.object, nullptr, &query));
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT,
              fwWorld_RequestArrival(w.world, w.object, middle, nullptr));

    ASSERT_EQ(FW_OK, fwWorld_RequestArrival(w.world, w.object, middle, &query));
    FwPointState point{};
    point.structSize = sizeof point;
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_FetchPoint(w.world, query, &point));
    EXPECT_THAT(lastMessage(w.world), testing::HasSubstr("fwWorld_FetchArrival answers it"));
    FwQueryId other{};
    ASSERT_EQ(FW_OK, fwWorld_RequestPoint(w.world, w.object, middle, &other));
    FwArrivalState state{};
    state.structSize = sizeof state;
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_FetchArrival(w.world, other, &state));
    EXPECT_THAT(lastMessage(w.world), testing::HasSubstr("fwWorld_FetchPoint answers it"));
    ASSERT_EQ(FW_OK, fwWorld_DestroyBurnableMesh(w.world, w.object));
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_FetchArrival(w.world, query, &state));
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_RequestArrival(w.world, w.object, middle, &query));
}

}  // namespace
