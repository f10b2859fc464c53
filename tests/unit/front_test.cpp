// Accuracy of the front on known surfaces: errors of arrival against exact travel times.
#include "shared/front.h"
#include "support/front_rig.h"
#include "support/sanitized.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <ctime>
#include <numbers>

namespace fw::test::front_test {
namespace {

constexpr double kPi = std::numbers::pi;

mesh::BurnDomain bakeOf(const Mesh& mesh, double density) {
    mesh::BakeInput input = mesh.input(density, 4096);
    input.trustUvs = true;
    return mesh::bake(input, std::pmr::get_default_resource());
}

struct Error {  // relative errors
    double most = 0, sum = 0;
    int count = 0;
    void add(double e) {
        most = std::max(most, std::abs(e));
        sum += std::abs(e);
        ++count;
    }
    [[nodiscard]] double mean() const { return count ? sum / count : 1; }
};

// Travel time over a displacement in a plane from head speed, back speed and drive direction.
struct Ellipse {
    double head, back;
    Vec3 along;
    [[nodiscard]] double time(Vec3 e) const {
        return (1 / head + 1 / back) / 2 * length(e) - (1 / back - 1 / head) / 2 * dot(e, along);
    }
};

// Gain g with head = R (1 + g) and back = R / (1 + g) for a length to breadth.
double gainOf(double lengthToBreadth) {
    return lengthToBreadth + std::sqrt(lengthToBreadth * lengthToBreadth - 1) - 1;
}

uint32_t windowOf(double links, double side, double rate) {
    return std::max(512u, uint32_t(links * side / rate * 4096));
}

TEST(Front, IsqrtIsExact) {
    const auto check = [](uint32_t n) {
        const double exact = std::sqrt(double(n));
        const uint32_t r = gpu::isqrtNear(n);
        // |r - sqrt n| <= 1/2; integers have no tie.
        ASSERT_LE(std::abs(double(r) - exact), 0.5) << n;
    };
    for (uint32_t n = 0; n < 70000; ++n) check(n);
    // Around every square and half-way point up to the kernel's largest argument.
    for (uint64_t r = 2; r < 65535; ++r)
        for (int64_t d = -1; d <= 1; ++d) {
            check(uint32_t(int64_t(r * r) + d));
            check(uint32_t(int64_t(r * r + r) + d));
        }
}

TEST(Front, MulShiftSaturates) {
    EXPECT_EQ(gpu::mulShift(0x80000000u, 4u, 1), 0xFFFFFFFFu);
    EXPECT_EQ(gpu::mulShift(0x80000000u, 1u, 1), 0x40000000u);
    EXPECT_EQ(gpu::mulShift(0xFFFFFFFFu, 128u, 7), 0xFFFFFFFFu);
    EXPECT_EQ(gpu::mulShift(0xFFFFFFFFu, 65535u, 7), 0xFFFFFFFFu);
}

TEST(Front, NormalDecodesAxesExactly) {
    EXPECT_EQ(gpu::decodeNormal(1023u), gpu::ivec3(16384, 0, 0));
    EXPECT_EQ(gpu::decodeNormal(uint32_t(-1023) & 0x7FFu).x, -16384);
    EXPECT_EQ(gpu::decodeNormal(511u << 22), gpu::ivec3(0, 0, 16384));
    EXPECT_EQ(gpu::decodeNormal(1023u << 11), gpu::ivec3(0, 16384, 0));
}

// Extreme records and slowness must neither trap nor stop time; sanitizers check this.
TEST(Front, KernelSurvivesExtremes) {
    std::mt19937 random(5);
    for (int i = 0; i < 20000; ++i) {
        gpu::BurnMaterial m{};
        m.sigma0 = random() >> (random() % 32);
        m.headGain = random() % 65281;
        m.backGain = random() % 65281;
        m.driveMax = random() % 64513;
        m.breadthMax = 256 + random() % 65280;
        m.ceiling = random() % 1025;
        const auto part = [&] { return int(random() % 75001) - 37500; };
        m.driveX = part();
        m.driveY = part();
        m.driveZ = part();
        m.upCeiling = {0, uint32_t(-1024), 0, 0};
        const gpu::FrontDrive p =
            gpu::prepareFront(gpu::decodeNormal(random()), 1 + random() % 65535, m);
        gpu::FrontRing ring;
        for (int k = 0; k < 8; ++k) {
            ring.tick[k] = random() >> (random() % 20) & 0x7FFFFFFFu;
            ring.burn[k] = random() % 3 ? gpu::kNoneTexel : random() % 100000;
            const auto unit = [&] { return int(random() % 9458) - 4729; };
            ring.link[k] = {unit(), unit(), unit()};
        }
        uint32_t wake = gpu::kNever, nextWake = gpu::kNever;
        const uint32_t counts = random() & 0xFF;
        const uint32_t t = gpu::frontArrival(ring, counts, p, 1 << 20, 0x7FFFFFFF, 1000, random(),
                                             true, wake, nextWake);
        if (t == gpu::kNever) continue;
        uint32_t least = gpu::kNever;
        for (int k = 0; k < 8; ++k)
            if (counts >> k & 1) least = std::min(least, ring.tick[k]);
        ASSERT_GE(t, least);
        ASSERT_LT(t, 0x90000000u);
    }
}

// On a ring of a baked shape, sources no sooner than `nextWake` change nothing and sooner ones
// sometimes do.
TEST(Front, SourcesAfterTheNextWakeChangeNothing) {
    std::mt19937 random(29);
    uint32_t asked = 0, early = 0, changed = 0;
    for (int i = 0; i < 400000; ++i) {
        gpu::BurnMaterial m{};
        m.sigma0 = 1u << (14 + random() % 6);
        m.headGain = random() % 1024;
        m.backGain = random() % 1024;
        m.driveMax = 60 * 1024;
        m.breadthMax = 14 * 256;
        const auto part = [&] { return random() % 3 ? int(random() % 2049) - 1024 : 0; };
        m.driveX = part();
        m.driveY = part();
        const gpu::FrontDrive p = gpu::prepareFront({0, 0, 16384}, 96 + random() % 64, m);
        const int unit = 100 + int(random() % 900), skew = int(random() % 3) * unit / 3;
        const uint32_t now = 100000, floorTick = 99000;
        gpu::FrontRing ring;
        for (int k = 0; k < 8; ++k) {
            const auto jitter = [&] { return int(random() % uint32_t(unit)) / 3 - unit / 6; };
            ring.tick[k] = now - random() % 800;
            ring.burn[k] = random() % 5 ? gpu::kNoneTexel : random() % 4000;
            const int x = mesh::kRingX[k], y = mesh::kRingY[k];
            ring.link[k] = {-x * unit + y * skew + jitter(), -y * unit + jitter(), jitter()};
        }
        const uint32_t counts = random() & 0xFF & random(), texel = random();
        uint32_t wake = gpu::kNever, nextWake = gpu::kNever, unused = gpu::kNever;
        const auto arrival = [&](uint32_t sources, bool settles, uint32_t& out) {
            return gpu::frontArrival(ring, sources, p, 1 << 20, now, floorTick, texel, settles,
                                     wake, out);
        };
        const uint32_t t = arrival(counts, true, nextWake);
        ASSERT_EQ(t, arrival(counts, false, unused));
        ASSERT_EQ(unused, gpu::kNever);
        if (nextWake == gpu::kNever) continue;
        const bool soon = i % 2 != 0;
        const uint32_t others = random() & 0xFF & ~counts;
        for (int k = 0; k < 8; ++k) {
            if ((others >> k & 1) == 0) continue;
            ring.tick[k] = soon ? nextWake - 1 - random() % 200 : nextWake + random() % 100;
            ring.burn[k] = gpu::kNoneTexel;
        }
        const uint32_t after = arrival(counts | others, false, unused);
        if (soon) {
            early += others ? 1 : 0;
            changed += after != t ? 1 : 0;
        } else {
            ASSERT_EQ(t, after) << i;
            asked += others ? 1 : 0;
        }
    }
    EXPECT_GT(asked, 50000u);
    EXPECT_GT(changed, early / 20);
    std::printf("wake: %u rings, and %u of %u that came sooner changed\n", asked, changed, early);
}

TEST(Front, PlanarFrontSpeedIsExact) {
    struct Case {
        double density, degrees, stretch, speedLimit, arrivalLimit;
    };
    const Case cases[] = {{64, 15, 1, 0.012, 0.02},   {128, 0, 1, 0.012, 0.005},
                          {128, 30, 1, 0.012, 0.02},  {256, 45, 1, 0.012, 0.02},
                          {1024, 15, 1, 0.012, 0.02}, {128, 15, 2, 0.045, 0.045},
                          {256, 45, 2, 0.045, 0.045}};
    double slowest = 1e9, fastest = 0;
    for (const Case& c : cases) {
        const double side = 120 / c.density;
        const mesh::BurnDomain d =
            bakeOf(makePlane(side, side / 2, c.degrees, c.stretch), c.density);
        const double h = 1 / c.density, rate = 0.011;
        FrontRig rig(d, {.rate = rate});
        rig.ignite([&](uint32_t i) {
            const double x = texelPosition(d, i).x;
            return x < 4 * h ? x / rate : -1;
        });
        rig.runAll();
        double sx = 0, st = 0, sxx = 0, sxt = 0;
        int n = 0;
        Error e;
        for (uint32_t i = 0; i < d.texelCount(); ++i) {
            if (!d.real(i)) continue;
            const Vec3 p = texelPosition(d, i);
            const double edge = std::min(p.y, side / 2 - p.y);
            if (p.x < 25 * h || edge < 3 * h || side - p.x < 3 * h) continue;
            const double t = rig.arrival(i);
            ASSERT_GE(t, 0);
            e.add(t / (p.x / rate) - 1);
            sx += p.x;
            st += t;
            sxx += p.x * p.x;
            sxt += p.x * t;
            ++n;
        }
        const double speed = (n * sxx - sx * sx) / (n * sxt - sx * st) / rate;
        EXPECT_NEAR(speed, 1, c.speedLimit) << c.density << "/m " << c.degrees;
        EXPECT_LT(e.most, c.arrivalLimit) << c.density << "/m " << c.degrees;
        std::printf("%4.0f/m %2.0f deg stretch %.0f: speed %+.3f %%, worst arrival %.2f %%\n",
                    c.density, c.degrees, c.stretch, (speed - 1) * 100, e.most * 100);
        if (c.stretch == 1) {
            slowest = std::min(slowest, speed);
            fastest = std::max(fastest, speed);
        }
    }
    EXPECT_LT(fastest / slowest - 1, 0.005);
}

struct PointStart {
    Error all, head;
    uint32_t late = 0;
};

// A disc on a plane, all texels lit together; errors farther than 25 texels from it.
PointStart pointStart(const mesh::BurnDomain& d, double lengthToBreadth, double degrees,
                      double rate) {
    const double g = lengthToBreadth > 1 ? gainOf(lengthToBreadth) : 0;
    const Vec3 along{std::cos(degrees * kPi / 180), std::sin(degrees * kPi / 180), 0};
    const double drive = lengthToBreadth > 1 ? 1 : 0;
    FrontRig rig(d, {.rate = rate, .headGain = g, .backGain = g}, along * drive);
    const double links = lengthToBreadth <= 1.5 ? 0 : lengthToBreadth <= 2 ? 1 : 2;
    const double h = double(d.texelSide);
    rig.setTiming(windowOf(links, h, rate));
    const Ellipse ellipse{rate * (1 + g), rate / (1 + g), along};
    const Vec3 middle{double(d.boundsHigh[0]) / 2, double(d.boundsHigh[1]) / 2, 0};
    const uint32_t start = texelNear(d, middle - along * (0.4 * drive));
    const Vec3 centre = texelPosition(d, start);
    std::vector<Vec3> disc;
    rig.ignite([&](uint32_t i) {
        const Vec3 e = texelPosition(d, i) - centre;
        if (length(e) > 3.1 * h) return -1.0;
        disc.push_back(e);
        return 0.0;
    });
    rig.runAll();
    PointStart result;
    for (uint32_t i = 0; i < d.texelCount(); ++i) {
        if (!d.real(i)) continue;
        const Vec3 x = texelPosition(d, i) - centre;
        if (length(x) < 25 * h) continue;
        double exact = 1e9;
        for (Vec3 p : disc) exact = std::min(exact, ellipse.time(x - p));
        const double e = rig.arrival(i) / exact - 1;
        result.all.add(e);
        if (dot(x, along) / length(x) > 0.9995) result.head.add(e);
    }
    result.late = rig.counters().lateClamps;
    return result;
}

TEST(Front, PointStartGrowsAsACircle) {
    const mesh::BurnDomain d = bakeOf(makePlane(1, 1), 128);
    const PointStart r = pointStart(d, 1, 0, 0.02);
    std::printf("point start: max %.2f %%, mean %.2f %%, late %u\n", r.all.most * 100,
                r.all.mean() * 100, r.late);
    EXPECT_LT(r.all.most, 0.011);
    EXPECT_LT(r.all.mean(), 0.004);
    EXPECT_EQ(r.late, 0u);
}

TEST(Front, WindDrivenFrontsAreEllipses) {
    const mesh::BurnDomain d = bakeOf(makePlane(1.2, 1.2), 128);
    struct Case {
        double lb, degrees, most, mean, head;
    };
    for (const Case& c : {Case{1.5, 20, 0.038, 0.009, 0.038}, Case{2, 20, 0.052, 0.012, 0.046},
                          Case{2, 0, 0.055, 0.012, 0.046}, Case{3.43, 20, 0.155, 0.026, 0.075}}) {
        const PointStart r = pointStart(d, c.lb, c.degrees, 0.02);
        std::printf("LB %.2f %2.0f deg: max %.1f %%, mean %.2f %%, head %.1f %%, late %u\n", c.lb,
                    c.degrees, r.all.most * 100, r.all.mean() * 100, r.head.most * 100, r.late);
        EXPECT_LT(r.all.most, c.most) << c.lb;
        EXPECT_LT(r.all.mean(), c.mean) << c.lb;
        EXPECT_LT(r.head.most, c.head) << c.lb;
    }
}

TEST(Front, HeadFiresHaveTheirSpeed) {
    for (double degrees : {0.0, 10.0, 20.0, 33.0}) {
        const mesh::BurnDomain d = bakeOf(makePlane(0.6, 0.6, degrees), 128);
        for (double lb : {1.0, 2.0, 3.43}) {
            const double g = gainOf(lb), rate = 0.02, head = rate * (1 + g);
            const double h = double(d.texelSide);
            FrontRig rig(d, {.rate = rate, .headGain = g, .backGain = g},
                         lb > 1 ? Vec3{1, 0, 0} : Vec3{});
            rig.setTiming(windowOf(lb > 2 ? 5 : lb > 1 ? 1 : 0, h, rate), lb > 2 ? 1 : 0);
            rig.ignite([&](uint32_t i) {
                const double x = texelPosition(d, i).x;
                return x < 3 * h ? x / head : -1;
            });
            rig.runAll();
            Error e;
            for (uint32_t i = 0; i < d.texelCount(); ++i) {
                if (!d.real(i)) continue;
                const Vec3 p = texelPosition(d, i);
                if (p.x < 25 * h || std::min(p.y, 0.6 - p.y) < 8 * h) continue;
                e.add(rig.arrival(i) / (p.x / head) - 1);
            }
            std::printf("straight head %2.0f deg LB %.2f: worst %.3f %%\n", degrees, lb,
                        e.most * 100);
            EXPECT_LT(e.most, lb > 3 ? 0.006 : 0.005) << degrees << " " << lb;
        }
    }
}

// Arrival against great circles, from a chart's middle and from a seam.
TEST(Front, ArrivalOnASphereMatchesGreatCircles) {
    const double rate = 0.02;
    for (double density : {64.0, 128.0}) {
        const mesh::BurnDomain d = bakeOf(makeCube(1, 48, true, true), density);
        const double h = double(d.texelSide);
        for (const Vec3 from : {Vec3{0.5, 0.02, 0.03}, Vec3{0.35, 0.35, 0}}) {
            if (density > 100 && from.y > 0.1) continue;
            const Vec3 start = texelPosition(d, texelNear(d, from));
            const auto exact = [&](uint32_t i) {
                const Vec3 a = normalised(start), b = normalised(texelPosition(d, i));
                return std::atan2(length(cross(a, b)), dot(a, b)) * length(start);
            };
            FrontRig rig(d, {.rate = rate});
            rig.ignite([&](uint32_t i) {
                const double s = exact(i);
                return s < 3.1 * h ? s / rate : -1;
            });
            rig.runAll();
            double farthest = 0, antipode = 0, worstJump = 0;
            Error e;
            uint32_t unburnt = 0;
            for (uint32_t i = 0; i < d.texelCount(); ++i) {
                if (!d.real(i)) continue;
                if (rig.arrival(i) < 0) {
                    ++unburnt;
                    continue;
                }
                const double s = exact(i);
                if (s > 25 * h) e.add(rig.arrival(i) / (s / rate) - 1);
                if (s > farthest) {
                    farthest = s;
                    antipode = rig.arrival(i) / (s / rate) - 1;
                }
            }
            for (uint32_t tile = 0; tile < d.tileCount(); ++tile) {
                const mesh::TileStatic& statics = d.tiles[tile];
                uint32_t record = statics.rimBase;
                for (uint32_t lane = 0; lane < 64; ++lane) {
                    if ((statics.rimMask >> lane & 1) == 0) continue;
                    const uint32_t i =
                        (tile / d.tilesX * 8 + lane / 8) * d.width + tile % d.tilesX * 8 + lane % 8;
                    for (uint32_t k = 0; k < 8; ++k) {
                        const uint32_t j = d.links[size_t(record) * 8 + k];
                        if (j == mesh::kNone || rig.arrival(i) < 0 || rig.arrival(j) < 0) continue;
                        const double link = length(texelPosition(d, i) - texelPosition(d, j));
                        worstJump =
                            std::max(worstJump,
                                     (std::abs(rig.arrival(i) - rig.arrival(j)) * rate - link) / h);
                    }
                    ++record;
                }
            }
            std::printf(
                "sphere %3.0f/m: antipode %+.2f %%, mean %.2f %%, worst %.2f %%, "
                "seam jump %.2f links\n",
                density, antipode * 100, e.mean() * 100, e.most * 100, worstJump);
            EXPECT_EQ(unburnt, 0u);
            EXPECT_NEAR(antipode, 0, 0.02);
            EXPECT_LT(e.mean(), 0.006);
            EXPECT_LE(worstJump, 0.6);
        }
    }
}

// A cylinder cut into charts burns like an uncut one.
TEST(Front, ChartsDoNotChangeABurningCylinder) {
    const double radius = 0.2, rate = 0.02;
    for (int cuts : {1, 2, 4}) {
        const mesh::BurnDomain d = bakeOf(makeCylinder(radius, 0.8, 192, 8, cuts, cuts > 1), 128);
        const double h = double(d.texelSide);
        const Vec3 start =
            texelPosition(d, texelNear(d, {radius * std::cos(0.7), 0.4, radius * std::sin(0.7)}));
        const auto exact = [&](uint32_t i) {
            const Vec3 p = texelPosition(d, i);
            double turn = std::atan2(p.z, p.x) - std::atan2(start.z, start.x);
            turn -= 2 * kPi * std::round(turn / (2 * kPi));
            return std::hypot(radius * turn, p.y - start.y);
        };
        FrontRig rig(d, {.rate = rate});
        rig.ignite([&](uint32_t i) {
            const double s = exact(i);
            return s < 3.1 * h ? s / rate : -1;
        });
        rig.runAll();
        double worst = 0;
        Error e;
        for (uint32_t i = 0; i < d.texelCount(); ++i) {
            if (!d.real(i)) continue;
            const double s = exact(i);
            if (cuts == 1 && s > 0.4 * radius * kPi) continue;  // an open seam: no path around
            ASSERT_GE(rig.arrival(i), 0);
            if (s < 25 * h) continue;
            e.add(rig.arrival(i) / (s / rate) - 1);
            worst = std::max(worst, std::abs(rig.arrival(i) * rate - s) / h);
        }
        std::printf("cylinder in %d: mean %.2f %%, max %.2f %%, %.2f links\n", cuts, e.mean() * 100,
                    e.most * 100, worst);
        EXPECT_LT(worst, 1.0) << cuts;
    }
}

TEST(Front, ArrivalIsIndependentOfTheTimeStep) {
    const mesh::BurnDomain d = bakeOf(makePlane(0.8, 0.8), 128);
    const double h = double(d.texelSide);
    struct Case {
        double head, gain, limit;
    };
    for (const Case& c :
         {Case{0.1, 0, 0}, Case{0.2, 0, 0}, Case{0.1, 2.732, 0.0005}, Case{0.1, 5.711, 0.006}}) {
        const double rate = c.head / (1 + c.gain);
        const Vec3 along{std::cos(0.35), std::sin(0.35), 0};
        std::vector<uint32_t> reference;
        for (uint32_t shift : {3u, 1u, 0u}) {
            FrontRig rig(d, {.rate = rate, .headGain = c.gain, .backGain = c.gain},
                         c.gain > 0 ? along : Vec3{});
            rig.setTiming(windowOf(c.gain > 3 ? 2 : c.gain > 0 ? 1 : 0, h, rate), shift);
            const Vec3 centre{0.25, 0.25, 0};
            rig.ignite([&](uint32_t i) {
                return length(texelPosition(d, i) - centre) < 3.1 * h ? 0.0 : -1.0;
            });
            rig.runAll();
            if (reference.empty()) {
                reference.assign(rig.ticks().begin(), rig.ticks().end());
                continue;
            }
            double most = 0;
            for (uint32_t i = 0; i < d.texelCount(); ++i)
                if (d.real(i) && reference[i] > kStartTick + 512)
                    most = std::max(most, std::abs(double(rig.ticks()[i]) - reference[i]) /
                                              (reference[i] - double(kStartTick)));
            std::printf("head %.2f gain %.2f, %u substeps against 8: %.4f %%\n", c.head, c.gain,
                        1u << shift, most * 100);
            EXPECT_LE(most, c.limit) << c.head << " " << c.gain;
            if (c.limit == 0) {
                EXPECT_TRUE(std::equal(reference.begin(), reference.end(), rig.ticks().begin()));
            }
        }
    }
}

// Up 90, sideways 11, down 2 mm/s: Mathur, Vikas, Kale.
TEST(Front, CottonPanelBurnsAtItsRate) {
    const double rate = 0.011;
    const mesh::BurnDomain d = bakeOf(makePlane(0.9, 0.9, 10, 1, 90), 128);
    const double h = double(d.texelSide);
    FrontRig rig(d, {.rate = rate, .headGain = 7.2, .backGain = 4.5, .lengthToBreadth = 3.5},
                 {0, 0, 1});
    rig.setTiming(windowOf(2, h, rate), 1);
    const Vec3 centre = texelPosition(d, texelNear(d, {0.45, 0, 0.2}));
    rig.ignite(
        [&](uint32_t i) { return length(texelPosition(d, i) - centre) < 3.1 * h ? 0.0 : -1.0; });
    rig.runAll();
    const auto speed = [&](Vec3 direction, double from) {
        const uint32_t a = texelNear(d, centre + direction * from);
        const uint32_t b = texelNear(d, centre + direction * (from * 2.2));
        return length(texelPosition(d, b) - texelPosition(d, a)) /
               (rig.arrival(b) - rig.arrival(a)) * 1000;
    };
    const double up = speed({0, 0, 1}, 0.25), down = speed({0, 0, -1}, 0.07);
    const double top = rig.arrival(texelNear(d, centre + Vec3{0, 0, 0.6}));
    double half[2] = {};
    for (uint32_t i = 0; i < d.texelCount(); ++i) {
        if (!d.real(i)) continue;
        for (int k = 0; k < 2; ++k)
            if (rig.arrival(i) <= top * (k + 1) / 2)
                half[k] = std::max(half[k], std::abs(texelPosition(d, i).x - centre.x));
    }
    const double sideways = (half[1] - half[0]) / (top / 2) * 1000;
    std::printf("cotton: up %.1f, down %.2f, sideways %.1f mm/s\n", up, down, sideways);
    EXPECT_NEAR(up, 90, 9);
    EXPECT_NEAR(down, 2, 0.2);
    EXPECT_GE(sideways, 11);
    EXPECT_LE(sideways, 14);
}

TEST(Front, CostOfASmallFireIsIndependentOfMapSize) {
    uint64_t tiles[2] = {};
    double milliseconds[2] = {1e9, 1e9};
    const double sides[2] = {248 / 128.0, 1016 / 128.0};
    const mesh::BurnDomain domains[2] = {bakeOf(makePlane(sides[0], sides[0]), 128),
                                         bakeOf(makePlane(sides[1], sides[1]), 128)};
    // Processor time, alternating, the least of each: pauses of a shared machine hit both.
    for (int repeat = 0; repeat < 6; ++repeat)
        for (int m = 0; m < 2; ++m) {
            const mesh::BurnDomain& d = domains[m];
            FrontRig rig(d, {.rate = 0.02});
            const Vec3 centre{0.45, 0.45, 0};
            rig.ignite([&](uint32_t i) {
                return length(texelPosition(d, i) - centre) < 0.025 ? 0.0 : -1.0;
            });
            rig.step();
            const std::clock_t start = std::clock();
            while (rig.now < kStartTick + 4096 * 15) rig.step();
            const double total = 1000.0 * double(std::clock() - start) / CLOCKS_PER_SEC;
            tiles[m] = rig.totalRunTiles;
            milliseconds[m] = std::min(milliseconds[m], total);
        }
    std::printf("%llu and %llu tiles run, %.2f and %.2f ms\n", (unsigned long long)tiles[0],
                (unsigned long long)tiles[1], milliseconds[0], milliseconds[1]);
    // The same fire may lie differently on the tiles of the two maps.
    EXPECT_NEAR(double(tiles[0]), double(tiles[1]), 0.02 * double(tiles[0]));
    if (!fw::test::kSanitized) {
        EXPECT_LT(milliseconds[1], 1.3 * milliseconds[0]);
    }
}

}  // namespace
}  // namespace fw::test::front_test
