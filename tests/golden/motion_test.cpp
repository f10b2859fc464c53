// Burning objects must not shimmer: consecutive frames 1/30 s apart against the same times with
// sixteen samples per pixel. The error may not change from frame to frame.
// FLAMEWRIGHT_MOTION=<folder> keeps the frames. Flames and speed are not tested here.
#include "support/own_world.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>

namespace fw::test::motion_test {
namespace {

constexpr uint32_t kWidth = 256, kHeight = 144, kSamples = 4;  // kSamples^2 per pixel
constexpr uint32_t kFrames = 4;
constexpr float kFrameTime = 1.0f / 30.0f;

// In 1/255: where the object covers whole pixels, and at rims and outlines.
struct Shimmer {
    double inside = 0, rim = 0;                  // mean change of the error
    double insideOutliers = 0, rimOutliers = 0;  // share of pixels where it changes by more than 48
    double flicker = 0;                          // share that jumps by 32 and back
    uint64_t insideCount = 0, rimCount = 0;
};

struct Frame {
    Picture shown, reference;
    std::vector<uint8_t> covered;  // of a pixel's samples, [0, kSamples^2]
};

Shimmer shimmerOf(const char* name, const std::vector<Frame>& frames) {
    Shimmer s;
    const auto error = [](const Frame& f, size_t i) {
        return int(f.shown.rgb[i]) - int(f.reference.rgb[i]);
    };
    Picture map = frames[0].shown;
    std::fill(map.rgb.begin(), map.rgb.end(), uint8_t(0));
    for (size_t f = 1; f < frames.size(); ++f) {
        const Frame &a = frames[f - 1], &b = frames[f];
        for (uint32_t y = 1; y + 1 < kHeight; ++y) {
            for (uint32_t x = 1; x + 1 < kWidth; ++x) {
                const size_t at = size_t{y} * kWidth + x;
                uint32_t low = kSamples * kSamples, high = 0;
                for (int k = 0; k < 9; ++k) {
                    const size_t n = at + size_t(k / 3) * kWidth + size_t(k % 3) - kWidth - 1;
                    for (const Frame* frame : {&a, &b}) {
                        low = std::min<uint32_t>(low, frame->covered[n]);
                        high = std::max<uint32_t>(high, frame->covered[n]);
                    }
                }
                if (high == 0) continue;
                int change = 0, jump = 0;
                for (size_t c = 0; c < 3; ++c) {
                    const size_t i = at * 3 + c;
                    change = std::max(change, std::abs(error(b, i) - error(a, i)));
                    if (f + 1 == frames.size()) continue;
                    const int in = int(b.shown.rgb[i]) - int(a.shown.rgb[i]);
                    const int out = int(b.shown.rgb[i]) - int(frames[f + 1].shown.rgb[i]);
                    if (in * out > 0) jump = std::max(jump, std::min(std::abs(in), std::abs(out)));
                }
                const bool inside = low == kSamples * kSamples;
                (inside ? s.inside : s.rim) += change;
                (inside ? s.insideOutliers : s.rimOutliers) += change > 48;
                (inside ? s.insideCount : s.rimCount) += 1;
                s.flicker += jump > 32;
                map.rgb[at * 3 + (inside ? 0 : 1)] = uint8_t(
                    std::min(255, std::max<int>(map.rgb[at * 3 + (inside ? 0 : 1)], 2 * change)));
            }
        }
    }
    const double inside = std::max<double>(1, double(s.insideCount));
    const double rim = std::max<double>(1, double(s.rimCount));
    s.inside /= inside;
    s.insideOutliers /= inside;
    s.rim /= rim;
    s.rimOutliers /= rim;
    s.flicker /= inside + rim;
    if (const char* folder = std::getenv("FLAMEWRIGHT_MOTION"))
        writePng(std::string(folder) + "/" + name + "_change.png", map);
    std::printf("%-18s inside %.2f (%.2f %% beyond 48), rim %.2f (%.1f %%), flicker %.2f %%\n",
                name, s.inside, 100 * s.insideOutliers, s.rim, 100 * s.rimOutliers,
                100 * s.flicker);
    return s;
}

class Motion : public OwnWorld {
 protected:
    void makeWorld(float pace) { OwnWorld::makeWorld(pace, 32); }

