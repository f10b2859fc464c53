// Hostile peers that know the session: packets of a real session with one field altered and a
// correct checksum, each field in turn, in both directions; a client written by hand that answers
// with the server's own numbers; and one such client among 64. Nothing crashes, the worlds of other
// clients equal the server's, impossible packets are refused and counted, and memory is bounded.
#include "abi/net_session.h"
#include "abi/panels.h"

#include <algorithm>
#include <array>
#include <map>
#include <span>

namespace {

using namespace host;

struct PacketField {
    const char* name;
    uint16_t kind;  // of packets with this field; kAnyKind: all
    size_t at, size;
};
constexpr uint16_t kAnyKind = 0xFFFF, kStatusKind = 2, kStreamKind = 3, kChunkKind = 4,
                   kTilesKind = 5;
constexpr size_t kPacketHeadBytes = 24;
constexpr PacketField kUpFields[] = {
    {"kind", kAnyKind, 6, 2},
    {"session", kAnyKind, 12, 4},
    {"token", kAnyKind, 16, 4},
    {"sequence", kAnyKind, 20, 4},
    {"request", kStatusKind, 24, 2},
    {"loaded state", kStatusKind, 26, 4},
    {"next record", kStatusKind, 30, 4},
    {"step", kStatusKind, 34, 4},
    {"newest packet", kStatusKind, 38, 4},
    {"state", kStatusKind, 42, 4},
    {"pieces before", kStatusKind, 46, 4},
    {"pieces that came", kStatusKind, 50, 8},
    {"runs", kStatusKind, 58, 2},
    {"gap", kStatusKind, 60, 2},
    {"run", kStatusKind, 62, 2},
    {"capture", kTilesKind, 24, 4},
    {"slot", kTilesKind, 28, 4},
    {"block hash", kTilesKind, 32, 4},
};
constexpr PacketField kDownFields[] = {
    {"kind", kAnyKind, 6, 2},
    {"session", kAnyKind, 12, 4},
    {"token", kAnyKind, 16, 4},
    {"sequence", kAnyKind, 20, 4},
    {"outdated", kStreamKind, 24, 4},
    {"step", kStreamKind, 28, 4},
    {"records", kStreamKind, 32, 4},
    {"first record", kStreamKind, 36, 4},
    {"record count", kStreamKind, 40, 2},
    {"flags", kStreamKind, 42, 2},
    {"record size", kStreamKind, 44, 2},
    {"record kind", kStreamKind, 46, 2},
    {"record step", kStreamKind, 48, 4},
    {"record word", kStreamKind, 52, 4},
    {"record word 2", kStreamKind, 56, 4},
    {"state", kChunkKind, 24, 4},
    {"state step", kChunkKind, 28, 4},
    {"state record", kChunkKind, 32, 4},
    {"state size", kChunkKind, 36, 4},
    {"piece", kChunkKind, 40, 4},
    {"piece bytes", kChunkKind, 44, 2},
    {"piece content", kChunkKind, 60, 4},
    {"identity", 1, 24, 8},
};

uint64_t numberIn(const Bytes& packet, const PacketField& field) {
    uint64_t value = 0;
    for (size_t k = 0; k < field.size; ++k) value |= uint64_t(packet[field.at + k]) << (8 * k);
    return value;
}

// Changes one field at a time and cycles through its values: near the correct one, zero, the
// maximum, an old one, a future one, a random one.
class FieldMutator {
 public:
    FieldMutator(std::span<const PacketField> fields, uint32_t seed)
        : fields_(fields), random_(seed) {}
    // Index of the field; fields_.size(): the packet has no field of that kind.
    size_t alter(Bytes& packet) {
        const auto kind = uint16_t(packet[6] | packet[7] << 8);
        size_t& turn = turn_[kind];
        for (size_t i = 0; i < fields_.size(); ++i) {
            const size_t at = turn++ % fields_.size();
            const PacketField& field = fields_[at];
            if ((field.kind != kAnyKind && field.kind != kind) ||
                packet.size() < field.at + field.size)
                continue;
            const uint64_t value = numberIn(packet, field);
            uint64_t& old = old_[at];
            const uint64_t most = field.size == 8 ? ~0ull : (1ull << (8 * field.size)) - 1;
            const uint64_t values[] = {value + 1,  value - 1,    0,        most,
                                       old,        value + 1000, most / 2, random_(),
                                       value + 64, value * 2 + 1};
            const uint64_t altered = values[round_[at]++ % std::size(values)] & most;
            old = value;
            if (altered == value) continue;
            for (size_t k = 0; k < field.size; ++k)
                packet[field.at + k] = (unsigned char)(altered >> (8 * k));
            signPacket(packet);
            return at;
        }
        return fields_.size();
    }

