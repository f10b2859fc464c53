// Networks: under loss, delay, repetition and damage a client's world burns bit for bit like the
// server's. A client that joins late or diverges catches up, and no packet breaks anything.
#include "abi/net_session.h"
#include "abi/panels.h"

namespace {

using namespace host;
using Busy = NetSession<BusyWorld>;

void put(float (&to)[3], float x, float y, float z) { to[0] = x, to[1] = y, to[2] = z; }

// Features that the busy world's own script omits: moving flames, jets and water.
void moveMore(BusyWorld& w, uint32_t frame) {
    const auto ok = [&](FwResult result) { EXPECT_EQ(FW_OK, result) << lastMessage(w.world); };
    const float turn = 0.1f * float(frame);
    float at[3], way[3];
    if (frame % 20 == 3) {
        put(at, -1.2f + 0.1f * std::cos(turn), 0.15f, 0.1f);
        put(way, 1, 0.1f * std::sin(turn), 0.05f);
        ok(fwWorld_MoveFireEmitter(w.world, w.jet, at, frame % 40 == 3 ? way : nullptr));
    }
    if (frame % 50 == 9) ok(fwWorld_SetFireEmitterPower(w.world, w.jet, 300 + float(frame)));
    if (frame % 30 == 5) {
        put(at, 1.8f, 0, 0.5f + 0.1f * std::sin(turn));
        ok(fwWorld_MoveVolumetricFire(w.world, w.fire, at));
        ok(fwWorld_SetVolumetricFirePower(w.world, w.fire, 40 + float(frame % 60)));
    }
    if (frame % 33 == 4) {
        put(at, 0.9f + 0.1f * std::cos(turn), 0, 0.5f);
        const float turned[4] = {0, std::sin(turn), 0, std::cos(turn)};
        ok(fwWorld_MoveParticleField(w.world, w.field, at, frame % 2 ? turned : nullptr));
        ok(fwWorld_SetParticleFieldAmount(w.world, w.field, 0.5f + 0.01f * float(frame % 50)));
    }
    if (frame % 27 == 6) {
        float wall[16] = {
            1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1.0f, 0.3f, 0.2f + 0.002f * float(frame), 1};
        ok(fwWorld_MoveHeatOccluder(w.world, w.occluder, wall));
    }
}

void play(Busy& session, uint32_t from, uint32_t to) {
    for (uint32_t frame = from; frame < to; ++frame) {
        moveMore(*session.server, frame);
        session.server->run(frame, frame + 1);
        session.pass(double(BusyWorld::timeOf(frame)));
    }
}

// One client from the beginning, one that joins mid-burn. At frames 60 and 130 water and a dousing
// ball extinguish parts of the fire.
void burnsIdentically(uint32_t seed, uint32_t clients, uint32_t end) {
    Busy session(std::make_unique<BusyWorld>(FW_BACKEND_CPU), seed);
    const auto add = [&] {
        auto world = std::make_unique<BusyWorld>(clients);
        if (there(*world)) session.join(std::move(world));
        return !session.clients.empty();
    };
    if (!add()) GTEST_SKIP() << "there is no such backend here";
    play(session, 0, 75);
    session.expectEqual("after some water");
    play(session, 75, 110);
    add();
    play(session, 110, 145);
    session.expectEqual("after a late join and a puff");
    play(session, 145, end);
    session.expectEqual("at the end");
    EXPECT_GE(session.server->burning(), 4u);
    for (const auto& client : session.clients) {
        const FwNetState state = Busy::stateOf(client->world->world);
        EXPECT_EQ(1u, state.states);
        EXPECT_EQ(0u, state.desyncs)
            << (client->world->host.warnings.empty() ? "" : client->world->host.warnings[0]);
        EXPECT_GT(state.hashes, 10u);
        EXPECT_EQ(state.step, Busy::stateOf(session.server->world, client->peer).newestKnownStep);
    }
}

TEST(Net, BurnsIdenticallyUnderPacketLoss) {
    for (const uint32_t seed : {1u, 2u, 3u}) burnsIdentically(seed, FW_BACKEND_CPU, 200);
}
TEST(Net, BurnsIdenticallyOnADevice) { burnsIdentically(4, FW_BACKEND_VULKAN, 160); }

// Half of a burning sheet is extinguished: it stays out, and the rest burns, on both sides.
TEST(Net, ExtinguishedPartsStayOut) {
    struct Sheets : SheetWorld {
        Sheets() : SheetWorld(evenMaterial(0.05f, 60)) {}
    };
    NetSession<Sheets> session(std::make_unique<Sheets>());
    SheetWorld& client = *session.join(std::make_unique<Sheets>()).world;
    SheetWorld& server = *session.server;
    server.ball(FW_IGNITE, 0.5f, 0, 0.12f, 0.02f);
    session.run(96);
    server.ball(FW_EXTINGUISH, 0.45f, 0, 0.12f, 0.05f);
    server.ball(FW_WET, 0.6f, 0, 0.2f, 0.04f);
    session.run(8);
    session.expectEqual("soon after");
    EXPECT_EQ(uint32_t(FW_POINT_EXTINGUISHED), client.point(0.45f, 0, 0.12f).kind);
    EXPECT_EQ(uint32_t(FW_POINT_BURNING), client.point(0.53f, 0, 0.12f).kind);
    EXPECT_EQ(server.state().ignited, client.state().ignited);
    session.run(96);
    session.expectEqual("when it burns on");
}

// A hash reveals a client that was altered by hand, and the server repairs it.
TEST(Net, AClientThatDivergesIsRepaired) {
    Busy session(std::make_unique<BusyWorld>(FW_BACKEND_CPU));
    BusyWorld& client = *session.join(std::make_unique<BusyWorld>(FW_BACKEND_CPU)).world;
    play(session, 0, 60);
    session.expectEqual("before");
    const uint32_t texels[] = {200, 201, 202, 203, 260};
    EXPECT_EQ(FW_OK, fwDebug_PushTexels(client.world, client.ids[3], FW_IGNITE, texels, 5));
    play(session, 60, 64);
    EXPECT_NE(session.server->hash(), client.hash());
    play(session, 64, 260);
    session.expectEqual("after");
    const FwNetState state = Busy::stateOf(client.world);
    EXPECT_GE(state.desyncs, 1u);  // its fire may have spread meanwhile
    EXPECT_EQ(state.desyncs + 1, state.states);
    EXPECT_EQ(1u, state.repairs);
    ASSERT_FALSE(client.host.warnings.empty());
    EXPECT_NE(std::string::npos, client.host.warnings[0].find("differs from the server's"))
        << client.host.warnings[0];
}

// If one object alone differs, only its differing tiles are sent.
TEST(Net, RepairsOnlyDifferingTiles) {
    struct Sheets : SheetWorld {
        Sheets() : SheetWorld(evenMaterial(0.02f, 60), 1.0f, 0.25f, 512) {}
    };
    NetSession<Sheets> session(std::make_unique<Sheets>());
    SheetWorld& client = *session.join(std::make_unique<Sheets>()).world;
    SheetWorld& server = *session.server;
    const auto in = [&] { return NetSession<Sheets>::stateOf(client.world).bytesIn; };
    server.ball(FW_IGNITE, 0.2f, 0, 0.12f, 0.05f);
    session.run(160);
    session.expectEqual("before");
    uint64_t whole = 0;
    EXPECT_EQ(FW_OK, fwWorld_RequestSave(server.world));
    EXPECT_EQ(FW_OK, fwWorld_Step(server.world, 0));
    EXPECT_EQ(FW_OK, fwWorld_FetchSave(server.world, nullptr, &whole));
    const uint64_t calm = in();
    session.run(128);
    const uint64_t before = in();
    uint64_t count = 0;
    EXPECT_EQ(FW_OK,
              fwDebug_GetTexelPositions(client.world, client.mesh, nullptr, nullptr, 0, &count));
    const auto middle = uint32_t(count / 2 + 400);  // a row in the middle, right half
    EXPECT_EQ(FW_OK, fwDebug_PushTexels(client.world, client.object, FW_IGNITE, &middle, 1));
    session.run(192);
    const FwNetState state = NetSession<Sheets>::stateOf(client.world);
    EXPECT_EQ(1u, state.desyncs);
    EXPECT_EQ(2u, state.states);
    EXPECT_EQ(1u, state.repairs);
    EXPECT_LT(double(in() - before), 1.5 * double(before - calm) + 0.5 * double(whole));
    session.expectEqual("after");
}

// The server rewinds, and clients follow.
TEST(Net, ClientsFollowARewoundServer) {
    Busy session(std::make_unique<BusyWorld>(FW_BACKEND_CPU));
    session.join(std::make_unique<BusyWorld>(FW_BACKEND_CPU));
    play(session, 0, 40);
    const Bytes then = session.server->save();
    play(session, 40, 90);
    ASSERT_EQ(FW_OK, session.server->load(then));
    play(session, 40, 80);
    session.expectEqual("in the other future");
    EXPECT_EQ(2u, Busy::stateOf(session.clients[0]->world->world).states);
}

// A host that is not updated for a while, and one that records one frame at a time, catch up.
TEST(Net, SlowHostsCatchUp) {
    Busy session(std::make_unique<BusyWorld>(FW_BACKEND_CPU, 12.0f, 4));
    auto& client = session.join(std::make_unique<BusyWorld>(FW_BACKEND_CPU, 12.0f, 4));
    client.oneFrame = true;
    play(session, 0, 40);
    client.updates = false;
    play(session, 40, 120);
    client.updates = true;
    play(session, 120, 200);
    EXPECT_LT(Busy::stateOf(client.world->world).behind, 0.6f);
    session.expectEqual("at the end");
    EXPECT_EQ(0u, Busy::stateOf(client.world->world).desyncs);
}

// Messages arrive in order, each before the step it was sent before: the objects they create are
// equal.
TEST(Net, MessagesArriveAtTheirSteps) {
    FwWorldDef def = worldDef(FW_WORLD_CONTACT | FW_WORLD_EMBERS);
    def.paceFactor = 8;
    const auto make = [&] {
        auto made = std::make_unique<Panels>(def);
        for (int i = 0; i < 4; ++i) (void)made->add(0.43f * float(i), 0, 0);
        return made;
    };
    NetSession<Panels> session(make());
    Panels& server = *session.server;
    auto& client = session.join(make());
    client.hears = [&](const std::string& text) {
        (void)client.world->add(0.43f * float(text[0] - '0'), 0, 0.23f);
    };
    std::vector<std::pair<uint64_t, std::string>> sent;
    for (uint32_t frame = 0; frame < 200; ++frame) {
        if (frame == 20) server.ignite(server.ids[0], 0.2f, 0, 0.1f, 0.05f);
        if (frame == 30 || frame == 31 || frame == 90) {
            const std::string text = frame == 30 ? "0" : frame == 31 ? "1" : "2 at last";
            (void)server.add(0.43f * float(text[0] - '0'), 0, 0.23f);
            EXPECT_EQ(FW_OK, fwNet_SendMessage(server.world, text.data(), uint32_t(text.size())));
            sent.emplace_back(NetSession<Panels>::stateOf(server.world).step, text);
        }
        server.run(1.0 / 32);
        session.pass(1.0 / 32);
    }
    session.expectEqual("at the end");
    EXPECT_EQ(sent, client.heard);
    EXPECT_GT(server.alight(), 4u);
    const Bytes much(1025);
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwNet_SendMessage(server.world, much.data(), 1025));
    EXPECT_NE(std::string::npos, lastMessage(server.world).find("1025 bytes"));
}

