// Appearance of a flame over time, in numbers: rising and detaching tongues, a steady base,
// brightest low, white by exposure only, no repetition, no visible bounds. volume_pictures_test
// writes the pictures.
#include "shared/volume_draw.h"
#include "support/sanitized.h"
#include "volume_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace {

using fw::test::kSanitized;
using fw::test::rounds;
using namespace volume_scene;

constexpr FlamePreset kTurbulent[] = {FlamePreset::CampFire, FlamePreset::Torch,
                                      FlamePreset::Bonfire, FlamePreset::HouseFire};

// Orthographic from the side; rows from the base up.
struct Side {
    static constexpr int kWide = 25, kHigh = 48;
    float row = 0;  // m
    std::vector<float> light = std::vector<float>(size_t(kWide * kHigh));
    std::vector<vec3> colour = std::vector<vec3>(size_t(kWide * kHigh));

    Side(const Shown& f, float heights, float diameters, uint32_t steps = 16, float jitter = 0.5f) {
        row = heights * f.size.height / float(kHigh);
        MarchRules rules;
        rules.steps = steps, rules.smoke = false, rules.detail = 0.02f * f.size.diameter;
        rules.jitter = jitter;
        const float away = 10.0f * f.size.height;
        for (int y = 0; y < kHigh; ++y)
            for (int x = 0; x < kWide; ++x) {
                const float u = (float(x) - 0.5f * float(kWide - 1)) / float(kWide);
                const vec3 from(diameters * f.size.diameter * u, row * (float(y) + 0.5f), away);
                const vec3 c =
                    marchRay(f.record, f.nodes, *f.profile, from, vec3(0, 0, -1), rules).radiance;
                colour[size_t(y * kWide + x)] = c;
                light[size_t(y * kWide + x)] = c.r;
            }
    }
    [[nodiscard]] float at(int x, int y) const { return light[size_t(y * kWide + x)]; }
    [[nodiscard]] double sum(int from, int to) const {
        double all = 0;
        for (int k = from * kWide; k < to * kWide; ++k) all += double(light[size_t(k)]);
        return all;
    }
    // True if a visible part hangs in the air above the rest.
    [[nodiscard]] bool hasTorn() const {
        std::vector<int> part(light.size(), 0);
        std::vector<int> stack;
        for (int x = 0; x < kWide; ++x)  // connected to the lowest sixth
            for (int y = 0; y < kHigh / 6; ++y) stack.push_back(y * kWide + x);
        const auto lit = [&](int k) { return seen(colour[size_t(k)]) > 0.1f; };
        while (!stack.empty()) {
            const int k = stack.back(), x = k % kWide;
            stack.pop_back();
            if (part[size_t(k)] || !lit(k)) continue;
            part[size_t(k)] = 1;
            if (x > 0) stack.push_back(k - 1);
            if (x + 1 < kWide) stack.push_back(k + 1);
            if (k >= kWide) stack.push_back(k - kWide);
            if (k + kWide < kWide * kHigh) stack.push_back(k + kWide);
        }
        int torn = 0;
        for (int k = 0; k < kWide * kHigh; ++k) torn += lit(k) && !part[size_t(k)];
        return torn >= 3;
    }
};

struct Spread {
    double sum = 0, square = 0;
    int count = 0;
    void add(double v) { sum += v, square += v * v, ++count; }
    [[nodiscard]] double mean() const { return sum / count; }
    [[nodiscard]] double relative() const {
        return std::sqrt(std::max(square / count - mean() * mean(), 0.0)) / mean();
    }
};

Flame burning(FlamePreset preset, const FlameAir& air) {
    const FlamePresetDef p = presetDef(preset);
    FlameDef d;
    d.appearance = p.appearance, d.power = p.power, d.diameter = p.diameter;
    Flame f;
    startFlame(f, d, air);
    return f;
}

