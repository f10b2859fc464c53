// A model of a network: a link with delay, loss and rate in each direction behind a queue, a
// server, a client from the beginning, and one that joins in the middle. The server's host changes
// something now and then, and for ten seconds more than a slow link carries.
#pragma once
#include "abi/net_session.h"
#include "abi/panels.h"

#include <algorithm>

namespace host {

struct NetModelCell {
    double delay = 0;      // s, one way; varies by a tenth, so packets overtake each other
    double loss = 0;       // probability per packet, each way
    double rate = 1e6;     // bytes/s, each way
    double seconds = 120;  // of the server's session
};

// A queue in front of a line: holds 2 s of the line's capacity and drops the rest.
class ModelLink {
 public:
    ModelLink(const NetModelCell& cell, uint32_t seed) : cell_(cell), random_(seed) {}
    void send(Bytes bytes, double now) {
        freeAt_ = std::max(freeAt_, now);
        if (freeAt_ - now > 2) return;
        freeAt_ += double(bytes.size()) / cell_.rate;
        if (chance() < cell_.loss) return;
        const double at = freeAt_ + cell_.delay * (0.9 + 0.2 * chance());
        if (chance() < 0.02) packets_.push_back({at + 0.3 * chance(), bytes});
        packets_.push_back({at, std::move(bytes)});
    }
    template <class Take>
    void deliver(double now, Take&& take) {
        // By time, as the delay of packets varies.
        const auto due = std::stable_partition(packets_.begin(), packets_.end(),
                                               [&](const Packet& p) { return p.at > now; });
        std::stable_sort(due, packets_.end(),
                         [](const Packet& a, const Packet& b) { return a.at < b.at; });
        for (auto packet = due; packet != packets_.end(); ++packet) take(packet->bytes);
        packets_.erase(due, packets_.end());
    }

 private:
    struct Packet {
        double at = 0;
        Bytes bytes;
    };
    double chance() { return double(random_() >> 8) / double(1u << 24); }

    NetModelCell cell_;
    std::mt19937 random_;
    double freeAt_ = 0;  // s: when the line has sent all of the queue
    std::vector<Packet> packets_;
};

class NetModel {
 public:
    explicit NetModel(const NetModelCell& cell) : cell_(cell) {
        server_ = make();
        FwNetDef def = netDef(7);
        def.bytesPerSecond = uint32_t(std::max(4000.0, 0.9 * cell.rate));
        ok(server_->world, fwNet_Serve(server_->world, &def));
    }

