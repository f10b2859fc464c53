// Light along a ray: exact for a constant medium, independent of the step count, confined to the
// bounds, continuous; noise in metres.
#include "support/sanitized.h"
#include "volume_scene.h"

#include <gtest/gtest.h>

#include <random>

namespace {

using fw::test::rounds;
using namespace volume_scene;
using fw::gpu::FlameMedium;
using fw::gpu::FlameRay;

TEST(VolumeMarch, ConstantMediumIsExactForAnyStepCount) {
    for (const float k : {0.0f, 1e-5f, 0.01f, 0.5f, 3.0f, 20.0f})
        for (const float chord : {0.05f, 0.6f, 4.0f})
            for (uint32_t n = 4; n <= 64; ++n) {
                const vec3 source(2.0f, 1.0f, 0.25f);  // radiance of the medium itself
                FlameMedium m{k, 0.0f, 0.5f, k * source};
                FlameRay ray{vec3(0.0f), vec3(1.0f)};
                for (uint32_t s = 0; s < n; ++s)
                    ray = fw::gpu::flameStep(ray, m, vec3(0), chord / float(n));
                const vec3 absorb = fw::gpu::kFlameAbsorb;
                for (int c = 0; c < 3; ++c) {
                    const double exact = double(source[c]) / double(absorb[c]) *
                                         -std::expm1(-double(k * absorb[c] * chord));
                    EXPECT_NEAR(ray.radiance[c], exact, 0.005 * exact + 1e-9)
                        << k << " " << chord << " " << n;
                    EXPECT_NEAR(ray.through[c], std::exp(-k * absorb[c] * chord), 0.005);
                }
            }
}

// Gas that emits without absorbing must not lose its light to a small-number guard.
TEST(VolumeMarch, EmittingGasWithoutAbsorptionIsExact) {
    FlameMedium m{0.0f, 0.0f, 0.5f, vec3(0.1f, 0.5f, 4.0f)};
    FlameRay ray{vec3(0.0f), vec3(1.0f)};
    for (int s = 0; s < 10; ++s) ray = fw::gpu::flameStep(ray, m, vec3(0), 0.03f);
    EXPECT_NEAR(ray.radiance.b, 1.2f, 1e-4f);
    EXPECT_EQ(ray.through, vec3(1.0f));
}

double meanRadiance(const Shown& f, uint32_t steps, float detail) {
    MarchRules rules;
    rules.steps = steps, rules.smoke = false, rules.detail = detail, rules.jitter = -1.0f;
    const float tall = 2.0f * f.size.height;
    const Camera camera{{0, 0.4f * tall, 6.0f * tall}, {0, 0.4f * tall, 0}, 0.1f};
    double sum = 0;
    for (int part = 0; part < 2; ++part)
        for (const vec3& p : picture(f, camera, 40, 60, rules, [](vec3, vec3) {
                 return std::pair{vec3(0.0f), 1e9f};
             }))
            sum += double(p.r + p.g + p.b);
    return sum;
}

TEST(VolumeMarch, BrightnessIsIndependentOfTheStepCount) {
    Shown f = Shown::preset(FlamePreset::CampFire);
    f.run(3.0);
    const float apart = rounds(0.03f, 0.08f);  // m between rays
    const double fine = meanRadiance(f, 256, apart);
    for (const uint32_t steps : {32u, 64u, 128u}) {
        const double here = meanRadiance(f, steps, apart);
        EXPECT_NEAR(here / fine, 1.0, steps == 32 ? 0.01 : 0.005) << steps << " steps";
    }
}

TEST(VolumeMarch, NothingIsVisibleOutsideTheBounds) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    for (uint32_t k = 0; k < uint32_t(FlamePreset::Count); ++k) {
        Shown f = Shown::preset(FlamePreset(k));
        f.run(1.7);
        const Bounds b = flameBounds(f.record, f.nodes);
        const vec3 size = b.high - b.low;
        int lit = 0;
        for (int trial = 0; trial < 20000; ++trial) {
            const vec3 x =
                b.low - 0.25f * size + 1.5f * size * vec3(unit(random), unit(random), unit(random));
            const auto at = locate(f.nodes, x);
            if (!at) continue;
            const FlameMedium m = sampleFlame(f.record, *f.profile, at->place, 0.001f, true);
            if (m.soot + m.smoke + m.emission.r + m.emission.g + m.emission.b <= 0.0f) continue;
            ++lit;
            ASSERT_TRUE(glm::all(glm::greaterThanEqual(x, b.low)) &&
                        glm::all(glm::lessThanEqual(x, b.high)))
                << presetName(FlamePreset(k));
        }
        EXPECT_GT(lit, 20) << presetName(FlamePreset(k));
    }
}

