// One fire on two machines. The server burns a yard of crates. The client starts itself, joins
// late, and receives packets over a connection that loses a fifth of them. The host's actions
// (matches, water, a puff, wind) travel as events; both sides compute the burn. At the end both
// hashes of all texels must agree.
#include "common/yard.h"
#include "wire.h"

#include <flamewright/flamewright_debug.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <thread>

namespace {

constexpr uint32_t kStepsPerSecond = 32;
constexpr float kStep = 1.0f / kStepsPerSecond;
constexpr double kPatience = 30;  // s without the peer

struct Settings {
    uint32_t crates = 36, steps = 12 * kStepsPerSecond, seed = 1;
    uint16_t port = 0;  // of the server, for a client; 0: this process is the server
    WireWeather weather;
    std::string out;
};

constexpr const char* kUsage =
    "usage: 12_multiplayer [--crates N] [--frames N] [--seconds N] [--seed N] [--loss PERCENT]\n"
    "                      [--delay MILLISECONDS] [--out DIR]\n"
    "  --crates N   [1, 1000], default 36\n"
    "  --frames N   the server's steps of 1/32 s; default 384\n"
    "  --loss P     [0, 90] of packets that are lost each way; default 20\n"
    "  --delay M    [0, 500] ms that a packet is under way at most; default 120\n"
    "  --out DIR    leave DIR/server.txt and DIR/client.txt: step and hash\n"
    "  --port P     be the client of the server at this port (it starts its own)\n";

Settings readArguments(int count, char** arguments) {
    Settings settings;
    for (int i = 1; i < count; ++i) {
        const std::string name = arguments[i];
        if (name == "--headless") continue;  // it never opens a window
        if (i + 1 == count) throw std::runtime_error(name + " has no value, or is not known");
        const char* value = arguments[++i];
        if (name == "--crates") {
            settings.crates = wholeOf(name, value, 1, 1000);
        } else if (name == "--frames") {
            settings.steps = wholeOf(name, value, 1, 1000000);
        } else if (name == "--seconds") {
            settings.steps = kStepsPerSecond * wholeOf(name, value, 1, 30000);
        } else if (name == "--seed") {
            settings.seed = wholeOf(name, value, 0, 0x7FFFFFFF);
        } else if (name == "--loss") {
            settings.weather.loss = wholeOf(name, value, 0, 90) / 100.0;
        } else if (name == "--delay") {
            settings.weather.latest = wholeOf(name, value, 0, 500) / 1000.0;
            settings.weather.soonest = settings.weather.latest / 6;
        } else if (name == "--port") {
            settings.port = uint16_t(wholeOf(name, value, 1, 65535));
        } else if (name == "--out") {
            settings.out = value;
        } else if (name != "--size") {
            throw std::runtime_error(name + " is not known; --help lists the arguments");
        }
    }
    return settings;
}

// A world with a yard on the cpu backend, equal on both sides.
class Side {
 public:
    explicit Side(const Settings& settings)
        : settings_(settings),
          isServer_(settings.port == 0),
          wire_(0, settings.weather, settings.seed * 2 + (isServer_ ? 0 : 1)),
          start_(Clock::now()) {
        FwContextDef contextDef = fwDefaultContextDef();
        contextDef.backend = FW_BACKEND_CPU;
        FwErrorInfo error{};
        if (fwCreateContext(&contextDef, &context_, &error) != FW_OK)
            throw std::runtime_error(error.message);
        FwWorldDef def = fwDefaultWorldDef();
        def.flags = FW_WORLD_RADIATION | FW_WORLD_PLUME | FW_WORLD_CONTACT | FW_WORLD_EMBERS;
        def.paceFactor = 10;
        def.seed = settings.seed;
        def.wind[0] = 2;
        if (fwCreateWorld(context_, &def, &world_) != FW_OK) {
            char why[512] = "";
            fwContext_GetLastMessage(context_, why, sizeof why);
            fwDestroyContext(context_);
            throw std::runtime_error(why);
        }
        yard_ = makeYard(world_, settings.crates);
        FwNetDef net = fwDefaultNetDef();
        net.token = std::random_device{}() | 1;
        check(isServer_ ? fwNet_Serve(world_, &net) : fwNet_Join(world_, &net));
    }
    virtual ~Side() { fwDestroyContext(context_); }
    Side(const Side&) = delete;
    Side& operator=(const Side&) = delete;

