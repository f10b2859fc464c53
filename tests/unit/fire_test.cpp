// The spread law, its material presets, the wind filter, and the 16-tap kernel of the reference
// implementation.
#include "core/error.h"
#include "fire/presets.h"
#include "reference/published.h"
#include "shared/front.h"
#include "support/front_rig.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace fw::test {
namespace {

mesh::BurnDomain bakePlane(double width, double height, double density) {
    mesh::BakeInput input;
    const Mesh plane = makePlane(width, height);
    input = plane.input(density, 4096);
    input.trustUvs = true;
    return mesh::bake(input, std::pmr::get_default_resource());
}

fire::SpreadFacts factsOf(const mesh::BurnDomain& d) {
    fire::SpreadFacts facts;
    facts.quantum = d.quantum;
    facts.texelSide = d.texelSide;
    facts.linkShort = d.linkShort;
    facts.up[1] = 0;  // planes lie in z = 0
    facts.up[2] = 1;
    return facts;
}

// Front speed (m/s) along +x of a preset on a level sheet, over the second half.
double measuredSpeed(const mesh::BurnDomain& d, const FwMaterialDef& def, const float wind[3]) {
    const fire::SpreadFacts facts = factsOf(d);
    const fire::WindVector units = fire::windUnits(wind);
    gpu::BurnMaterial record = fire::burnMaterial(def, facts, units);
    const FwMaterialDef* defs[] = {&def};
    const fire::FrontTiming timing = fire::frontTiming(defs, facts, {&units, 1}, {&record, 1});
    FrontRig rig(d, record);
    rig.setTiming(timing.window, timing.substepShift);
    const double width = double(d.boundsHigh[0]), middle = double(d.boundsHigh[1]) / 2;
    rig.ignite(
        [&](uint32_t i) { return texelPosition(d, i).x < 4 * double(d.texelSide) ? 0.0 : -1.0; });
    rig.runAll();
    const uint32_t a = texelNear(d, {0.5 * width, middle, 0});
    const uint32_t b = texelNear(d, {0.9 * width, middle, 0});
    EXPECT_GE(rig.arrival(a), 0);
    EXPECT_GE(rig.arrival(b), 0);
    return (texelPosition(d, b).x - texelPosition(d, a).x) / (rig.arrival(b) - rig.arrival(a));
}

// 0.35 to 0.56 g/m/s per width: Stott; Atallah, in Thomas and Law (1965).
TEST(Fire, PaperSpreadsAtMeasuredRates) {
    const float still[3] = {};
    const mesh::BurnDomain d = bakePlane(0.4, 0.15, 128);
    struct Case {
        float mass;
        double low, high;  // mm/s
    };
    for (const Case& c :
         {Case{45, 7.8, 12.4}, Case{80, 4.4, 7.0}, Case{160, 2.2, 3.5}, Case{300, 1.2, 1.9}}) {
        FwMaterialDef def = fire::presetDef(FW_MATERIAL_PAPER);
        def.spreadRate = 0.44f / c.mass;  // paper burns 0.44 g/m/s (0.35 to 0.56 measured)
        def.burnTime = 0;
        const double speed = measuredSpeed(d, def, still) * 1000;
        std::printf("paper %3.0f g/m^2: %.2f mm/s\n", double(c.mass), speed);
        EXPECT_GE(speed, c.low);
        EXPECT_LE(speed, c.high);
    }
    for (uint32_t preset : {uint32_t(FW_MATERIAL_NEWSPAPER), uint32_t(FW_MATERIAL_PAPER)}) {
        const double speed = measuredSpeed(d, fire::presetDef(preset), still) * 1000;
        EXPECT_GE(speed, preset == FW_MATERIAL_PAPER ? 4.4 : 7.8);
        EXPECT_LE(speed, preset == FW_MATERIAL_PAPER ? 7.0 : 12.4);
    }
}

// Head fires at 20 % of the 10 m wind: Cruz, Alexander, Kilinc (2022).
TEST(Fire, GrassFollowsTheWind) {
    const mesh::BurnDomain d = bakePlane(60, 30, 4);
    for (double kilometresPerHour : {20.0, 40.0, 62.0}) {
        const double metres = kilometresPerHour / 3.6;
        const float wind[3] = {float(metres), 0, 0};
        const double speed = measuredSpeed(d, fire::presetDef(FW_MATERIAL_DRY_GRASS), wind);
        std::printf("grass, wind %2.0f km/h: head %.2f m/s, %.1f %% of the wind\n",
                    kilometresPerHour, speed, speed / metres * 100);
        EXPECT_NEAR(speed / metres, 0.2, 0.02);
    }
}

TEST(Fire, SpreadScalesWithThePace) {
    const mesh::BurnDomain d = bakePlane(0.3, 0.1, 128);
    const fire::SpreadFacts facts = factsOf(d);
    fire::SpreadFacts fast = facts;
    fast.pace = 10;
    const FwMaterialDef pine = fire::presetDef(FW_MATERIAL_PINE);
    const gpu::BurnMaterial a = fire::burnMaterial(pine, facts, {});
    const gpu::BurnMaterial b = fire::burnMaterial(pine, fast, {});
    EXPECT_NEAR(double(a.sigma0) / double(b.sigma0), 10, 0.01);
    EXPECT_NEAR(double(a.flameTicks) / double(b.flameTicks), 10, 0.01);
    EXPECT_EQ(a.burnTicks, gpu::kNoneTexel);
    EXPECT_EQ(b.timeScale, 10.0f);
}

TEST(Fire, MoistureSlowsAndStopsSpread) {
    EXPECT_FLOAT_EQ(fire::moistureFactor(0, 0.3f), 1);
    EXPECT_FLOAT_EQ(fire::moistureFactor(0.3f, 0.3f), 0);
    EXPECT_FLOAT_EQ(fire::moistureFactor(2, 0.3f), 0);
    float last = 1;
    for (float m = 0.01f; m < 0.3f; m += 0.01f) {
        const float f = fire::moistureFactor(m, 0.3f);
        EXPECT_LT(f, last);
        EXPECT_GT(f, 0);
        last = f;
    }
    fire::SpreadFacts facts = factsOf(bakePlane(0.1, 0.1, 64));
    const FwMaterialDef paper = fire::presetDef(FW_MATERIAL_PAPER);
    EXPECT_EQ(fire::burnMaterial(paper, facts, {}).flags & 1u, 1u);
    facts.moisture = 0.5f;
    EXPECT_EQ(fire::burnMaterial(paper, facts, {}).flags & 1u, 0u);
}

TEST(Fire, PresetsAreValidAndNamed) {
    std::vector<std::string> names;
    for (uint32_t p = 0; p < FW_MATERIAL_PRESET_COUNT; ++p) {
        EXPECT_NO_THROW(fire::checkMaterial(fire::presetDef(p))) << p;
        EXPECT_EQ(fire::presetDef(p).appearance, p);
        names.emplace_back(fire::presetName(p));
    }
    std::sort(names.begin(), names.end());
    EXPECT_EQ(std::unique(names.begin(), names.end()), names.end());
    EXPECT_STREQ(fire::presetName(99), "unknown");
    EXPECT_EQ(fire::presetDef(FW_MATERIAL_NONCOMBUSTIBLE).spreadRate, 0);
}

TEST(Fire, RefusesBadMaterialsByName) {
    const auto message = [](auto&& change) -> std::string {
        FwMaterialDef def = fire::presetDef(FW_MATERIAL_PINE);
        change(def);
        try {
            fire::checkMaterial(def);
        } catch (const core::Error& error) {
            EXPECT_EQ(error.result, FW_ERROR_INVALID_ARGUMENT);
            return error.message;
        }
        return "accepted";
    };
    EXPECT_EQ(message([](FwMaterialDef& d) { d.spreadRate = 2; }),
              "FwMaterialDef::spreadRate is 2; it must be within [0, 1].");
    EXPECT_EQ(message([](FwMaterialDef& d) { d.lengthToBreadth = 0.5f; }),
              "FwMaterialDef::lengthToBreadth is 0.5; it must be within [1, 4].");
    EXPECT_NE(message([](FwMaterialDef& d) { d.moisture = NAN; }).find("moisture"),
              std::string::npos);
    EXPECT_NE(message([](FwMaterialDef& d) { d.baseColor[2] = INFINITY; }).find("baseColor[2]"),
              std::string::npos);
    EXPECT_NE(message([](FwMaterialDef& d) { d.appearance = 14; }).find("appearance is 14"),
              std::string::npos);
}

// Every valid material stays within the kernel's ranges.
TEST(Fire, MaterialRecordsStayInRange) {
    std::mt19937 random(9);
    const auto real = [&](double low, double high) {
        return float(low + (high - low) * double(random()) / 4294967295.0);
    };
    for (int i = 0; i < 5000; ++i) {
        FwMaterialDef def = fire::presetDef(random() % FW_MATERIAL_PRESET_COUNT);
        def.spreadRate = std::pow(10.0f, real(-6, 0));
        def.windGain = real(0, 16);
        def.upGain = real(0, 16);
        def.headGain = real(0, 255);
        def.backGain = real(0, 255);
        def.driveMax = real(0, 63);
        def.lengthToBreadth = real(1, 4);
        fire::SpreadFacts facts;
        facts.quantum = std::pow(10.0f, real(-7, -2));
        facts.texelSide = facts.quantum * 500;
        facts.linkShort = facts.texelSide * 0.8f;
        facts.scale = std::pow(10.0f, real(-3, 3));
        facts.pace = std::pow(10.0f, real(-1, 3));
        const float blow[3] = {real(-200, 200), real(-200, 200), real(-200, 200)};
        const fire::WindVector wind = fire::windUnits(blow);
        gpu::BurnMaterial m = fire::burnMaterial(def, facts, wind);
        const double drive = std::sqrt(double(m.driveX) * m.driveX + double(m.driveY) * m.driveY +
                                       double(m.driveZ) * m.driveZ);
        ASSERT_LE(drive, gpu::kDriveLimit);
        ASSERT_GE(m.sigma0, 16u);
        ASSERT_LE(m.headGain, 65280u);
        ASSERT_LE(m.driveMax, 64512u);
        ASSERT_GE(m.breadthMax, 256u);
        const FwMaterialDef* defs[] = {&def};
        const fire::FrontTiming t = fire::frontTiming(defs, facts, {&wind, 1}, {&m, 1});
        ASSERT_LE(t.substepShift, 3u);
        ASSERT_LE(t.window, t.windowMax);
        ASSERT_EQ(m.windowMax, t.windowMax);
    }
}

TEST(Fire, WindFilterSettles) {
    const float blow[3] = {3, -200, NAN};
    const fire::WindVector wind = fire::windUnits(blow);
    EXPECT_EQ(wind, (fire::WindVector{384, -15360, 0}));
    fire::WindFilter filter;
    EXPECT_FALSE(fire::latchWind(filter));
    const uint32_t tau = 4096;
    for (int i = 0; i < 32; ++i) fire::filterWind(filter, wind, tau);
    EXPECT_TRUE(fire::latchWind(filter));
    EXPECT_NEAR(filter.latched[0], 384 * (1 - std::exp(-1)), 8);
    EXPECT_FALSE(fire::latchWind(filter));
    for (int i = 0; i < 1000; ++i) fire::filterWind(filter, wind, tau);
    EXPECT_TRUE(fire::latchWind(filter));
    EXPECT_EQ(filter.latched, wind);
    fire::filterWind(filter, {0, 0, 0}, 0);  // longer than a step: applies at once
    EXPECT_EQ(fire::filteredWind(filter), (fire::WindVector{0, 0, 0}));
}

// Planar speed of a pulled front: least over q of ln(1 + k M(q)) / q, in texels per step.
double theorySpeed(double k) {
    double best = 1e9;
    for (double q = 0.01; q < 4; q += 0.001) {
        const double m = double(gpu::kPublishedNear) * (2 + 2 * std::cosh(q)) +
                         double(gpu::kPublishedDiagonal) * 4 * std::cosh(q) +
                         double(gpu::kPublishedKnight) * (4 * std::cosh(q) + 4 * std::cosh(2 * q));
        best = std::min(best, std::log(1 + k * m) / q);
    }
    return best;
}

TEST(Fire, ReferenceKernelHasItsTheoreticalSpeed) {
    const double table[][2] = {
        {0.01, 0.0180}, {0.05, 0.0870}, {0.1, 0.167}, {0.3, 0.434}, {1.0, 0.986}};
    for (const auto& row : table) EXPECT_NEAR(theorySpeed(row[0]) / row[1], 1, 0.02) << row[0];
    const double density = 128;
    const mesh::BurnDomain d = bakePlane(330 / density, 80 / density, density);
    for (uint32_t slow : {24u, 12u, 4u}) {
        const double k = double(gpu::kPublishedRate) / 32 * 128 / slow;
        const std::vector<uint16_t> slowness(d.texelCount(), uint16_t(slow));
        gpu::BurnMaterial record{};
        record.flags = 1;
        record.sigma0 = 1 << 20;
        record.burnTicks = record.flameTicks = gpu::kNoneTexel;
        FrontRig rig(d, record, slowness, gpu::kObjectExtended);
        for (uint32_t i = 0; i < d.texelCount(); ++i)
            if (d.real(i) && texelPosition(d, i).x < 3 / density)
                rig.push(i, gpu::kEventIgnite, kStartTick);
        const uint32_t a = texelNear(d, {200 / density, 40 / density, 0});
        const uint32_t b = texelNear(d, {310 / density, 40 / density, 0});
        while (rig.arrival(b) < 0 && rig.steps < 6000) rig.step();
        ASSERT_GE(rig.arrival(b), 0);
        const double speed = (texelPosition(d, b).x - texelPosition(d, a).x) * density /
                             ((rig.arrival(b) - rig.arrival(a)) * 32);
        std::printf("published, k %.3f: %.4f texels/step, theory %.4f (%+.2f %%)\n", k, speed,
                    theorySpeed(k), (speed / theorySpeed(k) - 1) * 100);
        EXPECT_NEAR(speed / theorySpeed(k), 1, 0.02);
    }
}

// The reference kernel in doubles on a map whose slowness varies twofold.
TEST(Fire, ReferenceKernelKeepsItsPrecision) {
    const double density = 128;
    const mesh::BurnDomain d = bakePlane(110 / density, 60 / density, density);
    std::vector<uint16_t> slowness(d.texelCount());
    for (uint32_t i = 0; i < d.texelCount(); ++i) slowness[i] = uint16_t(16 + gpu::hash32(i) % 17);
    gpu::BurnMaterial record{};
    record.flags = 1;
    record.sigma0 = 1 << 20;
    record.burnTicks = record.flameTicks = gpu::kNoneTexel;
    FrontRig rig(d, record, slowness, gpu::kObjectExtended);
    std::vector<double> now(d.texelCount()), next(d.texelCount()), at(d.texelCount(), -1);
    const auto spread = [&](int x, int y) {
        const uint32_t i = uint32_t(y) * d.width + uint32_t(x);
        return d.real(i) ? double(gpu::kPublishedRate) / 32 * 128 / slowness[i] : 0.0;
    };
    const auto tap = [&](int x, int y) {
        return x < 0 || y < 0 || x >= int(d.width) || y >= int(d.height)
                   ? 0.0
                   : now[size_t(y) * d.width + size_t(x)] * spread(x, y);
    };
    const uint32_t first = texelNear(d, {20 / density, 30 / density, 0});
    rig.push(first, gpu::kEventIgnite, kStartTick);
    now[first] = 1;
    const uint32_t last = texelNear(d, {90 / density, 30 / density, 0});
    for (int step = 1; at[last] < 0 && step < 4000; ++step) {
        rig.step();
        for (int y = 0; y < int(d.height); ++y)
            for (int x = 0; x < int(d.width); ++x) {
                double sum = 0;
                for (int dy = -2; dy <= 2; ++dy)
                    for (int dx = -2; dx <= 2; ++dx) {
                        const int r = dx * dx + dy * dy;
                        if (r == 0 || r == 4 || r == 8) continue;
                        sum += tap(x + dx, y + dy) * double(r == 1   ? gpu::kPublishedNear
                                                            : r == 2 ? gpu::kPublishedDiagonal
                                                                     : gpu::kPublishedKnight);
                    }
                const size_t i = size_t(y) * d.width + size_t(x);
                next[i] = spread(x, y) > 0 ? std::min(1.0, now[i] + sum) : 0.0;
                if (now[i] < 0.5 && next[i] >= 0.5) at[i] = step / 32.0;
            }
        now.swap(next);
    }
    ASSERT_GT(at[last], 0);
    double worst = 0;  // s
    uint32_t lit = 0;
    for (uint32_t i = 0; i < d.texelCount(); ++i) {
        if (at[i] < 0) continue;
        ASSERT_GE(rig.arrival(i), 0) << i;
        worst = std::max(worst, std::abs(rig.arrival(i) - at[i]));
        ++lit;
    }
    std::printf("published against doubles: %u arrivals within %.4f s, the last at %.2f s\n", lit,
                worst, at[last]);
    EXPECT_GT(lit, 3000u);
    EXPECT_LE(worst, 1.0 / 32 + 1e-9);  // one step
}

TEST(Fire, ReferenceSpreadConvertsSlowness) {
    for (uint32_t slow : {1u, 3u, 24u, 128u, 255u, 256u, 257u, 1000u, 65535u})
        for (int fall : {-4096, -1000, 0, 777, 4096}) {
            const double wanted = double(gpu::kPublishedRate) / 32 * 128 / slow *
                                  (1 + double(gpu::kPublishedGravity) * fall / 4096);
            EXPECT_NEAR(gpu::publishedSpread(slow, fall) / wanted, 1, 5e-5) << slow << " " << fall;
        }
}

}  // namespace
}  // namespace fw::test