    // Plays the whole session, then waits until all have reached the server's tick.
    void play() {
        const auto steps = uint32_t(cell_.seconds * 32);
        join();
        for (uint32_t step = 0; step < steps; ++step) {
            if (step == steps / 2) join();
            act(step, steps);
            ok(server_->world, fwWorld_Step(server_->world, kStep));
            pass();
            watch();
        }
        while (!together() && settled < kSettleMost) {
            pass();
            watch();
            settled += double(kStep);
        }
    }
    // Does every client's world equal the server's, with each message of the host once and in
    // order?
    void expectEqual() {
        ASSERT_TRUE(together()) << what();
        const uint64_t hash = server_->hash();
        for (const auto& client : clients_) {
            EXPECT_EQ(hash, client->world->hash()) << what();
            const FwNetState state = stateOf(client->world->world);
            EXPECT_EQ(0u, state.packetsRefused) << what();
            EXPECT_EQ(0u, state.desyncs) << what();
            EXPECT_FALSE(client->messages.empty()) << what();
            const size_t from =
                sentMessages_.size() - std::min(sentMessages_.size(), client->messages.size());
            EXPECT_TRUE(std::equal(sentMessages_.begin() + std::ptrdiff_t(from),
                                   sentMessages_.end(), client->messages.begin(),
                                   client->messages.end()))
                << what();
        }
        const FwNetState state = stateOf(server_->world);
        EXPECT_EQ(0u, state.packetsRefused) << what();
        EXPECT_EQ(0u, state.messagesLost) << what();
        EXPECT_LT(memoryMost, int64_t(24) << 20) << what();
        // 29 kB/s of changes for ten seconds; a smaller rate must be reported as overload.
        if (cell_.rate <= 10000) {
            EXPECT_TRUE(overloaded) << what();
        }
    }
    [[nodiscard]] uint32_t resyncs() { return stateOf(server_->world).resyncs; }
    [[nodiscard]] std::string what() {
        const FwNetState state = stateOf(server_->world);
        char text[400];
        std::snprintf(text, sizeof text,
                      "delay %.2f s, loss %.0f %%, %.0f bytes/s: %.0f s session, settled after "
                      "%.1f s, %u resyncs, overloaded %d, most behind %.1f s, %llu kB out, memory "
                      "%lld kB",
                      cell_.delay, 100 * cell_.loss, cell_.rate, cell_.seconds, settled,
                      state.resyncs, int(overloaded), mostBehind,
                      static_cast<unsigned long long>(state.bytesOut / 1024),
                      static_cast<long long>(memoryMost / 1024));
        std::string all = text;
        for (const auto& client : clients_) {
            const FwNetState own = stateOf(client->world->world);
            const FwNetState theirs = stateOf(server_->world, client->peer);
            std::snprintf(text, sizeof text,
                          "; client: phase %u (%u at the server), step %llu of %llu, %u states, %u "
                          "strays, %u records, %u refused, %zu of %zu messages",
                          own.phase, theirs.phase, static_cast<unsigned long long>(own.step),
                          static_cast<unsigned long long>(state.step), own.states, own.desyncs,
                          own.records, uint32_t(own.packetsRefused + theirs.packetsRefused),
                          client->messages.size(), sentMessages_.size());
            all += text;
        }
        return all;
    }

    bool overloaded = false;  // the server has reported that a rate cannot carry its changes
    double mostBehind = 0, settled = 0;  // s
    int64_t memoryMost = 0;              // bytes of the server, including its worlds

 private:
    static constexpr float kStep = 1.0f / 32;
    static constexpr double kSettleMost = 180;  // s
    struct Client {
        explicit Client(const NetModelCell& cell, uint32_t seed)
            : up(cell, seed), down(cell, seed + 1) {}
        std::unique_ptr<Panels> world;
        FwPeerId peer{};
        ModelLink up, down;
        std::vector<std::string> messages;
    };

