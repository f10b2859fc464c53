// Flipbooks drawn by a device: a particle shows its flipbook, also between two frames, and removing
// a flipbook leaves the others unchanged. Smoke quads stand upright and take their alpha from the
// flipbook alone, so pictures compare texel by texel.
#include "flipbook/flipbook.h"
#include "flipbook/picture.h"
#include "sample.h"
#include "shared/particle.h"
#include "support/own_world.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace fw::test::flipbook_picture_test {
namespace {

using gpu::vec2;
using gpu::vec4;

constexpr uint32_t kSide = 256;  // px
constexpr float kSize = 1;       // m, particle size
constexpr uint32_t kSeed = 0x51a3;
constexpr float kSmokeLife = 10;  // in lifetimes of the fire

std::pmr::memory_resource* memory() { return std::pmr::get_default_resource(); }

// A soft spot that moves 8 of 64 texels right and 6 up per frame.
flipbook::Flipbook spots(flipbook::Kind kind) {
    flipbook::Flipbook made(memory());
    flipbook::Facts& f = made.facts;
    f.kind = kind;
    f.loops = 0;
    f.width = f.height = 64;
    f.motionWidth = f.motionHeight = 8;
    f.frames = 5;
    f.maxMotion = 0.25f;
    f.seconds = 1;
    for (uint32_t frame = 0; frame < f.frames; ++frame) {
        for (uint32_t y = 0; y < 64; ++y)
            for (uint32_t x = 0; x < 64; ++x) {
                const float dx = float(x) + 0.5f - 14 - 8 * float(frame);
                const float dy = float(y) + 0.5f - 18 - 6 * float(frame);
                const float v = std::exp(-(dx * dx + dy * dy) / 40);
                for (const float c : {0.5f, 0.0f, v, 0.5f * v})
                    made.texels.push_back(uint8_t(255 * c + 0.5f));
            }
        for (uint32_t i = 0; i < 64; ++i) {
            made.motion.push_back(uint8_t(128.5f + 127 * (8 / 64.0f) / f.maxMotion));
            made.motion.push_back(uint8_t(128.5f + 127 * (6 / 64.0f) / f.maxMotion));
        }
        made.rects.push_back({0, 0, 64, 64});
    }
    return made;
}

struct Shown {
    std::vector<float> alpha;  // kSide^2, rows from the bottom
    float width = 0;           // m, width of the quad
    bool mirrored = false;
};

class FlipbookPicture : public OwnWorld {
 protected:
    void SetUp() override {
        OwnWorld::SetUp();
        if (IsSkipped()) return;
        FwWorldDef def = fwDefaultWorldDef();
        ASSERT_EQ(FW_OK, fwCreateWorld(context_, &def, &world_));
    }
    FwFlipbookId create(const flipbook::Flipbook& made) {
        const auto bytes = flipbook::cookFlipbook(made, memory());
        FwFlipbookDef def = fwDefaultFlipbookDef();
        def.cooked = bytes.data();
        def.cookedSize = bytes.size();
        return created(fwWorld_CreateFlipbook, world_, def);
    }
    FwFlipbookId create(uint32_t preset) {
        FwFlipbookDef def = fwDefaultFlipbookDef();
        def.preset = preset;
        return created(fwWorld_CreateFlipbook, world_, def);
    }
    // One particle of pure smoke, a second old, at `time` of its flipbook, in a picture of `span` m
    // around (aside, 0).
    Shown smokeAt(FwFlipbookId book, float time, float span = 2, float aside = 0) {
        FwFireEmitterDef def = fwDefaultFireEmitterDef();
        def.seed = kSeed;
        def.shape = FW_EMITTER_DISC;  // a point
        def.rate = 0.25f;
        def.speed = 1e-3f;
        def.cone = 1e-5f;
        def.size0 = def.size1 = kSize;
        def.buoyancy = def.turbulence = def.sparks = def.lifeVariance = 0;
        def.smoke = 1;
        def.smokeLife = kSmokeLife;
        def.life = 1 / (0.65f + time * (0.35f + kSmokeLife));
        def.maxParticles = 1;
        def.smokeFlipbooks[0] = book;
        const FwFireEmitterId emitter = created(fwWorld_CreateFireEmitter, world_, def);
        for (int i = 0; i < 5 * 32; ++i) fwWorld_Step(world_, 1.0f / 32);
        const FwView view = frontView({aside, 0}, span, span);
        const float nothing[4] = {0, 0, 0, 0};
        const std::vector<uint8_t> pixels = shoot(world_, view, kSide, kSide, nothing);
        EXPECT_EQ(FW_OK, fwWorld_DestroyFireEmitter(world_, emitter));
        gpu::ParticleEmitter record{};
        record.life = {def.life, 0, kSmokeLife, 1};
        record.heat = {1500, 1400, 1, 0};
        record.size = {kSize, 0, 0, 1};
        const uint32_t seed = gpu::particleSeed(kSeed, 0);
        const gpu::ParticleTraits traits = gpu::particleTraits(record, seed);
        Shown shown;
        shown.width = 1.24f * gpu::particleSize(record, traits, 1, 0, traits.own);
        shown.mirrored = (seed & 1) != 0;
        for (uint32_t y = 0; y < kSide; ++y)
            for (uint32_t x = 0; x < kSide; ++x)
                shown.alpha.push_back(float(pixels[4 * (size_t(kSide - 1 - y) * kSide + x) + 3]) /
                                      255);
        return shown;
    }
    // UV in the flipbook of a pixel.
    static vec2 uvOf(const Shown& shown, uint32_t x, uint32_t y) {
        const float metres = 2.0f / kSide;
        float u = (float(x) + 0.5f - kSide / 2.0f) * metres / shown.width;
        if (shown.mirrored) u = -u;
        return {u + 0.5f, (float(y) + 0.5f - kSide / 2.0f) * metres / shown.width + 0.5f};
    }
};

TEST_F(FlipbookPicture, ParticlesShowTheirFlipbookOnAndBetweenFrames) {
    const flipbook::Flipbook made = spots(flipbook::Kind::Smoke);
    (void)create(FW_FLIPBOOK_SPARK);  // one of several flipbooks
    const FwFlipbookId id = create(made);
    for (const float time : {0.25f, 0.375f}) {  // frame 1; halfway between frames 1 and 2
        const Shown shown = smokeAt(id, time);
        double drawn = 0, said = 0, worst = 0;
        float most = 0;
        for (uint32_t y = 0; y < kSide; ++y)
            for (uint32_t x = 0; x < kSide; ++x) {
                const float v = flipbook::sampleFlipbook(made, time, uvOf(shown, x, y)).z;
                drawn += double(shown.alpha[y * kSide + x] * v), said += double(v * v);
                most = std::max(most, shown.alpha[y * kSide + x]);
            }
        const auto opacity = float(drawn / said);
        ASSERT_GT(opacity, 0.1f);
        for (uint32_t y = 0; y < kSide; ++y)
            for (uint32_t x = 0; x < kSide; ++x) {
                const float v = flipbook::sampleFlipbook(made, time, uvOf(shown, x, y)).z;
                worst = std::max(worst, std::abs(double(shown.alpha[y * kSide + x] / opacity - v)));
            }
        // Peaks at least a spot's width apart.
        int peaks = 0;
        constexpr int kNear = 12;
        for (int y = kNear; y + kNear < int(kSide); ++y)
            for (int x = kNear; x + kNear < int(kSide); ++x) {
                const float v = shown.alpha[size_t(y) * kSide + size_t(x)];
                bool peak = v > 0.3f * opacity;
                for (int j = -kNear; peak && j <= kNear; ++j)
                    for (int i = -kNear; peak && i <= kNear; ++i) {
                        const float other = shown.alpha[size_t(y + j) * kSide + size_t(x + i)];
                        peak = j < 0 || (j == 0 && i < 0) ? v > other : v >= other;
                    }
                peaks += peak;
            }
        std::printf("[   FIGURE ] book at %.3f: off by %.4f at most, %d peak(s), %.2f high\n",
                    double(time), worst, peaks, double(most / opacity));
        EXPECT_LT(worst, 0.04) << time;  // 8 bits of flipbook, of motion and of picture
        EXPECT_EQ(1, peaks) << time;
        EXPECT_GT(most / opacity, 0.9f) << time;  // a cross-fade would reach 0.6
    }
}

// Stripes of two texels at four texels per pixel show their mean at any pixel offset. Sampling
// level 0 would show every other stripe or none.
TEST_F(FlipbookPicture, DistantParticlesShowTheMeanWithoutShimmer) {
    flipbook::Flipbook striped = spots(flipbook::Kind::Smoke);
    for (size_t i = 0; i < striped.texels.size() / 4; ++i)
        striped.texels[4 * i + 2] = i % 64 / 2 % 2 ? 240 : 0;
    for (uint8_t& motion : striped.motion) motion = 128;
    const FwFlipbookId id = create(striped);
    constexpr float kSpan = 28;
    std::vector<double> sums;
    float least = 1, most = 0;
    for (int k = 0; k < 4; ++k) {
        const Shown shown = smokeAt(id, 0.25f, kSpan, 0.25f * kSpan / kSide * float(k));
        double sum = 0;
        for (const float v : shown.alpha) sum += double(v);
        sums.push_back(sum);
        for (uint32_t x = kSide / 2 - 4; x < kSide / 2 + 4; ++x) {
            const float v = shown.alpha[(kSide / 2) * kSide + x];
            least = std::min(least, v), most = std::max(most, v);
        }
    }
    const auto [low, high] = std::minmax_element(sums.begin(), sums.end());
    std::printf("[   FIGURE ] far away: alpha %.3f to %.3f, sums within %.4f\n", double(least),
                double(most), *high / *low - 1);
    EXPECT_GT(least, 0.05f);
    EXPECT_LT(most / least, 1.25f);
    EXPECT_LT(*high / *low, 1.03);
}

TEST_F(FlipbookPicture, FlipbooksMayBeCreatedAndDestroyed) {
    const flipbook::Flipbook made = spots(flipbook::Kind::Smoke);
    const FwFlipbookId roll = create(FW_FLIPBOOK_ROLL), id = create(made);
    const Shown before = smokeAt(id, 0.25f);
    ASSERT_EQ(FW_OK, fwWorld_DestroyFlipbook(world_, roll));  // the atlas is rebuilt
    const Shown after = smokeAt(id, 0.25f);
    for (size_t i = 0; i < before.alpha.size();
         ++i)  // from another place of an equally large atlas
        ASSERT_NEAR(before.alpha[i], after.alpha[i], 1.5f / 255) << i;
    ASSERT_EQ(FW_OK, fwWorld_DestroyFlipbook(world_, id));
    const Shown without = smokeAt({}, 0.25f);  // drawn with noise
    EXPECT_NE(before.alpha, without.alpha);
    EXPECT_GT(*std::max_element(without.alpha.begin(), without.alpha.end()), 0.05f);
}

// If flipbooks cover all particles but sparks, the device skips the noise of the others.
TEST_F(FlipbookPicture, LooksTheSameBesideEmittersWithoutFlipbooks) {
    const auto picture = [&](bool beside) {
        fwDestroyWorld(world_);
        world_ = nullptr;
        FwWorldDef worldDef = fwDefaultWorldDef();
        EXPECT_EQ(FW_OK, fwCreateWorld(context_, &worldDef, &world_));
        FwFireEmitterDef def = fwDefaultFireEmitterDef();
        def.seed = kSeed;
        def.shape = FW_EMITTER_DISC;
        def.radius = 0.3f;
        def.power = 100;
        def.smoke = 0.5f;
        FwFireEmitterDef other = def;
        def.fireFlipbooks[0] = create(FW_FLIPBOOK_FLAME);
        def.fireFlipbooks[1] = create(FW_FLIPBOOK_ROLL);
        def.smokeFlipbooks[0] = create(FW_FLIPBOOK_SMOKE);
        other.position[0] = 100;  // outside the picture
        FwFireEmitterId id = created(fwWorld_CreateFireEmitter, world_, def);
        if (beside) {
            EXPECT_EQ(FW_OK, fwWorld_CreateFireEmitter(world_, &other, &id));
        }
        for (int i = 0; i < 96; ++i) fwWorld_Step(world_, 1.0f / 32);
        const float nothing[4] = {0, 0, 0, 0};
        return shoot(world_, frontView({0, 1}, 4, 4), kSide, kSide, nothing);
    };
    const std::vector<uint8_t> alone = picture(false), beside = picture(true);
    EXPECT_GT(std::count_if(alone.begin(), alone.end(), [](uint8_t v) { return v > 64; }), 2000);
    EXPECT_EQ(alone, beside);
}

// A soft spot of fire that covers nothing; `hides`: it covers as much as it glows.
flipbook::Flipbook glow(float hides) {
    flipbook::Flipbook made = spots(flipbook::Kind::Fire);
    for (size_t i = 0; i < made.texels.size(); i += 4) {
        const uint8_t v = made.texels[i + 2];
        made.texels[i + 1] = v;
        made.texels[i + 2] = uint8_t(hides * float(v));
    }
    return made;
}

// Additive fire is a sum, so the picture is the same in any order but for 8-bit rounding. It is not
// sorted; its order in a frame is the order of creation. Fire that covers is sorted and not
// additive.
TEST_F(FlipbookPicture, AdditiveFireLooksTheSameInAnyOrder) {
    const auto picture = [&](const flipbook::Flipbook& made, bool backwards) {
        fwDestroyWorld(world_);  // eddies depend on its clock
        world_ = nullptr;
        const FwWorldDef fresh = fwDefaultWorldDef();
        EXPECT_EQ(FW_OK, fwCreateWorld(context_, &fresh, &world_));
        const FwFlipbookId book = create(made);
        for (uint32_t k = 0; k < 6; ++k) {
            const uint32_t i = backwards ? 5 - k : k;
            FwFireEmitterDef def = fwDefaultFireEmitterDef();
            def.seed = 77 + i;
            def.position[0] = 0.1f * float(i) - 0.25f;
            def.position[1] = -0.8f;
            def.position[2] = i % 2 == 0 ? 0.6f : -0.6f;
            def.rate = 40;
            def.speed = 1;
            def.life = 1.2f;
            def.size0 = 0.3f;
            def.size1 = 0.6f;
            def.smoke = 0;
            def.temperature = i < 3 ? 1800.0f : 1250.0f;
            def.fireFlipbooks[0] = book;
            (void)created(fwWorld_CreateFireEmitter, world_, def);
        }
        for (int i = 0; i < 48; ++i) fwWorld_Step(world_, 1.0f / 32);
        FwView view = frontView({0, 0}, 3, 3);
        view.exposure = 0.15f;  // far from white, where all would be equal
        const float black[4] = {0, 0, 0, 1};
        return shoot(world_, view, kSide, kSide, black);
    };
    const flipbook::Flipbook alone = glow(0);
    const std::vector<uint8_t> one = picture(alone, false), other = picture(alone, true);
    double shown = 0, apart = 0;
    int most = 0, lit = 0;
    for (size_t i = 0; i < one.size(); ++i) {
        if (i % 4 == 3) continue;
        const int d = std::abs(int(one[i]) - int(other[i]));
        shown += one[i], apart += d;
        most = std::max(most, d);
        lit += one[i] > 40;
    }
    std::printf("           apart %d levels at most, %.4f of its light; %d texels lit\n", most,
                apart / shown, lit);
    EXPECT_GT(lit, 5000);
    EXPECT_LE(most, 6);  // rounding of some dozens of additions
    EXPECT_LT(apart, 0.005 * shown);
    const std::vector<uint8_t> hiding = picture(glow(1), false);
    double hidden = 0;
    for (size_t i = 0; i < hiding.size(); ++i) hidden += i % 4 == 3 ? 0 : hiding[i];
    EXPECT_LT(hidden, 0.95 * shown);
}

}  // namespace
}  // namespace fw::test::flipbook_picture_test