TEST(VolumeMarch, RaysFindEverythingInTheTube) {
    Shown f = Shown::preset(FlamePreset::Torch);
    f.run(0.9);
    std::mt19937 random(9);
    std::normal_distribution<float> normal;
    for (int trial = 0; trial < 2000; ++trial) {
        vec3 d(normal(random), normal(random), normal(random));
        d = glm::normalize(d);
        const vec3 through(0.05f * normal(random), 0.15f + 0.1f * normal(random),
                           0.05f * normal(random));
        const vec3 from = through - 2.0f * d;
        const vec2 span = flameSpan(f.record, f.nodes, from, d);
        for (float t = 0.0f; t < 4.0f; t += 0.01f) {
            const auto at = locate(f.nodes, from + t * d);
            if (!at || (t > span.x && t < span.y)) continue;
            const FlameMedium m = sampleFlame(f.record, *f.profile, at->place, 0.001f, true);
            ASSERT_EQ(m.soot + m.smoke + m.emission.r + m.emission.b, 0.0f) << "at " << t;
        }
    }
}

// Knots replace a ray's samples: no flame is missed or moved.
TEST(VolumeMarch, KnotsKeepTheFlameInPlace) {
    Shown f = Shown::preset(FlamePreset::CampFire);
    Curve bent;
    const float r = 0.5f * f.size.diameter, tall = f.size.height;
    const ControlPoint points[] = {{vec3(0), r},
                                   {vec3(0.1f, 0.4f * tall, 0), r},
                                   {vec3(0.5f, 0.8f * tall, 0.1f), r},
                                   {vec3(1.2f, tall, 0.2f), r}};
    bent.set(points, vec3(0, 1, 0));
    placeFlameNodes(bent, topOf(f.record), f.nodes);
    f.run(0.9);
    std::mt19937 random(9);
    std::normal_distribution<float> normal;
    double off = 0;
    int lit = 0;
    for (int trial = 0; trial < 300; ++trial) {
        const vec3 d = glm::normalize(vec3(normal(random), normal(random), normal(random)));
        const vec3 through = bent.at(0.8f * std::abs(normal(random)) * tall).position;
        const vec3 from = through - 4.0f * d;
        RayKnots knots;
        const vec2 chord =
            flameChord(f.record, f.nodes, from, d, 1e9f, fw::gpu::kFlameIntervals, knots);
        for (float t = 3.0f; t < 5.0f; t += 0.02f) {
            const auto at = locate(f.nodes, from + t * d);
            if (!at || sampleFlame(f.record, *f.profile, at->place, 0.01f, false).soot <= 0.0f)
                continue;
            ++lit;
            if (!(t > chord.x && t < chord.y)) {
                off += 1.0;
                continue;
            }
            const auto place =
                fw::gpu::flameAlong(knots.first, knots.delta, (t - knots.from) / knots.gap);
            off += std::abs(place.s - at->place.s) > 0.2f * f.size.diameter ? 1.0 : 0.0;
        }
    }
    ASSERT_GT(lit, 1000);
    std::printf("           %d lit, %.0f displaced\n", lit, off);
    EXPECT_LT(off, 0.02 * lit);
}

