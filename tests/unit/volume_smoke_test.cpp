// Smoke in the sun: optical depth towards the sun is the integral of the plume, and by day one side
// is brighter. By night the flame below lights the smoke.
#include "volume_scene.h"

#include <gtest/gtest.h>

#include <random>

namespace {

using namespace volume_scene;
namespace gpu = fw::gpu;

Shown houseFire() { return Shown::preset(FlamePreset::HouseFire); }

// The same from two thousand samples of a ray out of the plume, whose cross-section stays that of
// the ray's start.
double depthByHand(const gpu::FlameRecord& f, gpu::FlamePlace at, vec3 to) {
    double sum = 0;
    const double flat =
        std::sqrt(std::max(double(to.x) * double(to.x) + double(to.y) * double(to.y), 0.08));
    const double scale = flat / std::max(double(glm::length(vec2(to))), 1e-9);
    const float wide = 0.45f * f.low.w + 0.16f * std::max(at.s - 0.6f * f.high.w, 0.0f);
    const double step = 8.0 * double(wide) / flat / 2000;
    gpu::FlamePlace axis = at;
    axis.p = vec2(0.0f);
    // Density on the axis, from a ray across the whole plume.
    for (int i = 0; i < 2000; ++i) {
        const double t = step * (i + 0.5);
        const double x = double(at.p.x) + scale * double(to.x) * t,
                     y = double(at.p.y) + scale * double(to.y) * t;
        sum += std::exp(-double(gpu::kSmokeBell) * (x * x + y * y) / double(wide * wide)) * step;
    }
    const double across = double(gpu::flameSmokeDepth(f, axis, vec3(1, 0, 0))) /
                          (0.8862269 * double(wide) / std::sqrt(double(gpu::kSmokeBell)));
    return across * sum;
}

TEST(VolumeSmoke, OpticalDepthToTheSunIsTheIntegral) {
    const Shown f = houseFire();
    ASSERT_GT(f.record.smoke, 0.0f);
    std::mt19937 random(7);
    std::uniform_real_distribution<float> unit(0, 1);
    for (int i = 0; i < 200; ++i) {
        gpu::FlamePlace at;
        at.s = f.record.high.w * (0.8f + (0.65f * f.record.smokeTop - 0.8f) * unit(random));
        const float wide = 0.45f * f.record.low.w + 0.16f * (at.s - 0.6f * f.record.high.w);
        at.p = wide * (2.0f * vec2(unit(random), unit(random)) - 1.0f);
        at.radius = wide;
        const float up = 0.9f * unit(random), turn = 6.2832f * unit(random);
        const vec3 to(std::sqrt(1 - up * up) * vec2(std::cos(turn), std::sin(turn)), up);
        const double hand = depthByHand(f.record, at, to);
        EXPECT_NEAR(hand, double(gpu::flameSmokeDepth(f.record, at, to)), 0.01 * hand + 1e-4);
    }
    // Nothing below and above the smoke; finite with the sun on the axis.
    gpu::FlamePlace at{vec2(0.0f), 0.5f * f.record.high.w, 1.0f};
    EXPECT_EQ(0.0f, gpu::flameSmokeDepth(f.record, at, vec3(1, 0, 0)));
    at.s = 1.01f * f.record.smokeTop * f.record.high.w;
    EXPECT_EQ(0.0f, gpu::flameSmokeDepth(f.record, at, vec3(1, 0, 0)));
    at.s = 1.5f * f.record.high.w;
    const float axis = gpu::flameSmokeDepth(f.record, at, vec3(0, 0, 1));
    EXPECT_TRUE(std::isfinite(axis) && axis > 0.0f);
}

TEST(VolumeSmoke, ErfcIsAccurate) {
    for (float x = 0; x < 5; x += 0.01f) EXPECT_NEAR(std::erfc(x), gpu::flameErfc(x), 3e-5f);
}

// Light of the two halves of a plume above its flame, from the side.
void halves(const Shown& f, vec3 toSun, double& left, double& right) {
    MarchRules rules;
    rules.steps = 8;
    rules.sun = vec3(1.0f);
    rules.toSun = toSun;
    left = right = 0;
    const float wide = f.size.diameter, away = 20.0f * f.size.height;
    for (int y = 0; y < 16; ++y)
        for (int x = -16; x < 16; ++x) {
            const vec3 from(wide * (float(x) + 0.5f) / 16.0f,
                            f.size.height * (2.2f + 0.05f * float(y)), away);
            const double light = double(
                marchRay(f.record, f.nodes, *f.profile, from, vec3(0, 0, -1), rules).radiance.g);
            (x < 0 ? left : right) += light;
        }
}

TEST(VolumeSmoke, TheSunnySideIsBrighter) {
    Shown f = houseFire();
    const vec3 low = glm::normalize(vec3(1, 0.3f, 0));
    double sunny = 0, shady = 0, against = 0, along = 0;
    for (int i = 0; i < 6;
         ++i, f.run(1.7)) {  // averaged: billows are thicker on one side at a time
        double left, right;
        halves(f, low, left, right);
        sunny += right, shady += left;
        halves(f, low * vec3(-1, 1, 1), left, right);
        sunny += left, shady += right;
        halves(f, vec3(0, 0, -1), left, right);
        against += left + right;
        halves(f, vec3(0, 0, 1), left, right);
        along += left + right;
    }
    std::printf("the sunny side: %.2f of the other's light; against the sun: %.2f\n", sunny / shady,
                against / along);
    EXPECT_GT(sunny, 1.15 * shady);
    EXPECT_GT(against, along);  // smoke scatters forwards
}

// Mean radiance of the flame that reaches a point from all directions, which the smoke there
// scatters.
vec3 comesTo(const Flame& flame, const Profile& profile, vec3 place) {
    MarchRules rules;
    rules.steps = 40, rules.smoke = false;
    constexpr int kDirections = 256;
    vec3 sum(0.0f);
    for (int k = 0; k < kDirections; ++k) {
        const float y = 1.0f - 2.0f * (float(k) + 0.5f) / float(kDirections);
        const float side = std::sqrt(1.0f - y * y), turn = 2.3999632f * float(k);
        const vec3 way(side * std::cos(turn), y, side * std::sin(turn));
        sum += marchRay(flame.record, flame.nodes, profile, place, way, rules).radiance;
    }
    return sum / float(kDirections);
}

float luminance(vec3 c) { return glm::dot(c, vec3(0.2126f, 0.7152f, 0.0722f)); }

TEST(VolumeSmoke, ByNightTheFlameLightsTheSmoke) {
    for (const FlamePreset preset :
         {FlamePreset::CampFire, FlamePreset::Bonfire, FlamePreset::HouseFire}) {
        const FlamePresetDef p = presetDef(preset);
        FlameDef def;
        def.appearance = p.appearance, def.power = p.power, def.diameter = p.diameter;
        Profile profile;
        paintDefaultProfile(def.appearance, profile);
        Flame flame;
        startFlame(flame, def, {});
        for (const float high : {1.0f, 1.5f, 2.0f}) {  // heights relative to the visible flame
            const vec3 place(0.25f * def.diameter, high * flame.size.height, 0.0f);
            float comes = 0.0f, said = 0.0f;
            Flame f = flame;
            for (int moment = 0; moment < 6; ++moment) {
                for (int k = 0; k < 9; ++k) advanceFlame(f, {}, 1.0 / 30.0);
                comes += luminance(comesTo(f, profile, place));
                const vec3 to = vec3(f.record.glow) - place;
                // Between crest and hollow in brightness, and as even as the radiance it comes
                // from.
                const vec3 light = gpu::flameSmokeLight(f.record, glm::dot(to, to), 1.0f / 3.0f,
                                                        vec3(0.0f), 0.0f) /
                                   (f.record.smokeAlbedo * gpu::kSmokeAside);
                said += luminance(light);
            }
            std::printf("%s, smoke at %.1f of its height: %.2f of what comes\n", presetName(preset),
                        double(high), double(said / comes));
            EXPECT_GT(said, 0.5f * comes) << presetName(preset) << " at " << high;
            EXPECT_LT(said, 2.5f * comes) << presetName(preset) << " at " << high;
        }
    }
}

// Relative to the brightest part of its flame on film: a veil above the flame, brown and not red.
TEST(VolumeSmoke, ByNightSmokeIsADimBrownVeil) {
    const FlamePresetDef p = presetDef(FlamePreset::HouseFire);
    FlameDef def;
    def.appearance = p.appearance, def.power = p.power, def.diameter = p.diameter;
    Flame flame;
    startFlame(flame, def, {});
    MarchRules rules;
    rules.steps = 40;
    const auto seenAt = [&](const Shown& f, float high) {
        vec3 sum(0.0f);
        for (int k = -4; k <= 4; ++k)
            sum += marchRay(f.record, f.nodes, *f.profile,
                            vec3(0.06f * float(k) * f.size.diameter, high * f.size.height, 40.0f),
                            vec3(0, 0, -1), rules)
                       .radiance;
        return sum / 9.0f;
    };
    vec3 fire(0.0f), smoke(0.0f);
    for (int moment = 0; moment < 8; ++moment) {
        for (int k = 0; k < 9; ++k) advanceFlame(flame, {}, 1.0 / 30.0);
        const Shown f(flame);
        fire += seenAt(f, 0.3f), smoke += seenAt(f, 2.0f);
    }
    const float share = luminance(smoke) / luminance(fire);
    std::printf("smoke at twice the height: %.4f of the flame's radiance, green %.2f of red\n",
                double(share), double(smoke.g / smoke.r));
    EXPECT_GT(share, 1.0f / 300.0f);
    EXPECT_LT(share, 1.0f / 40.0f);
    EXPECT_GT(smoke.g, 0.22f * smoke.r);
    EXPECT_LT(smoke.g, 0.5f * smoke.r);
}

}  // namespace