// ---- refusals
// ------------------------------------------------------------------------------------

TEST(Net, RefusesImpossibleCalls) {
    BusyWorld alone(FW_BACKEND_CPU, 12, 3), other(FW_BACKEND_CPU, 12, 3);
    FwNetAction turn{};
    turn.structSize = sizeof turn;
    FwPeerId peer{};
    Bytes room(1400);
    uint32_t size = 1400;
    const auto says = [](FwWorld* world, const char* what) {
        EXPECT_NE(std::string::npos, lastMessage(world).find(what)) << lastMessage(world);
    };
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwNet_Update(alone.world, 0.1f));
    says(alone.world, "fwNet_Serve");
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwNet_AddPeer(alone.world, &peer));
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwNet_NextAction(alone.world, &turn));
    EXPECT_EQ(FW_OK, fwNet_Leave(alone.world));
    const struct {
        void (*change)(FwNetDef&);
        const char* says;
    } wrong[] = {
        {[](FwNetDef& d) { d.token = 0; }, "FwNetDef::token is 0"},
        {[](FwNetDef& d) { d.packetBytes = 1401; }, "FwNetDef::packetBytes is 1401"},
        {[](FwNetDef& d) { d.bytesPerSecond = 3; }, "FwNetDef::bytesPerSecond is 3"},
        {[](FwNetDef& d) { d.interval = 0; }, "FwNetDef::interval"},
        {[](FwNetDef& d) { d.delay = -1; }, "FwNetDef::delay"},
        {[](FwNetDef& d) { d.flags = 1; }, "FwNetDef::flags is 1"},
    };
    for (const auto& one : wrong) {
        FwNetDef def = netDef(5);
        one.change(def);
        EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwNet_Serve(alone.world, &def));
        says(alone.world, one.says);
    }
    const FwNetDef def = netDef(5);
    EXPECT_EQ(FW_OK, fwNet_Serve(alone.world, &def));
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwNet_Join(alone.world, &def));
    says(alone.world, "a server's already");
    EXPECT_EQ(FW_ERROR_STALE_ID, fwNet_Write(alone.world, peer, room.data(), &size));
    EXPECT_EQ(FW_OK, fwNet_AddPeer(alone.world, &peer));
    EXPECT_EQ(FW_NOT_READY, fwNet_Write(alone.world, peer, room.data(), &size));
    size = 700;
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwNet_Write(alone.world, peer, room.data(), &size));
    says(alone.world, "*size is 700");
    EXPECT_EQ(FW_OK, fwNet_RemovePeer(alone.world, peer));
    EXPECT_EQ(FW_ERROR_STALE_ID, fwNet_RemovePeer(alone.world, peer));
    EXPECT_EQ(FW_ERROR_BAD_DATA, [&] {
        FwPeerId fresh{};
        EXPECT_EQ(FW_OK, fwNet_AddPeer(alone.world, &fresh));
        return fwNet_Read(alone.world, fresh, room.data(), 11);
    }());
    says(alone.world, "11 bytes");

    EXPECT_EQ(FW_OK, fwNet_Join(other.world, &def));
    FwIgnitionDef ball = fwDefaultIgnitionDef();
    ball.radius = 1;
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_Ignite(other.world, &ball, nullptr));
    says(other.world, "follows a server's");
    const float wind[3] = {1, 0, 0};
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_SetWind(other.world, wind));
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_SetFlags(other.world, 0));
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_Step(other.world, 0.5f));
    says(other.world, "fwNet_NextAction");
    EXPECT_EQ(FW_OK, fwWorld_Step(other.world, 0));
    EXPECT_EQ(FW_OK, fwNet_NextAction(other.world, &turn));
    EXPECT_EQ(uint32_t(FW_NET_ACTION_WAIT), turn.kind);
    EXPECT_EQ(FW_OK, fwNet_Leave(other.world));
    EXPECT_EQ(FW_OK, fwWorld_SetWind(other.world, wind));
    EXPECT_EQ(FW_OK, fwWorld_Step(other.world, 0.5f));
}

