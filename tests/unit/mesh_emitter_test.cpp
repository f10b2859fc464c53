// A mesh emitter while its mesh burns more and more: flame height and particle count.
#include "components/fire_emitter.h"
#include "shared/particle.h"

#include <gtest/gtest.h>

#include <cmath>

namespace fw::test {
namespace {

components::FireEmitter emitterOf(uint32_t shape) {
    FwFireEmitterDef def{};
    def.structSize = sizeof def;
    def.direction[1] = def.buoyancy = def.smokeDensity = 1;
    def.smoke = 0.5f;
    def.smokeLife = 2;
    def.stickTime = 1;
    def.shape = shape;
    def.object.index1 = shape == FW_EMITTER_MESH ? 1 : 0;
    def.power = 200;
    def.rate = 3000;
    def.life = 0.6f;
    def.lifeVariance = 0;
    components::FireEmitter emitter;
    components::makeFireEmitter(def, 1, emitter);
    emitter.ring = 4096;
    return emitter;
}

struct Frames {
    components::FireEmitter emitter;
    gpu::ParticleEmitter record{};
    double now = 0;
    double births = 0;  // 1/s, in the last run
    explicit Frames(uint32_t shape) : emitter(emitterOf(shape)) {}
    void run(int count) {
        constexpr float kStep = 1.0f / 60;
        const uint32_t before = emitter.births.serial;
        for (int i = 0; i < count; ++i) {
            components::EmitterAir air;
            air.now = now += double(kStep);
            components::advanceEmitter(emitter, air, kStep, record);
            components::commitEmitter(emitter);
        }
        births = (emitter.births.serial - before) / (count * double(kStep));
    }
    // m/s at the end of its life.
    double height() const {
        return double(record.motion.y) * double(record.motion.z) * double(record.life.x);
    }
};

TEST(MeshEmitter, FlameHeightFollowsThePower) {
    Frames all(FW_EMITTER_MESH);
    all.emitter.share = 1;
    all.run(60);
    for (const float share : {0.01f, 0.1f, 0.5f}) {
        Frames some(FW_EMITTER_MESH);
        some.emitter.share = share;
        some.run(60);
        EXPECT_NEAR(some.height() / all.height(), std::pow(double(share), 0.4), 0.02) << share;
        // Its share of all particles exists at one time.
        const double there = some.births * double(some.record.life.x);
        EXPECT_NEAR(there / (all.births * double(all.record.life.x)), double(share),
                    0.15 * double(share))
            << share;
        // Smoke has left the fire and keeps its lifetime.
        EXPECT_NEAR(double(some.record.life.x * some.record.life.z),
                    double(all.record.life.x * all.record.life.z), 1e-3);
    }
}

// If life grew faster than time passes, dead particles would burn again.
TEST(MeshEmitter, ParticlesNeverGetYounger) {
    Frames fire(FW_EMITTER_MESH);
    fire.emitter.share = 0.001f;
    fire.run(30);
    fire.emitter.share = 1;
    float before = fire.record.life.x;
    int frames = 0;
    for (; frames < 600 && fire.record.life.x < 0.599f; ++frames) {
        fire.run(1);
        EXPECT_LE(fire.record.life.x - before, 0.62f * 0.6f / 60) << frames;
        before = fire.record.life.x;
    }
    EXPECT_LT(frames, 120);
}

TEST(MeshEmitter, FreeEmittersKeepTheirOwnPower) {
    Frames point(FW_EMITTER_POINT);
    point.run(60);
    EXPECT_FLOAT_EQ(point.record.life.x, 0.6f);
    EXPECT_NEAR(point.births, 3000, 60);
}

}  // namespace
}  // namespace fw::test
