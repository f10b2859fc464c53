// Fire profiles: painting, lookups, the cooked file and its refusals.
#include "core/error.h"
#include "core/hash.h"
#include "support/sanitized.h"
#include "volume/appearance.h"
#include "volume/profile.h"
#include "volume_scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <glm/gtc/packing.hpp>
#include <random>
#include <span>
#include <string>

namespace {

using namespace fw::volume;
using testing::AnyOf;
using testing::HasSubstr;
using volume_scene::failure;

Profile painted() {
    Profile p;
    paintDefaultProfile(presetDef(FlamePreset::CampFire).appearance, p);
    return p;
}

TEST(VolumeProfile, LookupsReturnPaintedValues) {
    std::vector<float> kelvin(64 * 128), soot(64 * 128);
    for (size_t y = 0; y < 128; ++y)
        for (size_t x = 0; x < 64; ++x)
            kelvin[y * 64 + x] = 1000.0f + float(x) + 4.0f * float(y),
                            soot[y * 64 + x] = float(x) / 64.0f;
    Profile p;
    paintProfile(kelvin, soot, 64, 128, p);
    for (const auto& [x, y] : {std::pair{0, 0}, {10, 100}, {63, 127}, {33, 5}}) {
        const auto v = p.sample((float(x) + 0.5f) / 64.0f * fw::gpu::kProfileReach,
                                (float(y) + 0.5f) / 128.0f);
        EXPECT_NEAR(v.x, 0.001f * kelvin[size_t(y * 64 + x)], 0.001f);
        EXPECT_NEAR(v.y, soot[size_t(y * 64 + x)], 0.001f);
    }
    EXPECT_EQ(p.sample(0.3f, 1.0f).y, 0.0f) << "nothing burns above the profile";
    EXPECT_EQ(p.sample(0.3f, -0.1f).y, 0.0f);
}

TEST(VolumeProfile, OtherSizesAreResampled) {
    std::vector<float> kelvin(16 * 32), soot(16 * 32);
    for (size_t y = 0; y < 32; ++y)
        for (size_t x = 0; x < 16; ++x)
            kelvin[y * 16 + x] = 1500.0f, soot[y * 16 + x] = float(y) / 31.0f;
    Profile p;
    paintProfile(kelvin, soot, 16, 32, p);
    EXPECT_NEAR(p.sample(0.5f, 0.5f).y, 0.5f, 0.02f);
    EXPECT_NEAR(p.sample(0.5f, 0.999f).y, 1.0f, 0.02f);
    EXPECT_NEAR(p.sample(1.0f, 0.2f).x, 1.5f, 0.001f);
}

TEST(VolumeProfile, CookedFormRoundTrips) {
    const Profile p = painted();
    const auto bytes = cookProfile(p, std::pmr::get_default_resource());
    EXPECT_EQ(bytes.size(), 24u + 4u * 64u * 128u);
    Profile back;
    readProfile(bytes, back);
    EXPECT_EQ(back.texels, p.texels);
}

TEST(VolumeProfile, RefusesBadInputWithValueAndLimit) {
    std::vector<float> kelvin(64 * 128, 1500.0f), soot(64 * 128, 0.5f);
    Profile p = painted();
    const Profile before = p;
    const auto paint = [&](uint32_t w, uint32_t h) {
        return failure([&] { paintProfile(kelvin, soot, w, h, p); });
    };
    EXPECT_THAT(paint(4, 128), HasSubstr("4 x 128 texels; each side must lie in [8, 512]"));
    EXPECT_THAT(paint(64, 64), HasSubstr("64 x 64 texels need 4096"));
    kelvin[64 * 3 + 5] = 3001.0f;
    EXPECT_THAT(paint(64, 128),
                HasSubstr("temperature of texel (5, 3) of the fire profile is 3001 K"));
    kelvin[64 * 3 + 5] = NAN;
    EXPECT_THAT(paint(64, 128), HasSubstr("nan K; it must lie in [0, 3000]"));
    kelvin[64 * 3 + 5] = 1500.0f, soot[0] = -0.25f;
    EXPECT_THAT(paint(64, 128), HasSubstr("soot of texel (0, 0) of the fire profile is -0.25"));
    std::fill(kelvin.begin(), kelvin.end(), 0.0f), std::fill(soot.begin(), soot.end(), 0.0f);
    EXPECT_THAT(paint(64, 128), HasSubstr("neither soot nor hot gas"));
    EXPECT_EQ(p.texels, before.texels) << "a failed read changes nothing";
}

TEST(VolumeProfile, RefusesBadFilesWithAReason) {
    const auto good = cookProfile(painted(), std::pmr::get_default_resource());
    const auto read = [&](std::pmr::vector<std::byte> bytes) {
        Profile p;
        return failure([&] { readProfile(bytes, p); });
    };
    auto b = good;
    b.resize(10);
    EXPECT_THAT(read(b), HasSubstr("has 10 bytes; its header alone has 24"));
    b = good, b[0] = std::byte(0);
    EXPECT_THAT(read(b), HasSubstr("must begin with 0x50465746"));
    b = good, b[4] = std::byte(9);
    EXPECT_THAT(read(b), HasSubstr("version 9; this library reads version 1"));
    b = good, b[8] = std::byte(3);
    EXPECT_THAT(read(b), HasSubstr("3 x 128 texels"));
    b = good, b.pop_back();
    EXPECT_THAT(read(b), HasSubstr("64 x 128 texels need 32792"));
    b = good, b[5000] ^= std::byte(1);
    EXPECT_THAT(read(b), HasSubstr("checksum"));
    // Every changed byte is either refused or harmless.
    std::mt19937 random(1);
    for (int k = 0; k < 200; ++k) {
        b = good;
        b[random() % b.size()] ^= std::byte(1u << (random() % 8));
        EXPECT_NE(read(b), "nothing failed");
    }
}

// With a valid checksum, so that the reader's other checks are tested.
TEST(VolumeProfile, DamagedFilesAreRefusedOrValid) {
    constexpr size_t kHeader = 24, kSum = 16;
    constexpr uint32_t kSide = 8;
    auto good = cookProfile(painted(), std::pmr::get_default_resource());
    good.resize(kHeader + 4 * size_t{kSide} * kSide);  // the smallest size
    std::memcpy(good.data() + 8, &kSide, sizeof kSide);
    std::memcpy(good.data() + 12, &kSide, sizeof kSide);
    std::mt19937 random(2);
    int refused = 0;
    const int rounds = fw::test::rounds(10000, 1000);
    for (int k = 0; k < rounds; ++k) {
        auto bytes = good;
        if (k % 4 == 0) bytes.resize(random() % bytes.size());
        for (uint32_t left = 1 + random() % 4; left > 0 && !bytes.empty(); --left)
            bytes[random() % (k % 2 ? bytes.size() : std::min(bytes.size(), kHeader))] =
                std::byte(random());
        if (bytes.size() >= kHeader) {
            const std::span<const std::byte> all(bytes);
            const uint64_t sum =
                fw::core::hashBytes(all.subspan(kHeader), fw::core::hashBytes(all.first(kSum)));
            std::memcpy(bytes.data() + kSum, &sum, sizeof sum);
        }
        Profile profile;
        const std::string said = failure([&] { readProfile(bytes, profile); });
        if (said != "nothing failed") {
            EXPECT_THAT(said, AnyOf(HasSubstr(".fwprofile"), HasSubstr("fire profile"))) << k;
            ++refused;
            continue;
        }
        for (const uint32_t texel : profile.texels) {
            const glm::vec2 value = glm::unpackHalf2x16(texel);
            ASSERT_TRUE(value.x >= 0 && value.x <= 3.001f && value.y >= 0 && value.y <= 2.001f)
                << k;
        }
    }
    EXPECT_GT(refused, rounds / 4);
    EXPECT_LT(refused, rounds) << "some only have other texels";
}

}  // namespace
