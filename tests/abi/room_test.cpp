// Rooms through the C ABI: fire that uses up its air weakens and goes out, a door brings it back,
// both backends agree to the bit, and what is refused.
#include "abi/busy_world.h"

#include <algorithm>

namespace {

using namespace host;

// m^3 of oxygen that a J takes, and what room lets fire have that many before it weakens.
constexpr double kTakes = 1 / (13.1e6 * 1.330);
float volumeFor(double joules) { return float(joules * kTakes / (0.2095 - 0.15)); }

// A sheet of paper on which fire runs, and how much there is in it.
struct Paper {
    explicit Paper(uint32_t backend, uint32_t preset = FW_MATERIAL_PAPER) : sheet(0.6f, 0.6f) {
        context = createContext(host, backend);
        if (!context) return;
        FwWorldDef def = fwDefaultWorldDef();
        def.maxStepsPerFrame = 64;
        EXPECT_EQ(FW_OK, fwCreateWorld(context, &def, &world)) << lastMessage(context);
        id = addBurnable(world, sheet.def(48), preset);
        fuel = double(book().fuel) / 1048576;
    }
    ~Paper() {
        fwDestroyContext(context);
        EXPECT_EQ(0, host.blocks);
    }
    Paper(const Paper&) = delete;
    Paper& operator=(const Paper&) = delete;

    FwRoomDef roomOf(double joules, float vent = 0) const {
        FwRoomDef def = fwDefaultRoomDef();
        def.volume = volumeFor(joules);
        def.vent = vent;
        return def;
    }
    FwRoomId put(const FwRoomDef& def) {
        FwRoomId made{};
        EXPECT_EQ(FW_OK, fwWorld_CreateRoom(world, &def, &made)) << lastMessage(world);
        return made;
    }
    void light(float radius) {
        FwIgnitionDef ball = fwDefaultIgnitionDef();
        ball.position[0] = ball.position[2] = 0.3f;
        ball.radius = radius;
        uint32_t texels = 0;
        EXPECT_EQ(FW_OK, fwWorld_Ignite(world, &ball, &texels)) << lastMessage(world);
        EXPECT_LT(0u, texels);
    }
    void run(double seconds) {
        for (double t = 0; t < seconds - 1e-9; t += 0.125) {
            ASSERT_EQ(FW_OK, fwWorld_Step(world, 0.125f)) << lastMessage(world);
            FwEvent some[32];
            events.insert(events.end(), some, some + fwWorld_PollEvents(world, some, 32));
        }
    }
    FwEnergyBook book() {
        FwEnergyBook made{};
        made.structSize = sizeof made;
        EXPECT_EQ(FW_OK, fwWorld_GetEnergyBook(world, &made)) << lastMessage(world);
        return made;
    }
    double released() {  // J
        const FwEnergyBook now = book();
        return double(now.radiated + now.convected) / 1048576;
    }
    FwRoomState air(FwRoomId room) {
        FwRoomState made{};
        made.structSize = sizeof made;
        EXPECT_EQ(FW_OK, fwWorld_GetRoomState(world, room, &made)) << lastMessage(world);
        return made;
    }
    uint32_t burning() {
        FwObjectState made{};
        made.structSize = sizeof made;
        EXPECT_EQ(FW_OK, fwWorld_GetObjectState(world, id, &made)) << lastMessage(world);
        return made.burning;
    }
    bool heard(uint32_t type) const {
        return std::any_of(events.begin(), events.end(),
                           [&](const FwEvent& event) { return event.type == type; });
    }
    // FwExtinguishCause of the last time that it went out; 0: it did not.
    uint32_t cause() const {
        uint32_t last = 0;
        for (const FwEvent& event : events)
            if (event.type == FW_EVENT_EXTINGUISHED) last = event.tag;
        return last;
    }
    uint64_t hash() {
        EXPECT_EQ(FW_OK, fwDebug_RequestBurnMap(world, id)) << lastMessage(world);
        uint64_t made = 0;
        FwResult result = FW_NOT_READY;
        for (int i = 0; i < 8 && result == FW_NOT_READY; ++i) {
            EXPECT_EQ(FW_OK, fwWorld_Step(world, 0)) << lastMessage(world);
            result = fwDebug_FetchBurnMap(world, id, nullptr, 0, nullptr, &made, nullptr);
        }
        EXPECT_EQ(FW_OK, result) << lastMessage(world);
        return made;
    }

