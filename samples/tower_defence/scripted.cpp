#include "scripted.h"

#include <cinttypes>
#include <cstdio>
#include <ctime>
#include <memory>

#include "common/options.h"
#include "game/bot.h"
#include "rewind.h"
#include "siege.h"
#include "world_def.h"

namespace tower {

int playScripted(const ScriptedGame& wanted) {
    const Battlefield field = makeBattlefield(wanted.seed);
    FwContextDef contextDef = fwDefaultContextDef();
    contextDef.backend = wanted.server ? FW_BACKEND_CPU : FW_BACKEND_VULKAN;
    FwContext* made = nullptr;
    FwErrorInfo error{};
    if (fwCreateContext(&contextDef, &made, &error) != FW_OK)
        throw sample::Failure(std::string("fwCreateContext: ") + error.message);
    const std::unique_ptr<FwContext, decltype(&fwDestroyContext)> context(made, &fwDestroyContext);
    const FwWorldDef worldDef = villageWorld(wanted.seed, wanted.pace);
    FwWorld* world = nullptr;
    if (fwCreateWorld(context.get(), &worldDef, &world) != FW_OK)
        throw sample::Failure("fwCreateWorld failed");
    FireVillage fires(context.get(), world, field.scene, nullptr);
    Siege siege(world, fires, field, game::newGame(wanted.seed));

    // Four ticks per step: an eighth of a second, the interval of inter-object heat transfer.
    constexpr int32_t kTicks = 4;
    // Late enough that objects burn, enemies have fallen and new ones use their slots.
    constexpr int32_t kRewindAt = 18 * game::kTicksPerSecond;
    Rewind rewind(world, siege);
    bool rewinds = wanted.rewind;
    const std::clock_t began = std::clock();
    uint32_t steps = 0;
    const game::State& state = siege.state();
    while (state.outcome == game::Outcome::kPlaying &&
           (wanted.waves == 0 || state.wave < wanted.waves)) {
        siege.give(game::botsOrder(state));
        siege.advance(kTicks);
        if (wanted.rewind) rewind.remember();
        checkFire(world, fwWorld_Step(world, kTicks * kTickSeconds), "fwWorld_Step");
        ++steps;
        if (rewinds && state.tick >= kRewindAt) {
            rewinds = false;
            const int32_t from = state.tick;
            rewind.goBack();
            std::fprintf(stderr, "rewind: %d ticks, %.1f ms, %zu KB a snapshot, saved in %.1f ms\n",
                         from - state.tick, 1e3 * rewind.loadSeconds,
                         rewind.bytes() / rewind.snapshotCount() / 1024, 1e3 * rewind.fetchSeconds);
        }
    }
    if (wanted.rewind && rewinds)
        throw sample::Failure("the game was over before it could be rewound");
    const char* outcome = state.outcome == game::Outcome::kLost  ? "lost"
                          : state.outcome == game::Outcome::kWon ? "won"
                                                                 : "stopped";
    std::printf(
        "game: %s, score %d, lives %d, waves %d, felled %d, village %d of 1000, hash %016" PRIx64
        "\n",
        outcome, game::score(state), state.lives, state.wave, state.felled, game::standing(state),
        game::hashOf(state));
    std::fprintf(stderr, "%u steps, %.1f ms of processor time each\n", steps,
                 1e3 * double(std::clock() - began) / CLOCKS_PER_SEC / steps);
    return 0;
}

}  // namespace tower