// Rows by which deviations from the mean picture rise from each picture to the next.
double risen(const std::vector<Side>& all, int from, int to) {
    std::vector<double> mean(all[0].light.size(), 0.0);
    for (const Side& side : all)
        for (size_t k = 0; k < mean.size(); ++k)
            mean[k] += double(side.light[k]) / double(all.size());
    double best = -1, rows = 0;
    for (int up = -8; up <= 12; ++up) {
        double both = 0, a = 0, b = 0;
        for (size_t i = 1; i < all.size(); ++i)
            for (int k = from * Side::kWide; k < to * Side::kWide; ++k) {
                const int later = k + up * Side::kWide;
                const double p = double(all[i - 1].light[size_t(k)]) - mean[size_t(k)],
                             q = double(all[i].light[size_t(later)]) - mean[size_t(later)];
                both += p * q, a += p * p, b += q * q;
            }
        const double alike = both / std::sqrt(std::max(a * b, 1e-12));
        if (alike > best) best = alike, rows = double(up);
    }
    return rows;
}

TEST(VolumeAppearance, TonguesRiseWithTheGasAndDetach) {
    for (const FlamePreset preset : kTurbulent) {
        if (kSanitized && preset != FlamePreset::Torch) continue;
        Flame f = burning(preset, {});
        const double law = double(plumeSpeed(f.size.power, f.size.height));
        const double step = 4.0 * 2.2 * double(f.size.height) / Side::kHigh / law;  // four rows
        const int frames = kSanitized ? 12 : 36;
        std::vector<Side> all;
        int torn = 0;
        for (int k = 0; k < frames; ++k) {
            all.emplace_back(Shown(f), 2.2f, 1.3f);
            torn += all.back().hasTorn();
            for (int part = 0; part < 4; ++part) advanceFlame(f, {}, 0.25 * step);
        }
        const double rise = risen(all, Side::kHigh / 3, Side::kHigh * 2 / 3);
        std::printf("           %s: %.1f of 4 rows, torn in %d of %d\n", presetName(preset), rise,
                    torn, frames);
        EXPECT_NEAR(rise, 4.0, 1.0) << presetName(preset);
        if (!kSanitized) {
            EXPECT_GT(torn, frames / 8) << presetName(preset);
        }
    }
}

// In any wind, the lowest part always burns over its bed.
TEST(VolumeAppearance, TheBaseStaysInPlace) {
    for (const FlamePreset preset : kTurbulent) {
        if (kSanitized && preset != FlamePreset::Torch) continue;
        for (const float wind : {0.0f, 3.0f}) {
            FlameAir air;
            air.wind = vec3(wind * std::sqrt(presetDef(preset).diameter), 0, 0);
            Flame f = burning(preset, air);
            Spread foot, top;
            double deviation = 0;
            for (int k = 0; k < (kSanitized ? 6 : 30); ++k) {
                advanceFlame(f, air, 0.11);
                const Side now(Shown(f), 1.8f, 1.6f);
                const int low = Side::kHigh / 10;
                double moment = 0;
                for (int y = 0; y < low; ++y)
                    for (int x = 0; x < Side::kWide; ++x)
                        moment += double(now.at(x, y)) *
                                  (double(x) - 0.5 * double(Side::kWide - 1)) * 1.6 / Side::kWide;
                foot.add(now.sum(0, low));
                top.add(now.sum(Side::kHigh * 6 / 10, Side::kHigh));
                deviation = std::max(deviation, std::abs(moment / now.sum(0, low)));
            }
            std::printf("           %s, wind %.1f: foot %.3f, top %.3f, deviation %.3f D\n",
                        presetName(preset), double(air.wind.x), foot.relative(), top.relative(),
                        deviation);
            EXPECT_LT(foot.relative(), 0.2) << presetName(preset);
            EXPECT_LT(deviation, 0.2) << presetName(preset);
            if (!kSanitized) {
                EXPECT_GT(top.relative(), 1.5 * foot.relative()) << presetName(preset);
            }
        }
    }
}