 private:
    std::span<const PacketField> fields_;
    std::mt19937 random_;
    std::map<uint16_t, size_t> turn_;  // next field, per kind of packet
    std::array<uint32_t, 64> round_{};
    std::array<uint64_t, 64> old_{};
};

std::unique_ptr<Panels> makePanels() {
    FwWorldDef def = fwDefaultWorldDef();
    def.flags = FW_WORLD_CONTACT;
    def.paceFactor = 4;
    auto made = std::make_unique<Panels>(def);
    for (int i = 0; i < 3; ++i) (void)made->add(0.43f * float(i), 0, 0);
    return made;
}
using PanelSession = NetSession<Panels>;

void actOnPanels(PanelSession& session, uint32_t frame) {
    Panels& server = *session.server;
    if (frame % 40 == 10) {
        FwIgnitionDef ball = fwDefaultIgnitionDef();
        ball.kind = frame % 120 == 90 ? FW_EXTINGUISH : FW_IGNITE;
        ball.position[0] = 0.1f + 0.04f * float(frame / 40 % 25);
        ball.position[2] = 0.1f;
        ball.radius = 0.03f;
        EXPECT_LE(0, fwWorld_Ignite(server.world, &ball, nullptr));
    }
    if (frame % 25 == 5) {
        const float wind[3] = {0.1f * float(frame % 17), 0, 0.5f};
        EXPECT_EQ(FW_OK, fwWorld_SetWind(server.world, wind));
    }
    if (frame % 30 == 7) {
        EXPECT_EQ(FW_OK, fwNet_SendMessage(server.world, "hello", 5));
    }
}
void playPanels(PanelSession& session, uint32_t from, uint32_t to) {
    for (uint32_t frame = from; frame < to; ++frame) {
        actOnPanels(session, frame);
        EXPECT_EQ(FW_OK, fwWorld_Step(session.server->world, 1.0f / 32));
        session.pass(1.0 / 32);
    }
}

// The client's own world diverges now and then, so that it requests tiles and states.
void diverge(PanelSession::Client& client, uint32_t frame) {
    if (frame % 90 != 60) return;
    const uint32_t texels[] = {frame % 300, frame % 300 + 1};
    EXPECT_LE(0, fwDebug_PushTexels(client.world->world, client.world->ids[frame / 90 % 3],
                                    FW_IGNITE, texels, 2));
}

// A session of an honest client and of one whose packets are altered for 900 frames. At the end all
// worlds are equal.
struct HostilePlay {
    explicit HostilePlay(uint32_t seed)
        : session(makePanels(), seed),
          honest(session.join(makePanels())),
          other(session.join(makePanels())),
          seed_(seed) {
        other.damages = true;
    }
    // `hook`: of the other client. `alters`: whether it alters its packet of that number. Counts by
    // name.
    template <class Alters>
    void run(std::function<void(Bytes&)> PanelSession::Client::*hook,
             std::span<const PacketField> fields, Alters alters, uint32_t until,
             std::map<std::string, uint32_t>& altered) {
        FieldMutator mutator(fields, seed_);
        uint32_t packets = 0;
        other.*hook = [&](Bytes& packet) {
            if (!alters(++packets)) return;
            const size_t field = mutator.alter(packet);
            if (field < fields.size()) ++altered[fields[field].name];
        };
        for (uint32_t frame = 0; frame < 900; ++frame) {
            playPanels(session, frame, frame + 1);
            diverge(other, frame);
        }
        other.*hook = nullptr;
        playPanels(session, 900, until);
        session.expectEqual("at the end");
    }

    PanelSession session;
    PanelSession::Client &honest, &other;

