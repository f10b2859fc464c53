// Sparks of fire emitters on the CPU by the shader's own code: a function of clock and index.
#include "support/spark_reference.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace fw::test {
namespace {

using gpu::vec3;

void expectSame(const std::vector<Spark>& a, const std::vector<Spark>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (size_t i = 0; i < a.size(); ++i) {
        EXPECT_EQ(a[i].slot, b[i].slot);
        EXPECT_EQ(a[i].now.seed, b[i].now.seed);
        EXPECT_LT(glm::length(a[i].place - b[i].place), 1e-4f) << i;
    }
}

// Six seconds in many frames, in one frame, and after a seek.
TEST(Sparks, DependOnlyOnTheirClock) {
    SparkRig played(200), jumped(200), sought(200);
    for (int i = 0; i < 6 * 64; ++i) (void)played.step(1 / 64.0f);
    ASSERT_TRUE(jumped.step(6));
    sought.air.now = 6;
    components::settleSparks(sought.emitter, 6);
    ASSERT_TRUE(sought.step(0));
    const std::vector<Spark> shown = played.sparks();
    EXPECT_LT(150u, shown.size());
    expectSame(shown, jumped.sparks());
    expectSame(shown, sought.sparks());
    // A moment later there are others.
    ASSERT_TRUE(played.step(1.5f));
    EXPECT_GT(glm::length(played.sparks()[0].place - shown[0].place), 0.01f);
}

TEST(Sparks, StayAboveTheGroundAndSettleOnIt) {
    SparkRig rig(60);
    rig.air.wind[0] = 2;
    int bounced = 0, rest = 0, all = 0;
    for (int i = 0; i < 300; ++i) {
        ASSERT_TRUE(rig.step(1 / 30.0f));
        for (const Spark& one : rig.sparks()) {
            ASSERT_GT(one.place.y, 0.5f) << "slot " << one.slot << " at " << one.now.age << " s";
            ++all;
            bounced += one.leg.began > 0;
            rest += one.leg.began > 0 && one.leg.speed == vec3(0.0f);
        }
    }
    std::printf("[   FIGURE ] %d sparks: %d after a bounce, %d at rest\n", all, bounced, rest);
    EXPECT_LT(all / 50, bounced);
    EXPECT_LT(all / 200, rest);
}

TEST(Sparks, SettleOnAHeightfield) {
    SparkRig rig(60);
    rig.air.wind[0] = -1;
    int bounced = 0, rest = 0, high = 0, all = 0;
    for (int i = 0; i < 300; ++i) {
        ASSERT_TRUE(rig.step(1 / 30.0f));
        rig.makeHill();
        for (const Spark& one : rig.sparks()) {
            // Cells are bilinear between corners.
            const vec3 p(glm::clamp(one.place.x, -4.0f, 4.0f), one.place.y,
                         glm::clamp(one.place.z, -4.0f, 4.0f));
            const float low = std::min({rig.hill(p.x, std::floor(p.z)), rig.hill(p.x, p.z),
                                        rig.hill(p.x, std::ceil(p.z))});
            ASSERT_GT(p.y, low - 0.01f) << "slot " << one.slot << " at " << one.now.age << " s";
            ++all;
            bounced += one.leg.began > 0;
            const bool still = one.leg.began > 0 && one.leg.speed == vec3(0.0f);
            rest += still;
            high += still && p.y > 0.2f;
        }
    }
    std::printf("[   FIGURE ] %d sparks: %d after a bounce, %d at rest, %d of them uphill\n", all,
                bounced, rest, high);
    EXPECT_LT(all / 50, bounced);
    EXPECT_LT(all / 200, rest);
    EXPECT_LT(10, high);
}

// A spark moves continuously from frame to frame, also at a bounce.
TEST(Sparks, MoveContinuously) {
    SparkRig rig(100);
    constexpr float kStep = 1 / 240.0f;
    ASSERT_TRUE(rig.step(3));
    std::vector<Spark> last = rig.sparks();
    for (int i = 0; i < 600; ++i) {
        ASSERT_TRUE(rig.step(kStep));
        const std::vector<Spark> now = rig.sparks();
        size_t k = 0;
        for (const Spark& one : now) {
            while (k < last.size() && last[k].slot < one.slot) ++k;
            if (k == last.size() || last[k].now.seed != one.now.seed) continue;
            EXPECT_LT(glm::length(one.place - last[k].place), 25 * kStep)
                << "slot " << one.slot << " at " << one.now.age << " s";
        }
        last = now;
    }
}

// Sparks born over a long time at powers of 1 to 16.
TEST(Sparks, AreBornInProportionToPower) {
    double first = 0;
    for (const float power : {20.0f, 40.0f, 80.0f, 320.0f}) {
        SparkRig rig(power);
        ASSERT_TRUE(rig.step(10));
        int born = 0;
        constexpr int kTurns = 40;
        constexpr float kStep = 0.05f;
        for (int i = 0; i < int(kTurns * gpu::kSparkTurn / kStep); ++i) {
            ASSERT_TRUE(rig.step(kStep));
            for (const Spark& one : rig.sparks()) born += one.now.age < kStep;
        }
        const double rate = born / double(kTurns) / double(gpu::kSparkTurn) / double(power);
        std::printf("[   FIGURE ] %g kW: %.3f sparks a second for each kW\n", double(power), rate);
        EXPECT_NEAR(rate, 1, 0.03);
        if (first == 0) first = rate;
        EXPECT_NEAR(rate / first, 1, 0.04);
    }
}

// Sparks in flight are unaffected by later changes of power or place.
TEST(Sparks, DependOnTheirBirthOnly) {
    SparkRig rig(100), moved(100);
    for (SparkRig* one : {&rig, &moved})
        for (int i = 0; i < 200; ++i) ASSERT_TRUE(one->step(1 / 50.0f));
    const float away[3] = {0.3f, 0.6f, 0};
    components::moveFireEmitter(moved.emitter, away, nullptr);
    components::setEmitterPower(moved.emitter, 5);
    constexpr float kLater = 0.5f;
    for (SparkRig* one : {&rig, &moved})
        for (int i = 0; i < 25; ++i) ASSERT_TRUE(one->step(kLater / 25));
    size_t k = 0, same = 0, old = 0;
    const std::vector<Spark> as = rig.sparks(), is = moved.sparks();
    for (const Spark& one : as) {
        if (one.now.age < kLater + 0.3f) continue;  // a step of the clock lies between
        ++old;
        while (k < is.size() && is[k].slot < one.slot) ++k;
        same += k < is.size() && is[k].now.seed == one.now.seed;
    }
    EXPECT_LT(20u, old);
    EXPECT_EQ(old, same);
    size_t young = 0;
    for (const Spark& one : is) young += one.now.age < kLater - 0.3f;
    EXPECT_LT(young, 10u);
}

// After a teleport nothing flies there yet; without power sparks end.
TEST(Sparks, BeginAndEndWithTheirSource) {
    SparkRig rig(100);
    ASSERT_TRUE(rig.step(1 / 60.0f));
    EXPECT_LT(rig.sparks().size(), 8u);
    ASSERT_TRUE(rig.step(4));
    EXPECT_LT(80u, rig.sparks().size());
    const float away[3] = {500, 0.6f, 0};
    components::moveFireEmitter(rig.emitter, away, nullptr);
    ASSERT_TRUE(rig.step(1 / 60.0f));
    EXPECT_LT(rig.sparks().size(), 30u);
    for (const Spark& one : rig.sparks()) EXPECT_GT(one.place.x, 450.0f);
    ASSERT_TRUE(rig.step(1));
    components::setEmitterPower(rig.emitter, 0);
    EXPECT_TRUE(rig.step(0.1f));
    EXPECT_FALSE(rig.step(4));
}

TEST(Sparks, BounceOffTheWallOfAJet) {
    SparkRig rig(1);
    FwFireEmitterDef def = rig.emitter.def;
    def.shape = FW_EMITTER_POINT;
    def.flags = FW_EMITTER_JET;
    def.direction[0] = 1;
    def.direction[1] = 0;
    def.power = 500;
    def.cone = 0.1f;
    components::makeFireEmitter(def, 7, rig.emitter);
    components::JetObstacle wall;
    wall.met = true;
    wall.place[0] = 2;
    wall.place[1] = 0.6f;
    wall.normal[0] = -1;
    wall.radius = 3;
    components::setJetObstacle(rig.emitter, 0, wall, 0);
    ASSERT_TRUE(rig.step(5));
    ASSERT_TRUE(rig.record.flags & gpu::kSparkWall);
    gpu::SparkBounds bounds{};
    bounds.ground = {0, 1, 0, -1e9f};
    bounds.wall = rig.record.wall;
    bounds.normal = vec3(rig.record.wallNormal);
    int back = 0;
    for (uint32_t seed = 1; seed < 400; ++seed) {
        const gpu::SparkKind kind = gpu::sparkKind(seed);
        const vec3 up(0, 1, 0), way(1, 0, 0);
        const gpu::SparkLeg born =
            gpu::sparkBorn(rig.record, kind, seed, vec3(0, 0.6f, 0), way, vec3(0.0f));
        for (float age = 0; age < kind.life; age += 0.05f) {
            const gpu::SparkLeg leg = gpu::sparkLeg(kind, born, bounds, up, age);
            const vec3 p = gpu::sparkPlace(leg, kind, bounds, up, seed, age);
            if (std::abs(p.y) < 3) {
                EXPECT_LT(p.x, 2.02f) << seed << " at " << age;
            }
            back += leg.began > 0 && leg.speed.x < 0;
        }
    }
    EXPECT_LT(100, back);
}

}  // namespace
}  // namespace fw::test
