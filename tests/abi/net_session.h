// A server and its clients in one process, connected by wires that lose, delay, repeat and reorder
// packets.
#pragma once
#include "abi/busy_world.h"

#include <memory>
#include <random>

namespace host {

struct Wire {
    double loss = 0.2, repeat = 0.1;       // probabilities per packet
    double soonest = 0.02, latest = 0.15;  // s
    std::mt19937 random{1};
    struct Packet {
        double at = 0;
        Bytes bytes;
    };
    std::vector<Packet> packets;
    std::vector<Bytes> seen;  // sent packets, if they are kept
    bool keeps = false;

    double chance() { return double(random() >> 8) / double(1u << 24); }
    void send(const Bytes& bytes, double now) {
        if (keeps) seen.push_back(bytes);
        const int copies = chance() < repeat ? 2 : 1;
        for (int i = 0; i < copies; ++i)
            if (chance() >= loss)
                packets.push_back({now + soonest + (latest - soonest) * chance(), bytes});
    }
    template <class Take>
    void deliver(double now, Take&& take) {
        std::vector<Bytes> due;
        std::erase_if(packets, [&](Packet& packet) {
            if (packet.at > now) return false;
            due.push_back(std::move(packet.bytes));
            return true;
        });
        for (const Bytes& bytes : due) take(bytes);
    }
};

inline FwNetDef netDef(uint32_t token) {
    FwNetDef def = fwDefaultNetDef();
    def.token = token;
    return def;
}

// The checksum in a packet's head, so that the receiver reads on.
inline void signPacket(Bytes& packet) {
    uint64_t hash = 1469598103934665603ull;
    for (size_t i = 0; i < packet.size(); ++i)
        if (i < 8 || i >= 12) hash = (hash ^ packet[i]) * 1099511628211ull;
    const uint32_t sum = uint32_t(hash) ^ uint32_t(hash >> 32);
    std::memcpy(&packet[8], &sum, 4);
}

// World: owns a context, a world and a host's log; has hash() and receives messages.
template <class World>
class NetSession {
 public:
    struct Client {
        std::unique_ptr<World> world;
        FwPeerId peer{};
        Wire up, down;
        std::vector<std::pair<uint64_t, std::string>> heard;  // steps, messages
        std::function<void(const std::string&)> hears;
        bool updates = true;  // false: its host does not update it
        bool oneFrame = false;
        bool damages = false;  // its wires damage packets: refusals are expected
        std::function<void(Bytes&)> alterUp, alterDown;  // alter a packet's bytes on the wire
    };

    explicit NetSession(std::unique_ptr<World> given, uint32_t seed = 1)
        : server(std::move(given)), seed_(seed) {
        const FwNetDef def = netDef(77 + seed);
        EXPECT_EQ(FW_OK, fwNet_Serve(server->world, &def)) << lastMessage(server->world);
    }

