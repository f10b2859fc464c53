// Particles of fire emitters on the CPU by the shader's own code: births, motion, appearance.
#include "support/particle_reference.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace fw::test {
namespace {

using gpu::vec3;

FwFireEmitterDef jetDef() {
    FwFireEmitterDef def{};
    def.stickTime = 6;
    def.flags = FW_EMITTER_JET;
    def.direction[0] = 1;
    def.power = 2000;
    def.lifeVariance = 0.33f;
    def.buoyancy = def.windResponse = def.turbulence = def.smokeDensity = 1;
    def.inherit = 0.5f;
    def.smoke = 0.32f;
    def.smokeLife = 2.2f;
    def.sparks = 0.04f;
    return def;
}
FwFireEmitterDef fireDef(float power) {
    FwFireEmitterDef def = jetDef();
    def.flags = 0;
    def.direction[0] = 0;
    def.direction[1] = 1;
    def.power = power;
    return def;
}

TEST(Particles, EachRingSlotHoldsTheNewestParticle) {
    for (const uint32_t ring : {1u, 7u, 256u})
        for (uint32_t head = 0; head < ring; ++head) {
            std::set<uint32_t> ages;
            for (uint32_t i = 0; i < ring; ++i) ages.insert(gpu::particleBirths(head, ring, i));
            EXPECT_EQ(ring, ages.size());
            EXPECT_EQ(ring - 1, *ages.rbegin());
            EXPECT_EQ(0u, gpu::particleBirths(head, ring, (head + ring - 1) % ring));
        }
}

struct Cloud {
    vec3 mean{0.0f};
    float reach = 0, count = 0;
};
Cloud fireOf(const ParticleReference& jet) {
    Cloud cloud;
    for (uint32_t i = 0; i < jet.record.ring; ++i) {
        const gpu::ParticleTraits t = jet.traits(i);
        if (!jet.alive(i) || jet.particles[i].placeAge.w > t.life) continue;
        cloud.mean += jet.place(i);
        cloud.reach = std::max(cloud.reach, jet.place(i).x);
        cloud.count += 1;
    }
    cloud.mean /= std::max(cloud.count, 1.0f);
    return cloud;
}

// 12 m/s is 0.4 m per frame at 30 Hz: births lie where they would at any frame rate.
TEST(Particles, AreIndependentOfTheFrameRate) {
    Cloud clouds[3];
    const float rates[3] = {30, 60, 120};
    for (int k = 0; k < 3; ++k) {
        ParticleReference jet(jetDef());
        for (int i = 0; i < int(2 * rates[k]); ++i) jet.step(1 / rates[k]);
        clouds[k] = fireOf(jet);
        // No gap in the young, narrow part of the stream.
        std::vector<float> along;
        for (uint32_t i = 0; i < jet.record.ring; ++i)
            if (jet.alive(i) && jet.particles[i].placeAge.w < 0.25f)
                along.push_back(jet.place(i).x);
        std::sort(along.begin(), along.end());
        ASSERT_LT(30u, along.size());
        for (size_t i = 1; i < along.size(); ++i)
            EXPECT_LT(along[i] - along[i - 1], 0.45f) << rates[k] << " Hz at " << along[i] << " m";
    }
    for (int k = 1; k < 3; ++k) {
        EXPECT_NEAR(clouds[0].count, clouds[k].count, 0.03f * clouds[0].count);
        EXPECT_NEAR(clouds[0].mean.x, clouds[k].mean.x, 0.06f * clouds[0].mean.x);
        EXPECT_NEAR(clouds[0].mean.y, clouds[k].mean.y, 0.15f);
    }
    // Tuned reach: 8 to 9.5 m.
    EXPECT_GT(clouds[1].reach, 7.0f);
    EXPECT_LT(clouds[1].reach, 11.0f);
}

TEST(Particles, AreBornAlongAMovingEmitterButNotAcrossATeleport) {
    FwFireEmitterDef def = fireDef(60);
    def.rate = 600;
    def.inherit = 0;
    def.sparks = 0;
    ParticleReference fire(def);
    fire.step(0.05f);
    const float there[3] = {1.5f, 0, 0};
    components::moveFireEmitter(fire.emitter, there, nullptr);
    fire.step(0.05f);
    int between = 0;
    for (uint32_t i = 0; i < fire.record.ring; ++i)
        between += fire.alive(i) && fire.place(i).x > 0.4f && fire.place(i).x < 1.1f;
    EXPECT_NEAR(between, 14, 5);
    const float far[3] = {20, 0, 0};
    components::moveFireEmitter(fire.emitter, far, nullptr);
    fire.step(0.05f);
    for (uint32_t i = 0; i < fire.record.ring; ++i)
        if (fire.alive(i)) {
            EXPECT_TRUE(fire.place(i).x < 2.5f || fire.place(i).x > 19);
        }
}

TEST(Particles, PowerSetsUnspecifiedParameters) {
    components::EmitterAppearance last = components::emitterAppearance(fireDef(5));
    for (const float power : {50.0f, 500.0f, 5000.0f}) {
        const components::EmitterAppearance look = components::emitterAppearance(fireDef(power));
        EXPECT_GT(look.rate, last.rate);
        EXPECT_GT(look.size0, last.size0);
        EXPECT_GT(look.speed, last.speed);
        EXPECT_GT(look.life, last.life);
        EXPECT_GT(look.reach, last.reach);
        last = look;
    }
    FwFireEmitterDef def = fireDef(500);
    def.rate = 7;
    def.size0 = 0.5f;
    def.life = 3;
    const components::EmitterAppearance own = components::emitterAppearance(def);
    EXPECT_EQ(7, own.rate);
    EXPECT_EQ(0.5f, own.size0);
    EXPECT_EQ(3, own.life);
}

TEST(Particles, RiseLeanInWindAndTurnToSmoke) {
    FwFireEmitterDef def = fireDef(200);
    def.sparks = 0;
    ParticleReference still(def), windy(def);
    windy.air.wind[0] = 3;
    for (int i = 0; i < 240; ++i) {
        still.step(1 / 60.0f);
        windy.step(1 / 60.0f);
    }
    const Cloud up = fireOf(still), aside = fireOf(windy);
    EXPECT_GT(up.mean.y, 0.3f);
    EXPECT_NEAR(up.mean.x, 0, 0.25f);
    EXPECT_GT(aside.mean.x, 0.4f);
    int smoke = 0, all = 0;
    float highest = 0;
    for (uint32_t i = 0; i < still.record.ring; ++i) {
        if (!still.alive(i)) continue;
        const bool old = still.particles[i].placeAge.w > still.traits(i).life;
        smoke += old;
        all += 1;
        if (old) {
            EXPECT_GT(still.traits(i).smoke, 0.0f);
            highest = std::max(highest, still.place(i).y);
        }
    }
    // A third of them, for twice the time.
    EXPECT_NEAR(float(smoke) / float(all), 0.41f, 0.1f);
    EXPECT_GT(highest, 1.3f * up.mean.y);
}

TEST(Particles, FadeContinuously) {
    ParticleReference jet(jetDef());
    jet.step(0.02f);
    float fire = 0, smoke = 0;
    for (float a = 0; a < 3.3f; a += 0.01f) {
        const float f = gpu::particleFire(a, 0.5f), s = gpu::particleSmoke(jet.record, a);
        if (a > 0) {
            EXPECT_LT(std::abs(f - fire), 0.09f) << a;
            EXPECT_LT(std::abs(s - smoke), 0.08f) << a;
        }
        fire = f, smoke = s;
    }
    EXPECT_EQ(0, fire);
    EXPECT_LT(smoke, 0.01f);
    EXPECT_GT(gpu::particleFire(0.75f, 0.5f), 0.3f);
    EXPECT_GT(gpu::particleSmoke(jet.record, 0.9f), 0.5f);
}

TEST(Particles, EddiesPreserveDensity) {
    float most = 0, mean = 0;
    for (int i = 0; i < 200; ++i) {
        const vec3 x(float(i) * 0.37f, float(i) * 0.71f, float(i) * -0.53f);
        constexpr float kStep = 0.02f;
        float divergence = 0;
        for (int c = 0; c < 3; ++c) {
            vec3 d(0.0f);
            d[c] = kStep;
            divergence +=
                (gpu::particleEddies(x + d)[c] - gpu::particleEddies(x - d)[c]) / (2 * kStep);
        }
        most = std::max(most, std::abs(divergence));
        const vec3 v = gpu::particleEddies(x);
        mean += glm::dot(v, v) / 200;
    }
    EXPECT_LT(most, 0.08f);
    EXPECT_NEAR(mean, 1, 0.35f);
}

TEST(Particles, StayAboveTheGround) {
    FwFireEmitterDef def = jetDef();
    def.flags |= FW_EMITTER_GROUND;
    def.direction[1] = -0.35f;
    def.position[1] = 1.5f;
    def.ground = 0.25f;
    for (const float dt : {1 / 90.0f, 1 / 15.0f}) {
        ParticleReference jet(def);
        float far = 0;
        for (float t = 0; t < 2; t += dt) {
            jet.step(dt);
            for (uint32_t i = 0; i < jet.record.ring; ++i) {
                if (!jet.alive(i)) continue;
                EXPECT_GT(jet.place(i).y, 0.25f - 1e-3f);
                if (jet.particles[i].hit.w >= 0) far = std::max(far, jet.place(i).x);
            }
        }
        EXPECT_GT(far, 4.0f) << "it spreads on the ground";
    }
}

// Walls hit by a jet's rays, at any frame rate: fire spreads along them and none passes.
TEST(Particles, WallsStopAStreamAtAnyFrameRate) {
    FwFireEmitterDef def = jetDef();
    def.sparks = 0;
    for (const float dt : {1 / 90.0f, 1 / 15.0f}) {
        ParticleReference jet(def);
        components::JetObstacle wall;
        wall.met = true;
        wall.place[0] = 3;
        wall.normal[0] = -1;
        wall.radius = 6;
        int spread = 0;
        for (float t = 0; t < 2; t += dt) {
            components::setJetObstacle(jet.emitter, 0, wall, jet.air.now);
            jet.step(dt);
            for (uint32_t i = 0; i < jet.record.ring; ++i) {
                if (!jet.alive(i)) continue;
                EXPECT_LT(jet.place(i).x, 3.0f) << dt;
                spread += jet.particles[i].hit.w > 0.2f && std::abs(jet.place(i).z) > 0.5f;
            }
        }
        EXPECT_LT(20, spread);
        // Particles in flight still hit a wall that no ray hits any more.
        wall.met = false;
        components::setJetObstacle(jet.emitter, 0, wall, jet.air.now);
        jet.step(dt);
        EXPECT_EQ(1u, jet.record.obstacleCount);
        for (int i = 0; i < 2; ++i) jet.step(0.5f);
        EXPECT_EQ(0u, jet.record.obstacleCount);
    }
}

TEST(Particles, StayFiniteForAnyFrameLength) {
    ParticleReference jet(jetDef());
    for (const float dt : {0.0f, 1e-4f, 10.0f, 0.0f, 0.5f, 3.0f, 0.016f})
        if (jet.step(dt))
            for (uint32_t i = 0; i < jet.record.ring; ++i) {
                if (jet.births(i) >= jet.record.filled) continue;
                const vec3 p = jet.place(i);
                EXPECT_LT(glm::length(p), 200.0f) << dt;
            }
}

TEST(Particles, EndWithoutPower) {
    ParticleReference fire(fireDef(60));
    for (int i = 0; i < 60; ++i) {
        const bool burns = fire.step(1 / 60.0f);
        EXPECT_TRUE(burns || i < 2) << i;
    }
    components::setEmitterPower(fire.emitter, 0);
    const float lasts = components::longestParticleLife(fire.emitter);
    int frames = 0;
    while (fire.step(1 / 60.0f) && frames < 10000) ++frames;
    EXPECT_NEAR(float(frames) / 60, lasts, 0.2f);
    EXPECT_EQ(0u, fire.emitter.births.filled);
    components::setEmitterPower(fire.emitter, 60);
    for (int i = 0; i < 10; ++i) fire.step(1 / 60.0f);
    EXPECT_LT(0u, fire.emitter.births.filled);
}

}  // namespace
}  // namespace fw::test