TEST(VolumeMarch, MarchesFromInsideAndUpToAWall) {
    Shown f = Shown::preset(FlamePreset::CampFire);
    f.run(1.0);
    MarchRules rules;
    const vec3 eye(0, 0.15f, 0);  // in the middle of the fire
    const FlameRay inside = marchRay(f.record, f.nodes, *f.profile, eye, vec3(0, 0, 1), rules);
    EXPECT_GT(inside.radiance.r, 0.05f);
    EXPECT_TRUE(std::isfinite(inside.radiance.r) && inside.through.r <= 1.0f);
    // A wall approaching from behind removes the light gradually.
    float before = 1e9f;
    for (float wall = 2.0f; wall > 0.5f; wall -= 0.01f) {
        rules.farthest = wall, rules.steps = 128, rules.detail = 0.02f;
        const float here =
            marchRay(f.record, f.nodes, *f.profile, vec3(0, 0.2f, 1.2f), vec3(0, 0, -1), rules)
                .radiance.r;
        if (before < 1e8f) {
            EXPECT_LT(std::abs(here - before), 0.35f) << "wall at " << wall;
        }
        before = here;
    }
    EXPECT_EQ(before, 0.0f) << "a wall in front hides the flame";
}

TEST(VolumeMarch, NoiseIsInMetres) {
    // The same fire ten times as large looks the same from ten times the distance.
    const FlameAppearance look = presetDef(FlamePreset::CampFire).appearance;
    Shown small(look, 60.0f, 0.6f, 0.6f), large(look, 60.0f, 6.0f, 6.0f);
    EXPECT_NEAR(large.record.lambda / small.record.lambda, 10.0f, 1e-3f);
    // A flame twice as high over the same bed has tongues of the same width.
    Shown tall(look, 400.0f, 0.6f, 2.4f), taller(look, 1600.0f, 0.6f, 4.8f);
    EXPECT_NEAR(taller.record.lambda / tall.record.lambda, 1.0f, 1e-3f);
}

// At the intersection with a wall no edge is harder than the flame's own unevenness.
TEST(VolumeMarch, NoHardEdgeWhereAWallCutsTheFlame) {
    Shown f = Shown::preset(FlamePreset::CampFire);
    f.run(1.3);
    MarchRules rules;
    rules.steps = 200, rules.detail = 0.04f, rules.smoke = false;
    const auto row = [&](bool wall) {
        std::vector<float> out;
        for (float x = -0.4f; x < 0.4f; x += 0.005f) {
            const vec3 from(x, 0.2f, 2.0f);
            rules.farthest =
                wall ? 2.0f - (0.3f - x) : 1e9f;  // a plane through the axis, leaning away
            out.push_back(
                marchRay(f.record, f.nodes, *f.profile, from, vec3(0, 0, -1), rules).radiance.r);
        }
        return out;
    };
    const auto steepest = [](const std::vector<float>& v) {
        float most = 0.0f;
        for (size_t k = 1; k < v.size(); ++k) most = std::max(most, std::abs(v[k] - v[k - 1]));
        return most;
    };
    const float open = steepest(row(false)), cut = steepest(row(true));
    EXPECT_GT(open, 0.01f);
    EXPECT_LT(cut, 1.5f * open + 0.02f);
}