TEST(VolumeAppearance, IsBrightestLowAndWhiteByExposureOnly) {
    for (const FlamePreset preset : kTurbulent) {
        if (kSanitized && preset != FlamePreset::Torch) continue;
        Flame f = burning(preset, {});
        std::vector<double> rows(size_t(Side::kHigh), 0.0);
        vec3 core(0.0f);
        float most = 0.0f, yellow = 0.0f;
        for (int k = 0; k < (kSanitized ? 4 : 20); ++k) {
            advanceFlame(f, {}, 0.13);
            const Side now(Shown(f), 2.0f, 1.2f);
            for (int y = 0; y < Side::kHigh; ++y) rows[size_t(y)] += now.sum(y, y + 1);
            for (const vec3& c : now.colour) {
                if (c.r > most) most = c.r, core = c;
                // Below that brightness the blue base shows.
                if (c.r > 0.3f) yellow = std::max(yellow, c.g / c.r);
            }
        }
        const auto peak = std::max_element(rows.begin(), rows.end()) - rows.begin();
        const float at = 2.0f * (float(peak) + 0.5f) / float(Side::kHigh);
        const auto shown = [&](float exposure) {
            return film(core * exposure * vec3(1.0f, 1.25f, 1.6f));
        };
        const vec3 night = shown(1.5f), dim = shown(0.1f);
        std::printf(
            "           %s: brightest at %.2f of its height, G/R %.2f, core %.2f %.2f %.2f, "
            "dimmed %.2f %.2f %.2f\n",
            presetName(preset), double(at), double(yellow), double(night.r), double(night.g),
            double(night.b), double(dim.r), double(dim.g), double(dim.b));
        EXPECT_LT(at, 0.45f) << presetName(preset);
        EXPECT_LT(yellow, 0.3f) << "soot of less than 2000 K is deep orange, nowhere yellow";
        EXPECT_GT(night.g, 0.7f * night.r) << "and yellow-white as a camera shows it";
        EXPECT_LT(dim.g, 0.5f * dim.r);
    }
}

double alike(const std::vector<float>& a, const std::vector<float>& b) {
    double both = 0, aa = 0, bb = 0;
    for (size_t k = 0; k < a.size(); ++k) {
        both += double(a[k] * b[k]), aa += double(a[k] * a[k]), bb += double(b[k] * b[k]);
    }
    return both / std::sqrt(std::max(aa * bb, 1e-12));
}

TEST(VolumeAppearance, DoesNotRepeatWithinAMinute) {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    for (const FlamePreset preset : kTurbulent) {
        Shown f = Shown::preset(preset), other = f;
        other.seed = 2;
        other.describe();
        std::vector<fw::gpu::FlamePlace> places;
        for (int k = 0; k < 160; ++k) {
            const float r = 0.4f * f.size.diameter;
            places.push_back({vec2(r * (2 * unit(random) - 1), r * (2 * unit(random) - 1)),
                              f.size.height * (0.15f + 0.6f * unit(random)),
                              0.5f * f.size.diameter});
        }
        const auto sample = [&](const Shown& shown) {
            std::vector<float> sheet;
            double mean = 0;
            for (const fw::gpu::FlamePlace& p : places) {
                const auto look = fw::gpu::flameLookup(shown.record, p, 0.002f * f.size.diameter);
                sheet.push_back(look.y - p.s / f.record.high.w);  // the noise only
                mean += double(sheet.back()) / double(places.size());
            }
            for (float& v : sheet) v -= float(mean);
            return sheet;
        };
        const double step = 1.0 / 12.0;
        std::vector<std::vector<float>> all;
        const int frames = int(rounds(720u, 120u));
        for (int k = 0; k < frames; ++k) {
            all.push_back(sample(f));
            f.run(step);
        }
        double most = 0;
        for (int i = 0; i < 12; ++i)
            for (int j = i + 12; j < frames; ++j)
                most = std::max(most, alike(all[size_t(i)], all[size_t(j)]));
        std::printf("           %s: %.2f alike at most, %.2f with another seed\n",
                    presetName(preset), most, alike(all[0], sample(other)));
        EXPECT_LT(most, 0.75) << presetName(preset);
        EXPECT_LT(std::abs(alike(all[0], sample(other))), 0.5) << "instances are not in phase";
        // The measure works: equal times correlate fully.
        EXPECT_GT(alike(all[3], all[3]), 0.999);
    }
}

// Sign changes in the middle of a sheet per metre.
double crossings(const Shown& f, float s) {
    int count = 0;
    const float reach = 0.35f * f.size.diameter;
    float length = 0;
    for (float z = -reach; z <= reach; z += reach / 12) {
        float before = 0;
        for (float x = -reach; x <= reach; x += reach / 200) {
            const auto look =
                fw::gpu::flameLookup(f.record, {vec2(x, z), s, 0.5f * f.size.diameter}, 1e-4f);
            const float now = look.sheet - 0.4f;
            if (x > -reach) count += (now > 0) != (before > 0);
            before = now;
        }
        length += 2 * reach;
    }
    return double(count) / double(length);
}

