// Flames against measurements: mean visible height (Heskestad 1984), centreline speed (McCaffrey
// 1979), puffing (Cetegen and Ahmed 1993).
#include "support/sanitized.h"
#include "volume/flame.h"
#include "volume_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace {

using fw::test::kSanitized;
using namespace fw::volume;

struct BurningFlame {
    Flame flame;
    FlameAir air;
    Profile profile;
    explicit BurningFlame(const FlameDef& def) {
        startFlame(flame, def, air);
        paintDefaultProfile(def.appearance, profile);
    }
};

FlameDef defOf(FlamePreset preset, float power, float diameter) {
    FlameDef d;
    d.appearance = presetDef(preset).appearance;
    d.power = power, d.diameter = diameter;
    return d;
}

// m, highest row where a ray from the side meets flame.
float tip(const BurningFlame& b) {
    const float height = b.flame.size.height, radius = 0.65f * b.flame.size.diameter;
    const float away = 10.0f * height;
    MarchRules rules;
    rules.steps = 20, rules.smoke = false, rules.detail = 0.01f * b.flame.size.diameter;
    constexpr int kRows = 36, kColumns = 19;
    for (int row = kRows; row > 0; --row)
        for (int column = 0; column < kColumns; ++column) {
            const float y = 2.0f * height * (float(row) - 0.5f) / float(kRows);
            const float x = radius * (2.0f * (float(column) + 0.5f) / float(kColumns) - 1.0f);
            const vec3 from(x, y, away);
            const auto ray =
                marchRay(b.flame.record, b.flame.nodes, b.profile, from, vec3(0, 0, -1), rules);
            if (volume_scene::seen(ray.radiance) > 0.1f) return y;
        }
    return 0.0f;
}

float meanTip(BurningFlame& b, int frames, double seconds) {
    double sum = 0;
    for (int k = 0; k < frames; ++k) {
        for (int s = 0; s < 4; ++s) advanceFlame(b.flame, b.air, 0.25 * seconds / frames);
        sum += double(tip(b));
    }
    return float(sum / frames);
}

TEST(VolumeHeight, MeanVisibleHeightMatchesHeskestad) {
    for (const float d : {0.1f, 0.2f, 0.4f, 1.0f})
        for (const float q : {5.0f, 50.0f, 500.0f}) {
            if (kSanitized && (d != 0.2f || q != 50.0f)) continue;
            std::array<Flamelet, kMaxFlamelets> parts;
            const uint32_t n = splitFire(q, d, parts);
            const float law = flameHeight(parts[0].power, parts[0].diameter);
            ASSERT_GT(law, 0.0f);
            if (n == 1) {
                EXPECT_FLOAT_EQ(law, flameHeight(q, d));
            }
            const FlamePreset preset = d <= 0.1f ? FlamePreset::Torch : FlamePreset::CampFire;
            BurningFlame b(defOf(preset, parts[0].power, parts[0].diameter));
            const float ratio = meanTip(b, 60, 20.0) / law;
            EXPECT_NEAR(ratio, 1.0f, 0.10f) << q << " kW on " << d << " m, of " << n << " flames";
        }
}

TEST(VolumeHeight, PresetsMatchHeskestadAtTheirOwnSize) {
    for (const FlamePreset preset : {FlamePreset::CampFire, FlamePreset::Torch,
                                     FlamePreset::Bonfire, FlamePreset::HouseFire}) {
        if (kSanitized && preset != FlamePreset::CampFire) continue;
        const FlamePresetDef d = presetDef(preset);
        BurningFlame b(defOf(preset, d.power, d.diameter));
        EXPECT_NEAR(meanTip(b, 60, 20.0) / flameHeight(d.power, d.diameter), 1.0f, 0.10f)
            << presetName(preset);
    }
}

TEST(VolumeHeight, WideWeakFiresAreManySmallFlames) {
    std::array<Flamelet, kMaxFlamelets> parts;
    EXPECT_EQ(splitFire(60.0f, 0.6f, parts), 1u);
    EXPECT_NEAR(flameHeight(1690.0f, 1.6f), 2.96f, 0.02f);  // the correlation's published example
    for (const float q : {0.0f, 0.01f, 1.0f, 5.0f, 20.0f, 100.0f})
        for (const float d : {0.0f, 0.05f, 0.5f, 1.0f, 3.0f, 30.0f}) {
            const uint32_t n = splitFire(q, d, parts);
            ASSERT_GE(n, 1u);
            ASSERT_LE(n, kMaxFlamelets);
            float sum = 0.0f;
            for (uint32_t k = 0; k < n; ++k) {
                const Flamelet& f = parts[k];
                sum += f.power;
                EXPECT_GT(f.height, 0.0f);
                EXPECT_TRUE(std::isfinite(f.x + f.z + f.height + f.diameter));
                EXPECT_LE(std::hypot(f.x, f.z) + 0.5f * f.diameter,
                          0.5f * std::max(d, 1e-3f) * 1.001f);
                if (n > 1) {
                    EXPECT_GE(f.height, 0.49f * f.diameter);
                }
            }
            EXPECT_NEAR(sum, q, 1e-3f * q + 1e-6f);
        }
    EXPECT_GT(splitFire(5.0f, 1.0f, parts), 4u);
}

