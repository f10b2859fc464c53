// A day of game time in one world: the fire of the last hour burns as that of the first, costs as
// much, and memory does not grow. Minutes long, so only tests/run --long runs it.
#include "abi/abi_support.h"
#include "support/cpu_time.h"

#include <algorithm>
#include <numeric>

namespace {

using namespace host;
using fw::test::cpuSeconds;

struct Hour {
    float burning = 0;  // m^2, two minutes after the match
    double energy = 0;  // J, twenty minutes after it
    uint32_t ignited = 0, burntOut = 0;
    int64_t bytes = 0;
    double seconds = 0;  // of processor time
};

// Six boards stand side by side, one is lit, and all are taken away at the end.
class Day : public SheetWorld {
 public:
    Day() : SheetWorld(evenMaterial(0.01f, 240), 0.5f, 0.25f, 48, dayDef()) {
        ok(fwWorld_DestroyBurnableMesh(world, object));
    }

    Hour hour() {
        Hour made;
        const double start = cpuSeconds();
        std::vector<FwBurnableMeshId> boards;
        for (uint32_t i = 0; i < 6; ++i) {
            boards.push_back(add(i));
            float at[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0.1f * float(i + 1), 0, 1};
            ok(fwWorld_SetTransform(world, boards.back(), at));
        }
        ignite(boards[0], 0.1f, 0.1f, 0.1f);
        const auto count = [&](double seconds) {
            run(seconds, 0.125f);
            for (const FwEvent& event : poll()) {
                made.ignited += event.type == FW_EVENT_IGNITED;
                made.burntOut += event.type == FW_EVENT_BURNT_OUT;
            }
        };
        count(120);
        for (const FwBurnableMeshId id : boards) made.burning += HostedWorld::state(id).burningArea;
        count(1080);
        for (const FwBurnableMeshId id : boards) made.energy += HostedWorld::state(id).energy;
        count(2400);
        for (const FwBurnableMeshId id : boards) ok(fwWorld_DestroyBurnableMesh(world, id));
        run(0.125, 0.125f);
        made.bytes = host.bytes;
        made.seconds = cpuSeconds() - start;
        return made;
    }

 private:
    static FwWorldDef dayDef() {
        FwWorldDef def = worldDef(FW_WORLD_RADIATION | FW_WORLD_CONTACT | FW_WORLD_PLUME);
        def.seed = 3;
        return def;
    }
};

TEST(LongSession, DISABLED_ADayOfGameTime) {
    constexpr size_t kHours = 24;
    Day day;
    std::vector<Hour> hours;
    for (size_t i = 0; i < kHours && !HasFailure(); ++i) {
        hours.push_back(day.hour());
        const Hour& h = hours.back();
        std::printf("hour %2zu: %u lit, %u burnt out, %.4f m2, %.0f J, %lld bytes, %.2f s\n", i,
                    h.ignited, h.burntOut, double(h.burning), h.energy,
                    static_cast<long long>(h.bytes), h.seconds);
        EXPECT_EQ(h.ignited, 6u);
        EXPECT_EQ(h.burntOut, 6u);
        EXPECT_NEAR(h.burning, hours[0].burning, 0.01f * hours[0].burning);
        EXPECT_NEAR(h.energy, hours[0].energy, 0.01 * hours[0].energy);
        EXPECT_LE(h.bytes, hours[std::min<size_t>(i, 1)].bytes);
    }
    ASSERT_EQ(hours.size(), kHours);
    const auto cost = [&](size_t first) {
        return std::accumulate(&hours[first], &hours[first] + 6, 0.0,
                               [](double sum, const Hour& h) { return sum + h.seconds; });
    };
    EXPECT_LT(cost(kHours - 6), 1.5 * cost(0));
}

}  // namespace
