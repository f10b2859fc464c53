// Particle fields: conservation, displacement by forces and spreading, isotropy, flatness.
#include "core/error.h"
#include "reference/field_scene.h"
#include "support/sanitized.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <random>
#include <string>

namespace {

using namespace fw::field;
using fw::gpu::FieldRules;
using fw::test::rounds;

Field fieldOf(uint32_t width, uint32_t height) {
    Field field(std::pmr::new_delete_resource());
    startField(field, width, height);
    return field;
}

FieldRules stillRules(uint32_t width, uint32_t height) {  // nothing moves, dies or is emitted
    FieldRules rules{};
    rules.width = width, rules.height = height;
    rules.seed = 1;
    return rules;
}

struct Moments {
    double x = 0, y = 0, variance = 0;  // variance over both axes, cells^2
};
Moments momentsOf(const Field& field) {
    Moments m;
    const double sum = double(total(field));
    for (uint32_t y = 0; y < field.height; ++y)
        for (uint32_t x = 0; x < field.width; ++x) {
            const double n = cellAt(field, x, y);
            m.x += n * x / sum;
            m.y += n * y / sum;
        }
    for (uint32_t y = 0; y < field.height; ++y)
        for (uint32_t x = 0; x < field.width; ++x) {
            const double n = cellAt(field, x, y);
            m.variance += n * (std::pow(x - m.x, 2) + std::pow(y - m.y, 2)) / sum;
        }
    return m;
}

double deviationOf(const Field& field) {
    double sum = 0, squares = 0;
    for (const uint32_t cell : field.cells) {
        const double n = fw::gpu::fieldNumber(cell);
        sum += n, squares += n * n;
    }
    const double count = double(field.cells.size());
    return std::sqrt(squares / count - sum / count * sum / count);
}

// Everything moves at once among walls, with two open sides: every particle is accounted for.
TEST(Field, ConservesParticles) {
    for (const uint32_t preset : {0u, 1u, 2u}) {
        FieldDef def;
        def.width = 12, def.height = 16;
        def.appearance = fieldPreset(FieldPreset(preset));
        def.wind = {0.3f, 0.0f};
        def.open = fw::gpu::kFieldOpenTop | fw::gpu::kFieldOpenRight;
        FieldRules rules = fieldRules(def);
        addDefaultSource(rules, def.appearance);
        Field field = fieldOf(def.width, def.height);
        std::mt19937 random(preset);
        std::vector<uint8_t> masks(field.masks.size());
        for (uint8_t& mask : masks) mask = random() % 7 == 0 ? fw::gpu::kFieldWall : 0;
        maskField(field, masks);
        const uint32_t steps = rounds(34000u, 300u);  // 10^5 over all three
        for (uint32_t s = 0; s < steps; ++s) {
            if (s % 100 == 0) rules.forceX = int(random() % 800) - 400;
            stepField(field, rules);
            ASSERT_EQ(total(field) + field.died + field.left, field.emitted) << s;
        }
        for (size_t i = 0; i < field.cells.size(); ++i)
            if (field.masks[i] == fw::gpu::kFieldWall) {
                ASSERT_EQ(field.cells[i], fw::gpu::kFieldWallCell);
            }
        EXPECT_GT(field.emitted, steps * 5u);
        EXPECT_GT(field.died, 0u);
        EXPECT_GT(field.left, 0u);
    }
}

TEST(Field, ClosedFieldsConserveTheirContent) {
    FieldDef def;
    def.width = def.height = 32;
    def.open = 0;
    FieldRules rules = fieldRules(def);
    rules.death = 0;
    Field field = fieldOf(32, 32);
    for (uint32_t i = 0; i < 4; ++i) fillCell(field, 5, 5 + i, 32000 + i);  // nearly full cells
    for (int s = 0; s < 1000; ++s) stepField(field, rules);
    EXPECT_EQ(total(field), 128006u);
    EXPECT_EQ(field.left, 0u);
    // It rises: the upper half holds nearly all of it.
    EXPECT_GT(momentsOf(field).y, 20);
}

// A force of one cell per step in any direction.
TEST(Field, ForcesMoveByTheStatedDistance) {
    const std::pair<double, double> expected[] = {{0, 0.99},  {11.25, 0.94}, {22.5, 0.93},
                                                  {45, 0.99}, {135, 0.99},   {270, 0.99}};
    for (const auto& [degrees, speed] : expected) {
        const double angle = degrees * M_PI / 180;
        FieldRules rules = stillRules(64, 64);
        rules.forceX = int(std::lround(std::cos(angle) * 128));
        rules.forceY = int(std::lround(std::sin(angle) * 128));
        Field field = fieldOf(64, 64);
        fillCell(field, 32, 32, 5000);
        const Moments before = momentsOf(field);
        for (int s = 0; s < 20; ++s) stepField(field, rules);
        const Moments after = momentsOf(field);
        const double x = (after.x - before.x) / 20, y = (after.y - before.y) / 20;
        const double turned = std::atan2(y, x) * 180 / M_PI;
        std::printf("[   FIGURE ] force at %6.2f deg: %.3f cells a step at %.2f deg\n", degrees,
                    std::hypot(x, y), turned);
        EXPECT_NEAR(std::hypot(x, y), speed, 0.03 * speed);
        EXPECT_NEAR(std::remainder(turned - degrees, 360), 0, 0.5);
    }
}

// A blob in an empty field: its variance grows by the flow to eight neighbours times their squared
// distance.
TEST(Field, SpreadingWidensABlob) {
    for (const uint32_t spread : {2048u, 4096u}) {  // 1/16, 1/8
        FieldRules rules = stillRules(64, 64);
        rules.spread = spread;
        Field field = fieldOf(64, 64);
        fillCell(field, 32, 32, 30000);
        const double before = momentsOf(field).variance;
        for (int s = 0; s < 30; ++s) stepField(field, rules);
        const double growth = (momentsOf(field).variance - before) / 30;
        EXPECT_NEAR(growth, 12 * spread / 32768.0, 0.03 * 12 * spread / 32768.0);
    }
}

// Shares normalised to 1 must not make peaks in a flat field.
TEST(Field, FlatFieldsStayFlat) {
    for (const uint32_t spread : {1024u, 2048u, 4096u}) {
        FieldRules rules = stillRules(32, 32);
        rules.spread = spread;
        Field field = fieldOf(32, 32);
        std::mt19937 random(3);
        for (uint32_t i = 0; i < 32 * 32; ++i)
            fillCell(field, i % 32, i / 32, uint32_t(97 + random() % 7));
        const uint64_t all = total(field);
        for (uint32_t s = 0; s < 1000; ++s) stepField(field, rules);
        std::printf("[   FIGURE ] flat field, spread %.3f: deviation %.2f after 1000 steps\n",
                    spread / 32768.0, deviationOf(field));
        EXPECT_LE(deviationOf(field), 3);
        EXPECT_EQ(total(field), all);
    }
}

// A symmetric start stays centred but for random fluctuation; over ten seeds no side is preferred.
TEST(Field, IsIsotropic) {
    double meanX = 0, meanY = 0;
    constexpr int kSteps = 50;
    constexpr uint32_t kCount = 6250;
    const double perStep = 4096 / 32768.0;
    const double bound = 4 * std::sqrt(6 * perStep * kSteps / kCount);
    for (uint32_t seed = 1; seed <= 10; ++seed) {
        FieldRules rules = stillRules(33, 33);
        rules.spread = 4096;
        rules.inertia = 64;
        rules.memory = 64;
        rules.seed = seed;
        Field field = fieldOf(33, 33);
        for (int y = -2; y <= 2; ++y)
            for (int x = -2; x <= 2; ++x)
                fillCell(field, uint32_t(16 + x), uint32_t(16 + y), kCount / 25);
        for (int s = 0; s < kSteps; ++s) stepField(field, rules);
        const Moments m = momentsOf(field);
        EXPECT_LT(std::hypot(m.x - 16, m.y - 16), bound) << seed;
        meanX += (m.x - 16) / 10;
        meanY += (m.y - 16) / 10;
    }
    EXPECT_LT(std::hypot(meanX, meanY), bound / std::sqrt(10.0));
}

TEST(Field, RandomMotionIsUnbiased) {
    double x = 0, y = 0, shortest = 1e9, longest = 0;
    uint32_t count = 0, octants[8] = {};
    for (uint32_t step = 0; step < 400; step += 4)
        for (uint32_t i = 0; i < 64; ++i)
            for (uint32_t j = 0; j < 64; j += 4) {
                const ivec2 d = fw::gpu::fieldChaos(
                    fw::gpu::fieldRandom(fw::gpu::fieldKey(step >> 2, 7, 1), i, j));
                const double length = std::hypot(d.x, d.y);
                shortest = std::min(shortest, length), longest = std::max(longest, length);
                x += d.x, y += d.y, ++count;
                const double turn = std::atan2(d.y, d.x) / (2 * M_PI) + 1;
                ++octants[uint32_t(turn * 8) & 7];
            }
    EXPECT_GT(shortest, 126);
    EXPECT_LT(longest, 130);
    const double noise = 4 * 128 / std::sqrt(2.0 * count);
    EXPECT_LT(std::abs(x / count), noise);
    EXPECT_LT(std::abs(y / count), noise);
    for (const uint32_t octant : octants) EXPECT_NEAR(octant, count / 8.0, 0.06 * count / 8.0);
}

// Remembered motion carries a puff on after the force ends.
TEST(Field, RemembersMotion) {
    double way[2] = {};
    for (const uint32_t memory : {0u, 1u}) {
        FieldRules rules = stillRules(64, 16);
        rules.memory = memory * 120, rules.inertia = memory * 200;
        rules.forceX = 128;
        Field field = fieldOf(64, 16);
        fillCell(field, 8, 8, 4000);
        for (int s = 0; s < 10; ++s) stepField(field, rules);
        rules.forceX = 0;
        const double at = momentsOf(field).x;
        for (int s = 0; s < 20; ++s) stepField(field, rules);
        way[memory] = momentsOf(field).x - at;
    }
    EXPECT_EQ(way[0], 0);
    EXPECT_GT(way[1], 2);
    EXPECT_LT(way[1], 19);
}

// Fire and smoke end above their source, water below.
TEST(Field, PresetsRiseAndFall) {
    double height[kFieldPresets], lit[kFieldPresets];
    for (uint32_t p = 0; p < kFieldPresets; ++p) {
        FieldDef def;
        def.appearance = fieldPreset(FieldPreset(p));
        FieldRules rules = fieldRules(def);
        addDefaultSource(rules, def.appearance);
        Field field = fieldOf(64, 64);
        for (int s = 0; s < 400; ++s) stepField(field, rules);
        height[p] = momentsOf(field).y;
        lit[p] = double(total(field));
    }
    std::printf("[   FIGURE ] mean height of fire, smoke, water: %.1f, %.1f, %.1f of 64 cells\n",
                height[0], height[1], height[2]);
    EXPECT_GT(height[0], 3);
    EXPECT_LT(height[0], 25);
    EXPECT_GT(height[1], height[0] + 5);
    EXPECT_LT(height[2], 32);
    for (const double sum : lit) EXPECT_GT(sum, 1000);
}

}  // namespace
