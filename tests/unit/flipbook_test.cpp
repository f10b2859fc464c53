// Flipbooks: interpolated frames show one moving image, loops have no seam, invalid files are
// refused by name, an interrupted bake resumes.
#include "flipbook/flipbook.h"
#include "core/error.h"
#include "finish.h"
#include "flamewright/flamewright.h"
#include "flipbook/own.h"
#include "flipbook/picture.h"
#include "sample.h"
#include "store.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <string>

namespace {

using namespace fw;
using fwtools::BakeDef;
using fwtools::Frame;
using gpu::vec2;
using gpu::vec4;

std::pmr::memory_resource* memory() { return std::pmr::get_default_resource(); }

// A soft spot at (x, y) in texels.
Frame spotAt(uint32_t side, float x, float y) {
    Frame frame;
    for (uint32_t j = 0; j < side; ++j)
        for (uint32_t i = 0; i < side; ++i) {
            const float dx = float(i) + 0.5f - x, dy = float(j) + 0.5f - y;
            const float v = std::exp(-(dx * dx + dy * dy) / 60.0f);
            frame.texels.emplace_back(0.7f, v, v, 0.3f * v);
        }
    return frame;
}

flipbook::Flipbook spots(uint32_t side, vec2 first, vec2 by) {
    flipbook::Facts facts;
    facts.width = facts.height = side;
    facts.motionWidth = facts.motionHeight = side / 2;
    facts.frames = 4;
    facts.loops = 0;
    std::vector<Frame> frames;
    for (uint32_t i = 0; i < facts.frames; ++i)
        frames.push_back(spotAt(side, first.x + by.x * float(i), first.y + by.y * float(i)));
    return fwtools::finishFlipbook(facts, frames, 1, memory());
}

TEST(Flipbook, MotionVectorsInterpolateOneBlob) {
    for (const vec2 by : {vec2(8, 0), vec2(0, 8), vec2(-5, 6)}) {
        const flipbook::Flipbook made = spots(64, vec2(by.x < 0 ? 44 : 20, 20), by);
        constexpr int kSide = 64;
        const float time = 1.5f / 3;  // halfway between frames 1 and 2
        double sum = 0, x = 0, y = 0;
        std::vector<float> seen;
        for (int j = 0; j < kSide; ++j)
            for (int i = 0; i < kSide; ++i) {
                const vec2 uv((float(i) + 0.5f) / kSide, (float(j) + 0.5f) / kSide);
                seen.push_back(flipbook::sampleFlipbook(made, time, uv).y);
                sum += double(seen.back());
                x += double(seen.back()) * (i + 0.5), y += double(seen.back()) * (j + 0.5);
            }
        const double wantX = (by.x < 0 ? 44 : 20) + 1.5 * double(by.x),
                     wantY = 20 + 1.5 * double(by.y);
        int peaks = 0;
        for (int j = 1; j + 1 < kSide; ++j)
            for (int i = 1; i + 1 < kSide; ++i) {
                const float v = seen[size_t(j * kSide + i)];
                bool peak = v > 0.25f;
                for (int k = 0; peak && k < 9; ++k) {  // of equal peaks the last
                    const float other = seen[size_t((j + k / 3 - 1) * kSide + i + k % 3 - 1)];
                    peak = k <= 4 ? v >= other : v > other;
                }
                peaks += peak;
            }
        std::printf("[   FIGURE ] spot by (%g, %g): %.3f texels off, %d peak\n", double(by.x),
                    double(by.y), std::hypot(x / sum - wantX, y / sum - wantY), peaks);
        EXPECT_LT(std::hypot(x / sum - wantX, y / sum - wantY), 0.25);
        EXPECT_EQ(peaks, 1);
        // Its height is kept too; a plain cross-fade reaches 0.77 of it.
        EXPECT_GT(*std::max_element(seen.begin(), seen.end()), 0.93f);
    }
}

flipbook::Flipbook smallBook(std::string_view scene, uint32_t side, uint32_t frames) {
    BakeDef def;
    def.scene = scene;
    EXPECT_TRUE(fwtools::sceneKind(scene, def.facts));
    def.facts.width = def.facts.height = side;
    def.facts.motionWidth = def.facts.motionHeight = side / 2;
    def.facts.frames = frames;
    def.facts.seconds *= float(frames) / 64;
    def.samples = 1;
    const auto made = fwtools::makeScene(def);
    std::vector<Frame> rendered(made->frames());
    for (uint32_t i = 0; i < made->frames(); ++i) made->render(i, rendered[i]);
    return fwtools::finishFlipbook(def.facts, rendered, 1, memory());
}

double seamOf(const flipbook::Flipbook& made, double& others, double& most) {
    const flipbook::Facts& f = made.facts;
    const size_t layer = size_t(4) * f.width * f.height;
    const auto difference = [&](uint32_t a, uint32_t b) {
        double sum = 0;
        for (size_t i = 0; i < layer; ++i)
            if (i % 4 != 0)
                sum += std::pow(double(made.texels[a * layer + i]) - made.texels[b * layer + i], 2);
        return std::sqrt(sum / double(layer));
    };
    others = most = 0;
    for (uint32_t i = 0; i + 1 < f.frames; ++i) {
        others += difference(i, i + 1) / (f.frames - 1);
        most = std::max(most, difference(i, i + 1));
    }
    return difference(f.frames - 1, 0);
}

TEST(Flipbook, IsAdditiveIfNoTexelOccludes) {
    flipbook::Flipbook book(std::pmr::get_default_resource());
    book.texels = {10, 20, 0, 30, 40, 50, 0, 60};
    EXPECT_TRUE(flipbook::emitsAlone(book));
    book.texels[6] = 1;
    EXPECT_FALSE(flipbook::emitsAlone(book));
}

TEST(Flipbook, LoopsWithoutASeam) {
    constexpr uint32_t kFrames = 20;
    const flipbook::Flipbook made = smallBook("campfire", 24, kFrames);
    double others = 0, most = 0;
    const double seam = seamOf(made, others, most);
    std::printf("[   FIGURE ] last frame to first: %.2f; others %.2f, at most %.2f of 255\n", seam,
                others, most);
    EXPECT_LE(seam, 1.1 * others);
    EXPECT_LE(most, 1.7 * others);  // nor at the loop's end
    EXPECT_GT(others, 1);
}

// Fire is in the frame, bright at its base, and nothing touches the border.
TEST(Flipbook, BuiltInFlipbooksMatchTheirHeader) {
    size_t all = 0;
    for (uint32_t preset = 1; preset < FW_FLIPBOOK_PRESET_COUNT; ++preset) {
        const auto bytes = flipbook::presetFlipbook(preset, memory());
        all += bytes.size();
        flipbook::Flipbook made(memory());
        ASSERT_NO_THROW(flipbook::readFlipbook(bytes, made)) << preset;
        const flipbook::Kind kind = preset <= FW_FLIPBOOK_PUFF   ? flipbook::Kind::Fire
                                    : preset <= FW_FLIPBOOK_HAZE ? flipbook::Kind::Smoke
                                                                 : flipbook::Kind::Spark;
        EXPECT_EQ(kind, made.facts.kind) << preset;
        EXPECT_EQ(preset == FW_FLIPBOOK_FLAME ? 1u : 0u, made.facts.loops) << preset;
        if (!made.facts.loops) continue;
        double others = 0, most = 0;
        const double seam = seamOf(made, others, most);
        std::printf("[   FIGURE ] own flame: last frame to first %.2f; others %.2f, at most %.2f\n",
                    seam, others, most);
        EXPECT_LE(seam, 1.1 * others);
        // Its base fades out: no row is full where the one below is empty.
        for (uint32_t i = 0; i < made.facts.frames; ++i)
            for (uint32_t y = 1; y < made.facts.height / 4; ++y)
                for (uint32_t x = 0; x < made.facts.width; ++x) {
                    const float u = (float(x) + 0.5f) / float(made.facts.width);
                    const float v = (float(y) + 0.5f) / float(made.facts.height);
                    const float step = 1.0f / float(made.facts.height);
                    ASSERT_LT(flipbook::frameAt(made, i, vec2(u, v)).z -
                                  flipbook::frameAt(made, i, vec2(u, v - step)).z,
                              0.45f)
                        << i << " " << x << " " << y;
                }
    }
    EXPECT_LT(all, size_t(3) << 20);
}

// Every texel is where its record says, no two overlap, and frames have an empty border.
TEST(Flipbook, TheAtlasHoldsAllFlipbooks) {
    std::vector<flipbook::Flipbook> flipbooks;
    for (const uint32_t preset : {FW_FLIPBOOK_FLAME, FW_FLIPBOOK_SPARK, FW_FLIPBOOK_HAZE}) {
        flipbooks.emplace_back(memory());
        flipbook::readFlipbook(flipbook::presetFlipbook(preset, memory()), flipbooks.back());
    }
    const flipbook::Flipbook* const placed[] = {&flipbooks[0], nullptr, &flipbooks[1],
                                                &flipbooks[2]};
    const flipbook::Picture picture = flipbook::packFlipbooks(placed, memory());
    EXPECT_LE(picture.width, flipbook::kMaxPicture);
    std::vector<uint8_t> taken(size_t(picture.width) * picture.height);
    for (uint32_t slot = 0; slot < 4; ++slot) {
        if (!placed[slot]) continue;
        const flipbook::Facts& f = placed[slot]->facts;
        gpu::FlipbookRecord record;
        std::memcpy(&record, picture.words.data() + slot * gpu::kFlipbookRecordWords,
                    sizeof record);
        EXPECT_EQ(f.frames, record.frames);
        for (uint32_t frame = 0; frame < f.frames; ++frame)
            for (const bool motion : {false, true}) {
                const auto at = motion ? gpu::flipbookMotionOrigin(record, frame)
                                       : gpu::flipbookFrameOrigin(record, frame);
                const uint32_t w = motion ? f.motionWidth : f.width;
                const uint32_t h = motion ? f.motionHeight : f.height, bytes = motion ? 2 : 4;
                const auto& from = motion ? placed[slot]->motion : placed[slot]->texels;
                for (uint32_t y = 0; y < h; ++y)
                    for (uint32_t x = 0; x < w; ++x) {
                        const size_t to = size_t(at.y + y) * picture.width + at.x + x;
                        ASSERT_EQ(0, taken[to]++) << slot << " " << frame;
                        ASSERT_EQ(0, std::memcmp(&picture.texels[4 * to],
                                                 &from[bytes * ((size_t(frame) * h + y) * w + x)],
                                                 bytes));
                    }
                for (uint32_t y = 0; !motion && y < h + 2; ++y)
                    for (const uint32_t x : {0u, w + 1}) {
                        const size_t to = size_t(at.y + y - 1) * picture.width + at.x + x - 1;
                        ASSERT_EQ(0, picture.texels[4 * to + 2]) << slot << " " << frame;
                    }
            }
    }
}

// Each texel of a level is the mean of four of the level before. Borders are empty and no two
// frames or levels share a texel, so no lookup bleeds.
TEST(Flipbook, MipLevelsAreMeansAndDoNotBleed) {
    flipbook::Flipbook one(memory());
    flipbook::readFlipbook(flipbook::presetFlipbook(FW_FLIPBOOK_FLAME, memory()), one);
    const flipbook::Flipbook* const placed[] = {&one};
    const flipbook::Picture picture = flipbook::packFlipbooks(placed, memory());
    gpu::FlipbookRecord record;
    std::memcpy(&record, picture.words.data(), sizeof record);
    const uint32_t ats[] = {record.at, record.at1, record.at2, record.at3};
    const auto texel = [&](uint32_t x, uint32_t y) {
        return &picture.texels[4 * (size_t(y) * picture.width + x)];
    };
    for (uint32_t level = 1; level < gpu::kFlipbookLevels; ++level) {
        gpu::FlipbookRecord big = record, small = record;
        big.at = ats[level - 1];
        small.at = ats[level];
        ASSERT_NE(0u, small.at) << level;
        big.size = (one.facts.width >> (level - 1)) | (one.facts.height >> (level - 1)) << 16;
        small.size = (one.facts.width >> level) | (one.facts.height >> level) << 16;
        const uint32_t w = small.size & 0xFFFF, h = small.size >> 16;
        for (uint32_t frame = 0; frame < one.facts.frames; ++frame) {
            const gpu::uvec2 from = gpu::flipbookFrameOrigin(big, frame),
                             at = gpu::flipbookFrameOrigin(small, frame);
            for (uint32_t y = 0; y < h; ++y)
                for (uint32_t x = 0; x < w; ++x)
                    for (uint32_t c = 1; c < 4; ++c) {
                        double mean = 0;
                        for (uint32_t k = 0; k < 4; ++k)
                            mean += texel(from.x + 2 * x + k % 2, from.y + 2 * y + k / 2)[c] / 4.0;
                        ASSERT_NEAR(mean, texel(at.x + x, at.y + y)[c], 0.51);
                    }
            for (uint32_t y = 0; y < h + 2; ++y)
                for (uint32_t x = 0; x < w + 2; ++x)
                    if (x == 0 || y == 0 || x == w + 1 || y == h + 1) {
                        ASSERT_EQ(0, texel(at.x + x - 1, at.y + y - 1)[2]) << level << " " << frame;
                    }
        }
    }
    // With as many texels as pixels or fewer, level 0; then one level per halving.
    EXPECT_EQ(0u, gpu::flipbookLevel(64, 128, 0.99f));
    EXPECT_EQ(0u, gpu::flipbookLevel(64, 64, 0.99f));
    EXPECT_EQ(1u, gpu::flipbookLevel(64, 32, 0.0f));
    EXPECT_EQ(1u, gpu::flipbookLevel(64, 32, 0.99f));
    EXPECT_EQ(3u, gpu::flipbookLevel(64, 0.1f, 0.0f));
}

TEST(Flipbook, RefusesMoreFlipbooksThanTheAtlasHolds) {
    flipbook::Flipbook huge(memory());
    huge.facts.width = huge.facts.height = 512;
    huge.facts.motionWidth = huge.facts.motionHeight = 512;
    huge.facts.frames = 256;
    const flipbook::Flipbook* const placed[] = {&huge};
    try {
        (void)flipbook::packFlipbooks(placed, memory());
        FAIL();
    } catch (const core::Error& error) {
        EXPECT_EQ(FW_ERROR_OUT_OF_MEMORY, error.result);
        EXPECT_NE(nullptr, std::strstr(error.message, "rows of 4096 texels; the limit is 4096"));
    }
}

TEST(Flipbook, ShowsTheStatedHeightAndLight) {
    const flipbook::Flipbook fire = smallBook("campfire", 24, 4);
    EXPECT_GT(flipbook::frameAt(fire, 0, vec2(0.5f, 0.25f)).y, 0.5f);
    EXPECT_GT(gpu::flipbookKelvin(flipbook::frameAt(fire, 0, vec2(0.5f, 0.25f)).x), 1200);
    for (const char* scene : {"roll", "smoke"}) {
        const flipbook::Flipbook puff = smallBook(scene, 16, 3);
        const bool smoke = puff.facts.kind == flipbook::Kind::Smoke;
        for (uint32_t i = 0; i < 3; ++i) {
            EXPECT_GT(flipbook::frameAt(puff, i, vec2(0.5f)).z, 0.2f) << scene << i;
            if (smoke) {
                EXPECT_EQ(flipbook::frameAt(puff, i, vec2(0.5f)).y, 0) << i;
            }
            for (const float s : {0.03f, 0.97f}) {
                EXPECT_LT(flipbook::frameAt(puff, i, vec2(s, 0.5f)).z, 0.02f) << scene << i;
                EXPECT_LT(flipbook::frameAt(puff, i, vec2(0.5f, s)).z, 0.02f) << scene << i;
            }
            EXPECT_LE(puff.rects[i].right, 16);
            EXPECT_LT(puff.rects[i].left, puff.rects[i].right);
        }
    }
}

std::string saidOf(std::span<const std::byte> bytes) {
    flipbook::Flipbook book(memory());
    book.facts.frames = 77;
    try {
        flipbook::readFlipbook(bytes, book);
    } catch (const core::Error& error) {
        EXPECT_EQ(book.facts.frames, 77u);
        return error.message;
    }
    return {};
}

TEST(Flipbook, RefusesBadFilesByName) {
    const flipbook::Flipbook made = spots(16, vec2(5, 5), vec2(1, 1));
    const auto whole = flipbook::cookFlipbook(made, memory());
    EXPECT_EQ(saidOf(whole), "");
    flipbook::Flipbook again(memory());
    flipbook::readFlipbook(whole, again);
    EXPECT_EQ(again.texels, made.texels);
    EXPECT_EQ(again.motion, made.motion);
    EXPECT_EQ(again.facts.maxMotion, made.facts.maxMotion);
    for (size_t cut = 0; cut < whole.size(); cut += 1 + cut / 3)
        EXPECT_NE(saidOf(std::span(whole).first(cut)), "") << cut;
    const auto changed = [&](size_t at, uint8_t to) {
        auto bytes = whole;
        bytes[at] = std::byte(to);
        return saidOf(bytes);
    };
    EXPECT_NE(changed(0, 0).find("begins with 0x"), std::string::npos);
    EXPECT_NE(changed(4, 9).find("has version 9"), std::string::npos);
    EXPECT_NE(changed(16, 7).find("kind is 7; it must lie in [0, 2]"), std::string::npos);
    EXPECT_NE(changed(24, 3).find("width is 3; it must lie in [8, 512]"), std::string::npos);
    EXPECT_NE(changed(32, 9).find("9 frames of 16 x 16 need"), std::string::npos);
    EXPECT_NE(changed(47, 0x7F).find("maxMotion is"), std::string::npos);
    EXPECT_NE(changed(52, 1).find("reserved word is 1"), std::string::npos);
    EXPECT_NE(changed(whole.size() - 1, uint8_t(whole.back()) ^ 1).find("checksum"),
              std::string::npos);
    EXPECT_NE(changed(60, 200).find("checksum"), std::string::npos);
}

TEST(Flipbook, ResumesAnInterruptedBake) {
    const std::string path =
        (std::filesystem::temp_directory_path() / "flamewright_flipbook_test.part").string();
    std::filesystem::remove(path);
    const Frame frame = spotAt(16, 5, 6);
    std::string error;
    {
        fwtools::FrameStore store(path, 7, 3, 256, false, error);
        ASSERT_EQ(error, "");
        EXPECT_TRUE(store.put(1, frame));
    }
    {
        fwtools::FrameStore store(path, 7, 3, 256, false, error);
        EXPECT_FALSE(store.has(0));
        ASSERT_TRUE(store.has(1));
        Frame read;
        ASSERT_TRUE(store.get(1, read));
        for (size_t i = 0; i < 256; ++i) EXPECT_NEAR(read.texels[i].y, frame.texels[i].y, 1e-3f);
        EXPECT_FALSE(store.get(2, read));
    }
    {
        fwtools::FrameStore other(path, 8, 3, 256, false, error);  // other settings
        EXPECT_FALSE(other.has(1));
        other.forget();
    }
    EXPECT_FALSE(std::filesystem::exists(path));
    fwtools::FrameStore nowhere("/nowhere/book.part", 7, 3, 256, false, error);
    EXPECT_EQ(error, "/nowhere/book.part cannot be written");
}

}  // namespace
