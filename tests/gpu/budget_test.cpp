// The frame budget: burns are equal at every level of detail, and no fire disappears.
#include "abi/fire_world.h"
#include "abi/panels.h"
#include "support/views.h"

#include <cmath>
#include <memory>

namespace {

using host::created;
using host::getState;
using host::lastMessage;
using host::Panels;

FwBudgetState budgetOf(FwWorld* world) { return getState(fwWorld_GetBudgetState, world); }

FwResult setBudget(FwWorld* world, float limit, float measured) {
    FwBudgetDef def = fwDefaultBudgetDef();
    def.gpuMilliseconds = limit;
    def.measuredMilliseconds = measured;
    return fwWorld_SetBudget(world, &def);
}

std::vector<std::byte> saved(Panels& panels) {
    EXPECT_EQ(FW_OK, fwWorld_RequestSave(panels.world)) << lastMessage(panels.world);
    uint64_t size = 0;
    FwResult result = FW_NOT_READY;
    for (int i = 0; i < 8 && result == FW_NOT_READY; ++i) {
        panels.run(0.01, 0.01f);
        result = fwWorld_FetchSave(panels.world, nullptr, &size);
    }
    EXPECT_EQ(FW_OK, result) << lastMessage(panels.world);
    std::vector<std::byte> bytes(size);
    EXPECT_EQ(FW_OK, fwWorld_FetchSave(panels.world, bytes.data(), &size));
    return bytes;
}

class Budget : public testing::TestWithParam<bool> {
 protected:
    // A world of burning sheets below six flames; null without a device.
    std::unique_ptr<Panels> make() {
        FwContext* context = nullptr;
        if (GetParam()) {
            FwErrorInfo info{};
            const FwContextDef own = fwDefaultContextDef();
            if (fwCreateContext(&own, &context, &info) != FW_OK) return nullptr;
        }
        FwWorldDef def = host::worldDef(FW_WORLD_CONTACT | FW_WORLD_EMBERS | FW_WORLD_RADIATION);
        def.paceFactor = 10;
        auto panels = std::make_unique<Panels>(def, 20, 64, context);
        for (int i = 0; i < 6; ++i) (void)panels->add(0.45f * float(i), 0, 0);
        panels->ignite(panels->ids[2], 1.0f, 0, 0.1f, 0.05f);
        for (int i = 0; i < 6; ++i) {
            FwVolumetricFireDef fire = host::presetDef(FW_FIRE_CAMP);
            fire.position[0] = float(i) - 2.5f;
            (void)created(fwWorld_CreateVolumetricFire, panels->world, fire);
        }
        return panels;
    }
};

TEST_P(Budget, DetailDoesNotChangeTheBurn) {
    const auto free = make();
    if (!free) GTEST_SKIP() << "no Vulkan device";
    const auto held = make();
    ASSERT_EQ(FW_OK, setBudget(held->world, 2, 100));
    free->run(4);
    held->run(4);
    const FwBudgetState least = budgetOf(held->world);
    EXPECT_EQ(least.levels - 1, least.level);
    EXPECT_EQ(1u, least.marchedFires);
    EXPECT_LT(least.refinedTriangles, fwDefaultWorldDef().maxRefinedTriangles / 4);
    EXPECT_EQ(0u, budgetOf(free->world).level);
    EXPECT_EQ(saved(*free), saved(*held));

    ASSERT_EQ(FW_OK, setBudget(held->world, 2, 0.1f));  // the budget is large again
    held->run(4);
    EXPECT_EQ(0u, budgetOf(held->world).level);
    free->run(4);
    EXPECT_EQ(saved(*free), saved(*held));
}
INSTANTIATE_TEST_SUITE_P(Backends, Budget, testing::Bool(),
                         [](const auto& backend) { return backend.param ? "device" : "cpu"; });

TEST(BudgetOnDevice, KeepsEveryFireAndItsLight) {
    double light[2] = {};
    for (const bool held : {false, true}) {
        FwContext* context = nullptr;
        FwErrorInfo info{};
        const FwContextDef own = fwDefaultContextDef();
        if (fwCreateContext(&own, &context, &info) != FW_OK) GTEST_SKIP() << info.message;
        Panels panels(fwDefaultWorldDef(), 20, 64, context);
        for (int i = 0; i < 5; ++i) {
            FwVolumetricFireDef fire = host::presetDef(FW_FIRE_CAMP);
            fire.position[0] = 1.4f * float(i - 2);
            (void)created(fwWorld_CreateVolumetricFire, panels.world, fire);
        }
        ASSERT_EQ(FW_OK, setBudget(panels.world, held ? 2 : 0, 100));
        std::vector<unsigned char> pixels(320 * 180 * 4);
        FwOffscreenDef shot = fwDefaultOffscreenDef();
        shot.width = 320, shot.height = 180;
        shot.pixels = pixels.data();
        shot.view = fw::test::viewAt({0, 1, 9}, {0, 0.8f, 0}, 320.0f / 180, 4.57f);
        panels.run(2.5);
        uint32_t shots = 0;
        for (; shots < 30; ++shots) {  // tiers change over frames
            panels.run(1.0 / 32);
            ASSERT_EQ(FW_OK, fwWorld_RenderOffscreen(panels.world, &shot))
                << lastMessage(panels.world);
            if (shots < 20) continue;
            for (size_t i = 0; i < pixels.size(); i += 4)
                light[held] += std::pow(double(pixels[i]) / 255, 2.2);
        }
        EXPECT_EQ(held ? 7u : 0u, budgetOf(panels.world).level);
        // Each of the five shows in its own fifth of the picture.
        for (uint32_t part = 0; part < 5; ++part) {
            unsigned most = 0;
            for (uint32_t y = 0; y < 180; ++y)
                for (uint32_t x = part * 64; x < part * 64 + 64; ++x)
                    most = std::max<unsigned>(most, pixels[(y * 320 + x) * 4]);
            EXPECT_GT(most, 100u) << "fire " << part << (held ? " at lowest detail" : "");
        }
    }
    EXPECT_NEAR(light[1] / light[0], 1, 0.08);
    std::printf("light at the least detail: %.3f of all\n", light[1] / light[0]);
}

// Fires, burning sheets and a jet's particles, shown in a picture now and then.
struct Seen {
    static constexpr uint32_t kWide = 160, kHigh = 90;
    std::unique_ptr<Panels> panels;
    std::vector<unsigned char> pixels = std::vector<unsigned char>(kWide * kHigh * 4);
    FwOffscreenDef shot = fwDefaultOffscreenDef();

