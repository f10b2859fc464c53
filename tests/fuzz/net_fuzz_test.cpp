// Networks of random hosts: calls in any order; packets lost, late, repeated, reordered, damaged,
// forged or sent to another peer; clients that join, leave and diverge; servers that load, leave
// and serve again. Nothing crashes, every refusal has a message, and afterwards all worlds burn bit
// for bit alike. Fixed seeds.
#include "abi/net_session.h"

#include <algorithm>
#include <limits>

namespace {

using namespace host;

class Storm {
 public:
    explicit Storm(uint32_t seed) : random_(seed) {
        server_ = std::make_unique<BusyWorld>(FW_BACKEND_CPU, 12.0f, kThings);
        serve();
        for (uint32_t i = 0; i < kClients; ++i) {
            Party& party = parties_.emplace_back();
            party.world = std::make_unique<BusyWorld>(FW_BACKEND_CPU, 12.0f, kThings);
            party.up.random.seed(seed * 10 + i);
            party.down.random.seed(seed * 10 + i + 5);
            party.up.loss = party.down.loss = 0.3;
            party.up.latest = party.down.latest = 0.4;
        }
        save_ = server_->save();
    }

    void blow(int rounds) {
        for (int i = 0; i < rounds; ++i) {
            server_->run(frame_, frame_ + 1);
            ++frame_;
            if (once(2)) serverActs();
            for (Party& party : parties_)
                if (once(3)) clientActs(party);
            pass(BusyWorld::timeOf(frame_), true);
        }
    }

    // Removed clients join again; then the wire is good, and hosts behave.
    void calm() {
        if (stateOf(server_->world).role != FW_NET_SERVER) serve();
        for (Party& party : parties_) {
            party.up.packets.clear(), party.down.packets.clear();
            party.up.loss = party.down.loss = 0.05;
            if (party.peer.index1 != 0) (void)fwNet_RemovePeer(server_->world, party.peer);
            ASSERT_EQ(FW_OK, fwNet_AddPeer(server_->world, &party.peer))
                << lastMessage(server_->world);
            (void)fwNet_Leave(party.world->world);
            join(party);
        }
        // Longer than the period of each object's hash.
        for (int i = 0; i < 200; ++i) {
            server_->run(frame_, frame_ + 1);
            ++frame_;
            pass(BusyWorld::timeOf(frame_), false);
        }
        for (int i = 0; i < 400 && !together(); ++i) pass(1.0 / 32, false);
        ASSERT_TRUE(together());
        const uint64_t hash = server_->hash();
        for (Party& party : parties_) EXPECT_EQ(hash, party.world->hash());
    }

    uint32_t refusals = 0, read = 0, heals = 0;

 private:
    static constexpr uint32_t kThings = 3, kClients = 2;
    struct Party {
        std::unique_ptr<BusyWorld> world;
        FwPeerId peer{};
        Wire up, down;
    };

    uint32_t below(uint32_t n) { return uint32_t(random_()) % n; }
    bool once(uint32_t in) { return below(in) == 0; }
    float number() {
        if (once(12)) return std::numeric_limits<float>::quiet_NaN();
        if (once(12)) return 1e30f;
        return float(below(2000)) / 1000.0f - 1.0f;
    }
    // A valid result: success, not ready, or a failure with a message.
    void heard(FwWorld* world, FwResult result) {
        if (result >= 0) return;
        ++refusals;
        EXPECT_TRUE(result == FW_ERROR_INVALID_ARGUMENT || result == FW_ERROR_BAD_DATA ||
                    result == FW_ERROR_VERSION || result == FW_ERROR_STALE_ID)
            << fwResultName(result);
        EXPECT_FALSE(lastMessage(world).empty());
    }
    static FwNetState stateOf(FwWorld* world) {
        FwNetState state{};
        state.structSize = sizeof state;
        EXPECT_EQ(FW_OK, fwNet_GetState(world, {}, &state)) << lastMessage(world);
        return state;
    }
    void serve() {
        const FwNetDef def = netDef(++tokens_);
        heard(server_->world, fwNet_Serve(server_->world, &def));
        for (Party& party : parties_) party.peer = {};
    }
    void join(Party& party) {
        const FwNetDef def = netDef(++tokens_);
        heard(party.world->world, fwNet_Join(party.world->world, &def));
    }
    FwPeerId anyPeer() {
        if (once(4)) return {below(5), below(4)};
        return parties_[below(kClients)].peer;
    }
    Bytes anyPacket() {
        Bytes bytes(below(once(10) ? 3000u : 1400u));
        for (unsigned char& byte : bytes) byte = (unsigned char)below(256);
        return bytes;
    }

