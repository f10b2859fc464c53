// Flames of volumetric fires: capacity, division, failed frames, and the tier that a view gives
// each of them.
#include "components/fire_flames.h"
#include "lod/impostor_atlas.h"
#include "lod/tiers.h"
#include "lod/volumes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
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

TEST(FireFlames, AFailedFrameChangesNothing) {
    Burning once(60, 0.6f), twice(60, 0.6f);
    for (Burning* b : {&once, &twice}) b->flames.reserveFlames(1);
    for (int k = 0; k < 20; ++k) {
        once.frame(1.0f / 32);
        twice.plan(0.4f);  // planned and not committed
        twice.frame(1.0f / 32);
    }
    ASSERT_EQ(1u, once.flames.now().size());
    EXPECT_EQ(once.fire.state.tip, twice.fire.state.tip);
    EXPECT_EQ(once.fire.state.intensity, twice.fire.state.intensity);
}

TEST(FireFlames, FlamesBeyondTheCapacityAreOmitted) {
    Burning b(10, 2);
    ASSERT_LT(8u, b.fire.partCount);
    EXPECT_EQ(5u, b.flames.reserveFlames(5));
    b.frame(1.0f / 32);
    EXPECT_EQ(5u, b.flames.now().size());
    EXPECT_EQ(size_t(gpu::kMaxVolumeFlames), b.flames.reserveFlames(1000));
    b.frame(1.0f / 32);
    EXPECT_EQ(b.fire.partCount, b.flames.now().size());
}

