// The predicted front: for each texel, when the simulation will light it or that it never will,
// across time slices, seams, walls and wind.
#include "mesh/front/arrivals.h"
#include "support/front_rig.h"
#include "support/sanitized.h"
#include "unit/mesh_checks.h"

#include <algorithm>
#include <cmath>

namespace {

using namespace fw;
using namespace fw::test;

mesh::Arrivals forecast(const mesh::ArrivalInput& input) {
    mesh::Arrivals arrivals(std::pmr::get_default_resource());
    mesh::beginArrivals(arrivals, input);
    mesh::runArrivals(arrivals, ~0u);
    EXPECT_TRUE(arrivals.whole);
    return arrivals;
}

struct Difference {
    double worst = 0, mean = 0;      // relative to the remaining time
    double ticks = 0;                // worst difference
    uint32_t texels = 0, other = 0;  // other: lit in only one of the two
};

Difference differ(const mesh::Arrivals& arrivals, std::span<const uint32_t> burnt, uint32_t now) {
    Difference d;
    for (size_t i = 0; i < burnt.size(); ++i) {
        const bool predicted = gpu::isSource(arrivals.ticks[i]), burned = gpu::isSource(burnt[i]);
        d.other += predicted != burned;
        if (!predicted || !burned || burnt[i] < now + 1024) continue;
        const double off = std::abs(double(arrivals.ticks[i]) - double(burnt[i]));
        d.worst = std::max(d.worst, off / (double(burnt[i]) - now));
        d.ticks = std::max(d.ticks, off);
        d.mean += off / (double(burnt[i]) - now);
        ++d.texels;
    }
    d.mean /= std::max(d.texels, 1u);
    return d;
}

mesh::BurnDomain plane(double size, double density) {
    return bakeOf(makePlane(size, size).input(density, 4096));
}

void lightMiddle(FrontRig& rig, const mesh::BurnDomain& d, Vec3 at) {
    const uint32_t start = texelNear(d, at);
    rig.ignite([&](uint32_t i) { return i == start ? 0.0 : -1.0; });
}

TEST(Arrivals, MatchTheSimulation) {
    const struct {
        const char* name;
        mesh::BurnDomain domain;
        FrontRig::Material material;
        Vec3 drive, at;
    } cases[] = {
        {"plane", plane(1, 128), {.rate = 0.02}, {}, {0.4, 0.5, 0}},
        {"plane, wind",
         plane(1, 128),
         {.rate = 0.02, .headGain = 0.8, .backGain = 0.4, .lengthToBreadth = 3},
         {2, 1, 0},
         {0.3, 0.3, 0}},
        {"plane, fast", plane(1, 64), {.rate = 0.3}, {}, {0.1, 0.5, 0}},
        {"plane, burns out", plane(1, 128), {.rate = 0.01, .burnTime = 2}, {}, {0.5, 0.5, 0}},
        {"sphere with seams",
         bakeOf(makeCube(1, 12, true).input(96, 4096)),
         {.rate = 0.02},
         {},
         {0.5, 0, 0}},
    };
    for (const auto& c : cases) {
        FrontRig rig(c.domain, c.material, c.drive);
        rig.setTiming(c.drive.x != 0 ? 4096 : 1024, c.material.rate > 0.1 ? 3 : 0);
        lightMiddle(rig, c.domain, c.at);
        rig.runUntil(0.12 / c.material.rate);
        const uint32_t now = rig.now;
        const mesh::Arrivals arrivals = forecast(rig.arrivalInput());
        rig.runAll();
        const Difference d = differ(arrivals, rig.ticks(), now);
        std::printf("%-18s %u texels to come, mean %.3f %%, worst %.2f %% or %.0f ticks\n", c.name,
                    d.texels, 100 * d.mean, 100 * d.worst, d.ticks);
        EXPECT_GT(d.texels, 1000u) << c.name;
        EXPECT_EQ(d.other, 0u) << c.name;
        EXPECT_LT(d.worst, 0.05) << c.name;
        EXPECT_LT(d.mean, 0.005) << c.name;
    }
}

TEST(Arrivals, AreIndependentOfTimeSlices) {
    const mesh::BurnDomain d = bakeOf(makeCube(0.5, 8, true).input(64, 4096));
    FrontRig rig(d, {.rate = 0.02, .headGain = 0.5, .backGain = 0.2}, {1, 0, 0});
    lightMiddle(rig, d, {0.25, 0, 0});
    rig.runUntil(3);
    const mesh::ArrivalInput input = rig.arrivalInput();
    const mesh::Arrivals whole = forecast(input);
    mesh::Arrivals sliced(std::pmr::get_default_resource());
    mesh::beginArrivals(sliced, input);
    uint32_t before = 0, slices = 0;
    while (!sliced.whole) {
        const uint32_t left = mesh::runArrivals(sliced, 3);
        EXPECT_TRUE(left == 0 || sliced.whole);
        const uint32_t settled = sliced.settled();
        EXPECT_GE(settled, before);
        if (++slices % 50 == 0)
            for (size_t i = 0; i < sliced.ticks.size(); ++i) {
                // Settled texels keep their ticks in both runs.
                if (sliced.ticks[i] < settled)
                    ASSERT_EQ(sliced.ticks[i], whole.ticks[i]) << i;
                else
                    ASSERT_GE(whole.ticks[i], settled) << i;
            }
        before = settled;
    }
    EXPECT_GT(slices, 100u);
    EXPECT_EQ(sliced.ticks, whole.ticks);
}

// Water blocks as long as it is present: fire goes around it and never into an enclosed area.
TEST(Arrivals, GoAroundWalls) {
    const mesh::BurnDomain d = plane(1, 64);
    FrontRig rig(d, {.rate = 0.02});
    const auto wet = [&](uint32_t i) {
        const Vec3 p = texelPosition(d, i);
        const double ring = std::max(std::abs(p.x - 0.8), std::abs(p.y - 0.8));
        return (std::abs(p.x - 0.5) < 0.03 && p.y < 0.6) || (ring > 0.07 && ring < 0.12);
    };
    for (uint32_t i = 0; i < d.texelCount(); ++i)
        if (d.real(i) && wet(i)) rig.push(i, gpu::kEventWet, 100);
    lightMiddle(rig, d, {0.2, 0.1, 0});
    rig.runUntil(1);
    const uint32_t now = rig.now;
    const mesh::Arrivals arrivals = forecast(rig.arrivalInput());
    const double behind = (arrivals.ticks[texelNear(d, {0.8, 0.1, 0})] - double(kStartTick)) / 4096;
    // Over the wall's upper end and down again.
    const double way = std::hypot(0.27, 0.5) + 0.06 + std::hypot(0.27, 0.5);
    EXPECT_NEAR(behind, way / 0.02, 0.03 * way / 0.02);
    EXPECT_EQ(arrivals.ticks[texelNear(d, {0.8, 0.8, 0})], gpu::kNever);
    rig.runAll();
    EXPECT_LT(differ(arrivals, rig.ticks(), now).worst, 0.05);
    EXPECT_EQ(differ(arrivals, rig.ticks(), now).other, 0u);
}

TEST(Arrivals, AreNeverWithoutFire) {
    const mesh::BurnDomain d = plane(0.5, 64);
    FrontRig rig(d, {.rate = 0.02});
    const mesh::Arrivals arrivals = forecast(rig.arrivalInput());
    EXPECT_TRUE(std::none_of(arrivals.ticks.begin(), arrivals.ticks.end(), gpu::isSource));
    EXPECT_EQ(arrivals.settled(), gpu::kLiveEnd);
}

}  // namespace