    static void ok(FwWorld* world, FwResult result) { ASSERT_LE(0, result) << lastMessage(world); }
    static std::unique_ptr<Panels> make() {
        FwWorldDef def = fwDefaultWorldDef();
        def.flags = FW_WORLD_CONTACT;
        auto made = std::make_unique<Panels>(def, 20.0f, 48.0f);
        for (int i = 0; i < 2; ++i) (void)made->add(0.43f * float(i), 0, 0);
        return made;
    }
    static FwNetState stateOf(FwWorld* world, FwPeerId peer = {}) {
        FwNetState state{};
        state.structSize = sizeof state;
        ok(world, fwNet_GetState(world, peer, &state));
        return state;
    }
    void join() {
        const auto number = uint32_t(clients_.size());
        Client& client = *clients_.emplace_back(std::make_unique<Client>(cell_, 100 + 2 * number));
        client.world = make();
        const FwNetDef def = netDef(1000 + number);
        ok(client.world->world, fwNet_Join(client.world->world, &def));
        ok(server_->world, fwNet_AddPeer(server_->world, &client.peer));
    }
    uint32_t below(uint32_t n) { return uint32_t(random_()) % n; }
    // A match, water or wind every two seconds, a message every four; in the middle third a storm
    // of wind changes; at the end no commands.
    void act(uint32_t step, uint32_t steps) {
        FwWorld* world = server_->world;
        const uint32_t storm = steps / 3;
        if (step >= storm && step < storm + 320 && step % 8 == 0) {
            std::vector<float> velocities(3 * 8 * 8 * 8);
            for (float& x : velocities) x = 0.1f * float(below(40));
            FwWindGridDef grid = fwDefaultWindGridDef();
            std::fill(std::begin(grid.counts), std::end(grid.counts), 8u);
            grid.velocities = velocities.data();
            ok(world, fwWorld_SetWindGrid(world, &grid));
        }
        if (step > steps - steps / 8) return;
        if (step % 64 == 10) {
            FwIgnitionDef ball = fwDefaultIgnitionDef();
            ball.kind = step % 192 == 10 ? FW_EXTINGUISH : FW_IGNITE;
            ball.position[0] = 0.01f * float(below(83));
            ball.position[2] = 0.01f * float(below(20));
            ball.radius = 0.03f;
            ok(world, fwWorld_Ignite(world, &ball, nullptr));
        }
        if (step % 64 == 42) {
            const float wind[3] = {0.1f * float(below(20)), 0, 0.1f * float(below(20))};
            ok(world, fwWorld_SetWind(world, wind));
        }
        if (step % 128 == 77) {
            const std::string text =
                "message " + std::to_string(step) + std::string(below(300), '.');
            ok(world, fwNet_SendMessage(world, text.data(), uint32_t(text.size())));
            sentMessages_.push_back(text);
        }
    }
    void take(FwWorld* world, FwPeerId to, ModelLink& link) {
        for (int i = 0; i < 10000; ++i) {
            Bytes bytes(1400);
            auto size = uint32_t(bytes.size());
            const FwResult result = fwNet_Write(world, to, bytes.data(), &size);
            ok(world, result);
            if (result != FW_OK) return;
            bytes.resize(size);
            link.send(std::move(bytes), now_);
        }
        ADD_FAILURE() << "packets do not end";
    }
    void pass() {
        now_ += double(kStep);
        ok(server_->world, fwNet_Update(server_->world, kStep));
        for (const auto& client : clients_) {
            FwWorld* world = client->world->world;
            take(server_->world, client->peer, client->down);
            client->down.deliver(now_, [&](const Bytes& bytes) {
                ok(world, fwNet_Read(world, {}, bytes.data(), uint32_t(bytes.size())));
            });
            ok(world, fwNet_Update(world, kStep));
            FwNetAction turn{};
            turn.structSize = sizeof turn;
            for (int i = 0; i < 1000; ++i) {
                ok(world, fwNet_NextAction(world, &turn));
                if (turn.kind == FW_NET_ACTION_WAIT) break;
                if (turn.kind == FW_NET_ACTION_STEP) ok(world, fwWorld_Step(world, turn.deltaTime));
                if (turn.kind == FW_NET_ACTION_MESSAGE)
                    client->messages.emplace_back(turn.message, turn.message + turn.messageSize);
            }
            take(world, {}, client->up);
            client->up.deliver(now_, [&](const Bytes& bytes) {
                ok(server_->world,
                   fwNet_Read(server_->world, client->peer, bytes.data(), uint32_t(bytes.size())));
            });
        }
    }
    void watch() {
        memoryMost = std::max<int64_t>(memoryMost, server_->host.bytes);
        overloaded |= stateOf(server_->world).overloaded > 0;
        for (const auto& client : clients_) {
            const FwNetState state = stateOf(server_->world, client->peer);
            if (state.phase == FW_NET_FOLLOWING)
                mostBehind = std::max(mostBehind, double(state.behind));
        }
    }
    bool together() {
        const uint64_t step = stateOf(server_->world).step;
        return std::all_of(clients_.begin(), clients_.end(), [&](const auto& client) {
            const FwNetState state = stateOf(client->world->world);
            return state.phase == FW_NET_FOLLOWING && state.records == 0 && state.step == step &&
                   stateOf(server_->world, client->peer).records == 0;
        });
    }

    NetModelCell cell_;
    std::unique_ptr<Panels> server_;
    std::vector<std::unique_ptr<Client>> clients_;
    std::vector<std::string> sentMessages_;
    std::mt19937 random_{3};
    double now_ = 0;
};

}  // namespace host