    void burn(const Mesh& mesh, const std::vector<float>& details, uint32_t preset, float density,
              bool twoSided, glm::vec3 at, float radius, float seconds) {
        FwMeshDef def = meshDefOf(mesh);
        def.details = details.empty() ? nullptr : details.data();
        def.mapSize = 1024;
        def.texelsPerMetre = density;
        FwMaterialDef material = fwDefaultMaterialDef();
        ASSERT_EQ(fwInitMaterialPreset(&material, preset), FW_OK);
        add(def, material, twoSided ? uint32_t{FW_BURNABLE_TWO_SIDED} : 0u);
        touch(FW_IGNITE, at.x, at.y, at.z, radius);
        run(seconds, 0.25f);
        for (int i = 0; i < 24; ++i) fwWorld_Step(world_, 0);  // one ring of prediction per frame
    }

    Picture draw(glm::vec3 eye, glm::vec3 target, uint32_t scale, float time,
                 std::vector<uint8_t>* hit) {
        const uint32_t width = kWidth * scale, height = kHeight * scale;
        FwView view = viewAt(eye, target, float(kWidth) / float(kHeight));
        view.time = time;
        const std::vector<uint8_t> pixels = shoot(world_, view, width, height);
        Picture picture{kWidth, kHeight, std::vector<uint8_t>(size_t{kWidth} * kHeight * 3)};
        if (hit) hit->assign(size_t{kWidth} * kHeight, 0);
        const uint8_t* corner = pixels.data();
        for (uint32_t y = 0; y < kHeight; ++y) {
            for (uint32_t x = 0; x < kWidth; ++x) {
                uint32_t sum[3] = {}, hits = 0;
                for (uint32_t k = 0; k < scale * scale; ++k) {
                    const size_t i = size_t{y * scale + k / scale} * width + x * scale + k % scale;
                    const uint8_t* p = &pixels[i * 4];
                    for (int c = 0; c < 3; ++c) sum[c] += p[c];
                    hits += std::memcmp(p, corner, 3) != 0;
                }
                const size_t at = size_t{y} * kWidth + x;
                for (size_t c = 0; c < 3; ++c)
                    picture.rgb[at * 3 + c] =
                        uint8_t((sum[c] + scale * scale / 2) / (scale * scale));
                if (hit) (*hit)[at] = uint8_t(hits);
            }
        }
        return picture;
    }

