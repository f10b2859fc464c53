// Ragged holes: noise makes slots burn through earlier or later, the same on both sides of a wall.
#include "mesh/refine/model.h"
#include "support/refine_scene.h"

#include <gtest/gtest.h>

namespace fw::test {
namespace {

constexpr uint32_t kSide = 16;

std::vector<gpu::RefineSlot> roughened(const RefineScene& scene,
                                       const std::vector<uint8_t>& noise) {
    std::vector<gpu::RefineSlot> slots(scene.model.slots.begin(), scene.model.slots.end());
    const mesh::RefineHoles holes{0.5f, 2.6f, 0.8f, true};
    mesh::refineRoughen(scene.domain, scene.model, {&holes, 1}, noise, kSide, slots);
    return slots;
}

// Scale of a slot's burn-through time.
double scaleOf(const RefineScene& scene, const std::vector<gpu::RefineSlot>& slots, size_t i) {
    return double(slots[i].reach >> 16) / double(scene.model.slots[i].reach >> 16);
}

TEST(RefineRoughen, DarkTexelsBurnThroughEarlier) {
    const RefineScene scene(gridBox(0.6, 0.5, 0.4, 1, 1, 1), {}, 64);
    const auto scales = [&](uint8_t level) {
        const auto slots = roughened(scene, std::vector<uint8_t>(kSide * kSide, level));
        double low = 1e9, high = 0;
        for (size_t i = 0; i < slots.size(); ++i) {
            if (scene.model.draws[i].triangle == mesh::kNone) continue;
            low = std::min(low, scaleOf(scene, slots, i));
            high = std::max(high, scaleOf(scene, slots, i));
            EXPECT_EQ(scene.model.slots[i].reach & 0xFFFFu, slots[i].reach & 0xFFFFu);
        }
        EXPECT_NEAR(low, high, 0.01) << int(level);
        return low;
    };
    EXPECT_NEAR(1 - 0.5 * 0.9, scales(0), 0.01);
    EXPECT_NEAR(1 + 0.5 * 0.9 * 0.45, scales(255), 0.01);
    EXPECT_NEAR(1, scales(128), 0.01);
}

TEST(RefineRoughen, BothSidesOfAWallAgree) {
    const RefineScene scene(gridBox(0.6, 0.5, 0.02, 2, 2, 1, 13), {}, 96);
    std::vector<uint8_t> noise(kSide * kSide);
    for (uint32_t i = 0; i < noise.size(); ++i) noise[i] = uint8_t(gpu::hash32(i) >> 24);
    const auto slots = roughened(scene, noise);
    std::map<std::pair<long, long>, double> below;
    const auto key = [](const gpu::RefineSlot& s) {
        return std::make_pair(std::lround(double(s.x) * 8192), std::lround(double(s.y) * 8192));
    };
    const auto inside = [](const gpu::RefineSlot& s) {
        return s.x > 0.03f && s.y > 0.03f && s.x < 0.57f && s.y < 0.47f;
    };
    for (size_t i = 0; i < slots.size(); ++i)
        if (slots[i].z == 0 && inside(slots[i])) below[key(slots[i])] = scaleOf(scene, slots, i);
    uint32_t pairs = 0;
    double low = 1e9, high = 0;
    for (size_t i = 0; i < slots.size(); ++i) {
        const auto other = below.find(key(slots[i]));
        if (slots[i].z < 0.019f || other == below.end()) continue;
        const double scale = scaleOf(scene, slots, i);
        ASSERT_NEAR(other->second, scale, 0.01);
        low = std::min(low, scale);
        high = std::max(high, scale);
        ++pairs;
    }
    EXPECT_GT(pairs, 20u);
    EXPECT_LT(low, 0.9);
    EXPECT_GT(high, 1.05);
}

// Each wall alone, and details that mirror the other wall's: hole times depend on the position.
TEST(RefineRoughen, WallsOfASolidAgreeForAnyDetails) {
    RefineScene scene(gridBox(0.6, 0.5, 0.2, 2, 2, 1, 13), {}, 96);
    for (mesh::RenderVertex& v : scene.domain.vertices) {
        v.detail[0] = v.position[2] > 0.1f ? v.position[0] : 0.6f - v.position[0];
        v.detail[1] = v.position[1];
    }
    scene.domain.hasDetail = true;
    std::vector<uint8_t> noise(kSide * kSide);
    for (uint32_t i = 0; i < noise.size(); ++i) noise[i] = uint8_t(gpu::hash32(i) >> 24);
    for (const bool wood : {false, true}) {
        std::vector<gpu::RefineSlot> slots(scene.model.slots.begin(), scene.model.slots.end());
        const mesh::RefineHoles holes{0.5f, 2.6f, 0.8f, wood};
        mesh::refineRoughen(scene.domain, scene.model, {&holes, 1}, noise, kSide, slots);
        std::map<std::pair<long, long>, double> below;
        const auto key = [](const gpu::RefineSlot& s) {
            return std::make_pair(std::lround(double(s.x) * 8192), std::lround(double(s.y) * 8192));
        };
        const auto inside = [](const gpu::RefineSlot& s) {
            return s.x > 0.03f && s.y > 0.03f && s.x < 0.57f && s.y < 0.47f;
        };
        for (size_t i = 0; i < slots.size(); ++i)
            if (slots[i].z == 0 && inside(slots[i]))
                below[key(slots[i])] = scaleOf(scene, slots, i);
        uint32_t pairs = 0, differ = 0;
        for (size_t i = 0; i < slots.size(); ++i) {
            const auto other = below.find(key(slots[i]));
            if (slots[i].z < 0.19f || other == below.end()) continue;
            differ += std::abs(other->second - scaleOf(scene, slots, i)) > 0.01;
            ++pairs;
        }
        EXPECT_GT(pairs, 20u);
        if (wood)
            EXPECT_GT(differ, pairs / 2);  // planks have their own grain
        else
            EXPECT_EQ(differ, 0u);
    }
}

}  // namespace
}  // namespace fw::test