    Host host;
    Sheet sheet;
    FwContext* context = nullptr;
    FwWorld* world = nullptr;
    FwBurnableMeshId id{};
    double fuel = 0;  // J
    std::vector<FwEvent> events;
};

TEST(AbiRoom, FireUsesUpItsAirAndGoesOut) {
    Paper free(FW_BACKEND_CPU), large(FW_BACKEND_CPU), shut(FW_BACKEND_CPU);
    const FwRoomId hall = large.put(large.roomOf(20 * large.fuel));
    const FwRoomId closet = shut.put(shut.roomOf(0.3 * shut.fuel));
    for (Paper* paper : {&free, &large, &shut}) {
        paper->light(0.03f);
        paper->run(180);
        EXPECT_EQ(0u, paper->burning());
    }
    EXPECT_EQ(free.hash(), large.hash());  // air enough is as air without end
    EXPECT_TRUE(free.heard(FW_EVENT_BURNT_OUT));
    EXPECT_NEAR(free.fuel, free.released(), 0.001 * free.fuel);
    // What the room lost is what the fire took.
    const double part = large.released() * kTakes / double(large.roomOf(20 * large.fuel).volume);
    EXPECT_NEAR(0.2095 - part, double(large.air(hall).oxygen), 2e-5);
    EXPECT_EQ(1.0f, large.air(hall).strength);
    EXPECT_EQ(1u, large.air(hall).objects);
    // Of the closet's, that which it had down to 15 %, and some more while it weakened.
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

// In air that lets it flame weakly wood gives too little heat back to itself.
TEST(AbiRoom, WoodInLittleAirGoesOutWithFuelLeft) {
    Paper wood(FW_BACKEND_CPU, FW_MATERIAL_PINE);
    FwRoomDef def = wood.roomOf(100 * wood.fuel);
    def.oxygen = 0.126f;  // a fifth of its strength
    (void)wood.put(def);
    wood.light(0.15f);
    wood.run(300);
    EXPECT_EQ(0u, wood.burning());
    EXPECT_EQ(uint32_t(FW_EXTINGUISHED_BY_AIR), wood.cause());
    EXPECT_FALSE(wood.heard(FW_EVENT_BURNT_OUT));
}

// A door that opens on a dying fire brings it back.
TEST(AbiRoom, ADoorBringsItBack) {
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

TEST(AbiRoom, InertGasPutsOutAndWhoLeavesBurnsOn) {
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
    // Without a room there is air again, and what it holds lights as ever.
    ASSERT_EQ(FW_OK, fwWorld_DestroyRoom(flooded.world, room));
    flooded.light(0.05f);
    flooded.run(2);
    EXPECT_LT(0u, flooded.burning());
}

// To the bit, also through doors, gas, moves and a save that is loaded on the other backend.
TEST(AbiRoom, BothBackendsAgree) {
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
            } else {  // the cpu's past instead of its own
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

// The power at which it does, once, at the same step on both backends, and not again where a save
// of it is loaded.
TEST(AbiRoom, FlashesOverWhenItsFiresGiveOffEnough) {
    float told[2] = {};
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
        (void)large.put(def);  // of the same air, and of larger walls
        for (float& half : def.halfSize) half = 0.2f;
        const FwRoomId room = paper.put(def);
        const float needed = paper.air(room).flashOverPower;
        EXPECT_NEAR(7800 * 24 * 0.04, double(needed), 100);
        FwRoomState state{};
        state.structSize = offsetof(FwRoomState, flashOverPower);  // an older host's
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
        else {  // on the other backend, where it is told no more
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
        told[b] = event.value;
        large.run(200);
        EXPECT_FALSE(large.heard(FW_EVENT_FLASHED_OVER));
    }
    EXPECT_EQ(told[0], told[1]);
}

// However long nothing burns: rooms whose air still comes back go on, and one at rest costs none.
TEST(AbiRoom, AirComesBackWhileNothingBurns) {
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

TEST(AbiRoom, NamesWhatIsWrong) {
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
    EXPECT_EQ(0u, paper.air(more).objects);  // they are in the one made first
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