// When one flame divides, the new ones grow while the old one dies down, and the total power never
// jumps.
TEST(FireFlames, DivisionKeepsThePowerContinuous) {
    Burning b(600, 1.3f);
    b.flames.reserveFlames(128);
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

// A view marches at most 32 flames and shows small ones as billboards. A flame keeps its tier while
// its size wavers about a limit and changes by steps.
TEST(VolumeTiers, AFlameKeepsItsTier) {
    lod::TierLives lives{};
    std::vector<lod::TierItem> items(256);
    std::vector<uint32_t> places(items.size());
    for (uint32_t i = 0; i < items.size(); ++i)
        items[i] = {i + 1, FW_FIRE_TIER_AUTO, 40.0f, 1.0f + 0.001f * float(i)};
    const auto count = [&](uint32_t tier) {
        uint32_t sum = 0;
        for (const uint32_t place : places) sum += lives[place].tier == tier;
        return sum;
    };
    const auto frame = [&] { lod::chooseTiers(items, gpu::kMaxVolumeFlames, {}, lives, places); };
    frame();
    EXPECT_EQ(16u, count(FW_FIRE_TIER_MARCH_HIGH));
    EXPECT_EQ(16u, count(FW_FIRE_TIER_MARCH_LOW));
    EXPECT_EQ(224u, count(FW_FIRE_TIER_IMPOSTOR));
    EXPECT_EQ(FW_FIRE_TIER_MARCH_HIGH, lives[places[255]].tier);
    // Others grow a little: no tier changes.
    for (uint32_t i = 0; i < items.size(); ++i) items[i].covers = 1.0f - 0.0005f * float(i);
    frame();
    for (uint32_t i = 224; i < 256; ++i)
        EXPECT_NE(FW_FIRE_TIER_IMPOSTOR, lives[places[i]].tier) << i;
    EXPECT_EQ(224u, count(FW_FIRE_TIER_IMPOSTOR));

    items.resize(1);
    for (int k = 0; k < 40; ++k) frame();
    uint32_t turns = 0, tier = lives[places[0]].tier;
    for (int k = 0; k < 200; ++k) {
        items[0].wide = k % 2 ? lod::kImpostorInside + 0.1f : lod::kImpostorOutside - 0.1f;
        frame();
        turns += lives[places[0]].tier != tier;
        tier = lives[places[0]].tier;
    }
    EXPECT_EQ(0u, turns);
    items[0].wide = 100;
    for (int k = 0; k < 40; ++k) frame();
    EXPECT_EQ(FW_FIRE_TIER_MARCH_HIGH, lives[places[0]].tier);
    items[0].wide = 5;
    float part = 0;
    for (uint32_t k = 0; k < lod::kTierFrames; ++k) {
        frame();
        const lod::TierLife& life = lives[places[0]];
        EXPECT_EQ(FW_FIRE_TIER_IMPOSTOR, life.tier);
        EXPECT_EQ(k + 1 < lod::kTierFrames, life.marched()) << k;
        EXPECT_NEAR(part, life.part(), 1.01f / float(lod::kTierFrames));
        part = life.part();
    }
    // A requested tier is used; without room for its billboard the flame is marched.
    items[0].requested = FW_FIRE_TIER_MARCH_LOW;
    for (int k = 0; k < 40; ++k) frame();
    EXPECT_EQ(lod::kLowSteps, lives[places[0]].steps);
    items[0].requested = FW_FIRE_TIER_IMPOSTOR;
    for (int k = 0; k < 40; ++k) lod::chooseTiers(items, 0, {}, lives, places);
    EXPECT_TRUE(lives[places[0]].marched());
}

// Similar flames that are too many to march, or small ones, share an impostor atlas. A flame alone
// or without an atlas is unchanged.
TEST(VolumeTiers, SimilarFlamesShareAnImpostor) {
    lod::TierLives lives{};
    std::vector<lod::TierItem> items(64);
    std::vector<uint32_t> places(items.size());
    for (uint32_t i = 0; i < items.size(); ++i)
        items[i] = {i + 1, FW_FIRE_TIER_AUTO, 60.0f, 2.0f - 0.01f * float(i), i % 2 == 0, true};
    const auto count = [&](uint32_t tier) {
        uint32_t sum = 0;
        for (const uint32_t place : places) sum += lives[place].tier == tier;
        return sum;
    };
    const auto frames = [&](int many) {
        for (int k = 0; k < many; ++k)
            lod::chooseTiers(items, gpu::kMaxVolumeFlames, {}, lives, places);
    };
    frames(1);
    EXPECT_EQ(16u, count(FW_FIRE_TIER_SHARED_IMPOSTOR));
    EXPECT_EQ(16u, count(FW_FIRE_TIER_IMPOSTOR));
    EXPECT_EQ(16u, count(FW_FIRE_TIER_MARCH_LOW));
    // The device's budget limits them too.
    for (int k = 0; k < 40; ++k)
        lod::chooseTiers(items, gpu::kMaxVolumeFlames, {4, 8}, lives, places);
    EXPECT_EQ(28u, count(FW_FIRE_TIER_SHARED_IMPOSTOR));

    // By size: an impostor below 24 px, kept up to 31; a billboard below 10, kept up to 13.
    items.resize(2);
    const auto settle = [&](float wide) {
        items[0].wide = items[1].wide = wide;
        frames(40);
        return lives[places[0]].tier;
    };
    EXPECT_EQ(FW_FIRE_TIER_MARCH_HIGH, settle(lod::kAtlasOutside + 1));
    EXPECT_EQ(FW_FIRE_TIER_MARCH_HIGH, settle(lod::kAtlasInside + 1));
    EXPECT_EQ(FW_FIRE_TIER_SHARED_IMPOSTOR, settle(lod::kAtlasInside - 1));
    EXPECT_EQ(FW_FIRE_TIER_MARCH_HIGH, lives[places[1]].tier) << "it has no impostor";
    EXPECT_EQ(FW_FIRE_TIER_SHARED_IMPOSTOR, settle(lod::kAtlasOutside - 1));
    EXPECT_EQ(FW_FIRE_TIER_IMPOSTOR, settle(lod::kImpostorInside - 1));
    EXPECT_EQ(FW_FIRE_TIER_IMPOSTOR, settle(lod::kImpostorOutside - 1));
    EXPECT_EQ(FW_FIRE_TIER_SHARED_IMPOSTOR, settle(lod::kImpostorOutside + 1));
    items[0].shared = false;  // it keeps its impostor and takes no other
    EXPECT_EQ(FW_FIRE_TIER_SHARED_IMPOSTOR, settle(lod::kImpostorOutside + 1));
    EXPECT_EQ(FW_FIRE_TIER_MARCH_HIGH, settle(lod::kAtlasOutside + 1));
    EXPECT_EQ(FW_FIRE_TIER_MARCH_HIGH, settle(lod::kImpostorOutside + 1));
    // A flame that requests an impostor gets it, or a billboard.
    items[0].requested = FW_FIRE_TIER_SHARED_IMPOSTOR;
    EXPECT_EQ(FW_FIRE_TIER_SHARED_IMPOSTOR, settle(100));
    items[0].hasAtlas = false;
    EXPECT_EQ(FW_FIRE_TIER_IMPOSTOR, settle(100));
}

// Similar flames read one atlas, each delayed by its own amount, frame by frame, and fade over to
// another flame's frames.
TEST(VolumeTiers, ImpostorsAreReadFrameByFrame) {
    constexpr uint32_t kFlames = 12;
    auto atlases = std::make_unique<lod::ImpostorAtlases>();
    std::vector<lod::AtlasItem> items(kFlames);
    std::vector<uint32_t> had(kFlames, lod::kNoAtlas), out(kFlames);
    std::vector<lod::AtlasCursor> readers(kFlames);
    for (uint32_t i = 0; i < kFlames; ++i) {
        items[i].kind = {i < 9 ? 7u : 8u, 0.5f + 0.01f * float(i), 2, 0.1f, true};
        items[i].key = 100 + i;
        items[i].covers = i == 3 ? 2.0f : 1.0f;
        items[i].wants = items[i].fits = true;
    }
    items[8].kind.wide = 1;  // too wide
    items[11].kind.plain = false;
    const auto frame = [&] {
        lod::chooseAtlases(items, had, 2, *atlases, out);
        for (lod::ImpostorAtlas& atlas : *atlases)
            if (atlas.used) atlas.frames[atlas.written++ % lod::kAtlasFrames].run = atlas.run;
        for (uint32_t i = 0; i < items.size(); ++i) {
            if (out[i] == lod::kNoAtlas) continue;
            readers[i].read(out[i], *atlases);
            had[i] = out[i];
        }
    };
    for (uint32_t i = 0; i < kFlames; ++i) readers[i].key = items[i].key;
    frame();
    EXPECT_EQ(103u, (*atlases)[0].key) << "the largest flame";
    EXPECT_EQ(8u, (*atlases)[0].shares);
    EXPECT_EQ(lod::kNoAtlas, out[11]);
    // With two impostors the second goes to the first flame without one.
    EXPECT_EQ(108u, (*atlases)[1].key);
    EXPECT_EQ(lod::kNoAtlas, out[9]) << "there are only two";
    for (int k = 0; k < 40; ++k) frame();
    std::set<uint64_t> late;
    for (uint32_t i = 0; i < 8; ++i) late.insert((*atlases)[0].written - 1 - readers[i].at);
    EXPECT_GE(late.size(), 6u);
    EXPECT_EQ((*atlases)[0].written - 1, readers[3].at) << "its own frames as they are written";
    EXPECT_LE(*late.rbegin() + lod::kAtlasFrameStep, lod::kAtlasFrames);

    // Another flame's frames: each reader switches to them in turn.
    items[3].wants = false;
    items[4].covers = 1.5f;
    uint32_t turns = 0;
    for (uint32_t k = 0; k < lod::kAtlasFrames; ++k) {
        const std::vector<lod::AtlasCursor> last = readers;
        frame();
        EXPECT_NE(103u, (*atlases)[0].key);
        for (uint32_t i = 0; i < 8; ++i) {
            const lod::AtlasCursor& r = readers[i];
            if (i == 3) continue;
            if (r.turned == 1) {
                ++turns;
                EXPECT_EQ(last[i].at, r.before) << "from the frame it showed";
            } else {
                EXPECT_EQ(last[i].at + 1, r.at) << i;
            }
            EXPECT_LT((*atlases)[0].written - r.at, lod::kAtlasFrames);
        }
    }
    EXPECT_EQ(7u, turns) << "each once";
    items[0].kind.facing += 0.2f;  // seen from higher up; a flame keeps its impostor for a while
    frame();
    EXPECT_EQ(0u, out[0]);
    items[0].kind.facing += 0.2f;
    frame();
    EXPECT_NE(0u, out[0]);
}

TEST(FireFlames, ViewsGiveSamplesToTheLargestFlames) {
    std::vector<lod::VolumeItem> items(40);
    for (uint32_t i = 0; i < items.size(); ++i) {
        items[i].flame = i;
        const float side = 0.01f * float((i * 17) % 40 + 1);
        items[i].draw.rect = {0, 0, side, side};
        items[i].draw.mostSteps = 32;
    }
    lod::chooseVolumes(items);
    uint32_t all = 0;
    float least = 9, most = 0;
    for (const lod::VolumeItem& item : items) {
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
    for (lod::VolumeItem& item : items) item.draw.mostSteps = 32;
    lod::chooseVolumes(items);
    for (const lod::VolumeItem& item : items) EXPECT_EQ(32u, item.draw.mostSteps);
}

}  // namespace