// A host may set any power from zero on: the smallest float divided by 32 is zero.
TEST(VolumeHeight, PartsOfAVanishingPowerKeepAWidth) {
    std::array<Flamelet, kMaxFlamelets> parts;
    for (const float power : {std::numeric_limits<float>::denorm_min(), 1e-40f, 1e-20f}) {
        const uint32_t n = splitFire(power, 1.0f, parts);
        ASSERT_GE(n, 2u);
        for (uint32_t i = 0; i < n; ++i) {
            EXPECT_GT(parts[i].diameter, 0.0f) << power;
            EXPECT_TRUE(std::isfinite(puffFrequency(parts[i].diameter))) << power;
        }
    }
}

TEST(VolumeHeight, CentrelineSpeedMatchesMcCaffrey) {
    for (const auto& [q, d] : {std::pair{5.0f, 0.13f}, {60.0f, 0.6f}, {600.0f, 1.3f}}) {
        BurningFlame b(defOf(FlamePreset::CampFire, q, d));
        const float height = b.flame.size.height;
        for (const float part : {0.3f, 0.6f, 1.0f}) {
            double sum = 0;
            int count = 0;
            for (int k = 0; k < 2000; ++k) {
                const FlameMotion old = b.flame.motion;
                advanceFlame(b.flame, b.air, double(kMotionStep));
                for (uint32_t i = 0; i < old.count; ++i)
                    for (uint32_t j = 0; j < b.flame.motion.count; ++j) {
                        const CurveParticle &was = old.particles[i],
                                            &is = b.flame.motion.particles[j];
                        if (was.number != is.number ||
                            std::abs(was.position.y - part * height) > 0.08f * height)
                            continue;
                        sum += double((is.position.y - was.position.y) / kMotionStep), ++count;
                    }
            }
            ASSERT_GT(count, 50);
            const double law = double(plumeSpeed(q, part * height));
            EXPECT_NEAR(sum / count / law, 1.0, 0.20) << q << " kW at " << part << " of its height";
        }
    }
    EXPECT_NEAR(plumeExcess(60.0f, 0.1f), 800.0f, 1.0f);
    EXPECT_LT(plumeExcess(60.0f, 3.0f), 100.0f);
}

// Light of the whole flame as if optically thin.
double luminousPower(const BurningFlame& b) {
    const Flame& f = b.flame;
    double sum = 0;
    const float top = f.record.high.w * fw::gpu::kFlameTop;
    for (int i = 0; i < 16; ++i) {
        const float s = top * (float(i) + 0.5f) / 16.0f;
        const float at = s / (f.nodes[1].along.w - f.nodes[0].along.w);
        const size_t k = std::min(size_t(at), f.nodes.size() - 2);
        const float radius = glm::mix(f.nodes[k].centre.w, f.nodes[k + 1].centre.w, at - float(k));
        for (int x = 0; x < 7; ++x)
            for (int y = 0; y < 7; ++y) {
                const vec2 p =
                    1.2f * radius * vec2((float(x) - 3.0f) / 3.5f, (float(y) - 3.0f) / 3.5f);
                const auto m = sampleFlame(f.record, b.profile, {p, s, radius},
                                           0.05f * f.size.diameter, false);
                sum += double(m.emission.r + m.emission.g) * double(radius * radius * top);
            }
    }
    return sum;
}

TEST(VolumeHeight, PuffingFrequencyMatchesCetegen) {
    for (const auto& [q, d] : {std::pair{15.0f, 0.2f}, {60.0f, 0.6f}, {600.0f, 1.3f}}) {
        if (kSanitized && q > 15) continue;
        BurningFlame b(defOf(FlamePreset::CampFire, q, d));
        const double law = double(puffFrequency(d)), rate = 10.0 * law;
        constexpr int kFrames = 400;
        std::vector<double> power(kFrames);
        double mean = 0;
        for (double& p : power) {
            advanceFlame(b.flame, b.air, 1.0 / rate);
            p = luminousPower(b);
            mean += p / kFrames;
        }
        double best = 0, peak = 0;
        for (double f = 0.3 * law; f < 3.0 * law; f += 0.02 * law) {
            double re = 0, im = 0;
            for (int k = 0; k < kFrames; ++k) {
                const double window = 0.5 - 0.5 * std::cos(6.2831853 * k / kFrames);
                re += window * (power[size_t(k)] - mean) * std::cos(6.2831853 * f * k / rate);
                im += window * (power[size_t(k)] - mean) * std::sin(6.2831853 * f * k / rate);
            }
            if (re * re + im * im > best) best = re * re + im * im, peak = f;
        }
        EXPECT_NEAR(peak / law, 1.0, 0.15) << d << " m";
        EXPECT_GT(mean, 0.0);
    }
}

}  // namespace