// Faults of a known port: a mirror seam at the axis, a hollow core, a straight base.
TEST(VolumeMarch, HasNoAxisSeamHollowCoreOrStraightBase) {
    Shown f = Shown::preset(FlamePreset::CampFire);
    double core = 0, rim = 0, mirrored = 0, plain = 0;
    double across = 0, beside = 0;
    for (int frame = 0; frame < 40; ++frame) {
        f.run(0.21);
        const auto soot = [&](float x, float z, float s) {
            return sampleFlame(f.record, *f.profile, {vec2(x, z), s, 0.3f}, 0.005f, false).soot;
        };
        for (float s = 0.03f; s < 0.5f; s += 0.02f) {
            // Steps of 1 mm across the axis, and beside it.
            across += double(std::abs(soot(0.0005f, 0.0f, s) - soot(-0.0005f, 0.0f, s)));
            for (const float x : {0.04f, -0.04f})
                beside +=
                    0.5 * double(std::abs(soot(x + 0.0005f, 0.0f, s) - soot(x - 0.0005f, 0.0f, s)));
            core += double(soot(0.0f, 0.0f, s)), rim += double(soot(0.27f, 0.0f, s));
            for (float x = 0.04f; x < 0.24f; x += 0.04f) {
                const float right = soot(x, 0.0f, s), left = soot(-x, 0.0f, s);
                mirrored += double(std::abs(right - left)), plain += double(right + left);
            }
        }
    }
    EXPECT_LT(across, 1.5 * beside) << "no seam at the axis";
    EXPECT_GT(core, rim);
    EXPECT_GT(mirrored / plain, 0.2) << "the halves are not mirrored";
    // The base fades in: the lowest visible soot is a small part of that above.
    const auto mean = [&](float s) {
        double sum = 0;
        for (float x = -0.25f; x < 0.26f; x += 0.05f)
            for (float z = -0.25f; z < 0.26f; z += 0.05f)
                sum += double(
                    sampleFlame(f.record, *f.profile, {vec2(x, z), s, 0.3f}, 0.01f, false).soot);
        return sum;
    };
    EXPECT_LT(mean(0.002f), 0.2 * mean(0.08f));
}

TEST(VolumeMarch, NoiseDoesNotRepeatWithinAMinute) {
    for (uint32_t k = 0; k < uint32_t(FlamePreset::Count); ++k) {
        Shown f = Shown::preset(FlamePreset(k));
        FlameScroll s;
        advanceScroll(s, f.appearance, f.record, 1.0);
        for (const double cells : {s.octaves[0], s.warp, s.column})
            EXPECT_LT(60.0 * cells, double(fw::gpu::kFlameWrap)) << presetName(FlamePreset(k));
    }
}

TEST(VolumeMarch, NoiseIsUnbiasedAndWraps) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> unit(0.0f, 4096.0f);
    double sum = 0, magnitude = 0;
    constexpr int kSamples = 400000;
    float most = 0;
    for (int k = 0; k < kSamples; ++k) {
        const float n =
            fw::gpu::flameNoise(vec3(0.1f * unit(random), unit(random), 0.1f * unit(random)));
        sum += double(n), magnitude += double(std::abs(n));
        most = std::max(most, std::abs(n));
    }
    EXPECT_NEAR(sum / kSamples, 0.0, 0.002);
    EXPECT_NEAR(magnitude / kSamples, double(fw::gpu::kFlameMeanAbs), 0.002);
    EXPECT_LT(most, 1.0f);
    for (float y = 0.0f; y < 1.0f; y += 0.0625f)
        EXPECT_FLOAT_EQ(fw::gpu::flameNoise(vec3(3.3f, y, 7.1f)),
                        fw::gpu::flameNoise(vec3(3.3f, y + fw::gpu::kFlameWrap, 7.1f)));
}

// Eddies displace fire within their limit, without bias and smoothly.
TEST(VolumeMarch, EddiesAreUnbiasedAndLimited) {
    std::mt19937 random(6);
    std::uniform_real_distribution<float> unit(0.0f, 400.0f);
    vec3 sum(0.0f);
    double square = 0;
    constexpr int kSamples = 100000;
    for (int k = 0; k < kSamples; ++k) {
        const vec3 x(unit(random), unit(random), unit(random));
        const vec3 eddy = fw::gpu::flameCurl(x);
        sum += eddy, square += double(glm::dot(eddy, eddy)) / kSamples;
        ASSERT_LT(glm::length(eddy), 1.0f / 0.6f);
        ASSERT_LT(glm::length(fw::gpu::flameCurl(x + vec3(1e-3f)) - eddy), 0.05f);
    }
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c] / kSamples, 0.0f, 0.01f);
    EXPECT_NEAR(std::sqrt(square), 0.48, 0.05);
}

}  // namespace