 private:
    uint32_t seed_;
};

TEST(NetHostile, AServerSurvivesEachAlteredFieldOfAClient) {
    uint64_t refused = 0;
    std::map<std::string, uint32_t> altered;
    for (const uint32_t seed : {1u, 2u, 3u, 4u}) {
        HostilePlay play(seed);
        const auto alters = [&](uint32_t packet) {
            return packet % 4 != seed % 2;  // so that the session continues
        };
        play.run(&PanelSession::Client::alterUp, kUpFields, alters, 1000, altered);
        const FwNetState good = PanelSession::stateOf(play.session.server->world, play.honest.peer);
        EXPECT_EQ(0u, good.packetsRefused);
        EXPECT_EQ(1u, good.states);
        EXPECT_EQ(0u, PanelSession::stateOf(play.honest.world->world).desyncs);
        const FwNetState bad = PanelSession::stateOf(play.session.server->world, play.other.peer);
        EXPECT_GT(bad.packetsRefused, 40u);
        EXPECT_FALSE(play.session.server->host.warnings.empty());
        refused += bad.packetsRefused;
    }
    for (const PacketField& field : kUpFields)
        EXPECT_GT(altered[field.name], field.kind == kTilesKind || field.at > 58 ? 0u : 20u)
            << field.name;
    std::printf("%llu packets refused\n", static_cast<unsigned long long>(refused));
}

TEST(NetHostile, AClientSurvivesEachAlteredFieldOfItsServer) {
    std::map<std::string, uint32_t> altered;
    for (const uint32_t seed : {1u, 2u, 3u, 4u}) {
        HostilePlay play(seed);
        const auto alters = [&](uint32_t packet) { return packet % 4 == seed % 4; };
        play.run(&PanelSession::Client::alterDown, kDownFields, alters, 1100, altered);
        EXPECT_EQ(0u, PanelSession::stateOf(play.honest.world->world).desyncs);
        EXPECT_GT(PanelSession::stateOf(play.other.world->world).packetsRefused, 20u);
    }
    for (const PacketField& field : kDownFields)
        if (field.kind != 1 && field.kind != kChunkKind) {
            EXPECT_GT(altered[field.name], 2u) << field.name;
        }
}

// ---- a client written by hand
// --------------------------------------------------------------------

// It takes part in a session with correct values; a test alters one of them.
class HandClient {
 public:
    HandClient(FwWorld* server, uint32_t token) : server_(server), token_(token) {
        EXPECT_EQ(FW_OK, fwNet_AddPeer(server, &peer)) << lastMessage(server);
    }
    struct Status {
        uint16_t request = 0;
        uint32_t loaded = 0, next = 0, step = 0, answered = 0, state = 0, base = 0;
        uint64_t came = 0;
        uint16_t runs = 0;
    };
    FwResult hello() { return send(0, 0, {}); }
    FwResult say(const Status& status) {
        Bytes body;
        put(body, status.request, 2), put(body, status.loaded, 4), put(body, status.next, 4);
        put(body, status.step, 4), put(body, status.answered, 4), put(body, status.state, 4);
        put(body, status.base, 4), put(body, status.came, 8), put(body, status.runs, 2);
        return send(kStatusKind, session, body);
    }
    FwResult hashes(uint32_t capture, uint32_t slot, uint32_t count) {
        Bytes body;
        put(body, capture, 4), put(body, slot, 4);
        for (uint32_t i = 0; i < count; ++i) put(body, i, 4);
        return send(kTilesKind, session, body);
    }
    // Reads the server's packets for it, and keeps its values correct.
    void drain() {
        for (int i = 0; i < 10000; ++i) {
            Bytes packet(1400);
            auto size = uint32_t(packet.size());
            if (fwNet_Write(server_, peer, packet.data(), &size) != FW_OK) return;
            packet.resize(size);
            bytes += size;
            session = word(packet, 12);
            right.answered = word(packet, 20);
            const uint16_t kind = packet[6];
            if (kind == kStreamKind) {
                right.step = word(packet, 28);
                takeRecords(packet);
            }
            if (kind == kChunkKind) takePiece(packet);
        }
        ADD_FAILURE() << "packets do not end";
    }
    // Accepts what has arrived completely.
    bool load() {
        if (pieces_ == 0 || right.base < pieces_) return false;
        right.loaded = stateId_;
        right.next = stateRecord_;
        right.request = 0;
        right.state = right.base = 0;
        right.came = 0;
        pieces_ = 0;
        return true;
    }
    FwResult send(uint16_t kind, uint32_t inSession, const Bytes& body) {
        Bytes packet;
        put(packet, 0x504E5746u, 4), put(packet, 3, 2), put(packet, kind, 2), put(packet, 0, 4);
        put(packet, inSession, 4), put(packet, token_, 4), put(packet, ++sequence_, 4);
        packet.insert(packet.end(), body.begin(), body.end());
        signPacket(packet);
        return fwNet_Read(server_, peer, packet.data(), uint32_t(packet.size()));
    }