    Shimmer measure(const char* name, glm::vec3 eye, glm::vec3 target, glm::vec3 drift,
                    bool burning) {
        std::vector<Frame> frames(kFrames);
        for (uint32_t f = 0; f < kFrames; ++f) {
            if (burning) fwWorld_Step(world_, kFrameTime);
            const float time = 3.0f + (burning ? float(f) * kFrameTime : 0.0f);
            const glm::vec3 shift = drift * float(f);
            frames[f].shown = draw(eye + shift, target + 0.7f * shift, 1, time, nullptr);
            frames[f].reference =
                draw(eye + shift, target + 0.7f * shift, kSamples, time, &frames[f].covered);
            if (const char* folder = std::getenv("FLAMEWRIGHT_MOTION")) {
                const std::string path = std::string(folder) + "/" + name + std::to_string(f);
                writePng(path + ".png", frames[f].shown);
                writePng(path + "_reference.png", frames[f].reference);
            }
        }
        return shimmerOf(name, frames);
    }
};

// The mean stays below a shade or two, and almost no pixel jumps.
void calm(const Shimmer& s, double inside) {
    EXPECT_GT(s.insideCount, 3000u);
    EXPECT_LT(s.inside, inside);
    EXPECT_LT(s.insideOutliers, 0.015);
    EXPECT_LT(s.rim, 15);
    EXPECT_LT(s.rimOutliers, 0.08);
    EXPECT_LT(s.flicker, 0.005);
}

// The measure must be able to fail.
TEST(MotionMeasure, SeesShimmer) {
    std::vector<Frame> frames(3);
    for (size_t f = 0; f < 3; ++f) {
        frames[f].reference = {kWidth, kHeight, std::vector<uint8_t>(kWidth * kHeight * 3, 90)};
        frames[f].shown = frames[f].reference;
        frames[f].covered.assign(kWidth * kHeight, kSamples * kSamples);
    }
    const Shimmer still = shimmerOf("still", frames);
    EXPECT_EQ(still.inside, 0);
    EXPECT_EQ(still.flicker, 0);
    for (size_t i = 0; i < kWidth * kHeight; i += 10) frames[1].shown.rgb[i * 3] = 255;
    const Shimmer sparks = shimmerOf("sparks", frames);
    EXPECT_GT(sparks.inside, 10);
    EXPECT_GT(sparks.insideOutliers, 0.05);
    EXPECT_GT(sparks.flicker, 0.02);
}

// A sheet in z = 0 from the origin, with detail coordinates.
Mesh sheet(float side, std::vector<float>& details) {
    Mesh mesh = makePlane(side, side, 0, 1, 0, 8);
    details.clear();
    for (uint32_t i = 0; i < mesh.vertexCount(); ++i)
        details.insert(details.end(), {mesh.positions[i * 3], mesh.positions[i * 3 + 1]});
    return mesh;
}

TEST_F(Motion, PaperSheetDoesNotShimmer) {
    std::vector<float> details;
    const Mesh mesh = sheet(0.3f, details);
    makeWorld(1);
    burn(mesh, details, FW_MATERIAL_PAPER, 512, true, {0.05f, 0.05f, 0}, 0.02f, 5);
    const glm::vec3 eye(0.24f, 0.19f, 0.55f), target(0.15f, 0.15f, 0);
    calm(measure("paper_moving", eye, target, {0.00043f, 0.00017f, 0.0005f}, false), 2);
    calm(measure("paper_burning", eye, target, {}, true), 2);
}

TEST_F(Motion, PineSheetDoesNotShimmer) {
    std::vector<float> details;
    const Mesh mesh = sheet(0.6f, details);
    makeWorld(40);
    burn(mesh, details, FW_MATERIAL_PINE, 192, true, {0.1f, 0.1f, 0}, 0.03f, 9);
    const glm::vec3 eye(0.5f, 0.35f, 1.25f), target(0.3f, 0.3f, 0);
    calm(measure("pine_moving", eye, target, {0.0009f, 0.0004f, 0.001f}, false), 5);
    calm(measure("pine_burning", eye, target, {}, true), 1.5);
    const glm::vec3 far(1.2f, 0.6f, 4.0f);
    calm(measure("pine_far_moving", far, target, {0.0028f, 0.0011f, 0.003f}, false), 5);
}

TEST_F(Motion, BunnyDoesNotShimmer) {
    Mesh mesh;
    std::string error;
    if (!loadGlb("bunny_31k.glb", mesh, error)) GTEST_SKIP() << error;
    makeWorld(150);
    burn(mesh, {}, FW_MATERIAL_PINE, 300, false, {-0.3f, 0.3f, 0.3f}, 0.2f, 7);
    const glm::vec3 eye(-0.5f, 0.7f, 1.85f), target(0, 0.5f, 0);
    calm(measure("bunny_moving", eye, target, {0.0013f, 0.0005f, 0.001f}, false), 6);
    calm(measure("bunny_burning", eye, target, {}, true), 4);
}

}  // namespace
}  // namespace fw::test::motion_test