    // Commands on the burn; a client refuses them.
    void changeBurn(BusyWorld& w) {
        FwIgnitionDef ball = fwDefaultIgnitionDef();
        ball.kind = below(4);
        ball.water = number() * 50;
        ball.radius = std::abs(number()) * 0.2f;
        for (float& x : ball.position) x = number();
        const float at[3] = {number(), number(), number()};
        uint32_t texels = 0;
        FwResult result = FW_OK;
        switch (below(7)) {
            case 0:
                result = fwWorld_Ignite(w.world, &ball, &texels);
                break;
            case 1:
                result = fwWorld_SetWind(w.world, at);
                break;
            case 2:
                result =
                    fwWorld_SetFlags(w.world, below(2) ? uint32_t(FW_WORLD_CONTACT) : below(64));
                break;
            case 3:
                result = fwWorld_MoveVolumetricFire(w.world, w.fire, at);
                break;
            case 4:
                result = fwWorld_SetFireEmitterPower(w.world, w.jet, 200 * number());
                break;
            case 5:
                result = fwWorld_MoveFireEmitter(w.world, w.jet, at, once(2) ? at : nullptr);
                break;
            default:
                result = fwWorld_SetParticleFieldAmount(w.world, w.field, number());
                break;
        }
        heard(w.world, result);
    }

    void serverActs() {
        FwWorld* world = server_->world;
        Party& party = parties_[below(kClients)];
        switch (below(12)) {
            case 0:
                if (party.peer.index1 == 0 || once(4))
                    heard(world, fwNet_AddPeer(world, &party.peer));
                break;
            case 1:
                heard(world, fwNet_RemovePeer(world, anyPeer()));
                break;
            case 2: {
                const Bytes text = anyPacket();
                heard(world, fwNet_SendMessage(world, text.data(), uint32_t(text.size())));
                break;
            }
            case 3:
                if (once(6)) heard(world, fwNet_Leave(world));
                break;
            case 4:
                serveIfNot();
                break;
            case 5:
                if (once(4)) heard(world, fwWorld_Load(world, save_.data(), save_.size()));
                break;
            case 6:
                heard(world, fwNet_Update(world, number()));
                break;
            case 7: {
                FwNetAction turn{};
                turn.structSize = once(2) ? sizeof turn : below(2000);
                heard(world, fwNet_NextAction(world, &turn));
                break;
            }
            case 8: {
                const Bytes bytes = anyPacket();
                heard(world, fwNet_Read(world, anyPeer(), bytes.data(), uint32_t(bytes.size())));
                break;
            }
            default:
                changeBurn(*server_);
                break;
        }
    }
    void serveIfNot() {
        if (stateOf(server_->world).role == FW_NET_NONE) return serve();
        const FwNetDef def = netDef(1);
        const FwResult result = fwNet_Serve(server_->world, &def);
        EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, result);
        heard(server_->world, result);
    }

