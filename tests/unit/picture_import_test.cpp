// Artists' files: fire profiles and flipbook sheets from PNG, EXR and TIFF, and refusals of bad
// ones.
#include "import/float_picture.h"
#include "import/image_decode.h"
#include "profile_picture.h"
#include "sample.h"
#include "sheet.h"
#include "support/sanitized.h"

#include "finish.h"
#include "volume/appearance.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <random>
#include <string>

namespace {

namespace fs = std::filesystem;
using fwimport::FloatPicture;
using fwimport::readPicture;
using fwimport::writePicture;
using testing::HasSubstr;
using namespace fw;

class PictureImport : public testing::Test {
 protected:
    void SetUp() override {
        folder_ = fs::path(testing::TempDir()) /
                  ("fw_pictures_" +
                   std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }
    [[nodiscard]] fs::path file(const std::string& name) const { return folder_ / name; }

 private:
    fs::path folder_;
};

volume::Profile bonfire() {
    volume::Profile p;
    volume::paintDefaultProfile(volume::presetDef(volume::FlamePreset::Bonfire).appearance, p);
    return p;
}

FloatPicture flat(uint32_t width, uint32_t height, std::vector<float> pixel,
                  std::vector<std::string> names, bool whole = false) {
    FloatPicture p;
    p.width = width;
    p.height = height;
    p.channels = uint32_t(pixel.size());
    p.whole = whole;
    p.names = std::move(names);
    for (size_t i = 0; i < size_t(width) * height; ++i)
        p.values.insert(p.values.end(), pixel.begin(), pixel.end());
    return p;
}

std::string pictureRefusal(const FloatPicture& picture) {
    volume::Profile profile;
    std::string error;
    EXPECT_FALSE(fwtools::profileOfPicture(picture, profile, error));
    return error;
}

TEST_F(PictureImport, ProfilesRoundTripThroughExr) {
    const volume::Profile before = bonfire();
    std::string error;
    ASSERT_TRUE(writePicture(file("p.exr"), fwtools::pictureOfProfile(before, false), error))
        << error;
    FloatPicture picture;
    ASSERT_TRUE(readPicture(file("p.exr"), picture, error)) << error;
    EXPECT_FALSE(picture.whole);
    volume::Profile after;
    ASSERT_TRUE(fwtools::profileOfPicture(picture, after, error)) << error;
    EXPECT_EQ(before.texels, after.texels);
}

TEST_F(PictureImport, ProfilesRoundTripThroughPngAndTiffWithinQuantisation) {
    const volume::Profile before = bonfire();
    for (const char* name : {"p.png", "p.tif"}) {
        std::string error;
        ASSERT_TRUE(writePicture(file(name), fwtools::pictureOfProfile(before, true), error))
            << error;
        FloatPicture picture;
        ASSERT_TRUE(readPicture(file(name), picture, error)) << error;
        EXPECT_TRUE(picture.whole);
        volume::Profile after;
        ASSERT_TRUE(fwtools::profileOfPicture(picture, after, error)) << error;
        for (float y = 0.005f; y < 1; y += 0.02f)
            for (float rho = 0.01f; rho < 1.2f; rho += 0.02f) {
                const gpu::vec2 a = before.sample(rho, y), b = after.sample(rho, y);
                // A step of sixteen bits and one of the profile's half floats.
                EXPECT_NEAR(a.x, b.x, 0.0012f) << name;
                EXPECT_NEAR(a.y, b.y, 0.0012f) << name;
            }
    }
}

// The lowest row of the picture is the flame's base, its left column the axis.
TEST_F(PictureImport, ProfilesKeepTheirOrientation) {
    FloatPicture picture = flat(16, 32, {1200.0f, 0.0f, 0.0f}, {"R", "G", "B"});
    for (uint32_t x = 0; x < 16; ++x) picture.values[(31 * 16 + x) * 3 + 1] = 1.5f;  // low
    for (uint32_t y = 0; y < 32; ++y) picture.values[y * 16 * 3 + 0] = 2000.0f;      // left
    volume::Profile profile;
    std::string error;
    ASSERT_TRUE(fwtools::profileOfPicture(picture, profile, error)) << error;
    EXPECT_NEAR(profile.sample(1.0f, 0.005f).y, 1.5f, 0.01f);
    EXPECT_NEAR(profile.sample(1.0f, 0.99f).y, 0.0f, 0.01f);
    EXPECT_NEAR(profile.sample(0.0f, 0.5f).x, 2.0f, 0.01f);
    EXPECT_NEAR(profile.sample(1.2f, 0.5f).x, 1.2f, 0.01f);
}

TEST_F(PictureImport, NamedChannelsTakePrecedence) {
    const FloatPicture picture = flat(8, 8, {9.0f, 1.0f, 1500.0f}, {"R", "soot", "Temperature"});
    volume::Profile profile;
    std::string error;
    ASSERT_TRUE(fwtools::profileOfPicture(picture, profile, error)) << error;
    EXPECT_NEAR(profile.sample(0.5f, 0.5f).x, 1.5f, 0.001f);
    EXPECT_NEAR(profile.sample(0.5f, 0.5f).y, 1.0f, 0.001f);
}

TEST_F(PictureImport, RefusesBadProfilesByName) {
    FloatPicture hot = flat(16, 16, {1500.0f, 0.5f, 0}, {"R", "G", "B"});
    hot.values[(3 * 16 + 5) * 3] = 4000.0f;
    EXPECT_EQ(pictureRefusal(hot),
              "channel \"R\" of pixel (5, 3) is 4000 K; it must lie in [0, 3000]");
    hot.values[(3 * 16 + 5) * 3] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THAT(pictureRefusal(hot), HasSubstr("pixel (5, 3) is nan K"));
    EXPECT_THAT(pictureRefusal(flat(16, 16, {1500.0f, -1.0f, 0}, {"R", "G", "B"})),
                HasSubstr("channel \"G\" of pixel (0, 15) is -1; it must lie in [0, 2]"));
    EXPECT_THAT(pictureRefusal(flat(4, 16, {1500.0f, 1.0f}, {"R", "G"})),
                HasSubstr("4 x 16 texels"));
    EXPECT_EQ(pictureRefusal(flat(8, 8, {1.0f}, {"Y"})),
              "its channels are \"Y\"; it needs R and G, or temperature and soot");
    EXPECT_THAT(pictureRefusal(flat(8, 8, {0, 0, 0}, {"R", "G", "B"})),
                HasSubstr("neither soot nor hot"));
}

TEST_F(PictureImport, RefusesBadFilesByName) {
    FloatPicture picture;
    std::string error;
    EXPECT_FALSE(readPicture(file("none.png"), picture, error));
    EXPECT_THAT(error, HasSubstr("none.png: "));
    EXPECT_FALSE(writePicture(file("none.what"), flat(8, 8, {1}, {"Y"}), error));
    EXPECT_THAT(error, HasSubstr("none.what: "));
    EXPECT_FALSE(fs::exists(file("none.what")));

    // Every damaged file gets an answer; most truncated or flipped ones are refused.
    std::mt19937 random(7);
    for (const char* name : {"f.png", "f.exr", "f.tif"}) {
        ASSERT_TRUE(
            writePicture(file(name), fwtools::pictureOfProfile(bonfire(), name[2] != 'e'), error))
            << error;
        std::ifstream in(file(name), std::ios::binary);
        const std::string whole((std::istreambuf_iterator<char>(in)), {});
        int refused = 0;
        constexpr int kTries = 40;
        for (int i = 0; i < kTries; ++i) {
            std::string bytes = whole;
            if (i % 2)
                bytes.resize(random() % bytes.size());
            else
                for (int k = 0; k < 8; ++k)
                    bytes[random() % bytes.size()] ^= char(1 + random() % 255);
            const fs::path path = file("fuzz" + fs::path(name).extension().string());
            std::ofstream(path, std::ios::binary) << bytes;
            volume::Profile profile;
            error.clear();
            if (readPicture(path, picture, error) &&
                fwtools::profileOfPicture(picture, profile, error))
                continue;
            ++refused;
            EXPECT_FALSE(error.empty());
        }
        EXPECT_GT(refused, kTries / 4) << name;
    }
}

// ---- sheets

// A disc of one colour that moves 2 texels to the right in each of 4 x 2 frames of 32 texels.
FloatPicture discs(std::vector<float> colour, bool whole) {
    FloatPicture p =
        flat(128, 64, std::vector<float>(colour.size(), 0.0f), {"R", "G", "B", "A"}, whole);
    p.names.resize(colour.size());
    for (uint32_t frame = 0; frame < 8; ++frame)
        for (uint32_t y = 0; y < 32; ++y)
            for (uint32_t x = 0; x < 32; ++x) {
                const float dx = float(x) - (8 + 2 * float(frame)), dy = float(y) - 12;
                const float part = std::exp(-(dx * dx + dy * dy) / 20);
                const size_t at = (size_t(frame / 4 * 32 + y) * 128 + frame % 4 * 32 + x);
                for (size_t c = 0; c < colour.size(); ++c)
                    p.values[at * colour.size() + c] =
                        whole && c < 3 ? colour[c] : colour[c] * part;
            }
    return p;
}

fwtools::SheetDef grid4x2() {
    fwtools::SheetDef def;
    def.columns = 4;
    def.rows = 2;
    def.facts.frames = 0;
    def.facts.loops = 0;
    return def;
}

// A mesh's images in every format: a row of white, half its light, and black.
TEST_F(PictureImport, MeshesReadEveryImageFormat) {
    const auto bytesOf = [&](const std::string& name) {
        std::ifstream stream(file(name), std::ios::binary);
        const std::string text((std::istreambuf_iterator<char>(stream)), {});
        return std::vector<uint8_t>(text.begin(), text.end());
    };
    std::map<std::string, std::vector<uint8_t>> pictures;
    for (const char* name : {"a.png", "a.tif", "a.exr", "a.hdr"}) {
        FloatPicture picture = flat(3, 1, {0, 0, 0}, {"R", "G", "B"}, std::string(name) == "a.png");
        std::fill_n(picture.values.begin(), 3, 1.0f);
        std::fill_n(picture.values.begin() + 3, 3, 0.5f);
        std::string error;
        if (std::string(name) != "a.hdr") {
            ASSERT_TRUE(writePicture(file(name), picture, error)) << error;
            pictures[name] = bytesOf(name);
        }
    }
    // Eight bits per channel and a shared exponent.
    std::string hdr = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 3\n";
    for (const int pixel : {0x81, 0x80, 0})
        hdr += std::string(3, pixel ? '\x80' : '\0') + static_cast<char>(pixel);
    pictures["a.hdr"] = {hdr.begin(), hdr.end()};
    // The header: caps, size, and masks of 32-bit RGB.
    std::vector<uint32_t> dds(32);
    dds[0] = 0x20534444u;
    dds[1] = 124;
    dds[2] = 0x1007;
    dds[3] = 1;
    dds[4] = 3;
    dds[19] = 32;
    dds[20] = 0x41;
    dds[22] = 32;
    dds[23] = 0x00ff0000u;
    dds[24] = 0x0000ff00u;
    dds[25] = 0x000000ffu;
    dds[26] = 0xff000000u;
    dds[27] = 0x1000;
    dds.insert(dds.end(), {0xffffffffu, 0xff808080u, 0xff000000u});
    for (const uint32_t word : dds)
        for (int i = 0; i < 4; ++i) pictures["a.dds"].push_back(uint8_t(word >> (8 * i)));

    for (const auto& [name, bytes] : pictures) {
        fwimport::DecodedImage image;
        std::string error;
        ASSERT_TRUE(fwimport::decodeImage(bytes, image, error)) << name << ": " << error;
        ASSERT_EQ(3u, image.width) << name;
        ASSERT_EQ(12u, image.rgba.size()) << name;
        EXPECT_EQ(255, image.rgba[0]) << name;
        // Half the light is 188 in sRGB; byte images store it directly.
        const bool light = name == "a.exr" || name == "a.hdr" || name == "a.tif";
        EXPECT_NEAR(light ? 188 : 128, image.rgba[4], 1) << name;
        EXPECT_EQ(0, image.rgba[8]) << name;
        EXPECT_EQ(255, image.rgba[11]) << name;
        // Damaged data is refused or gives an image.
        std::mt19937 random(3);
        for (int i = 0; i < 200; ++i) {
            std::vector<uint8_t> spoilt = bytes;
            for (int k = 0; k < 4; ++k) spoilt[random() % spoilt.size()] = uint8_t(random());
            if (i % 2) spoilt.resize(random() % spoilt.size());
            fwimport::DecodedImage made;
            if (fwimport::decodeImage(spoilt, made, error))
                EXPECT_EQ(size_t{4} * made.width * made.height, made.rgba.size()) << name;
            else
                EXPECT_FALSE(error.empty());
        }
    }
    fwimport::DecodedImage none;
    std::string error;
    EXPECT_FALSE(fwimport::decodeImage(std::vector<uint8_t>(64), none, error));
    EXPECT_THAT(error, HasSubstr("none of PNG, JPEG, EXR, TIFF, HDR, DDS and WebP"));
}

TEST(SheetImport, FramesRunRightThenDown) {
    fwtools::SheetDef def = grid4x2();
    std::vector<fwtools::Frame> frames;
    std::string error;
    ASSERT_TRUE(fwtools::framesOfSheet(discs({1, 0.8f, 0.3f, 1}, false), def, frames, error))
        << error;
    ASSERT_EQ(frames.size(), 8u);
    EXPECT_EQ(def.facts.width, 32u);
    EXPECT_EQ(def.facts.height, 32u);
    for (uint32_t k = 0; k < 8; ++k) {
        const auto& texels = frames[k].texels;
        const size_t best =
            size_t(std::max_element(texels.begin(), texels.end(),
                                    [](const auto& a, const auto& b) { return a.y < b.y; }) -
                   texels.begin());
        EXPECT_EQ(best % 32, 8 + 2 * k) << "frame " << k;
        EXPECT_EQ(best / 32, 31u - 12u) << "rows are from the bottom";
        EXPECT_NEAR(fw::gpu::flipbookKelvin(texels[best].x), 1780.0f, 1.0f) << "yellow in kelvin";
        EXPECT_NEAR(texels[best].y, 1.0f, 1e-5f);
    }
    // The motion between frames is found: 2 texels of 32 per frame.
    const auto book =
        fwtools::finishFlipbook(def.facts, frames, 1, std::pmr::get_default_resource());
    const auto motion = fw::flipbook::motionAt(book, 2, {(12.5f) / 32, 1 - 12.5f / 32});
    EXPECT_NEAR(motion.x, 2.0f / 32, 0.3f / 32);
    EXPECT_NEAR(motion.y, 0.0f, 0.3f / 32);
}

TEST(SheetImport, HueSetsTemperatureAndAlphaSmoke) {
    std::vector<fwtools::Frame> frames;
    std::string error;
    const auto middle = [&](const FloatPicture& picture, fw::flipbook::Kind kind) {
        fwtools::SheetDef def = grid4x2();
        def.facts.kind = kind;
        EXPECT_TRUE(fwtools::framesOfSheet(picture, def, frames, error)) << error;
        return frames[0].texels[(31 - 12) * 32 + 8];
    };
    using enum fw::flipbook::Kind;
    EXPECT_NEAR(fw::gpu::flipbookKelvin(middle(discs({0.5f, 0, 0}, false), Fire).x), 1370.0f, 1.0f);
    EXPECT_NEAR(middle(discs({0.5f, 0, 0}, false), Fire).y, 0.5f, 1e-5f);
    // Integer formats are sRGB: 0.735 is half the light.
    EXPECT_NEAR(middle(discs({0.7354f, 0, 0, 1}, true), Fire).y, 0.5f, 1e-3f);
    const auto smoke = middle(discs({0.2f, 0.2f, 0.2f, 0.6f}, false), Smoke);
    EXPECT_EQ(smoke.y, 0.0f) << "smoke does not glow";
    EXPECT_NEAR(smoke.z, 0.6f, 1e-5f);
    EXPECT_NEAR(smoke.w, 1 - std::pow(0.4f, 0.25f), 1e-4f) << "1 - exp(-tau / 4)";
    EXPECT_GT(middle(discs({1, 0.8f, 0.3f}, false), Fire).z, 0.99f)
        << "black without alpha is empty";
    // Light without any coverage is additive; with coverage anywhere, all of it occludes.
    FloatPicture light = discs({1, 0.8f, 0.3f, 0}, false);
    for (uint32_t i = 3; i < light.values.size(); i += 4) light.values[i] = 0;
    EXPECT_EQ(middle(light, Fire).z, 0.0f);
    EXPECT_GT(middle(light, Fire).y, 0.99f);
    light.values[3] = 0.5f;
    EXPECT_GT(middle(light, Fire).z, 0.99f);
}

TEST(SheetImport, ResamplingKeepsTheMean) {
    fwtools::SheetDef def = grid4x2();
    def.side = 12;
    std::vector<fwtools::Frame> whole, small;
    std::string error;
    const FloatPicture picture = discs({0.4f, 0.2f, 0.1f, 0.4f}, false);
    ASSERT_TRUE(fwtools::framesOfSheet(picture, def, small, error)) << error;
    EXPECT_EQ(def.facts.width, 12u);
    def = grid4x2();
    ASSERT_TRUE(fwtools::framesOfSheet(picture, def, whole, error)) << error;
    const auto mean = [](const fwtools::Frame& frame) {
        double sum = 0;
        for (const auto& t : frame.texels) sum += double(t.z);
        return sum / double(frame.texels.size());
    };
    for (size_t k = 0; k < 8; ++k) EXPECT_NEAR(mean(small[k]), mean(whole[k]), 1e-4);
}

TEST(SheetImport, RefusesBadSheetsByName) {
    const auto refusal = [](const FloatPicture& picture, fwtools::SheetDef def) {
        std::vector<fwtools::Frame> frames;
        std::string error;
        EXPECT_FALSE(fwtools::framesOfSheet(picture, def, frames, error));
        EXPECT_TRUE(frames.empty());
        return error;
    };
    const FloatPicture good = discs({1, 1, 1, 1}, false);
    fwtools::SheetDef def = grid4x2();
    def.columns = 5;
    EXPECT_EQ(refusal(good, def), "it is 128 x 64 pixels; that does not part into 5 equal columns");
    def.columns = 0;
    EXPECT_EQ(refusal(good, def), "it has 0 columns; they must lie in [1, 256]");
    def = grid4x2();
    def.facts.frames = 9;
    EXPECT_EQ(refusal(good, def), "frames is 9; a grid of 4 x 2 has [2, 8] of them");
    def = grid4x2();
    def.columns = 32;
    EXPECT_THAT(refusal(good, def), HasSubstr("a frame is 4 x 32 texels"));
    FloatPicture broken = good;
    broken.values[(7 * 128 + 3) * 4 + 1] = std::numeric_limits<float>::infinity();
    EXPECT_EQ(refusal(broken, grid4x2()), "pixel (3, 7) is inf; it must be a number");
    EXPECT_THAT(refusal(flat(64, 64, {1, 1, 1}, {"X", "Y", "Z"}), grid4x2()),
                HasSubstr("without R, G and B"));
}

// Any values and grid give valid frames or a message.
TEST(SheetImport, DamagedSheetsAreRefusedOrValid) {
    constexpr float kBad[] = {-1, 1e30f, -1e30f, std::numeric_limits<float>::infinity(),
                              std::numeric_limits<float>::quiet_NaN()};
    std::mt19937 random(11);
    const auto below = [&](uint32_t limit) { return uint32_t(random() % limit); };
    int refused = 0;
    const int rounds = test::rounds(10000, 1000);
    for (int k = 0; k < rounds; ++k) {
        const uint32_t channels = below(8) ? 3 + below(2) : 1 + below(2);
        const uint32_t columns = 1 + below(4), rows = 1 + below(3);
        FloatPicture picture =
            flat(8 * columns, 8 * rows, std::vector<float>(channels, 0.5f), {"R", "G", "B", "A"});
        picture.names.resize(channels);
        picture.whole = below(2) == 0;
        for (uint32_t left = below(3) ? 0 : below(4); left > 0; --left)
            picture.values[random() % picture.values.size()] = kBad[below(std::size(kBad))];
        fwtools::SheetDef def;
        def.columns = below(8) ? columns : uint32_t(random());
        def.rows = below(8) ? rows : uint32_t(random());
        def.side = below(4) ? 0 : below(8) ? below(64) : uint32_t(random());
        def.facts.frames = below(4) ? 0 : below(16);
        def.facts.kind = fw::flipbook::Kind(below(3));
        std::vector<fwtools::Frame> frames;
        std::string error;
        if (!fwtools::framesOfSheet(picture, def, frames, error)) {
            EXPECT_FALSE(error.empty()) << k;
            EXPECT_TRUE(frames.empty()) << k;
            ++refused;
            continue;
        }
        ASSERT_EQ(def.facts.frames, frames.size()) << k;
        for (const fwtools::Frame& frame : frames) {
            ASSERT_EQ(size_t{def.facts.width} * def.facts.height, frame.texels.size()) << k;
            for (const auto& texel : frame.texels)
                for (int c = 0; c < 4; ++c) ASSERT_TRUE(std::isfinite(texel[c])) << k;
        }
    }
    EXPECT_GT(refused, rounds / 4);
    EXPECT_LT(refused, rounds - rounds / 10);
}

}  // namespace