    Client& join(std::unique_ptr<World> world) {
        Client& client = *clients.emplace_back(std::make_unique<Client>());
        client.world = std::move(world);
        client.up.random.seed(seed_ * 100 + uint32_t(clients.size()) * 2);
        client.down.random.seed(seed_ * 100 + uint32_t(clients.size()) * 2 + 1);
        const FwNetDef def = netDef(1000 + seed_ * 10 + uint32_t(clients.size()));
        EXPECT_EQ(FW_OK, fwNet_Join(client.world->world, &def)) << lastMessage(client.world->world);
        EXPECT_EQ(FW_OK, fwNet_AddPeer(server->world, &client.peer)) << lastMessage(server->world);
        return client;
    }
    // Steps of the server, and the packets in between.
    void run(int steps) {
        for (int i = 0; i < steps; ++i) {
            server->run(1.0 / 32);
            pass(1.0 / 32);
        }
    }
    // After the server's host has acted: `seconds` pass.
    void pass(double seconds) {
        EXPECT_EQ(FW_OK, fwNet_Update(server->world, float(seconds)));
        for (const auto& client : clients) {
            take(server->world, client->peer, client->down, now);
            const int frames = seconds > 0.03 ? 3 : 1;  // a client's frames are shorter
            for (int i = 0; i < frames; ++i) {
                const double then = now + seconds * (i + 1) / frames;
                client->down.deliver(then, [&](Bytes bytes) {
                    if (client->alterDown) client->alterDown(bytes);
                    read(client->world->world, {}, bytes, client->damages);
                });
                if (client->updates) go(*client, seconds / frames);
                take(client->world->world, {}, client->up, then);
                client->up.deliver(then, [&](Bytes bytes) {
                    if (client->alterUp) client->alterUp(bytes);
                    read(server->world, client->peer, bytes, client->damages);
                });
            }
        }
        now += seconds;
    }
    // The server stands still until all clients have reached its tick.
    bool settle(double most = 30) {
        for (double waited = 0; waited < most; waited += 1.0 / 30) {
            pass(1.0 / 30);
            bool all = true;
            for (const auto& client : clients) {
                const FwNetState state = stateOf(client->world->world);
                all = all && state.phase == FW_NET_FOLLOWING && state.records == 0 &&
                      state.step == stateOf(server->world).step;
            }
            if (all && ++calm_ > 30) return calm_ = 0, true;  // and no divergence was reported
            if (!all) calm_ = 0;
        }
        for (const auto& client : clients) {
            const FwNetState state = stateOf(client->world->world);
            ADD_FAILURE() << "phase " << state.phase << ", step " << state.step << " of "
                          << stateOf(server->world).step << ", " << state.records << " records, "
                          << state.states << " states, " << state.desyncs << " strays; "
                          << lastMessage(client->world->world);
            for (const std::string& warning : client->world->host.warnings)
                ADD_FAILURE() << warning;
        }
        return false;
    }
    static FwNetState stateOf(FwWorld* world, FwPeerId peer = {}) {
        FwNetState state{};
        state.structSize = sizeof state;
        EXPECT_EQ(FW_OK, fwNet_GetState(world, peer, &state)) << lastMessage(world);
        return state;
    }
    void expectEqual(const char* when) {
        ASSERT_TRUE(settle()) << when;
        const uint64_t hash = server->hash();
        for (const auto& client : clients) EXPECT_EQ(hash, client->world->hash()) << when;
    }

    std::unique_ptr<World> server;
    std::vector<std::unique_ptr<Client>> clients;
    double now = 0;

 private:
    static void read(FwWorld* world, FwPeerId from, const Bytes& bytes, bool maybe) {
        const FwResult result = fwNet_Read(world, from, bytes.data(), uint32_t(bytes.size()));
        EXPECT_TRUE(result == FW_OK || (maybe && result == FW_ERROR_BAD_DATA))
            << lastMessage(world);
    }
    static void take(FwWorld* world, FwPeerId to, Wire& wire, double now) {
        for (int i = 0;; ++i) {
            ASSERT_LT(i, 10000);
            Bytes bytes(1400);
            auto size = uint32_t(bytes.size());
            const FwResult result = fwNet_Write(world, to, bytes.data(), &size);
            if (result == FW_NOT_READY) return;
            ASSERT_EQ(FW_OK, result) << lastMessage(world);
            ASSERT_LE(size, 1200u);
            bytes.resize(size);
            wire.send(bytes, now);
        }
    }
    void go(Client& client, double seconds) {
        FwWorld* world = client.world->world;
        ASSERT_EQ(FW_OK, fwNet_Update(world, float(seconds))) << lastMessage(world);
        FwNetAction turn{};
        turn.structSize = sizeof turn;
        for (int i = 0; i < 1000; ++i) {
            ASSERT_EQ(FW_OK, fwNet_NextAction(world, &turn)) << lastMessage(world);
            if (turn.kind == FW_NET_ACTION_WAIT) return;
            if (turn.kind == FW_NET_ACTION_MESSAGE) {
                const std::string text(turn.message, turn.message + turn.messageSize);
                client.heard.emplace_back(stateOf(world).step, text);
                if (client.hears) client.hears(text);
                continue;
            }
            ASSERT_EQ(FW_OK, fwWorld_Step(world, turn.deltaTime)) << lastMessage(world);
            if (client.oneFrame) return;
        }
        ADD_FAILURE() << "a client's turns do not end";
    }

    uint32_t seed_ = 1;
    int calm_ = 0;
};

}  // namespace host
