// Rooms through the C ABI: fire that uses up the oxygen goes out, and a door brings it back. Both
// backends agree bit for bit, and bad values are refused.
#include "abi/busy_world.h"

#include <algorithm>

namespace {

using namespace host;

// m^3 of oxygen per J.
constexpr double kTakes = 1 / (13.1e6 * 1.330);
float volumeFor(double joules) { return float(joules * kTakes / (0.2095 - 0.15)); }

// A sheet of burning paper and its fuel.
struct Paper : HostedWorld {
    explicit Paper(uint32_t backend, uint32_t preset = FW_MATERIAL_PAPER)
        : HostedWorld(backend, worldDef(fwDefaultWorldDef().flags)), sheet(0.6f, 0.6f) {
        if (!world) return;
        id = addBurnable(world, sheet.def(48), preset);
        fuel = double(book().fuel) / 1048576;
    }

    FwRoomDef roomOf(double joules, float vent = 0) const {
        FwRoomDef def = fwDefaultRoomDef();
        def.volume = volumeFor(joules);
        def.vent = vent;
        return def;
    }
    FwRoomId put(const FwRoomDef& def) { return created(fwWorld_CreateRoom, world, def); }
    void light(float radius) { ignite({}, 0.3f, 0, 0.3f, radius); }
    void run(double seconds) {
        for (double t = 0; t < seconds - 1e-9; t += 0.125) {
            ASSERT_EQ(FW_OK, fwWorld_Step(world, 0.125f)) << lastMessage(world);
            const std::vector<FwEvent> some = poll();
            events.insert(events.end(), some.begin(), some.end());
        }
    }
    FwEnergyLedger book() { return getState(fwWorld_GetEnergyLedger, world); }
    double released() {  // J
        const FwEnergyLedger now = book();
        return double(now.radiated + now.convected) / 1048576;
    }
    FwRoomState air(FwRoomId room) { return getState(fwWorld_GetRoomState, world, room); }
    uint32_t burning() { return state(id).burning; }
    bool heard(uint32_t type) const {
        return std::any_of(events.begin(), events.end(),
                           [&](const FwEvent& event) { return event.type == type; });
    }
    // FwExtinguishCause of the last time that it went out; 0 if it did not.
    uint32_t cause() const {
        uint32_t last = 0;
        for (const FwEvent& event : events)
            if (event.type == FW_EVENT_EXTINGUISHED) last = event.tag;
        return last;
    }
    uint64_t hash() { return HostedWorld::hash(id); }