TEST(Net, RefusesAnotherWorld) {
    Busy session(std::make_unique<BusyWorld>(FW_BACKEND_CPU, 12.0f, 4));
    auto& client = session.join(std::make_unique<BusyWorld>(FW_BACKEND_CPU, 12.0f, 3));
    play(session, 0, 40);
    EXPECT_EQ(uint32_t(FW_NET_REFUSED), Busy::stateOf(client.world->world).phase);
    EXPECT_EQ(0u, Busy::stateOf(client.world->world).step);
    ASSERT_FALSE(client.world->host.warnings.empty());
    EXPECT_NE(std::string::npos, client.world->host.warnings[0].find("identity"));
}

// Packets that are damaged, cut, extended, of another session, of the other direction or repeated
// are refused with a message, or recognised, and change nothing.
TEST(Net, TenThousandFuzzedPacketsChangeNothing) {
    Busy session(std::make_unique<BusyWorld>(FW_BACKEND_CPU, 12.0f, 4));
    auto& client = session.join(std::make_unique<BusyWorld>(FW_BACKEND_CPU, 12.0f, 4));
    client.up.keeps = client.down.keeps = true;
    client.up.loss = client.down.loss = 0;
    play(session, 0, 50);
    session.expectEqual("before");
    client.up.deliver(1e9, [&](const Bytes& bytes) {
        EXPECT_EQ(FW_OK, fwNet_Read(session.server->world, client.peer, bytes.data(),
                                    uint32_t(bytes.size())));
    });
    client.down.deliver(1e9, [&](const Bytes& bytes) {
        EXPECT_EQ(FW_OK, fwNet_Read(client.world->world, {}, bytes.data(), uint32_t(bytes.size())));
    });
    const uint64_t before = session.server->hash();
    const FwNetState ours = Busy::stateOf(client.world->world);
    const FwNetState theirs = Busy::stateOf(session.server->world, client.peer);
    std::mt19937 random(17);
    uint32_t refused = 0, known = 0;
    for (int i = 0; i < 10000; ++i) {
        const bool toServer = random() % 2 != 0, swapped = random() % 16 == 0;
        const std::vector<Bytes>& from = toServer != swapped ? client.up.seen : client.down.seen;
        Bytes bytes = from[random() % from.size()];
        const bool damaged = random() % 8 != 0;
        if (damaged) {
            const uint32_t kind = random() % 5;
            if (kind == 0) bytes.resize(random() % bytes.size());
            if (kind == 1) bytes.resize(bytes.size() + 1 + random() % 2000);
            if (kind == 2)
                for (unsigned char& byte : bytes) byte = (unsigned char)(random());
            if (kind > 2)
                for (uint32_t k = 0; k < 1 + random() % 4; ++k)
                    bytes[random() % bytes.size()] ^= (unsigned char)(1u << (random() % 8));
        }
        FwWorld* world = toServer ? session.server->world : client.world->world;
        const unsigned char none = 0;
        const FwResult result =
            fwNet_Read(world, toServer ? client.peer : FwPeerId{},
                       bytes.empty() ? &none : bytes.data(), uint32_t(bytes.size()));
        if (result == FW_OK) {
            ++known;
            continue;
        }
        EXPECT_TRUE(result == FW_ERROR_BAD_DATA || result == FW_ERROR_VERSION);
        EXPECT_FALSE(lastMessage(world).empty());
        ++refused;
    }
    EXPECT_GT(refused, 8000u);
    EXPECT_GT(known, 800u);
    const auto same = [](const FwNetState& a, const FwNetState& b) {
        EXPECT_EQ(a.packetsIn, b.packetsIn);
        EXPECT_EQ(a.records, b.records);
        EXPECT_EQ(a.step, b.step);
        EXPECT_EQ(a.newestKnownStep, b.newestKnownStep);
        EXPECT_EQ(a.states, b.states);
        EXPECT_EQ(a.desyncs, b.desyncs);
        EXPECT_EQ(a.phase, b.phase);
    };
    same(ours, Busy::stateOf(client.world->world));
    same(theirs, Busy::stateOf(session.server->world, client.peer));
    EXPECT_EQ(before, session.server->hash());
    EXPECT_EQ(before, client.world->hash());
    play(session, 50, 100);
    session.expectEqual("and it continues");
    EXPECT_EQ(0u, Busy::stateOf(client.world->world).desyncs);
}