    FwPeerId peer{};
    uint32_t session = 0;
    uint64_t bytes = 0;
    Status right;  // values of an honest client

 private:
    static void put(Bytes& to, uint64_t value, size_t size) {
        for (size_t k = 0; k < size; ++k) to.push_back((unsigned char)(value >> (8 * k)));
    }
    static uint32_t word(const Bytes& packet, size_t at) {
        uint32_t value = 0;
        std::memcpy(&value, &packet[at], 4);
        return value;
    }
    void takeRecords(const Bytes& packet) {
        uint32_t at = word(packet, 36);
        size_t from = kPacketHeadBytes + 20;
        for (uint32_t i = 0; i < (word(packet, 40) & 0xFFFF); ++i) {
            const size_t size = packet[from] | packet[from + 1] << 8;
            const bool skipped = packet[from + 2] == 4;
            at += skipped ? word(packet, from + 8) : 1;
            from += 2 + size;
        }
        if (right.loaded != 0 && word(packet, 36) <= right.next)
            right.next = std::max(right.next, at);
    }
    void takePiece(const Bytes& packet) {
        if (word(packet, 24) != stateId_ || pieces_ == 0) {
            stateId_ = word(packet, 24);
            stateRecord_ = word(packet, 32);
            const uint32_t each = word(packet, 44) & 0xFFFF;
            pieces_ = (word(packet, 36) + each - 1) / each;
            right.state = stateId_;
            right.base = 0;
        }
        if (word(packet, 40) == right.base) ++right.base;  // this wire keeps the order
    }