    Sheet sheet;
    FwBurnableMeshId id{};
    double fuel = 0;  // J
    std::vector<FwEvent> events;
};

TEST(FireInRoom, FireConsumesTheOxygenAndGoesOut) {
    Paper free(FW_BACKEND_CPU), large(FW_BACKEND_CPU), shut(FW_BACKEND_CPU);
    const FwRoomId hall = large.put(large.roomOf(20 * large.fuel));
    const FwRoomId closet = shut.put(shut.roomOf(0.3 * shut.fuel));
    for (Paper* paper : {&free, &large, &shut}) {
        paper->light(0.03f);
        paper->run(180);
        EXPECT_EQ(0u, paper->burning());
    }
    EXPECT_EQ(free.hash(), large.hash());  // a large room equals no room
    EXPECT_TRUE(free.heard(FW_EVENT_BURNT_OUT));
    EXPECT_NEAR(free.fuel, free.released(), 0.001 * free.fuel);
    // The room loses the oxygen that the fire consumes.
    const double part = large.released() * kTakes / double(large.roomOf(20 * large.fuel).volume);
    EXPECT_NEAR(0.2095 - part, double(large.air(hall).oxygen), 2e-5);
    EXPECT_EQ(1.0f, large.air(hall).strength);
    EXPECT_EQ(1u, large.air(hall).objects);
    // In the closet: the oxygen down to 15 %, and some more while the fire weakened.
    EXPECT_TRUE(shut.heard(FW_EVENT_EXTINGUISHED));
    EXPECT_FALSE(shut.heard(FW_EVENT_BURNT_OUT));
    EXPECT_EQ(uint32_t(FW_EXTINGUISHED_BY_AIR), shut.cause());
    EXPECT_GT(shut.released(), 0.3 * shut.fuel);
    EXPECT_LT(shut.released(), 0.46 * shut.fuel);
    EXPECT_GT(shut.air(closet).oxygen, 0.1199f);
    EXPECT_LT(shut.air(closet).oxygen, 0.1425f);
    EXPECT_LT(shut.air(closet).strength, 0.75f);
    EXPECT_EQ(0.0f, shut.air(closet).power);
}

// Wood in thin air feeds too little heat back to itself.
TEST(FireInRoom, WoodInThinAirGoesOutWithFuelLeft) {
    Paper wood(FW_BACKEND_CPU, FW_MATERIAL_PINE);
    FwRoomDef def = wood.roomOf(100 * wood.fuel);
    def.oxygen = 0.126f;  // a fifth of the flame's strength
    (void)wood.put(def);
    wood.light(0.15f);
    wood.run(300);
    EXPECT_EQ(0u, wood.burning());
    EXPECT_EQ(uint32_t(FW_EXTINGUISHED_BY_AIR), wood.cause());
    EXPECT_FALSE(wood.heard(FW_EVENT_BURNT_OUT));
}

TEST(FireInRoom, OpeningADoorRevivesADyingFire) {
    Paper shut(FW_BACKEND_CPU), opened(FW_BACKEND_CPU);
    FwRoomId rooms[2] = {};
    Paper* papers[] = {&shut, &opened};
    for (int i = 0; i < 2; ++i) {
        rooms[i] = papers[i]->put(papers[i]->roomOf(0.25 * papers[i]->fuel));
        papers[i]->light(0.1f);
    }
    float most = 0, weak = 0;
    for (int i = 0; i < 2400 && (most == 0 || shut.air(rooms[0]).strength > 0.4f); ++i) {
        for (Paper* paper : papers) paper->run(0.125);
        weak = opened.air(rooms[1]).power;
        most = std::max(most, weak);
    }
    EXPECT_LT(0u, opened.burning());
    EXPECT_LT(weak, 0.8f * most);
    FwRoomDef door = opened.roomOf(0.25 * opened.fuel, 2);
    ASSERT_EQ(FW_OK, fwWorld_SetRoom(opened.world, rooms[1], &door)) << lastMessage(opened.world);
    float again = 0;
    for (int i = 0; i < 40; ++i) {
        for (Paper* paper : papers) paper->run(0.5);
        again = std::max(again, opened.air(rooms[1]).power);
    }
    EXPECT_GT(again, 1.5f * weak);
    for (Paper* paper : papers) paper->run(120);
    EXPECT_GT(opened.released(), 1.5 * shut.released());
    EXPECT_GT(opened.air(rooms[1]).oxygen, 0.2094f);
    EXPECT_EQ(1.0f, opened.air(rooms[1]).strength);
}

TEST(FireInRoom, InertGasExtinguishesOnlyInsideTheRoom) {
    Paper flooded(FW_BACKEND_CPU), carried(FW_BACKEND_CPU);
    FwRoomDef def = flooded.roomOf(100 * flooded.fuel);
    const FwRoomId room = flooded.put(def), other = carried.put(def);
    for (Paper* paper : {&flooded, &carried}) {
        paper->light(0.1f);
        paper->run(4);
        EXPECT_LT(0u, paper->burning());
    }
    def.flags = FW_ROOM_REFILL;
    def.oxygen = 0.1f;
    for (Paper* paper : {&flooded, &carried})
        ASSERT_EQ(FW_OK, fwWorld_SetRoom(paper->world, paper == &flooded ? room : other, &def));
    float away[16] = {};
    away[0] = away[5] = away[10] = away[15] = 1;
    away[12] = 10;
    ASSERT_EQ(FW_OK, fwWorld_SetTransform(carried.world, carried.id, away));
    EXPECT_EQ(0u, carried.air(other).objects);
    for (Paper* paper : {&flooded, &carried}) paper->run(0.5);
    EXPECT_EQ(0u, flooded.burning());
    EXPECT_EQ(uint32_t(FW_EXTINGUISHED_BY_AIR), flooded.cause()) << "at once, with fuel left";
    EXPECT_FALSE(flooded.heard(FW_EVENT_BURNT_OUT));
    EXPECT_NEAR(0.1f, flooded.air(room).oxygen, 1e-5f);
    EXPECT_EQ(0.0f, flooded.air(room).strength);
    EXPECT_LT(0u, carried.burning());
    // Outside the room there is air again, and the object ignites as usual.
    ASSERT_EQ(FW_OK, fwWorld_DestroyRoom(flooded.world, room));
    flooded.light(0.05f);
    flooded.run(2);
    EXPECT_LT(0u, flooded.burning());
}

// Bit for bit, also through doors, gas, moves and a save loaded on the other backend.
TEST(FireInRoom, BothBackendsAgree) {
    uint64_t hashes[2][6] = {};
    float oxygen[2][6] = {};
    std::vector<unsigned char> save;
    const uint32_t backends[] = {FW_BACKEND_CPU, FW_BACKEND_VULKAN};
    for (int b = 0; b < 2; ++b) {
        Paper paper(backends[b]);
        if (!paper.world) GTEST_SKIP() << "there is no such backend here";
        FwRoomDef def = paper.roomOf(0.25 * paper.fuel, 0.001f);
        const FwRoomId room = paper.put(def);
        paper.light(0.15f);
        for (int part = 0; part < 6; ++part) {
            paper.run(6);
            if (part == 2) {
                def.vent = 0.1f;
                ASSERT_EQ(FW_OK, fwWorld_SetRoom(paper.world, room, &def));
            }
            if (part == 4) {
                def.flags = FW_ROOM_REFILL;
                def.oxygen = 0.13f;
                ASSERT_EQ(FW_OK, fwWorld_SetRoom(paper.world, room, &def));
            }
            hashes[b][part] = paper.hash();
            oxygen[b][part] = paper.air(room).oxygen;
            if (part != 1) continue;
            if (b == 0) {
                ASSERT_EQ(FW_OK, fwWorld_RequestSave(paper.world));
                ASSERT_EQ(FW_OK, fwWorld_Step(paper.world, 0));
                uint64_t size = 0;
                ASSERT_EQ(FW_OK, fwWorld_FetchSave(paper.world, nullptr, &size));
                save.resize(size);
                ASSERT_EQ(FW_OK, fwWorld_FetchSave(paper.world, save.data(), &size));
            } else {  // the cpu's past in place of its own
                ASSERT_EQ(FW_OK, fwWorld_Load(paper.world, save.data(), save.size()))
                    << lastMessage(paper.world);
                EXPECT_EQ(oxygen[0][1], paper.air(room).oxygen);
            }
        }
        EXPECT_LT(oxygen[b][1], 0.15f);
    }
    for (int part = 0; part < 6; ++part) {
        EXPECT_EQ(hashes[0][part], hashes[1][part]) << part;
        EXPECT_EQ(oxygen[0][part], oxygen[1][part]) << part;
    }
}

// The power at which a room flashes over: once, at the same step on both backends, and not again
// after a load.
TEST(FireInRoom, FlashesOverOnceAtTheFlashOverPower) {
    float reported[2] = {};
    std::vector<unsigned char> save;
    const uint32_t backends[] = {FW_BACKEND_CPU, FW_BACKEND_VULKAN};
    const auto flashes = [](const Paper& paper) {
        return std::count_if(paper.events.begin(), paper.events.end(), [](const FwEvent& event) {
            return event.type == FW_EVENT_FLASHED_OVER;
        });
    };
    for (int b = 0; b < 2; ++b) {
        Paper paper(backends[b]), large(FW_BACKEND_CPU);
        if (!paper.world) GTEST_SKIP() << "there is no such backend here";
        FwRoomDef def = paper.roomOf(20 * paper.fuel);
        def.position[0] = def.position[2] = 0.3f;
        (void)large.put(def);  // the same air and larger walls
        for (float& half : def.halfSize) half = 0.2f;
        const FwRoomId room = paper.put(def);
        const float needed = paper.air(room).flashOverPower;
        EXPECT_NEAR(7800 * 24 * 0.04, double(needed), 100);
        FwRoomState state{};
        state.structSize = offsetof(FwRoomState, flashOverPower);  // the struct of an older host
        EXPECT_EQ(FW_OK, fwWorld_GetRoomState(paper.world, room, &state));
        EXPECT_EQ(0u, state.flashedOver);
        paper.light(0.03f);
        large.light(0.03f);
        double before = 0, most = 0;
        for (int i = 0; i < 1440 && paper.air(room).flashedOver == 0; ++i) {
            paper.run(0.125);
            before = most;
            most = std::max(most, double(paper.air(room).power));
        }
        ASSERT_EQ(1u, paper.air(room).flashedOver) << most << " W of " << needed;
        EXPECT_GT(most, double(needed));
        EXPECT_LT(before, 1.5 * double(needed));
        if (b == 0)
            save = saveOf(paper.world);
        else {  // on the other backend, where it is not reported again
            Paper loaded(backends[1]);
            const FwRoomId same = loaded.put(def);
            ASSERT_EQ(FW_OK, fwWorld_Load(loaded.world, save.data(), save.size()))
                << lastMessage(loaded.world);
            EXPECT_EQ(1u, loaded.air(same).flashedOver);
            loaded.run(200);
            EXPECT_EQ(0u, loaded.air(same).flashedOver);
            EXPECT_EQ(0, flashes(loaded));
        }
        paper.run(200);
        EXPECT_EQ(0u, paper.air(room).flashedOver);
        ASSERT_EQ(1, flashes(paper));
        const FwEvent event =
            *std::find_if(paper.events.begin(), paper.events.end(),
                          [](const FwEvent& one) { return one.type == FW_EVENT_FLASHED_OVER; });
        EXPECT_EQ(room.index1, event.tag);
        EXPECT_EQ(0u, event.object.index1);
        EXPECT_EQ(0.3f, event.position[0]);
        EXPECT_GT(event.value, 1);
        reported[b] = event.value;
        large.run(200);
        EXPECT_FALSE(large.heard(FW_EVENT_FLASHED_OVER));
    }
    EXPECT_EQ(reported[0], reported[1]);
}

// While nothing burns, rooms still recover their air, and recovered rooms cost nothing.
TEST(FireInRoom, AirRecoversWhileNothingBurns) {
    Paper steady(FW_BACKEND_CPU), coarse(FW_BACKEND_CPU);
    FwRoomDef def = steady.roomOf(steady.fuel, 0.01f);
    def.oxygen = 0.05f;
    const FwRoomId rooms[2] = {steady.put(def), coarse.put(def)};
    steady.run(30);
    for (int i = 0; i < 15; ++i) ASSERT_EQ(FW_OK, fwWorld_Step(coarse.world, 2));
    EXPECT_EQ(steady.air(rooms[0]).oxygen, coarse.air(rooms[1]).oxygen);
    EXPECT_GT(steady.air(rooms[0]).oxygen, 0.1f);
    EXPECT_LT(steady.air(rooms[0]).oxygen, 0.2094f);
}

TEST(FireInRoom, RefusesBadValuesByName) {
    Paper paper(FW_BACKEND_CPU);
    FwRoomDef def = fwDefaultRoomDef();
    EXPECT_EQ(0.2095f, def.oxygen);
    EXPECT_EQ(0.01f, def.vent);
    const FwRoomId room = paper.put(def);
    def.oxygen = 1.5f;
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_SetRoom(paper.world, room, &def));
    EXPECT_EQ("FwRoomDef::oxygen is 1.5; the limits are [0, 1].\n - While calling fwWorld_SetRoom.",
              lastMessage(paper.world));
    EXPECT_NEAR(0.2095f, paper.air(room).oxygen, 1e-7f);
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_GetRoomState(paper.world, room, nullptr));
    FwRoomState state{};
    EXPECT_EQ(FW_ERROR_VERSION, fwWorld_GetRoomState(paper.world, room, &state));
    def = fwDefaultRoomDef();
    FwRoomId more{};
    for (int i = 1; i < 64; ++i)
        ASSERT_EQ(FW_OK, fwWorld_CreateRoom(paper.world, &def, &more)) << lastMessage(paper.world);
    EXPECT_EQ(0u, paper.air(more).objects);  // the objects belong to the room created first
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_CreateRoom(paper.world, &def, &more));
    EXPECT_EQ("64 rooms are there; the limit is 64.\n - While calling fwWorld_CreateRoom.",
              lastMessage(paper.world));
    ASSERT_EQ(FW_OK, fwWorld_DestroyRoom(paper.world, room));
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_DestroyRoom(paper.world, room));
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_SetRoom(paper.world, room, &def));
    state.structSize = sizeof state;
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_GetRoomState(paper.world, room, &state));
}

}  // namespace