 protected:
    using Clock = std::chrono::steady_clock;

    void check(FwResult result) const { ::check(result, world_); }
    [[nodiscard]] double seconds() const {
        return std::chrono::duration<double>(Clock::now() - start_).count();
    }
    [[nodiscard]] FwNetState state() const {
        FwNetState state{};
        state.structSize = sizeof state;
        check(fwNet_GetState(world_, {}, &state));
        return state;
    }
    // Receives packets: take(port, bytes, size).
    template <class Take>
    void exchange(double now, const Take& take) {
        unsigned char room[1400];
        uint16_t from = 0;
        while (const size_t came = wire_.receive(room, sizeof room, from))
            take(from, room, uint32_t(came));
        check(fwNet_Update(world_, float(std::min(now - before_, 10.0))));
        before_ = now;
    }
    void send(FwPeerId peer, uint16_t to, double now) {
        for (;;) {
            unsigned char room[1400];
            uint32_t size = sizeof room;
            const FwResult result = fwNet_Write(world_, peer, room, &size);
            check(result);
            if (result == FW_NOT_READY) break;
            wire_.send(to, room, size, now);
        }
        wire_.flush(now);
    }
    // Hashes every texel of every crate.
    [[nodiscard]] std::string hash() const {
        char text[64];
        std::snprintf(text, sizeof text, "%016llx",
                      static_cast<unsigned long long>(hashOf(world_, yard_)));
        return text;
    }
    void leave(const std::string& hash) const {
        const FwNetState end = state();
        std::printf("%s: step %llu, hash %s; %llu bytes out, %llu in\n",
                    isServer_ ? "server" : "client", static_cast<unsigned long long>(end.step),
                    hash.c_str(), static_cast<unsigned long long>(end.bytesOut),
                    static_cast<unsigned long long>(end.bytesIn));
        std::fflush(stdout);
        if (settings_.out.empty()) return;
        std::filesystem::create_directories(settings_.out);
        std::ofstream file(std::filesystem::path(settings_.out) /
                           (isServer_ ? "server.txt" : "client.txt"));
        file << end.step << ' ' << hash << '\n';
        if (!file.flush()) throw std::runtime_error(settings_.out + " cannot be written");
    }

    Settings settings_;
    bool isServer_;
    Wire wire_;
    FwContext* context_ = nullptr;
    FwWorld* world_ = nullptr;
    Yard yard_;

 private:
    Clock::time_point start_;
    double before_ = 0;
};

class Server : public Side {
 public:
    using Side::Side;
    [[nodiscard]] uint16_t port() const { return wire_.port(); }

    // Returns true if the client reached the end.
    bool run() {
        uint32_t step = 0;
        std::string message;
        double heard = 0;
        for (;;) {
            const double now = seconds();
            for (; step < settings_.steps && double(step) * double(kStep) <= now; ++step) {
                act(step);
                check(fwWorld_Step(world_, kStep));
            }
            // The last that it says, to a client that is there.
            if (step == settings_.steps && message.empty() && follows()) {
                message = hash();
                check(fwNet_SendMessage(world_, message.data(), uint32_t(message.size())));
                leave(message);
                heard = now;
            }
            exchange(now, [&](uint16_t from, const void* packet, uint32_t size) {
                if (client_ == 0) {
                    check(fwNet_AddPeer(world_, &peer_));
                    client_ = from;
                }
                if (from != client_) return;
                if (fwNet_Read(world_, peer_, packet, size) == FW_OK) {
                    greeted_ = true;
                } else if (!greeted_) {  // a packet of a stranger: the slot stays free
                    check(fwNet_RemovePeer(world_, peer_));
                    client_ = 0;
                }
            });
            if (client_ != 0) send(peer_, client_, now);
            if (!message.empty() && state().records == 0) return true;
            if (step < settings_.steps) heard = now;
            if (now - heard > kPatience) return false;
            std::this_thread::sleep_for(std::chrono::milliseconds(4));
        }
    }

