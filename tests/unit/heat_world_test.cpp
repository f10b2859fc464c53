// Heat on whole maps, on the cpu backend: ignition under an external flux, hot tiles, sleep of the
// others.
#include "fire/heat.h"
#include "fire/presets.h"
#include "gpu/cpu/cpu_backend.h"
#include "support/meshes.h"
#include "world/clock.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

namespace fw::test {
namespace {

class HotSheet {
 public:
    HotSheet(const fire::HeatFacts& facts, double rate)
        : backend(std::pmr::get_default_resource(), 4) {
        const Mesh plane = makePlane(1, 1);
        mesh::BakeInput input = plane.input(64, 4096);
        input.trustUvs = true;
        input.noiseAmplitude = 0;
        domain = mesh::bake(input, std::pmr::get_default_resource());
        backend.createMesh(0, domain);
        std::array<gpu::BurnMaterial, gpu::kMaterialsPerObject> materials{};
        std::array<gpu::HeatMaterial, gpu::kMaterialsPerObject> heat{};
        material = fire::heatMaterial(facts, 1.0 / 8, fire::kAmbient);
        material.burnTicks = 8 * 4096;
        material.energy = 3;
        for (uint32_t i = 0; i < gpu::kMaterialsPerObject; ++i) {
            gpu::BurnMaterial& m = materials[i];
            m.sigma0 = uint32_t(std::lround(4096 / rate * double(domain.quantum) / 8 * 4194304));
            m.breadthMax = 256;
            m.burnTicks = m.flameTicks = facts.thick ? gpu::kNoneTexel : 8 * 4096;
            m.flags = 1;
            m.air = 256;
            m.windowMax = 512;
            heat[i] = material;
        }
        gpu::ObjectInit init{};
        init.record.flags = gpu::kObjectLive | gpu::kObjectHeat;
        init.record.window = 512;
        init.materials = materials;
        init.heat = heat;
        backend.createObject(0, init);
    }
    void step(std::span<const gpu::TexelEvent> events = {}) {
        gpu::StepPlan plan;
        plan.now = now;
        plan.events = events;
        plan.heat = world::heatsAt(now);
        plan.reduce = world::reducesAt(now);
        gpu::FramePlan frame;
        frame.frameIndex = ++frames;
        frame.steps = {&plan, 1};
        frame.endTick = now += gpu::kStepTicks;
        backend.run(frame);
        while (const gpu::Readback* readback = backend.nextReadback()) hot = readback->hotTiles;
    }
    [[nodiscard]] uint32_t texelNear(float x, float y) const {
        std::pmr::vector<uint32_t> found;
        const float point[3] = {x, y, 0};
        return mesh::nearestTexel(domain, point, 10);
    }
    [[nodiscard]] gpu::HeatTexel at(uint32_t texel) const {
        return gpu::unpackHeat(backend.heat(0)[texel]);
    }