TEST(VolumeAppearance, TongueWidthDoesNotDependOnTheHeight) {
    const FlameAppearance look = presetDef(FlamePreset::CampFire).appearance;
    const auto perMetre = [&](float diameter, float height) {
        double sum = 0;
        Shown f(look, 60.0f, diameter, height);
        for (int k = 0; k < 8; ++k) {
            f.run(0.37 * std::sqrt(double(diameter)));
            sum += crossings(f, 0.15f * height) / 8;
        }
        return sum;
    };
    const double one = perMetre(0.6f, 0.6f), ten = perMetre(6.0f, 6.0f);
    EXPECT_NEAR(10.0 * ten / one, 1.0, 0.15) << "ten times the fire, ten times the tongue";
    const double tall = perMetre(0.6f, 2.4f), taller = perMetre(0.6f, 4.8f);
    EXPECT_NEAR(taller / tall, 1.0, 0.15) << "not stretched with the flame";
}

// Flame and smoke end before the bounds of the drawn tube.
TEST(VolumeAppearance, BoundsOfTheTubeAreInvisible) {
    std::mt19937 random(4);
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    for (uint32_t k = 0; k < uint32_t(FlamePreset::Count); ++k) {
        Shown f = Shown::preset(FlamePreset(k));
        f.run(1.3);
        const float r = 0.5f * f.size.diameter;
        const auto medium = [&](float rim, float y) {
            const float a = 6.2831853f * unit(random);
            return sampleFlame(f.record, *f.profile,
                               {rim * r * vec2(std::cos(a), std::sin(a)), y * f.record.high.w, r},
                               0.001f, true);
        };
        float soot = 0, smoke = 0, edge = 0, end = 0;
        for (int trial = 0; trial < 3000; ++trial) {
            const auto in = medium(unit(random), fw::gpu::kFlameTop * unit(random));
            soot = std::max(soot, in.soot);
            edge = std::max(edge, medium(fw::gpu::kFlameReach - 0.01f, 1.8f * unit(random)).soot);
            edge = std::max(edge, medium(unit(random), fw::gpu::kFlameTop - 0.01f).soot);
            if (f.appearance.smoke <= 0) continue;
            // Smoke reaches to where its density falls to 0.01.
            const float y = 0.6f + (f.appearance.smokeTop - 0.6f) * unit(random);
            const float wide =
                0.45f * f.size.diameter + 0.16f * std::max(y - 0.6f, 0.0f) * f.record.high.w;
            smoke = std::max(smoke, medium(0.5f * wide / r * unit(random), y).smoke);
            end = std::max(end, medium(1.9f * wide / r, y).smoke);
            end =
                std::max(end, medium(wide / r * unit(random), f.appearance.smokeTop - 0.01f).smoke);
            end = std::max(end, medium(wide / r * unit(random), 0.61f).smoke);
        }
        EXPECT_GT(soot, 0.0f);
        EXPECT_LE(edge, 0.02f * soot) << presetName(FlamePreset(k));
        EXPECT_LE(end, 0.03f * smoke) << presetName(FlamePreset(k));
    }
}