// One packet in twenty is damaged behind its head but has a correct checksum. Clients may diverge;
// the server finds and repairs them.
TEST(Net, RepairsDivergenceFoundLate) {
    for (const uint32_t seed : {1u, 2u, 3u}) {
        Busy session(std::make_unique<BusyWorld>(FW_BACKEND_CPU, 12.0f, 4), seed);
        auto& client = session.join(std::make_unique<BusyWorld>(FW_BACKEND_CPU, 12.0f, 4));
        std::mt19937 random(seed);
        uint32_t damaged = 0;
        const auto damage = [&](Wire& wire) {
            for (Wire::Packet& packet : wire.packets) {
                if (packet.bytes.size() <= 24 || random() % 20 != 0) continue;
                const size_t room = packet.bytes.size() - 24;
                for (uint32_t k = 0; k < 1 + random() % 3; ++k)
                    packet
                        .bytes[24 + random() % std::min<size_t>(room, random() % 2 ? 40 : room)] ^=
                        (unsigned char)(1u << (random() % 8));
                signPacket(packet.bytes);
                ++damaged;
            }
        };
        client.damages = true;
        for (uint32_t frame = 0; frame < 300; ++frame) {
            play(session, frame, frame + 1);
            if (frame < 200) damage(client.up), damage(client.down);
        }
        client.damages = false;
        EXPECT_GT(damaged, 15u);
        play(session, 300, 420);  // so that the hash of every object is compared
        session.expectEqual("at the end");
    }
}

}  // namespace