    mesh::BurnDomain domain{std::pmr::get_default_resource()};
    gpu::cpu::CpuBackend backend;
    gpu::HeatMaterial material{};
    uint32_t now = 4096, hot = 0;
    uint64_t frames = 0;
};

fire::HeatFacts insulatedWood() {
    fire::HeatFacts facts;
    facts.emissivity = 0;
    facts.absorptivity = 1;
    facts.convection = 0;
    facts.conductivity = 0.2222f;  // k rho c = 0.25 kW^2 s / m^4 K^2
    facts.ignition = 293 + 330;
    return facts;
}

TEST(HeatMap, ExternalFluxIgnitesItsTileInTime) {
    for (const double flux : {20e3, 30e3, 50e3}) {
        HotSheet sheet(insulatedWood(), 1e-4);
        const double inertia = 0.2222 * 450 * 2500;
        const double exact = std::numbers::pi / 4 * inertia * (330 / flux) * (330 / flux);
        const uint32_t tile = 2 * sheet.domain.tilesX + 2, start = sheet.now;
        const uint32_t corner = 2 * 8 * sheet.domain.width + 2 * 8;
        sheet.backend.setTileHeat(0, tile, {uint32_t(flux), 1});
        // Heat is rounded per texel, so texels catch in different steps.
        double first = -1, last = -1;  // s
        while (last < 0 && sheet.now < start + 200 * 4096) {
            sheet.step();
            uint32_t lit = 0;
            for (uint32_t i = 0; i < 64; ++i)
                lit += gpu::isSource(
                           sheet.backend.state(0)[corner + (i >> 3) * sheet.domain.width + (i & 7)])
                           ? 1
                           : 0;
            const double seconds = double(sheet.now - start) / 4096;
            if (lit != 0 && first < 0) first = seconds;
            if (lit == 64) last = seconds;
        }
        std::printf("a tile at %.0f kW/m^2 caught after %.1f to %.1f s, half-space %.1f s\n",
                    flux / 1000, first, last, exact);
        EXPECT_NEAR(first, exact, 0.05 * exact + 0.2);
        EXPECT_NEAR(last, exact, 0.05 * exact + 0.2);
        // No other tile yet.
        sheet.step();
        EXPECT_EQ(64u, sheet.backend.counters(0).ignited);
    }
}

TEST(HeatMap, WithoutAPilotAutoIgnitionIsLater) {
    HotSheet sheet(insulatedWood(), 1e-4);
    const uint32_t tile = 2 * sheet.domain.tilesX + 2;
    const uint32_t texel = (2 * 8 + 3) * sheet.domain.width + 2 * 8 + 3;
    sheet.backend.setTileHeat(0, tile, {30000, 0});
    while (sheet.at(texel).heat < sheet.material.ignitesAt + 320) sheet.step();
    EXPECT_FALSE(gpu::isSource(sheet.backend.state(0)[texel]));
    while (sheet.at(texel).heat < sheet.material.ignitesAlone - 32) sheet.step();
    EXPECT_FALSE(gpu::isSource(sheet.backend.state(0)[texel]));
    for (int i = 0; i < 400; ++i) sheet.step();
    EXPECT_TRUE(gpu::isSource(sheet.backend.state(0)[texel]));
}

TEST(HeatMap, HotTilesFollowTheFireAndOthersSleep) {
    fire::HeatFacts cloth;
    cloth.thick = false;
    cloth.thickness = 0.0005f;
    cloth.density = 300;
    HotSheet sheet(cloth, 0.002);
    sheet.step();
    EXPECT_EQ(0u, sheet.hot);
    const gpu::TexelEvent lit{0, sheet.texelNear(0.5f, 0.5f), gpu::kEventIgnite, sheet.now + 1};
    sheet.step({&lit, 1});
    EXPECT_EQ(1u, sheet.hot);
    uint32_t most = 0;
    uint64_t energy = 0;
    const uint32_t tiles = sheet.domain.tileCount();
    for (int i = 0; i < 32 * 2000 && (sheet.hot > 0 || i < 32); ++i) {
        sheet.step();
        most = std::max(most, sheet.hot);
        if (i % 320 != 0) continue;
        // The object's energy account equals the loss of its texels.
        energy = 0;
        for (uint32_t k = 0; k < sheet.domain.texelCount(); ++k)
            if (sheet.domain.real(k))
                energy += uint64_t(gpu::kFuelFull - sheet.at(k).fuel) * sheet.material.energy;
        const gpu::ObjectCounters& counters = sheet.backend.counters(0);
        EXPECT_EQ(energy, uint64_t(counters.energyHigh) << 32 | counters.energyLow);
    }
    std::printf("at most %u of %u tiles were hot\n", most, tiles);
    EXPECT_EQ(0u, sheet.hot) << "burnt out and cold";
    EXPECT_LT(most, tiles);
    for (uint32_t k = 0; k < sheet.domain.texelCount(); ++k) {
        if (!sheet.domain.real(k)) continue;
        const gpu::HeatTexel x = sheet.at(k);
        EXPECT_EQ(0u, x.fuel);
        EXPECT_EQ(gpu::kPhaseBurnt, x.phase);
        EXPECT_NEAR(double(x.heat), double(sheet.material.ambient), gpu::kSleepTolerance);
    }
}

// A warm texel takes one step in kSleepSteps, or one in four times as many where little arrives.
// Its temperature must follow that of all steps, during and after the flux, and when the flux
// grows.
TEST(HeatMap, WarmTilesTakeOneStepInEight) {
    HotSheet sheet(fire::HeatFacts{}, 1e-4);
    const uint32_t tile = 2 * sheet.domain.tilesX + 2;
    const uint32_t texel = (2 * 8 + 3) * sheet.domain.width + 2 * 8 + 3;
    gpu::HeatTexel all = sheet.at(texel);  // takes every step
    // Exchanges give the tile another flux at the end of a skipped span.
    for (bool ends = false; !ends;) {
        const uint32_t now = sheet.now;
        sheet.step();
        ends = world::heatsAt(now) && gpu::sleepEnds(tile, gpu::kLongSleepFlux, now);
    }
    const auto run = [&](uint32_t flux, int seconds) {
        sheet.backend.setTileHeat(0, tile, {flux, 1});
        uint32_t changes = 0;
        double apart = 0;  // K
        for (int i = 0; i < 32 * seconds; ++i) {
            const uint32_t before = sheet.at(texel).heat, now = sheet.now;
            sheet.step();
            if (!world::heatsAt(now)) continue;
            uint32_t burnt = 0, water = 0;
            const uint32_t chance = gpu::heatChance(texel, gpu::hash32(now));
            gpu::heatStep(all, sheet.material, flux, 256, true, chance, burnt, water);
            changes += sheet.at(texel).heat != before ? 1 : 0;
            if (gpu::sleepEnds(tile, flux, now))
                apart = std::max(apart, std::fabs(double(sheet.at(texel).heat) - all.heat) / 16);
        }
        std::printf("under %u W/m^2 for %d s: %u of %d steps, %.1f K, at most %.2f K apart\n", flux,
                    seconds, changes, seconds * 8, double(sheet.at(texel).heat) / 16, apart);
        EXPECT_LT(apart, 4.0) << "the worst case is a long step from cold";
        return changes;
    };
    const uint32_t warms = run(3000, 120);
    EXPECT_GT(sheet.at(texel).heat, sheet.material.ambient + 16u * 30);
    EXPECT_LT(warms, 120u + gpu::kSleepSteps);
    EXPECT_LT(run(0, 120), 120u / 4 + gpu::kSleepSteps);
    const uint32_t hot = run(8000, 60);
    EXPECT_GT(hot, 60u * 8 * 9 / 10) << "it takes every step again";
}

}  // namespace
}  // namespace fw::test
