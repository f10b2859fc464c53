// Exactness of the front: sparse equals dense updates, mutants are caught, gusts are filtered, wet
// bands hold. mesh_front_test.cpp covers other unwraps.
#include "core/hash.h"
#include "flamewright/flamewright_debug.h"
#include "support/front_rig.h"
#include "support/sanitized.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace fw::test {
namespace {

mesh::BurnDomain bakeOf(const Mesh& mesh, double density, bool trust = true) {
    mesh::BakeInput input = mesh.input(density, 4096);
    input.trustUvs = trust;
    return mesh::bake(input, std::pmr::get_default_resource());
}

bool loadAsset(const char* name, Mesh& mesh) {
    std::string error;
    if (assetPath(name).empty() || !loadGlb(name, mesh, error)) {
        std::printf("%s is not there (FLAMEWRIGHT_ASSETS): left out. %s\n", name, error.c_str());
        return false;
    }
    return true;
}

std::vector<uint32_t> realTexels(const mesh::BurnDomain& d) {
    std::vector<uint32_t> texels;
    for (uint32_t i = 0; i < d.texelCount(); ++i)
        if (d.real(i)) texels.push_back(i);
    return texels;
}

std::vector<uint16_t> roughSlowness(const mesh::BurnDomain& d, uint32_t seed) {
    std::vector<uint16_t> slow(d.texelCount());
    for (uint32_t i = 0; i < d.texelCount(); ++i) {
        const uint32_t h = core::hash32(i + seed * 7919);
        slow[i] = uint16_t(98 + h % 61);
        if (h % 997 == 0) slow[i] = 0;      // noncombustible
        if (h % 991 == 0) slow[i] = 60000;  // nearly noncombustible
    }
    return slow;
}

struct Chaos {
    double lengthToBreadth = 1, burnTime = -1;
    uint32_t seed = 1, steps = rounds(900u, 300u);
    bool latches = true;  // winds, windows and substeps change
    bool douses = true;
};

// Runs the same commands on every rig, step by step. False at the first difference from rigs[0].
bool sameBurn(const mesh::BurnDomain& d, const Chaos& chaos, std::span<const uint32_t> switchesOf,
              uint32_t& failedAt) {
    const double g =
        chaos.lengthToBreadth + std::sqrt(chaos.lengthToBreadth * chaos.lengthToBreadth - 1) - 1;
    const std::vector<uint16_t> slow = roughSlowness(d, chaos.seed);
    std::vector<std::unique_ptr<FrontRig>> rigs;
    for (uint32_t switches : switchesOf) {
        FrontRig::Material material{.rate = 0.03, .headGain = g, .backGain = g};
        material.burnTime = chaos.burnTime;
        rigs.push_back(std::make_unique<FrontRig>(d, material, Vec3{0.6, 0.5, 0.3}, slow));
        rigs.back()->setSwitches(switches);
        rigs.back()->setTiming(1500, 0, 6000);
        rigs.back()->reduceEvery = 4;
    }
    const auto all = [&](auto&& action) {
        for (auto& rig : rigs) action(*rig);
    };
    const std::vector<uint32_t> reals = realTexels(d);
    const double h = double(d.texelSide);
    std::mt19937 random(chaos.seed);
    const auto ball = [&](double radius, auto&& action) {
        const Vec3 centre = texelPosition(d, reals[random() % reals.size()]);
        for (uint32_t i : reals)
            if (length(texelPosition(d, i) - centre) < radius * h) action(i);
    };
    for (uint32_t step = 0; step < chaos.steps; ++step) {
        if (step % 90 == 0) {
            const uint32_t early = random() % 128;
            ball(3, [&](uint32_t i) {
                all([&](FrontRig& rig) { rig.push(i, gpu::kEventIgnite, rig.now + early); });
            });
        }
        if (chaos.latches && step % 37 == 20) {
            const auto part = [&] { return double(random() % 200) / 100 - 1; };
            const Vec3 drive{part(), part(), part()};
            const uint32_t window = 512 + random() % 4000, shift = random() % 3;
            all([&](FrontRig& rig) {
                rig.setDrive(drive);
                rig.setTiming(window, shift, 6000);
            });
        }
        if (chaos.douses && step % 23 == 11)
            ball(9, [&](uint32_t i) { all([&](FrontRig& rig) { rig.push(i, gpu::kEventWet); }); });
        if (chaos.douses && step % 23 == 2) {
            const uint32_t third = random() % 3;
            for (uint32_t i : reals)
                if (core::hash32(i / 97 + step) % 3 == third)
                    all([&](FrontRig& rig) { rig.push(i, gpu::kEventDry); });
        }
        if (chaos.douses && step % 61 == 30)
            ball(5, [&](uint32_t i) {
                all([&](FrontRig& rig) {
                    rig.push(i, gpu::kEventExtinguish);
                    if (i % 2) rig.push(i, gpu::kEventIgnite, rig.now + 1);  // the order matters
                });
            });
        all([](FrontRig& rig) { rig.step(); });
        for (size_t r = 1; r < rigs.size(); ++r) {
            const gpu::ObjectCounters& a = rigs[0]->counters();
            const gpu::ObjectCounters& b = rigs[r]->counters();
            if (!std::equal(rigs[0]->ticks().begin(), rigs[0]->ticks().end(),
                            rigs[r]->ticks().begin()) ||
                a.ignited != b.ignited || a.burning != b.burning || a.lateClamps != b.lateClamps ||
                a.burningTiles != b.burningTiles) {
                failedAt = step;
                return false;
            }
        }
    }
    uint32_t sources = 0;
    for (uint32_t t : rigs[0]->ticks()) sources += gpu::isSource(t);
    EXPECT_EQ(rigs[0]->counters().ignited, sources);
    uint64_t runs[2] = {rigs[0]->totalRunTiles, rigs[1]->totalRunTiles};
    std::printf("seed %u: %u steps equal, %.0f %% burn, dense/sparse %.1fx, hash %016llx\n",
                chaos.seed, chaos.steps, 100.0 * sources / double(reals.size()),
                double(runs[0]) / double(std::max<uint64_t>(1, runs[1])),
                (unsigned long long)core::hashWords(rigs[0]->ticks()));
    return true;
}

TEST(Front, SparseDenseAndShuffledUpdatesAreEqual) {
    constexpr uint32_t variants[] = {FW_DEBUG_DENSE, 0, FW_DEBUG_SHUFFLE,
                                     FW_DEBUG_DENSE | FW_DEBUG_SHUFFLE};
    std::vector<std::pair<const char*, mesh::BurnDomain>> domains;
    domains.emplace_back("sphere", bakeOf(makeCube(1, 24, true, true), 40));
    domains.emplace_back("confetti", bakeOf(makeConfetti(0.5, 12, 0.05), 96));
    domains.emplace_back("cylinder", bakeOf(makeCylinder(0.2, 0.6, 48, 4, 4, true), 80));
    Mesh mesh;
    if (loadAsset("bunny_4k.glb", mesh)) domains.emplace_back("bunny_4k", bakeOf(mesh, 40, false));
    if (loadAsset("spot.glb", mesh = {})) domains.emplace_back("spot", bakeOf(mesh, 40, true));
    uint32_t failedAt = 0, seed = 1;
    for (const auto& [name, d] : domains) {
        const double lb = seed % 3 == 0 ? 1.0 : seed % 3 == 1 ? 2.0 : 3.0;
        EXPECT_TRUE(sameBurn(d, {.lengthToBreadth = lb, .seed = seed}, variants, failedAt))
            << name << " differs at step " << failedAt;
        ++seed;
        EXPECT_TRUE(
            sameBurn(d, {.lengthToBreadth = lb, .burnTime = 1.5, .seed = seed}, variants, failedAt))
            << name << ", finite burn, differs at step " << failedAt;
        ++seed;
        // Fuel so short-lived that sources die before they light a neighbour, until wind comes.
        EXPECT_TRUE(sameBurn(d, {.lengthToBreadth = lb, .burnTime = 0.25, .seed = seed}, variants,
                             failedAt))
            << name << ", short burn, differs at step " << failedAt;
        ++seed;
    }
}

// Fires lit within a step that has substeps correct texels that are already lit.
TEST(Front, SourcesMayBeginWithinAStep) {
    constexpr uint32_t variants[] = {FW_DEBUG_DENSE, 0};
    const mesh::BurnDomain d = bakeOf(makeConfetti(0.5, 12, 0.05), 96);
    uint32_t failedAt = 0;
    EXPECT_TRUE(sameBurn(d, {.lengthToBreadth = 2, .seed = 1}, variants, failedAt)) << failedAt;
    EXPECT_TRUE(sameBurn(d, {.lengthToBreadth = 3, .seed = 5}, variants, failedAt)) << failedAt;
}

// The equality test must notice every omitted tile wake-up.
TEST(Front, EqualityTestCatchesMutants) {
    const mesh::BurnDomain d = bakeOf(makeCube(1, 24, true, true), 64);
    uint32_t failedAt = 0;
    const auto differs = [&](uint32_t mutant, bool latches) {
        const uint32_t pair[] = {FW_DEBUG_DENSE, mutant};
        Chaos chaos{.lengthToBreadth = 2, .seed = 3, .steps = 400};
        chaos.latches = latches;
        chaos.douses = false;
        return !sameBurn(d, chaos, pair, failedAt);
    };
    EXPECT_FALSE(differs(0, true));
    EXPECT_TRUE(differs(FW_DEBUG_NO_SEAM_WAKE, false));
    std::printf("no seam wake: differs at step %u\n", failedAt);
    EXPECT_TRUE(differs(FW_DEBUG_WRONG_DEPENDENTS, false));
    std::printf("wrong readers: differs at step %u\n", failedAt);
    EXPECT_TRUE(differs(FW_DEBUG_NO_WIND_WAKE, true));
    std::printf("no wake on a wind key: differs at step %u\n", failedAt);
}

// Gusts on a slow front: filtered wind gives the mean speed, raw wind far more.
TEST(Front, GustsAverageToTheMeanWind) {
    const mesh::BurnDomain d = bakeOf(makePlane(0.2, 0.05), 128);
    const double rate = 0.0003, gain = 4;
    const uint32_t tau = uint32_t(double(d.texelSide) / rate * 4096);
    const auto speed = [&](double duty, double period, bool filtered) {
        FrontRig rig(d, {.rate = rate, .headGain = gain, .backGain = 1});
        rig.ignite([&](uint32_t i) { return texelPosition(d, i).x < 0.03 ? 0.0 : -1.0; });
        fire::WindFilter filter;
        fire::resetWind(filter, {int32_t(std::lround(128 * duty)), 0, 0});
        rig.setDrive({double(filter.latched[0]) / 128, 0, 0});
        const uint32_t probe = texelNear(d, {0.15, 0.025, 0});
        while (rig.now < kStartTick + 4096u * 500 && rig.arrival(probe) < 0) {
            const double phase = std::fmod(double(rig.now) / 4096, period);
            const fire::WindVector wind{phase < duty * period ? 128 : 0, 0, 0};
            if (filtered)
                fire::filterWind(filter, wind, tau);
            else
                fire::resetWind(filter, wind);
            const fire::WindVector before = filter.latched;
            const bool latched =
                filtered ? rig.now % fire::kWindLatchTicks == 0 && fire::latchWind(filter)
                         : before != wind || rig.steps % 32 == 0;
            if (latched || !filtered) rig.setDrive({double(filter.latched[0]) / 128, 0, 0});
            rig.step();
        }
        double reach = 0;
        for (uint32_t i : realTexels(d))
            if (rig.arrival(i) >= 0) reach = std::max(reach, texelPosition(d, i).x);
        return (reach - 0.03) / ((double(rig.now) - kStartTick) / 4096) * 1000;
    };
    struct Case {
        double duty, period;
    };
    for (const Case& c : {Case{0.02, 2}, Case{0.1, 10}}) {
        const double raw = speed(c.duty, c.period, false), filtered = speed(c.duty, c.period, true);
        const double mean = rate * (1 + gain * c.duty) * 1000;
        std::printf("duty %.2f period %2.0f s: raw %.2f, filtered %.2f, time mean %.2f mm/s\n",
                    c.duty, c.period, raw, filtered, mean);
        EXPECT_GT(raw, 1.5 * mean);
        EXPECT_NEAR(filtered, mean, 0.08 * mean);
    }
}

TEST(Front, WetBandsStopTheFront) {
    struct Case {
        double degrees, texels;
    };
    for (const Case& c : {Case{0, 1.0}, Case{30, 1.5}, Case{45, 1.0}, Case{15, 1.5}}) {
        const mesh::BurnDomain d = bakeOf(makePlane(0.4, 0.4, c.degrees), 128);
        const double h = double(d.texelSide);
        FrontRig rig(d, {.rate = 0.02});
        for (uint32_t i : realTexels(d)) {
            const double x = texelPosition(d, i).x;
            if (std::abs(x - 0.2) < c.texels * h / 2) rig.push(i, gpu::kEventWet);
            if (x < 0.03) rig.push(i, gpu::kEventIgnite, kStartTick);
        }
        rig.runAll(200);
        int over = 0, before = 0;
        for (uint32_t i : realTexels(d)) {
            const double x = texelPosition(d, i).x;
            over += x > 0.2 + c.texels * h && rig.arrival(i) >= 0;
            before += x < 0.2 - c.texels * h && rig.arrival(i) < 0;
        }
        EXPECT_EQ(over, 0) << c.degrees;
        EXPECT_EQ(before, 0) << c.degrees;
    }
    // One exact diagonal of texels: the corner rule.
    const mesh::BurnDomain d = bakeOf(makePlane(0.4, 0.4), 128);
    FrontRig rig(d, {.rate = 0.05});
    uint32_t low = d.width, lowRow = d.height;
    for (uint32_t i : realTexels(d)) {
        low = std::min(low, i % d.width);
        lowRow = std::min(lowRow, i / d.width);
    }
    const auto side = [&](uint32_t i) {
        return int(i % d.width - low) - int(i / d.width - lowRow);
    };
    for (uint32_t i : realTexels(d)) {
        if (side(i) == 0)
            rig.push(i, gpu::kEventWet);
        else if (side(i) < -2 && i % d.width - low < 6)
            rig.push(i, gpu::kEventIgnite, kStartTick);
    }
    rig.runAll(200);
    int over = 0, burnt = 0;
    for (uint32_t i : realTexels(d)) {
        over += side(i) > 0 && rig.arrival(i) >= 0;
        burnt += side(i) < 0 && rig.arrival(i) >= 0;
    }
    EXPECT_EQ(over, 0);
    EXPECT_GT(burnt, 500);
}

// A fire that died long ago must not cross a band that dries; a live one must.
TEST(Front, OnlyLiveFireCrossesADryingBand) {
    const mesh::BurnDomain d = bakeOf(makePlane(0.4, 0.4, 20), 128);
    const double h = double(d.texelSide);
    for (double burnTime : {-1.0, 4.0}) {
        FrontRig rig(d, {.rate = 0.02, .burnTime = burnTime});
        rig.setTiming(512, 0, 512);
        for (uint32_t i : realTexels(d)) {
            const double x = texelPosition(d, i).x;
            if (std::abs(x - 0.2) < 4 * h) rig.push(i, gpu::kEventWet);
            if (x < 0.03) rig.push(i, gpu::kEventIgnite, kStartTick);
        }
        while (rig.now < kStartTick + 4096 * 30) rig.step();
        EXPECT_TRUE(rig.idle());
        const double dried = (double(rig.now) - kStartTick) / 4096;
        for (uint32_t i : realTexels(d)) rig.push(i, gpu::kEventDry);
        rig.step();
        rig.runAll(200);
        int beyond = 0, lit = 0;
        double first = 1e9;
        for (uint32_t i : realTexels(d)) {
            if (texelPosition(d, i).x < 0.2 + 4 * h) continue;
            ++beyond;
            if (rig.arrival(i) < 0) continue;
            ++lit;
            first = std::min(first, rig.arrival(i));
        }
        std::printf("burn time %.0f s: %d of %d beyond the band burnt\n", burnTime, lit, beyond);
        if (burnTime > 0) {
            EXPECT_EQ(lit, 0);  // cold
        } else {
            EXPECT_EQ(lit, beyond);
            EXPECT_NEAR(first - dried, 8 * h / 0.02, 0.5);
        }
    }
}

TEST(Front, ExtinguishedTexelsReignite) {
    const mesh::BurnDomain d = bakeOf(makePlane(0.4, 0.4, 20), 128);
    FrontRig rig(d, {.rate = 0.02});
    const auto band = [&](uint32_t i) { return std::abs(texelPosition(d, i).x - 0.1) < 0.03; };
    for (uint32_t i : realTexels(d))
        if (texelPosition(d, i).x < 0.03) rig.push(i, gpu::kEventIgnite, kStartTick);
    rig.runUntil(10);
    int doused = 0;
    for (uint32_t i : realTexels(d))
        if (rig.arrival(i) >= 0 && band(i)) {
            rig.push(i, gpu::kEventWet);
            ++doused;
        }
    rig.step();
    uint32_t sources = 0;
    for (uint32_t t : rig.ticks()) sources += gpu::isSource(t);
    EXPECT_EQ(rig.counters().ignited, sources);
    rig.runUntil(20);
    int wet = 0;
    for (uint32_t t : rig.ticks()) wet += t == gpu::kOutWet;
    EXPECT_EQ(wet, doused);
    for (uint32_t i : realTexels(d)) rig.push(i, gpu::kEventDry);
    const double dried = (double(rig.now) - kStartTick) / 4096;
    rig.step();
    rig.runAll(100);
    double last = 0;
    for (uint32_t i : realTexels(d)) {
        ASSERT_GE(rig.arrival(i), 0);
        if (band(i)) last = std::max(last, rig.arrival(i));
    }
    EXPECT_GT(last, dried);
    EXPECT_LT(last, dried + 3);
}

TEST(Front, EventsApplyInOrder) {
    using namespace gpu;
    EXPECT_EQ(applyEvent(kNever, kEventIgnite, 50, 10), 50u);
    EXPECT_EQ(applyEvent(kInert, kEventIgnite, 50, 10), kInert);
    EXPECT_EQ(applyEvent(kWet, kEventIgnite, 50, 10), kWet);
    EXPECT_EQ(applyEvent(60, kEventIgnite, 50, 10), 50u);
    EXPECT_EQ(applyEvent(5, kEventIgnite, 4, 10), 5u);
    EXPECT_EQ(applyEvent(kNever, kEventWet, 0, 10), kWet);
    EXPECT_EQ(applyEvent(5, kEventWet, 0, 10), kOutWet);
    EXPECT_EQ(applyEvent(kOut, kEventWet, 0, 10), kOutWet);
    EXPECT_EQ(applyEvent(kOutWet, kEventDry, 0, 10), kOut);
    EXPECT_EQ(applyEvent(kWet, kEventDry, 0, 10), kNever);
    EXPECT_EQ(applyEvent(5, kEventExtinguish, 0, 10), kOut);
    EXPECT_EQ(applyEvent(kNever, kEventExtinguish, 0, 10), kNever);
}

}  // namespace
}  // namespace fw::test