    FwWorld* server_;
    uint32_t token_;
    uint32_t sequence_ = 0;
    uint32_t stateId_ = 0, stateRecord_ = 0, pieces_ = 0;
};

void passFrames(Panels& server, int frames = 1) {
    for (int i = 0; i < frames; ++i) {
        EXPECT_EQ(FW_OK, fwWorld_Step(server.world, 1.0f / 32)) << lastMessage(server.world);
        EXPECT_EQ(FW_OK, fwNet_Update(server.world, 1.0f / 32)) << lastMessage(server.world);
    }
}
void joinBy(HandClient& client, Panels& server) {
    EXPECT_EQ(FW_OK, client.hello());
    passFrames(server, 3);
    client.drain();
    client.right.request = 1;
    for (int i = 0; i < 60 && client.right.loaded == 0; ++i) {
        EXPECT_EQ(FW_OK, client.say(client.right)) << lastMessage(server.world);
        passFrames(server, 2);
        client.drain();
        (void)client.load();
    }
    ASSERT_NE(0u, client.right.loaded);
    EXPECT_EQ(FW_OK, client.say(client.right)) << lastMessage(server.world);
}

// Unsent records, states and pieces cannot be acknowledged, and the server continues.
TEST(NetHostile, AcknowledgementsOfUnsentDataAreRefusedAndCounted) {
    const std::unique_ptr<Panels> server = makePanels();
    const FwNetDef def = netDef(0x1234);
    ASSERT_EQ(FW_OK, fwNet_Serve(server->world, &def));
    HandClient client(server->world, 99);
    ASSERT_NO_FATAL_FAILURE(joinBy(client, *server));
    const Bytes text(1000);
    uint64_t expected = 0;
    for (int round = 0; round < 20; ++round) {
        for (int i = 0; i < 40; ++i)
            EXPECT_EQ(FW_OK, fwNet_SendMessage(server->world, text.data(), 1000));
        passFrames(*server, 2);
        using Status = HandClient::Status;
        const Status right = client.right;
        const auto refused = [&](const char* what, auto&& alter) {
            Status altered = right;
            alter(altered);
            EXPECT_EQ(FW_ERROR_BAD_DATA, client.say(altered)) << what;
            EXPECT_NE(std::string::npos, lastMessage(server->world).find("status"))
                << lastMessage(server->world);
            ++expected;
        };
        refused("all that there are", [](Status& s) { s.next += 40; });
        refused("one that was not sent", [](Status& s) { s.next += 1; });
        refused("far more", [](Status& s) { s.next = 0xFFFFFFFFu; });
        refused("none any more", [](Status& s) { s.next = 0; });
        refused("a state to come", [](Status& s) { s.loaded += 2; });
        refused("any state", [](Status& s) { s.loaded = 0xFFFFFFFFu; });
        refused("no state any more", [](Status& s) { s.loaded = 0; });
        refused("a packet to come", [](Status& s) { s.answered += 1000; });
        refused("a step to come", [](Status& s) { s.step += 100000; });
        refused("pieces of a state to come", [](Status& s) { s.state = 1000; });
        refused("pieces of none", [](Status& s) { s.base = 1; });
        refused("pieces of none behind them", [](Status& s) { s.came = 1; });
        refused("a run that is not there", [](Status& s) { s.runs = 1; });
        refused("what is no request", [](Status& s) { s.request = 3; });
        for (int i = 0; i < 8; ++i) {
            EXPECT_EQ(FW_OK, fwNet_SendMessage(server->world, text.data(), 1000));
            passFrames(*server);
        }
        // Correct packets are still accepted.
        EXPECT_EQ(FW_OK, client.say(client.right)) << lastMessage(server->world);
        client.drain();
        EXPECT_EQ(FW_OK, client.say(client.right)) << lastMessage(server->world);
    }
    EXPECT_EQ(expected, PanelSession::stateOf(server->world, client.peer).packetsRefused);
    EXPECT_EQ(expected, PanelSession::stateOf(server->world).packetsRefused);
    EXPECT_EQ(0u, PanelSession::stateOf(server->world).messagesLost);
    ASSERT_FALSE(server->host.warnings.empty());
    EXPECT_NE(std::string::npos, server->host.warnings[0].find("peer 1 is refused"))
        << server->host.warnings[0];
    EXPECT_LT(server->host.warnings.size(), 20u);  // a flood of packets does not flood the log
}

// 63 honest clients and a hostile one: it floods, alters fields, requests the state again and
// again, and acknowledges nothing.
TEST(NetHostile, OneHostileClientCostsTheOthersNothing) {
    PanelSession session(makePanels());
    for (int i = 0; i < 63; ++i) session.join(makePanels());
    HandClient hostile(session.server->world, 0xBAD);
    FwWorld* server = session.server->world;
    std::mt19937 random(5);
    const auto below = [&](uint32_t n) { return uint32_t(random()) % n; };
    int64_t before = 0, most = 0;
    uint32_t frames = 0;
    for (uint32_t at = 0; at < 200; ++at, ++frames) {
        playPanels(session, at, at + 1);
        if (at == 60) before = session.server->host.bytes;
        most = std::max<int64_t>(most, session.server->host.bytes);
        hostile.drain();
        (void)hostile.load();
        if (at < 5) {
            EXPECT_EQ(FW_OK, hostile.hello());
        }
        for (int i = 0; i < 300; ++i) {
            HandClient::Status status = hostile.right;
            status.request = uint16_t(below(3));
            uint32_t* fields[] = {&status.loaded,   &status.next,  &status.step,
                                  &status.answered, &status.state, &status.base};
            uint32_t& field = *fields[below(6)];
            const uint32_t values[] = {field + 1,   field - 1,    0,
                                       0xFFFFFFFFu, field + 1000, uint32_t(random())};
            if (below(4) != 0) field = values[below(6)];
            if (below(8) == 0) status.came = random();
            (void)hostile.say(status);
            if (below(10) == 0) (void)hostile.hashes(below(20), below(5), below(100));
        }
    }
    session.expectEqual("with a hostile one among them");
    for (const auto& client : session.clients) {
        const FwNetState state = PanelSession::stateOf(server, client->peer);
        EXPECT_EQ(0u, state.packetsRefused);
        EXPECT_EQ(1u, state.states);
        EXPECT_EQ(0u, PanelSession::stateOf(client->world->world).desyncs);
    }
    const FwNetState state = PanelSession::stateOf(server, hostile.peer);
    EXPECT_GT(state.packetsRefused, 500u);
    EXPECT_GT(state.packetsIgnored, 30000u);  // the server ignores packets beyond 512 a second
    EXPECT_LT(most - before, int64_t(4) << 20);
    // At most its rate: 10 s of it, plus one burst.
    EXPECT_LT(double(state.bytesOut), 262144 * (double(frames) / 32 + 0.5));
}

}  // namespace