 private:
    [[nodiscard]] bool follows() const {
        if (client_ == 0) return false;
        FwNetState state{};
        state.structSize = sizeof state;
        check(fwNet_GetState(world_, peer_, &state));
        return state.phase == FW_NET_FOLLOWING;
    }
    // Ignites a crate every quarter of a second, wets some, extinguishes one half way, turns the
    // wind.
    void act(uint32_t step) {
        if (step % 8 == 0 && step / 8 < yard_.crates.size()) lightCrate(world_, yard_, step / 8);
        if (step % 40 == 39) douse(step / 40, step % 80 == 39 ? FW_WET : FW_EXTINGUISH);
        if (step % 64 == 63) {
            const float wind[3] = {2 * std::cos(0.05f * float(step)), 0,
                                   2 * std::sin(0.05f * float(step))};
            check(fwWorld_SetWind(world_, wind));
        }
    }
    void douse(uint32_t crate, uint32_t kind) {
        if (crate >= yard_.crates.size()) return;
        FwIgnitionDef ball = fwDefaultIgnitionDef();
        ball.kind = kind;
        ball.object = yard_.crates[crate];
        placeOf(yard_, crate, ball.position);
        ball.position[0] += 0.25f;
        ball.position[1] += 0.1f;
        ball.radius = 0.12f;
        check(fwWorld_Ignite(world_, &ball, nullptr));
    }

    FwPeerId peer_{};
    uint16_t client_ = 0;
    bool greeted_ = false;  // has received a valid client packet
};

class Client : public Side {
 public:
    using Side::Side;

    // Returns true if the server's last message equals this world's hash.
    bool run() {
        double progress = 0;
        uint64_t step = 0;
        bool followed = false, equal = false, done = false;
        double doneAt = 0;
        for (;;) {
            const double now = seconds();
            // The library rejects a damaged packet; the server sends it again.
            exchange(now, [&](uint16_t from, const void* packet, uint32_t size) {
                if (from == settings_.port) (void)fwNet_Read(world_, {}, packet, size);
            });
            FwNetAction turn{};
            turn.structSize = sizeof turn;
            for (;;) {
                check(fwNet_NextAction(world_, &turn));
                if (turn.kind == FW_NET_ACTION_WAIT) break;
                if (turn.kind == FW_NET_ACTION_STEP) {
                    check(fwWorld_Step(world_, turn.deltaTime));
                    continue;
                }
                const std::string message(turn.message, turn.message + turn.messageSize);
                const std::string mine = hash();
                leave(mine);
                equal = message == mine;
                done = true;
                doneAt = now;
            }
            const FwNetState at = state();
            if (!followed && at.phase == FW_NET_FOLLOWING) {
                followed = true;
                std::printf("client: joined at step %llu\n",
                            static_cast<unsigned long long>(at.step));
            }
            if (at.step != step || !followed) step = at.step, progress = now;
            send({}, settings_.port, now);
            // Continue briefly, so that the server receives the acknowledgement.
            if (done && now - doneAt > 2) return equal;
            if (!done && (now - progress > kPatience || double(at.silent) > kPatience))
                throw std::runtime_error("the server is silent");
            std::this_thread::sleep_for(std::chrono::milliseconds(4));
        }
    }
};

// Starts this program again, as the client of a port.
pid_t startClient(int count, char** arguments, uint16_t port) {
    const pid_t child = fork();
    if (child != 0) return child;
    std::string value = std::to_string(port), name = "--port";
    std::vector<char*> all(arguments, arguments + count);
    all.push_back(name.data());
    all.push_back(value.data());
    all.push_back(nullptr);
    execv("/proc/self/exe", all.data());
    _exit(127);
}

bool serve(const Settings& settings, int count, char** arguments) {
    Server server(settings);
    const pid_t client = startClient(count, arguments, server.port());
    if (client < 0) throw std::runtime_error("the client cannot be started");
    const bool heard = server.run();
    int status = 0;
    waitpid(client, &status, 0);
    const bool equal = heard && WIFEXITED(status) && WEXITSTATUS(status) == 0;
    std::puts(equal ? "both burn alike" : "the worlds differ");
    return equal;
}

}  // namespace

int main(int count, char** arguments) {
    for (int i = 1; i < count; ++i)
        if (std::strcmp(arguments[i], "--help") == 0) return std::puts(kUsage), 0;
    try {
        const Settings settings = readArguments(count, arguments);
        return (settings.port == 0 ? serve(settings, count, arguments) : Client(settings).run())
                   ? 0
                   : 1;
    } catch (const std::exception& failure) {
        std::fprintf(stderr, "12_multiplayer: %s\n", failure.what());
        return 1;
    }
}
