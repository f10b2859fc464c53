// The flames that volumetric fires burn as, below the world: room, divisions, frames that fail, and
// which of them a view gives all its samples to.
#include "components/fire_flames.h"
#include "gpu/passes/draw.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace {

using namespace fw;
using components::FireFlames;
using components::VolumetricFire;

struct Burning {
    VolumetricFire fire{std::pmr::get_default_resource()};
    FireFlames flames{std::pmr::get_default_resource()};
    explicit Burning(float power, float diameter) {
        FwVolumetricFireDef def{};
        def.windResponse = def.turbulence = def.speed = def.density = def.smoke = def.blue = 1;
        def.blend = 0.3f;
        def.power = power;
        def.diameter = diameter;
        components::makeVolumetricFire(def, 1, fire);
    }
    void plan(float seconds) {
        flames.begin();
        flames.settle(fire, {});
        flames.advance({}, seconds);
    }
    void frame(float seconds) {
        plan(seconds);
        flames.commit();
        fire.state = fire.nextState;
    }
};

TEST(FireFlames, AFrameThatFailsChangesNothing) {
    Burning once(60, 0.6f), twice(60, 0.6f);
    for (Burning* b : {&once, &twice}) b->flames.findRoom(1);
    for (int k = 0; k < 20; ++k) {
        once.frame(1.0f / 32);
        twice.plan(0.4f);  // not taken
        twice.frame(1.0f / 32);
    }
    ASSERT_EQ(1u, once.flames.now().size());
    EXPECT_EQ(once.fire.state.tip, twice.fire.state.tip);
    EXPECT_EQ(once.fire.state.intensity, twice.fire.state.intensity);
}

TEST(FireFlames, FlamesWithoutRoomAreLeftOut) {
    Burning b(10, 2);
    ASSERT_LT(8u, b.fire.partCount);
    EXPECT_EQ(5u, b.flames.findRoom(5));
    b.frame(1.0f / 32);
    EXPECT_EQ(5u, b.flames.now().size());
    EXPECT_EQ(size_t(gpu::kMaxVolumeFlames), b.flames.findRoom(1000));
    b.frame(1.0f / 32);
    EXPECT_EQ(b.fire.partCount, b.flames.now().size());
}

// Where one flame becomes many, the new ones grow while the old one dies down, and the sum of their
// power never leaps.
TEST(FireFlames, ADivisionIsNoLeap) {
    Burning b(600, 1.3f);
    b.flames.findRoom(128);
    b.frame(1.0f / 32);
    EXPECT_EQ(1u, b.flames.now().size());
    components::setFirePower(b.fire, 8);
    float before = b.fire.state.power;
    uint32_t most = 0;
    for (int k = 0; k < 256; ++k) {
        b.frame(1.0f / 32);
        EXPECT_LT(std::abs(b.fire.state.power - before), 0.11f * before + 1) << "frame " << k;
        before = b.fire.state.power;
        most = std::max(most, uint32_t(b.flames.now().size()));
    }
    EXPECT_EQ(b.fire.partCount + 1, most);
    EXPECT_EQ(b.fire.partCount, b.flames.now().size());
    EXPECT_NEAR(before, 8, 0.1f);
}

TEST(FireFlames, AViewGivesItsSamplesToWhatCoversMost) {
    std::vector<gpu::VolumeItem> items(40);
    for (uint32_t i = 0; i < items.size(); ++i) {
        items[i].flame = i;
        const float side = 0.01f * float((i * 17) % 40 + 1);
        items[i].draw.rect = {0, 0, side, side};
        items[i].draw.mostSteps = 32;
    }
    gpu::chooseVolumes(items);
    uint32_t all = 0;
    float least = 9, most = 0;
    for (const gpu::VolumeItem& item : items) {
        const bool full = item.draw.mostSteps == 32;
        all += full;
        if (full)
            least = std::min(least, item.draw.rect.z);
        else
            most = std::max(most, item.draw.rect.z);
    }
    EXPECT_EQ(32u, all);
    EXPECT_LT(most, least);
    items.resize(32);
    for (gpu::VolumeItem& item : items) item.draw.mostSteps = 32;
    gpu::chooseVolumes(items);
    for (const gpu::VolumeItem& item : items) EXPECT_EQ(32u, item.draw.mostSteps);
}

}  // namespace
