// Heat, fuel and water of a texel: char depth, ignition time, energy balance, extinction by water,
// and ranges under any input.
#include "fire/heat.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace fw::test {
namespace {

constexpr double kHeatStep = 1.0 / 32;

struct TexelBurn {
    gpu::HeatTexel texel;
    gpu::HeatMaterial material;
    uint32_t texelIndex = 7;
    uint32_t step = 0;
    uint64_t burnt = 0, evaporated = 0;

    uint32_t run(uint32_t flux, bool pilot = true, uint32_t air = 256) {
        uint32_t gone = 0, water = 0;
        const uint32_t chance = gpu::hash32(texelIndex * 0x9E3779B9u + step++);
        const uint32_t result =
            gpu::heatStep(texel, material, flux, air, pilot, chance, gone, water);
        burnt += gone;
        evaporated += water;
        return result;
    }
};

// A texel that has not been heated. `ambient`: K; `moisture`: kg/kg.
gpu::HeatTexel atRest(float ambient, float moisture) {
    gpu::HeatTexel x{};
    x.fuel = gpu::kFuelFull;
    x.heat = fire::fixed(double(ambient), 16, 16000);
    x.moist = fire::fixed(double(moisture), 128, gpu::kMaxMoist);
    return x;
}

TexelBurn texelOf(const fire::HeatFacts& facts, double seconds = kHeatStep, float ambient = 293) {
    return {atRest(ambient, 0), fire::heatMaterial(facts, seconds, ambient)};
}

// Without losses, as the analytic ignition times assume.
fire::HeatFacts insulated() {
    fire::HeatFacts facts;
    facts.emissivity = 0;
    facts.absorptivity = 1;
    facts.convection = 0;
    return facts;
}

double secondsToIgnite(const fire::HeatFacts& facts, uint32_t flux, double seconds) {
    TexelBurn burn = texelOf(facts, seconds);
    for (uint32_t i = 1; i < 2'000'000; ++i) {
        if (burn.run(flux) & gpu::kHeatIgnites) return i * seconds;
    }
    return -1;
}

// Depth charred in an hour under a furnace's flux, mm.
double charDepth(float density, double seconds) {
    fire::HeatFacts facts;
    facts.density = density;
    facts.thickness = 0.08f;
    TexelBurn burn = texelOf(facts, seconds);
    for (uint32_t i = 0; i < uint32_t(3600 / seconds); ++i) burn.run(50000);
    return 80.0 * (1 - double(burn.texel.fuel) / gpu::kFuelFull);
}

TEST(Heat, CharDepthAfterAnHourMatchesEurocode5) {
    for (const double seconds : {kHeatStep, 30 * kHeatStep}) {  // pace 1 and 30
        const double soft = charDepth(450, seconds), hard = charDepth(660, seconds);
        std::printf("char after an hour, step %.3f s: softwood %.1f mm, hardwood %.1f mm\n",
                    seconds, soft, hard);
        EXPECT_NEAR(soft, 39, 3.9);
        EXPECT_NEAR(hard, 30, 3.0);
    }
}

// Without losses: a half-space takes pi / 4 k rho c (dT / q)^2, a thin sheet rho c d dT / q.
TEST(Heat, IgnitionTimeMatchesTheory) {
    fire::HeatFacts thick = insulated();
    thick.conductivity = 0.2222f;  // k rho c = 0.25 kW^2 s / m^4 K^2
    thick.ignition = 293 + 330;
    for (const double flux : {20e3, 30e3, 50e3}) {
        const double inertia = double(thick.conductivity) * 450 * 2500;
        const double exact = std::numbers::pi / 4 * inertia * (330 / flux) * (330 / flux);
        const double found = secondsToIgnite(thick, uint32_t(flux), kHeatStep);
        std::printf("thick wood at %.0f kW/m^2: %.1f s, half-space %.1f s\n", flux / 1000, found,
                    exact);
        EXPECT_NEAR(found, exact, 0.05 * exact);
    }
    fire::HeatFacts paper = insulated();
    paper.thick = false;
    paper.thickness = 0.0001f;
    paper.density = 800;
    paper.specificHeat = 1500;  // 120 J/m^2/K
    paper.ignition = 293 + 330;
    for (const double flux : {20e3, 30e3, 50e3}) {
        const double exact = 120 * 330 / flux;
        const double found = secondsToIgnite(paper, uint32_t(flux), kHeatStep);
        std::printf("paper at %.0f kW/m^2: %.2f s, exactly %.2f s\n", flux / 1000, found, exact);
        EXPECT_NEAR(found, exact, 0.05 * exact + kHeatStep);
    }
}

TEST(Heat, BurntEnergyAddsUp) {
    std::mt19937 random(1);
    fire::HeatFacts facts;
    facts.thickness = 0.002f;
    uint64_t cells[16] = {}, texels = 0;
    for (uint32_t i = 0; i < 256; ++i) {
        TexelBurn burn = texelOf(facts, 4 * kHeatStep);
        burn.texelIndex = i;
        const uint64_t worth = 1 + random() % 5000;  // mJ per unit
        const uint32_t before = burn.texel.fuel;
        for (uint32_t k = 0; k < 4000; ++k) {
            const uint64_t had = burn.burnt;
            burn.run(20000 + uint32_t(random() % 30000));
            cells[i % 16] += (burn.burnt - had) * worth;
        }
        texels += uint64_t(before - burn.texel.fuel) * worth;
        EXPECT_EQ(burn.burnt, before - burn.texel.fuel);
        EXPECT_LT(burn.texel.fuel, before);
    }
    uint64_t sum = 0;
    for (const uint64_t cell : cells) sum += cell;
    EXPECT_EQ(sum, texels);
}

TEST(Heat, WaterExtinguishesClothAndMustEvaporateBeforeReignition) {
    fire::HeatFacts cloth;
    cloth.thick = false;
    cloth.thickness = 0.0005f;
    cloth.density = 400;
    cloth.specificHeat = 1400;
    TexelBurn burn = texelOf(cloth);
    while (!(burn.run(30000) & gpu::kHeatIgnites)) ASSERT_LT(burn.step, 3200u);
    for (int i = 0; i < 32; ++i) burn.run(0);
    ASSERT_EQ(burn.texel.phase, gpu::kPhaseBurning);

    gpu::wetTexel(burn.texel, 250, burn.material);
    EXPECT_EQ(burn.texel.film, 200u) << "the surplus runs off";
    uint32_t result = 0;
    for (int i = 0; i < 8 && !(result & gpu::kHeatExtinguishes); ++i) result |= burn.run(0);
    EXPECT_TRUE(result & gpu::kHeatExtinguishes);
    EXPECT_EQ(burn.texel.phase, gpu::kPhaseOut);
    EXPECT_GT(burn.texel.film, 0u);

    // Under a flux again, not before the film is gone.
    bool dry = false;
    for (int i = 0; i < 3200 && !dry; ++i) {
        result = burn.run(40000);
        dry = (result & gpu::kHeatDries) != 0;
        EXPECT_FALSE(result & gpu::kHeatIgnites);
        EXPECT_LE(burn.texel.heat, gpu::kBoiling);
    }
    EXPECT_TRUE(dry);
    result = 0;
    for (int i = 0; i < 3200 && !(result & gpu::kHeatIgnites); ++i) result = burn.run(40000);
    EXPECT_TRUE(result & gpu::kHeatIgnites) << "it reignites once dry";
    EXPECT_EQ(burn.texel.epoch, 1u);
    EXPECT_EQ(burn.texel.phase, gpu::kPhaseBurning);
}

TEST(Heat, EvaporationConsumesItsLatentHeat) {
    fire::HeatFacts cloth;
    cloth.thick = false;
    cloth.thickness = 0.0005f;
    cloth.density = 400;
    cloth.specificHeat = 1400;
    cloth.airDrying = 0;
    double joules = 0, grams = 0;
    for (uint32_t i = 0; i < 400; ++i) {
        TexelBurn burn = texelOf(cloth);
        burn.texelIndex = i;
        burn.texel.heat = gpu::kBoiling;
        gpu::wetTexel(burn.texel, 200, burn.material);
        while (!(burn.run(40000) & gpu::kHeatDries)) ASSERT_LT(burn.step, 3200u);
        // Net of the losses of a surface at 373 K by radiation and convection.
        const double net =
            230.0 / 256 * (40000 - 5.670374e-8 * (std::pow(373.125, 4) - std::pow(293, 4))) -
            15 * (373.125 - 293);
        joules += net * burn.step * kHeatStep;
        grams += double(burn.evaporated);
        EXPECT_EQ(burn.evaporated, 200u);
    }
    std::printf("film: %.3f MJ/kg\n", joules / grams / 1000);
    EXPECT_NEAR(joules / grams / 1000, 2.26, 0.02);
}

TEST(Heat, MoistureDelaysOrPreventsIgnition) {
    fire::HeatFacts wood;
    double before = 0;
    for (const float moisture : {0.0f, 0.12f, 0.3f}) {
        TexelBurn burn = texelOf(wood);
        burn.texel = atRest(293, moisture);
        while (!(burn.run(30000) & gpu::kHeatIgnites)) ASSERT_LT(burn.step, 32u * 600);
        const double seconds = burn.step * kHeatStep;
        std::printf("wood of moisture %.2f at 30 kW/m^2: %.1f s\n", double(moisture), seconds);
        EXPECT_GT(seconds, before * 1.1);
        before = seconds;
    }
}

TEST(Heat, AFreePlankNeedsHeatFeedback) {
    fire::HeatFacts feeds, starves;
    starves.ownFlux = 8000;
    for (const bool fed : {true, false}) {
        TexelBurn burn = texelOf(fed ? feeds : starves);
        while (!(burn.run(40000) & gpu::kHeatIgnites)) ASSERT_LT(burn.step, 3200u);
        for (int i = 0; i < 32 * 1800; ++i) burn.run(0);
        EXPECT_EQ(burn.texel.phase, fed ? gpu::kPhaseBurning : gpu::kPhaseOut);
    }
}

TEST(Heat, RandomRoundingConservesHeat) {
    // A thick block under a small flux warms by far less than a unit per step; the mean of many
    // texels is the exact rise.
    fire::HeatFacts facts = insulated();
    facts.thick = false;
    facts.thickness = 0.05f;
    facts.density = 700;
    double rise = 0;
    constexpr int kTexels = 2000, kSteps = 320;
    for (int i = 0; i < kTexels; ++i) {
        TexelBurn burn = texelOf(facts);
        burn.texelIndex = uint32_t(i);
        for (int k = 0; k < kSteps; ++k) burn.run(1000);
        rise += burn.texel.heat / 16.0 - 293;
    }
    const double exact = 1000.0 * kSteps * kHeatStep / (0.05 * 700 * 2500);
    EXPECT_NEAR(rise / kTexels, exact, 0.02 * exact);
}

TEST(Heat, RadiationAndExponentsMatchFloats) {
    for (uint32_t heat = 100; heat < 65536; heat += 97) {
        const double kelvin = heat / 16.0;
        const double flux = 5.670374419e-8 * std::pow(kelvin, 4);
        EXPECT_NEAR(gpu::radiation(heat), flux, 1 + 1e-4 * flux);
        const double slope = 4 * 5.670374419e-8 * std::pow(kelvin, 3) * 256;
        EXPECT_NEAR(gpu::radiationSlope(heat), slope, 2 + 0.01 * slope) << kelvin;
    }
    for (uint32_t x = 0; x < 20u << 16u; x += 1013)
        EXPECT_NEAR(gpu::halvings(x), 65536 * std::exp2(-double(x) / 65536), 48);
    for (const uint32_t burn : {1u, 100u, 40000u, 1u << 28}) {
        for (uint32_t k = 0; k <= 64; ++k) {
            const auto age = uint32_t(uint64_t(burn) * k / 64);
            const double y = double(age) / burn;
            const double left = 65535 * (1 - y * y * (3 - 2 * y));
            EXPECT_NEAR(gpu::thinFuel(age, burn), left, 12) << burn << " " << age;
            const uint32_t again = gpu::thinAge(gpu::thinFuel(age, burn), burn);
            EXPECT_LE(again, age);
            EXPECT_EQ(gpu::thinFuel(again, burn), gpu::thinFuel(age, burn));
        }
    }
}

TEST(Heat, PointSourcesMatchTheFormula) {
    const auto share = uint32_t(0.33 / (4 * std::numbers::pi) * 65536);
    for (const double power : {1e3, 1e5, 1e7, 1e9}) {
        for (const double distance : {0.15, 1.0, 4.0, 30.0}) {
            const double exact = double(share) / 65536 * power * 0.5 / (distance * distance);
            const uint32_t flux =
                gpu::pointFlux(uint32_t(power), share, 128, uint32_t(distance * distance * 10000));
            if (exact < 500)
                EXPECT_LT(flux, 600u);
            else
                EXPECT_NEAR(flux, std::min(exact, 500000.0), 0.02 * exact)
                    << power << " " << distance;
        }
    }
}

TEST(Heat, PackingRoundTrips) {
    std::mt19937 engine(3);
    const auto random = [&] { return uint32_t(engine()); };
    for (int i = 0; i < 1000; ++i) {
        const gpu::uvec2 words(random(), random());
        EXPECT_EQ(gpu::packHeat(gpu::unpackHeat(words)), words);
    }
}

TEST(Heat, StaysInRangeForAnyInput) {
    std::mt19937 engine(5);
    const auto random = [&] { return uint32_t(engine()); };
    const auto upTo = [&](float most) { return float(random() % 10001) / 10000 * most; };
    for (int i = 0; i < 3000; ++i) {
        fire::HeatFacts facts;
        facts.thick = (random() & 1) != 0;
        facts.thickness = 1e-5f + upTo(1);
        facts.density = 1 + upTo(20000);
        facts.conductivity = 0.001f + upTo(400);
        facts.specificHeat = 1 + upTo(10000);
        facts.emissivity = upTo(1);
        facts.absorptivity = upTo(1);
        facts.convection = upTo(200);
        facts.ownFlux = upTo(200000);
        facts.pyrolysis = upTo(1);
        facts.charFloor = upTo(1);
        facts.maxFilm = upTo(1023);
        const double seconds = kHeatStep / 128 * std::pow(2.0, double(random() % 18));
        TexelBurn burn = texelOf(facts, seconds, upTo(1000));
        burn.texelIndex = random();
        burn.texel = gpu::unpackHeat({random(), random()});
        const gpu::HeatTexel first = burn.texel;
        uint32_t fuel = first.fuel;
        for (int k = 0; k < 200; ++k) {
            if (random() % 32 == 0) gpu::wetTexel(burn.texel, random(), burn.material);
            const uint32_t film = burn.texel.film, moist = burn.texel.moist;
            burn.run(random() % 3 ? random() % 200000 : random(), (random() & 1) != 0,
                     256 + random() % 257);
            const gpu::HeatTexel& x = burn.texel;
            ASSERT_LE(x.fuel, fuel);
            ASSERT_LE(x.heat, 65535u);
            ASSERT_LE(x.film, film);
            ASSERT_LE(x.moist, moist);
            ASSERT_LE(x.soaked, gpu::kSoakSteps);
            ASSERT_LE(x.charred, 255u);
            const gpu::HeatTexel same = gpu::unpackHeat(gpu::packHeat(x));
            ASSERT_EQ(gpu::packHeat(same), gpu::packHeat(x));
            ASSERT_EQ(same.heat, x.heat);
            fuel = x.fuel;
        }
    }
}

}  // namespace
}  // namespace fw::test