    bool make() {
        FwContext* context = nullptr;
        FwErrorInfo info{};
        const FwContextDef own = fwDefaultContextDef();
        if (fwCreateContext(&own, &context, &info) != FW_OK) return false;
        panels = std::make_unique<Panels>(fwDefaultWorldDef(), 20, 64, context);
        for (int i = 0; i < 2; ++i) {
            FwVolumetricFireDef fire = host::presetDef(FW_FIRE_CAMP);
            fire.position[0] = 1.5f * float(i) - 3.0f;
            (void)created(fwWorld_CreateVolumetricFire, panels->world, fire);
        }
        FwFireEmitterDef emitter = fwDefaultFireEmitterDef();
        emitter.position[0] = 0.2f;
        emitter.power = 300;
        (void)created(fwWorld_CreateFireEmitter, panels->world, emitter);
        panels->ignite(panels->add(2.2f, 0.4f, 0), 2.4f, 0.4f, 0.1f, 0.05f);
        shot.width = kWide, shot.height = kHigh;
        shot.pixels = pixels.data();
        shot.view = fw::test::viewAt({0, 1, 9}, {0, 0.8f, 0}, float(kWide) / kHigh, 4.57f);
        return true;
    }
    void frames(uint32_t count) {
        for (uint32_t i = 0; i < count; ++i) panels->run(1.0 / 32);
        ASSERT_EQ(FW_OK, fwWorld_RenderOffscreen(panels->world, &shot))
            << lastMessage(panels->world);
    }
    // Linear red light of the picture's columns.
    double light(uint32_t from, uint32_t to) const {
        double sum = 0;
        for (uint32_t y = 0; y < kHigh; ++y)
            for (uint32_t x = from; x < to; ++x)
                sum += std::pow(double(pixels[(y * kWide + x) * 4]) / 255, 2.2);
        return sum;
    }
};

// Visual memory falls below the limit within 60 frames and stays there; without a limit it returns.
// The burn is unaffected.
TEST(BudgetOnDevice, BytesSettleUnderTheLimitAndReturn) {
    Seen seen, free;
    if (!seen.make() || !free.make()) GTEST_SKIP() << "no Vulkan device";
    FwWorld* world = seen.panels->world;
    for (int i = 0; i < 4; ++i)
        seen.frames(10);  // by then the impostors of its flames are allocated
    const uint64_t all = budgetOf(world).bytes;
    EXPECT_GT(all, 200000u);
    FwBudgetDef def = fwDefaultBudgetDef();
    def.bytes = all / 2;
    ASSERT_EQ(FW_OK, fwWorld_SetBudget(world, &def));
    seen.frames(60);
    const uint32_t level = budgetOf(world).level;
    EXPECT_GT(level, 0u);
    for (int i = 0; i < 4; ++i) {  // still under the limit
        seen.frames(5);
        EXPECT_EQ(level, budgetOf(world).level);
        EXPECT_LE(budgetOf(world).bytes, def.bytes);
    }
    std::printf("bytes: %llu of %llu, at level %u\n",
                static_cast<unsigned long long>(budgetOf(world).bytes),
                static_cast<unsigned long long>(all), level);
    EXPECT_GT(seen.light(0, 95), 10.0) << "the fires are visible";
    def.bytes = 0;
    ASSERT_EQ(FW_OK, fwWorld_SetBudget(world, &def));
    seen.frames(60);
    EXPECT_EQ(0u, budgetOf(world).level);
    EXPECT_NEAR(1, double(budgetOf(world).bytes) / double(all), 0.15)
        << "except for spare capacity";
    free.panels->run(180.0 / 32);
    EXPECT_EQ(saved(*free.panels), saved(*seen.panels));
}

// At the lowest detail a third of the quads shows (ParticlePass counts them), each larger, so the
// amount of fire stays. This includes flames so small that they are merged anyway.
TEST(BudgetOnDevice, FewerQuadsShowTheSameFire) {
    double sheet[2] = {}, jet[2] = {};
    for (const bool held : {false, true}) {
        Seen seen;
        if (!seen.make()) GTEST_SKIP() << "no Vulkan device";
        ASSERT_EQ(FW_OK, setBudget(seen.panels->world, held ? 2 : 0, 100));
        seen.frames(40);
        for (uint32_t i = 0; i < 12; ++i) {  // several seconds, because flames flicker
            seen.panels->run(5.0 / 32);
            seen.frames(1);
            jet[held] += seen.light(58, 112);
            sheet[held] += seen.light(118, 160);
        }
        EXPECT_FLOAT_EQ(held ? 0.35f : 1.0f, budgetOf(seen.panels->world).quads);
    }
    std::printf("at the least detail %.2f of the light of particles, %.2f of a sheet's\n",
                jet[1] / jet[0], sheet[1] / sheet[0]);
    EXPECT_NEAR(jet[1] / jet[0], 1, 0.08);
    EXPECT_NEAR(sheet[1] / sheet[0], 1, 0.08);
}

TEST(FrameBudget, RefusesInvalidBudgets) {
    host::FireWorld w;
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, setBudget(w.world, -1, -1));
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, setBudget(w.world, 1001, -1));
    EXPECT_NE(std::string::npos, lastMessage(w.world).find("FwBudgetDef::gpuMilliseconds"));
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, setBudget(w.world, 1, NAN));
    EXPECT_EQ(FW_OK, setBudget(w.world, 1, -1));
    FwBudgetState state{};
    EXPECT_EQ(FW_ERROR_VERSION, fwWorld_GetBudgetState(w.world, &state));
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_SetBudget(w.world, nullptr));
}

// Measured by the clock of the host's thread; the cpu backend has no other.
TEST(FrameBudget, MeasuresProcessorTime) {
    host::FireWorld w;
    FwBudgetDef def = fwDefaultBudgetDef();
    def.cpuMilliseconds = 1e-6f;
    ASSERT_EQ(FW_OK, fwWorld_SetBudget(w.world, &def));
    w.run(3);
    const FwBudgetState state = budgetOf(w.world);
    EXPECT_GT(state.cpuMilliseconds, 0.0f);
    EXPECT_EQ(state.levels - 1, state.level);
}

}  // namespace