// A flame's custom colours blend from edge to core with the gas temperature, at equal brightness.
// With one colour the hottest part is slightly paler.
TEST(VolumeAppearance, CustomColoursBlendFromEdgeToCore) {
    FlameAppearance look = presetDef(FlamePreset::CampFire).appearance;
    const vec3 edge(0.05f, 0.1f, 0.9f), core(0.9f, 0.2f, 0.6f),
        kLuminance(0.2126f, 0.7152f, 0.0722f);
    look.tint[0] = edge.r, look.tint[1] = edge.g, look.tint[2] = edge.b, look.tint[3] = 1;
    const auto hue = [&](float kelvin) {
        const fw::gpu::FlameRecord record = describeFlame(look, {60, 0.6f, 1, 1}, {}, 1);
        FlameAppearance real = look;
        real.tint[3] = 0;
        const auto glow = describeFlame(real, {60, 0.6f, 1, 1}, {}, 1);
        return fw::gpu::flameRadiance(record, kelvin) /
               (1.1f * glm::dot(fw::gpu::flameRadiance(glow, kelvin), kLuminance));
    };
    const auto near = [](vec3 wanted, vec3 is) {
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(wanted[c], is[c], 0.01f) << "channel " << c;
    };
    near(edge, hue(look.tip - 100));
    near(glm::mix(edge, vec3(1.0f), look.tintWhite), hue(look.core));
    look.coreTint[0] = core.r, look.coreTint[1] = core.g, look.coreTint[2] = core.b;
    look.coreTint[3] = 1;
    near(edge, hue(look.tip - 100));
    near(core, hue(look.core));
    const vec3 between = hue(0.5f * (look.tip + look.core));
    EXPECT_GT(between.r, edge.r + 0.05f);
    EXPECT_LT(between.r, core.r - 0.05f);
}

// The offset of samples within a ray's step leaves no layers: the same picture on average, and no
// row brighter.
TEST(VolumeAppearance, SampleOffsetsLeaveNoLayers) {
    Flame f = burning(FlamePreset::CampFire, {});
    for (int k = 0; k < 20; ++k) advanceFlame(f, {}, 0.05);
    const Shown shown(f);
    std::vector<Side> all;
    for (const float jitter : {0.0f, 0.25f, 0.5f, 0.75f})
        all.emplace_back(shown, 1.8f, 1.3f, 64, jitter);
    for (int y = 0; y < Side::kHigh; y += 4) {
        double least = 1e9, most = 0;
        for (const Side& side : all) {
            const double sum = side.sum(y, y + 4);
            least = std::min(least, sum), most = std::max(most, sum);
        }
        if (most < 0.02 * all[0].sum(0, Side::kHigh)) continue;
        EXPECT_LT(most / least, 1.08) << "row " << y;
    }
    const double total = all[0].sum(0, Side::kHigh);
    for (const Side& side : all) EXPECT_NEAR(side.sum(0, Side::kHigh) / total, 1.0, 0.02);
}

// Adjacent pixels offset their samples differently; a tip seen by only some of them would look like
// beads.
TEST(VolumeAppearance, TipsDoNotBreakIntoBeads) {
    for (const FlamePreset preset : {FlamePreset::Bonfire, FlamePreset::HouseFire}) {
        Flame f = burning(preset, {});
        double light = 0, apart = 0;
        for (int moment = 0; moment < 6; ++moment) {
            for (int k = 0; k < 9; ++k) advanceFlame(f, {}, 1.0 / 30.0);
            const Shown shown(f);
            const float d = f.size.diameter, h = f.size.height;
            MarchRules rules;
            rules.smoke = false;
            rules.apart = 0.05f * d, rules.steps = 48, rules.first = 10.0f * h - 1.2f * d;
            for (int y = 0; y < 24; ++y)
                for (int x = 0; x < 32; ++x) {
                    const vec3 from(1.4f * d * ((float(x) + 0.5f) / 32.0f - 0.5f),
                                    h * (0.9f + 0.7f * float(y) / 24.0f), 10.0f * h);
                    double sum = 0, squares = 0;
                    for (uint32_t quarter = 0; quarter < 4; ++quarter) {
                        rules.jitter = fw::gpu::marchSamplePhase(quarter & 1u, quarter >> 1u);
                        const double one =
                            double(marchRay(shown.record, shown.nodes, *shown.profile, from,
                                            vec3(0, 0, -1), rules)
                                       .radiance.r);
                        sum += 0.25 * one, squares += 0.25 * one * one;
                    }
                    light += sum;
                    apart += std::sqrt(std::max(squares - sum * sum, 0.0));
                }
        }
        ASSERT_GT(light, 0.0);
        std::printf("%s: cells differ at its tips by %.3f of their light\n", presetName(preset),
                    apart / light);
        // 0.92 for a house fire, where eddies fold its tongues.
        EXPECT_LT(apart / light, preset == FlamePreset::Bonfire ? 0.65 : 0.88)
            << presetName(preset);
    }
}

}  // namespace