    void clientActs(Party& party) {
        FwWorld* world = party.world->world;
        switch (below(10)) {
            case 0:
                if (once(5)) heard(world, fwNet_Leave(world));
                break;
            case 1:
                join(party);
                break;
            case 2:
                heard(world, fwWorld_Step(world, std::abs(number())));
                break;  // any command
            case 3:
                heard(world, fwWorld_Load(world, save_.data(), save_.size()));
                break;
            case 4:
                heard(world, fwNet_AddPeer(world, nullptr));
                break;
            case 5:
                heard(world, fwNet_Update(world, number()));
                break;
            case 6: {  // its world diverges by itself
                const uint32_t texels[] = {below(400), below(400)};
                const FwBurnableMeshId id = party.world->ids[below(kThings)];
                heard(world, fwDebug_PushTexels(world, id, FW_IGNITE, texels, 2));
                break;
            }
            case 7: {
                const Bytes bytes = anyPacket();
                heard(world, fwNet_Read(world, {}, bytes.data(), uint32_t(bytes.size())));
                break;
            }
            default:
                changeBurn(*party.world);
                break;
        }
    }

    // Packets to send, some damaged or sent to another peer.
    void send(FwWorld* world, FwPeerId to, Wire& wire, Wire& wrong, bool wild) {
        for (int i = 0; i < 200; ++i) {
            Bytes bytes(1400);
            auto size = uint32_t(bytes.size());
            const FwResult result = fwNet_Write(world, to, bytes.data(), &size);
            if (result != FW_OK) return heard(world, result);
            bytes.resize(size);
            if (wild && once(15)) bytes[below(size)] ^= (unsigned char)(1u << below(8));
            if (wild && once(20)) bytes.resize(below(size));
            (wild && once(20) ? wrong : wire).send(bytes, now_);
        }
    }
    void take(FwWorld* world, FwPeerId from, Wire& wire) {
        wire.deliver(now_, [&](const Bytes& bytes) {
            const unsigned char none = 0;
            heard(world, fwNet_Read(world, from, bytes.empty() ? &none : bytes.data(),
                                    uint32_t(bytes.size())));
            ++read;
        });
    }
    void pass(double seconds, bool wild) {
        now_ += seconds;
        heard(server_->world, fwNet_Update(server_->world, float(seconds)));
        for (Party& party : parties_) {
            Party& other = parties_[wild ? below(kClients) : 0];
            if (party.peer.index1 != 0)
                send(server_->world, party.peer, party.down, other.up, wild);
            take(party.world->world, {}, party.down);
            go(party, seconds, wild);
            send(party.world->world, {}, party.up, other.down, wild);
            take(server_->world, party.peer, party.up);
        }
    }
    void go(Party& party, double seconds, bool wild) {
        FwWorld* world = party.world->world;
        heard(world, fwNet_Update(world, float(seconds)));
        FwNetAction turn{};
        turn.structSize = sizeof turn;
        for (int i = 0; i < 100; ++i) {
            const FwResult result = fwNet_NextAction(world, &turn);
            heard(world, result);
            if (result != FW_OK || turn.kind == FW_NET_ACTION_WAIT) return;
            if (turn.kind != FW_NET_ACTION_STEP) continue;
            if (wild && once(20)) continue;  // the host skips an update
            heard(world, fwWorld_Step(world, turn.deltaTime));
        }
    }
    bool together() {
        const uint64_t step = stateOf(server_->world).step;
        return std::all_of(parties_.begin(), parties_.end(), [&](const Party& party) {
            const FwNetState state = stateOf(party.world->world);
            heals = std::max(heals, state.desyncs);
            return state.phase == FW_NET_FOLLOWING && state.records == 0 && state.step == step;
        });
    }

    std::mt19937 random_;
    std::unique_ptr<BusyWorld> server_;
    std::vector<Party> parties_;
    Bytes save_;
    uint32_t frame_ = 0, tokens_ = 100;
    double now_ = 0;
};

TEST(NetFuzz, RandomHostsNeitherCrashNorDivergeSilently) {
    uint32_t refusals = 0, read = 0;
    for (uint32_t seed = 1; seed <= 8; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Storm storm(seed);
        storm.blow(160);
        storm.calm();
        refusals += storm.refusals;
        read += storm.read;
    }
    EXPECT_GT(refusals, 500u);
    EXPECT_GT(read, 1000u);
    std::printf("%u packets read, %u calls refused\n", read, refusals);
}

}  // namespace
