// A dedicated server: crates burn at 32 Hz on one core, with the same integers as on any GPU.
// Prints a line per second: burning crates, cost, and the hash, which a client compares with its
// own. Links only the library. --baked burns one crate in advance; the others play it until heat of
// their neighbours makes them live.
#include "common/yard.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <thread>

namespace {

constexpr uint32_t kStepsPerSecond = 32;
constexpr float kStep = 1.0f / kStepsPerSecond;

struct Settings {
    uint32_t crates = 100, steps = 20 * kStepsPerSecond, seed = 1;
    bool fast = false;  // ignores the clock
    bool baked = false;
    std::string out;
};

constexpr const char* kUsage =
    "usage: 13_server [--crates N] [--frames N] [--seconds N] [--seed N] [--fast] [--baked] [--out "
    "DIR]\n"
    "  --crates N   [1, 1000] how many burn; default 100\n"
    "  --frames N   steps of 1/32 s; default 640\n"
    "  --fast       as fast as it can instead of in real time\n"
    "  --baked      crates play a burn baked of one until something disturbs them\n"
    "  --out DIR    leave DIR/server.fwsave at the end\n";

Settings readArguments(int count, char** arguments) {
    Settings settings;
    for (int i = 1; i < count; ++i) {
        const std::string name = arguments[i];
        if (name == "--fast") {
            settings.fast = true;
            continue;
        }
        if (name == "--baked") {
            settings.baked = true;
            continue;
        }
        if (name == "--headless") continue;  // as in all samples: it never opens a window
        if (i + 1 == count) throw std::runtime_error(name + " has no value, or is not known");
        const char* value = arguments[++i];
        if (name == "--crates") {
            settings.crates = wholeOf("--crates", value, 1, 1000);
        } else if (name == "--frames") {
            settings.steps = wholeOf("--frames", value, 1, 1000000);
        } else if (name == "--seconds") {
            settings.steps = kStepsPerSecond * wholeOf("--seconds", value, 1, 30000);
        } else if (name == "--seed") {
            settings.seed = wholeOf("--seed", value, 0, 0x7FFFFFFF);
        } else if (name == "--out") {
            settings.out = value;
        } else if (name != "--size") {
            throw std::runtime_error(name + " is not known; --help lists the arguments");
        }
    }
    return settings;
}

// Processor time of all threads of the process.
double cpuSeconds() { return double(std::clock()) / CLOCKS_PER_SEC; }

void save(FwWorld* world, const std::string& folder) {
    uint64_t size = 0;
    check(fwWorld_RequestSave(world), world);
    check(fwWorld_Step(world, 0), world);  // a save takes the next frame (deltaTime may be 0)
    check(fwWorld_FetchSave(world, nullptr, &size), world);
    std::string bytes(size, '\0');
    check(fwWorld_FetchSave(world, bytes.data(), &size), world);
    std::filesystem::create_directories(folder);
    const std::filesystem::path path = std::filesystem::path(folder) / "server.fwsave";
    std::ofstream file(path, std::ios::binary);
    if (!file.write(bytes.data(), std::streamsize(bytes.size())).flush())
        throw std::runtime_error(path.string() + " cannot be written");
    std::printf("%s: %zu bytes, with which a client joins late\n", path.c_str(), bytes.size());
}

// Burns a single crate for a minute in a world like the server's. Returns the burn as bytes.
std::string bakeCrate(FwWorld* world) {
    const Yard yard = makeYard(world, 1);
    lightCrate(world, yard, 0);
    for (uint32_t step = 0; step < 60 * kStepsPerSecond; ++step)
        check(fwWorld_Step(world, kStep), world);
    uint64_t size = 0;
    check(fwWorld_RequestBurn(world, yard.crates[0]), world);
    check(fwWorld_FetchBurn(world, yard.crates[0], nullptr, &size), world);
    std::string bytes(size, '\0');
    check(fwWorld_FetchBurn(world, yard.crates[0], bytes.data(), &size), world);
    return bytes;
}

// `burn`: a baked burn for the crates; null: ignite them.
void serve(FwWorld* world, const Yard& yard, FwBurnId burn, const Settings& settings) {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point start = Clock::now();
    double spent = 0, worst = 0, all = 0;  // s: in this second, longest step, whole run
    uint32_t lit = 0;
    for (uint32_t step = 0; step < settings.steps; ++step) {
        // Ignite all of them within two seconds.
        for (; lit < yard.crates.size() && lit * 2 * kStepsPerSecond <= step * yard.crates.size();
             ++lit)
            if (burn.index1 != 0)
                check(fwWorld_PlayBurn(world, yard.crates[lit], burn, 0, 1), world);
            else
                lightCrate(world, yard, lit);
        const double before = cpuSeconds();
        check(fwWorld_Step(world, kStep), world);
        const double took = cpuSeconds() - before;
        spent += took, all += took;
        worst = std::max(worst, took);
        FwEvent events[64];
        while (fwWorld_PollEvents(world, events, 64) == 64) {
        }
        if ((step + 1) % kStepsPerSecond == 0) {
            const YardState state = stateOf(world, yard);
            std::printf(
                "%5.0f s: %3u burn, %3u burnt, %3u play, %7.0f kW; load %4.1f %% of a core, "
                "longest "
                "step %5.2f ms; hash %016llx\n",
                double(step + 1) * kStep, state.burning, state.burnt, state.plays,
                double(state.power) / 1000, 100 * spent, 1000 * worst,
                static_cast<unsigned long long>(hashOf(world, yard)));
            std::fflush(stdout);
            spent = worst = 0;
        }
        if (!settings.fast)
            std::this_thread::sleep_until(
                start + std::chrono::duration_cast<Clock::duration>(
                            std::chrono::duration<double>(double(step + 1) * double(kStep))));
    }
    std::printf("%u steps of %zu crates: %.2f ms of the processor each, %.1f %% of a core\n",
                settings.steps, yard.crates.size(), 1000 * all / settings.steps,
                100 * all / (settings.steps * double(kStep)));
}

void run(const Settings& settings) {
    FwContextDef contextDef = fwDefaultContextDef();
    contextDef.backend = FW_BACKEND_CPU;
    FwContext* context = nullptr;
    FwErrorInfo error{};
    if (fwCreateContext(&contextDef, &context, &error) != FW_OK)
        throw std::runtime_error(error.message);
    const struct Owner {
        FwContext* context;
        ~Owner() { fwDestroyContext(context); }
    } owner{context};
    FwWorldDef def = fwDefaultWorldDef();
    def.flags = FW_WORLD_RADIATION | FW_WORLD_PLUME | FW_WORLD_CONTACT | FW_WORLD_EMBERS;
    def.paceFactor = 10;
    def.seed = settings.seed;
    def.wind[0] = 2;
    const auto createWorld = [&] {
        FwWorld* made = nullptr;
        if (fwCreateWorld(context, &def, &made) == FW_OK) return made;
        char why[512] = "";
        fwContext_GetLastMessage(context, why, sizeof why);
        throw std::runtime_error(why);
    };
    std::string baked;
    if (settings.baked) {
        FwWorld* alone = createWorld();  // the context destroys it if this throws
        baked = bakeCrate(alone);
        fwDestroyWorld(alone);
        std::printf("a crate's burn: %zu bytes\n", baked.size());
    }
    FwWorld* world = createWorld();
    const Yard yard = makeYard(world, settings.crates);
    FwBurnId burn{};
    if (settings.baked) check(fwWorld_CreateBurn(world, baked.data(), baked.size(), &burn), world);
    serve(world, yard, burn, settings);
    if (!settings.out.empty()) save(world, settings.out);
}

}  // namespace

int main(int count, char** arguments) {
    for (int i = 1; i < count; ++i)
        if (std::strcmp(arguments[i], "--help") == 0) return std::puts(kUsage), 0;
    try {
        run(readArguments(count, arguments));
    } catch (const std::exception& failure) {
        std::fprintf(stderr, "13_server: %s\n", failure.what());
        return 1;
    }
    return 0;
}
