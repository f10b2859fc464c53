// The editor driven by scripts through the shared library as in a game: paint, fires and queries
// match the burn and its pictures.
#include "script/script.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "document/world_parts.h"
#include "editor/yard.h"
#include "import/float_picture.h"

namespace {

using namespace fwtest;
using ::testing::HasSubstr;

TEST(EditorScript, LightsUndoesRedoesSavesAndReopensAFire) {
    Yard yard;
    yard.run(kBoard);
    yard.run(
        "expect count source 1\nexpect step \"Add heat source\"\n"
        "play 20\nexpect lit Board above 0.9\n"
        "set Match start 5\nplay 4.9\nexpect lit Board below 0.001\nundo\nexpect Match start 0\n"
        "redo\nexpect Match start 5 s\nundo\nsave \"yard.fwscene\"\nexpect unsaved no\n"
        "expect same yard.fwscene\nmove Match 0.1 0 0\nexpect unsaved yes\nundo\nexpect unsaved "
        "no\n"
        "new\nexpect count mesh 0\nopen yard.fwscene\nexpect same yard.fwscene\n"
        "expect count mesh 1\nplay 20\nexpect lit Board above 0.9\n");
}

TEST(EditorScript, NamesFailuresByLine) {
    Yard yard;
    const auto fails = [&](const std::string& line) { return yard.fails(line); };
    EXPECT_THAT(fails("import nothing.glb"), HasSubstr("nothing.glb"));
    EXPECT_EQ(1u, yard.host->document.steps.size());
    EXPECT_THAT(fails("undo"), HasSubstr("nothing more to undo"));
    EXPECT_THAT(fails("save"), HasSubstr("no file yet"));
    EXPECT_THAT(fails("shot a.png 0x9"), HasSubstr("1x1 to 8192x8192"));
    EXPECT_THAT(fails("play soon"), HasSubstr("\"soon\""));
    EXPECT_THAT(fails("expect count mesh 1"), HasSubstr("there are 0"));
    EXPECT_THAT(fails("open board.glb"), HasSubstr("was not opened"));
    EXPECT_THAT(fails("refuse add source"), HasSubstr("succeeded"));
    std::ofstream(yard.folder / "bad.txt") << "add source\n\n// fine\nset \"Nobody\" output 1\n";
    std::string error;
    EXPECT_FALSE(runScript(*yard.host, yard.folder / "bad.txt", error));
    EXPECT_THAT(error, HasSubstr("bad.txt:4: "));
    EXPECT_THAT(error, HasSubstr("no object \"Nobody\""));
}

TEST(EditorBurn, APaintedBeltStopsFireAcrossEverySeam) {
    Yard yard;
    yard.run(kBoard);
    yard.run("play 20\nexpect lit Board above 0.9\n");
    const size_t whole = static_cast<size_t>(std::count_if(
        yard.host->record.fields[0].seconds.begin(), yard.host->record.fields[0].seconds.end(),
        [](float seconds) { return seconds < kNeverLit; }));
    // Around the board over the seams of its six faces: one stroke along its height suffices,
    // because the brush is a ball.
    yard.run(
        "add layer multiplier name=Belt mesh Board\n"
        "stroke Belt value 0 size 0.06 hardness 1 path 0:-0.05:0 0:0.45:0\n"
        "expect step \"Paint burn multiplier on Board\"\nburn\n");
    const ArrivalField& field = yard.host->record.fields[0];
    std::string error;
    const auto surface = paintSurfaceOf(yard.host->cpu(error), yard.host->document.scene.meshes[0],
                                        yard.folder, yard.host->assets, error);
    ASSERT_TRUE(surface) << error;
    ASSERT_EQ(surface->width, field.width);
    size_t left = 0, right = 0, belt = 0;
    for (size_t i = 0; i < field.seconds.size(); ++i) {
        if (!surface->real[i] || field.seconds[i] >= kNeverLit) continue;
        const float x = surface->positions[i * 3];
        left += x < -0.06f;
        right += x > 0.06f;
        belt += std::abs(x) < 0.055f;
    }
    EXPECT_GT(left, whole / 3);
    EXPECT_EQ(0u, right);
    EXPECT_EQ(0u, belt);
    yard.run("undo\nplay 20\nexpect lit Board above 0.9\n");
}

TEST(EditorBurn, TheUnwrapMatchesItsTexels) {
    Yard yard;
    yard.run(kBoard);
    std::string error;
    const auto surface = paintSurfaceOf(yard.host->cpu(error), yard.host->document.scene.meshes[0],
                                        yard.folder, yard.host->assets, error);
    ASSERT_TRUE(surface) << error;
    ASSERT_FALSE(surface->corners.empty());
    ASSERT_EQ(0u, surface->corners.size() % 15);
    // The texel at the centre of each large triangle lies at its centre.
    size_t large = 0;
    for (size_t t = 0; t < surface->corners.size(); t += 15) {
        const float* c = &surface->corners[t];
        float middle[5];
        for (size_t k = 0; k < 5; ++k) middle[k] = (c[k] + c[5 + k] + c[10 + k]) / 3;
        const float area =
            std::abs((c[8] - c[3]) * (c[14] - c[4]) - (c[13] - c[3]) * (c[9] - c[4]));
        if (area < 50) continue;
        ++large;
        const size_t texel = size_t(middle[4]) * surface->width + size_t(middle[3]);
        ASSERT_LT(texel, surface->real.size());
        ASSERT_TRUE(surface->real[texel]);
        for (size_t k = 0; k < 3; ++k)
            EXPECT_NEAR(middle[k], surface->positions[texel * 3 + k], 1.1f * surface->spacing);
    }
    EXPECT_GT(large, 4u);
    // The board is closed, so each cut of the unwrap has two sides.
    ASSERT_FALSE(surface->seams.empty());
    for (const Seam& seam : surface->seams) {
        const auto other =
            std::find_if(surface->seams.begin(), surface->seams.end(), [&](const Seam& one) {
                return &one != &seam && one.fromPosition == seam.toPosition &&
                       one.toPosition == seam.fromPosition;
            });
        EXPECT_NE(surface->seams.end(), other);
    }
}

TEST(EditorBurn, ThePaintSurfaceHasIslandsPiecesAndNormals) {
    Yard yard;
    yard.run(kBoard);
    std::string error;
    const auto surface = paintSurfaceOf(yard.host->cpu(error), yard.host->document.scene.meshes[0],
                                        yard.folder, yard.host->assets, error);
    ASSERT_TRUE(surface) << error;
    std::vector<uint32_t> pieces, islands;
    size_t real = 0;
    for (size_t i = 0; i < surface->real.size(); ++i) {
        if (!surface->real[i]) continue;
        ++real;
        pieces.push_back(surface->piece[i]);
        islands.push_back(surface->island[i]);
        const float* n = &surface->normals[i * 3];
        const float* p = &surface->positions[i * 3];
        EXPECT_NEAR(1, n[0] * n[0] + n[1] * n[1] + n[2] * n[2], 1e-4f);
        // Outwards from the middle of its board.
        const float middle = p[2] < -0.25f ? -0.5f : 0;
        if (std::abs(p[2] - middle) > 0.0099f && std::abs(p[0]) < 0.48f &&
            std::abs(p[1] - 0.2f) < 0.18f) {
            EXPECT_GT(n[2] * (p[2] - middle), 0.009f);
        }
    }
    EXPECT_GT(real, 2000u);
    const auto kinds = [](std::vector<uint32_t>& list) {
        std::sort(list.begin(), list.end());
        return std::unique(list.begin(), list.end()) - list.begin();
    };
    EXPECT_EQ(2, kinds(pieces));
    EXPECT_GE(kinds(islands), 2);
    // Filling by piece leaves the other board unchanged.
    yard.run("add layer moisture name=Wet mesh Board\nfill Wet value 1 by piece at 0 0.2 0.01\n");
    const PaintImage& image = yard.host->document.images.begin()->second;
    for (size_t i = 0; i < surface->real.size(); ++i)
        if (surface->real[i]) {
            const uint8_t value = image.at(static_cast<uint32_t>(i % surface->width),
                                           static_cast<uint32_t>(i / surface->width));
            ASSERT_EQ(surface->positions[i * 3 + 2] > -0.25f ? 255 : 0, value);
        }
}

TEST(EditorBurn, CreatesEveryKindOfObject) {
    Yard yard;
    yard.run(kBoard);
    yard.run(
        "add source point position 0 0 0.1 output 30 radius 0.1\n"
        "add source disc position 0.3 0 0 output 60 radius 0.2\n"
        "add source line position 0 0 0.3 direction 1 0 0 length 1 output 50 radius 0.08\n"
        "add source flamethrower position -1 0.2 0 direction 1 0 0 output 500 keys 0:0 2:1\n"
        "add source rain position 0 1 0 radius 0.5 output 0.1 length 1\n"
        "add source water position 0.5 0.2 0 radius 0.1 output 0.05\n"
        "add flame candle position 1 0 0 sticks_to Board\n"
        "add emitter mesh sticks_to Board\nadd emitter disc position 0 0 1 duration 2\n"
        "add wind velocity 3 0 0 start 1 duration 2\n"
        "add collider ball position 0 0 3\nadd collider capsule position 0 0 4 rotation 0 0 90\n"
        "add collider box position 0 0 5 rotation 10 20 30\nadd collider floor position 0 -0.1 0\n"
        "add event time 3 note roof\nplay 3\nwhy Board 0.4 0.2 0.01\n");
    ASSERT_TRUE(yard.host->burn);
    EXPECT_THAT(yard.host->burn->report, ::testing::IsEmpty());
    EXPECT_NEAR(3, yard.host->burn->time, 1e-6);
    // Invalid objects are omitted and named; the others burn.
    yard.run("add emitter mesh name=Lost\nimport board.glb name=Second\nplay 0\n");
    fs::remove(yard.folder / "board.glb");
    yard.host->assets.models.clear();
    std::string error;
    ASSERT_TRUE(burnToPlayhead(*yard.host, yard.host->cpu(error), error)) << error;
    EXPECT_THAT(
        yard.host->burn->report,
        ::testing::Contains(HasSubstr("\"Lost\" is left out: it shows the fire of a mesh")));
    EXPECT_THAT(yard.host->burn->report, ::testing::Contains(HasSubstr("\"Second\" is left out")));
}

// A flame attached to a node of a burning file follows the object.
TEST(EditorBurn, AFlameFollowsANodeOfTheFile) {
    Yard yard;
    yard.run(kBoard);
    yard.run(
        "add flame candle name=Candle sticks_to Board sticks_to_node wick\n"
        "add emitter name=Sparks direction 0 0 1 sticks_to Board sticks_to_node \"#1\"\n"
        "play 0\n");
    std::string error;
    ASSERT_TRUE(burnToPlayhead(*yard.host, yard.host->cpu(error), error)) << error;
    Burn& burn = *yard.host->burn;
    EXPECT_THAT(burn.report, ::testing::IsEmpty());
    const auto near = [](Vec3 expected, const float* given) {
        for (size_t k = 0; k < 3; ++k) EXPECT_NEAR(expected[k], given[k], 1e-5f) << k;
    };
    near({0.4f, 0.3f, 0.02f}, fireDefOf(burn.scene, burn.scene.flames[0]).position);
    near({1, 0, 0}, emitterDefOf(burn.scene, burn.scene.emitters[0]).direction);
    // At the wick's own scale.
    yard.run("set Candle position 0 0.1 0\nset Board rotation 0 90 0\nmove Board 5 0 0\n");
    ASSERT_TRUE(reviseBurn(burn, yard.host->document.scene, yard.folder));
    near({5.02f, 0.5f, -0.4f}, fireDefOf(burn.scene, burn.scene.flames[0]).position);
    near({0, 0, -1}, emitterDefOf(burn.scene, burn.scene.emitters[0]).direction);
    EXPECT_THAT(yard.fails("set Candle sticks_to_node wich"),
                HasSubstr("sticks_to_node is \"wich\"; board.glb: there is no node \"wich\"; its "
                          "nodes are #0 to #2: boards, hook, wick"));
    // A missing node is reported, and nothing is written at a wrong place.
    yard.host->document.scene.flames[0].sticksToNode = "gone";
    yard.host->burn = nullptr;
    ASSERT_TRUE(burnToPlayhead(*yard.host, yard.host->cpu(error), error)) << error;
    EXPECT_THAT(yard.host->burn->report, ::testing::ElementsAre(HasSubstr("no node \"gone\"")));
    EXPECT_THAT(yard.fails("cook game"), HasSubstr("no node \"gone\""));
}

TEST(EditorBurn, APartOfAFileBurnsSeparately) {
    Yard yard;
    yard.run(kBoard);
    EXPECT_THAT(yard.fails("refuse set Board node boards"), HasSubstr("succeeded"));
    yard.run("play 1\nset Board node hook\n");
    std::string error;
    ASSERT_TRUE(burnToPlayhead(*yard.host, yard.host->cpu(error), error)) << error;
    ASSERT_EQ(1u, yard.host->burn->report.size());
    EXPECT_THAT(yard.host->burn->report[0], HasSubstr("there is no triangle in it"));
}

TEST(EditorBurn, HeatSourcesIgniteAndWaterPrevents) {
    Yard yard;
    yard.run(
        "import board.glb name=Board materials paper map_size 128 texels_per_metre 64\n"
        "set settings pace 20 duration 15 frames_per_second 8 radiation no plume no contact no "
        "embers no\nadd source point name=Torch position 0 0 0.02 output 30 radius 0.1\n"
        "play 15\nexpect lit Board above 0.3\n"
        "set Torch keys 0:0\nexpect lit Board below 0.001\nundo\n");
    yard.run(
        "add source water name=Hose position 0 0.2 0 radius 1.2 output 40\n"
        "expect lit Board below 0.05\n");
}

// A wind zone acts at its place with its keyed strength, and follows edits.
TEST(EditorBurn, FansBlowAtTheirPlaceAndTime) {
    Yard yard;
    yard.run(kBoard);
    yard.run(
        "set settings wind 1 0 0\n"
        "add wind fan name=Fan velocity 0 0 6 position 0 0 -3 length 4 radius 1 falloff 0 start 1\n"
        "add wind ball name=Shelter velocity 0 0 0 position 5 0 0 radius 1 falloff 0 shelters "
        "yes\n");
    std::string error;
    ASSERT_TRUE(burnToPlayhead(*yard.host, yard.host->cpu(error), error)) << error;
    Burn& burn = *yard.host->burn;
    EXPECT_THAT(burn.report, ::testing::IsEmpty());
    const auto windAt = [&](float x, float z) {
        const float point[3] = {x, 0, z};
        Vec3 wind{};
        EXPECT_EQ(FW_OK, fwWorld_GetWindAt(burn.world, point, wind.data()));
        return wind;
    };
    ASSERT_TRUE(runBurn(burn, 0.75, error)) << error;
    EXPECT_EQ((Vec3{1, 0, 0}), windAt(0, -1)) << "the fan does not run yet";
    EXPECT_EQ((Vec3{0, 0, 0}), windAt(5, 0)) << "behind the shelter";
    ASSERT_TRUE(runBurn(burn, 2, error)) << error;
    const Vec3 blown = windAt(0, -1);
    EXPECT_NEAR(1, blown[0], 1e-4f);
    EXPECT_NEAR(6, blown[2], 1e-3f);
    EXPECT_EQ((Vec3{1, 0, 0}), windAt(0, 3)) << "beyond its reach";
    yard.run("move Fan 0 0 4\nset Fan velocity 0 0 3\n");
    ASSERT_TRUE(reviseBurn(burn, yard.host->document.scene, yard.folder));
    ASSERT_TRUE(runBurn(burn, 2.5, error)) << error;
    EXPECT_EQ((Vec3{1, 0, 0}), windAt(0, -1));
    EXPECT_NEAR(3, windAt(0, 3)[2], 1e-3f);
    yard.run("set Fan hidden yes\n");
    ASSERT_TRUE(reviseBurn(burn, yard.host->document.scene, yard.folder));
    ASSERT_TRUE(runBurn(burn, 3, error)) << error;
    EXPECT_EQ((Vec3{1, 0, 0}), windAt(0, 3));
}

TEST(EditorWhy, AnswersInPlainWords) {
    Yard yard;
    yard.run(kBoard);
    yard.run("play 0");
    EXPECT_THAT(yard.why("why Board 0.45 0.2 0.01"), HasSubstr("Not lit: heat 0.00 of 1.00"));
    yard.run("play 1.5");
    const std::string ahead = yard.why("why Board 0.45 0.2 0.01");
    EXPECT_THAT(ahead, HasSubstr(", arrives in "));
    EXPECT_THAT(yard.why("why Board -0.5 0.2 0"), HasSubstr(" 1.5 s"));
    // The forecast comes true.
    const double seconds = std::stod(ahead.substr(ahead.find("arrives in ") + 11));
    yard.run("play " + std::to_string(1.5 + seconds - 0.3));
    EXPECT_THAT(yard.why("why Board 0.45 0.2 0.01"), HasSubstr("Not lit"));
    yard.run("play " + std::to_string(1.5 + seconds + 0.3));
    EXPECT_THAT(yard.why("why Board 0.45 0.2 0.01"), ::testing::Not(HasSubstr("Not lit")));
    // Paint that stops the fire is named as the first cause.
    yard.run("add layer multiplier name=Belt mesh Board\nfill Belt value 0\nplay 1\n");
    (void)yard.why("why Board 0.45 0.2 0.01");
    EXPECT_THAT(yard.said, ::testing::Contains(HasSubstr("painted ×0")));
}

TEST(EditorInspect, ScrubbingComparesTimesOnly) {
    ArrivalField field;
    field.width = field.height = 1024;
    field.seconds.resize(1024 * 1024);
    for (size_t i = 0; i < field.seconds.size(); ++i)
        field.seconds[i] = i % 5 == 0 ? kNeverLit : static_cast<float>(i) * 1e-5f;
    const auto begin = std::chrono::steady_clock::now();
    const std::vector<uint8_t> map = burnTimeMap(field, 10);
    EXPECT_NEAR(0.5, litShare(field, 5.24f), 0.01);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    EXPECT_LT(took.count(), 1.0);
    EXPECT_EQ(255, map[0]);
    EXPECT_EQ(0, map[1]);
    EXPECT_NEAR(127, map[500001], 1);
    EXPECT_EQ(254, map[1024 * 1024 - 2]);
}

// Mean brightness of a picture, and its share of fire-coloured pixels.
struct Seen {
    double light = 0, fire = 0;
};
Seen lookAt(const fs::path& file) {
    fwimport::FloatPicture picture;
    std::string error;
    EXPECT_TRUE(fwimport::readPicture(file, picture, error)) << error;
    Seen seen;
    const double pixels = double(picture.width) * picture.height;
    for (uint32_t y = 0; y < picture.height; ++y)
        for (uint32_t x = 0; x < picture.width; ++x) {
            const float r = picture.at(x, y, 0), b = picture.at(x, y, 2);
            seen.light += double(r + picture.at(x, y, 1) + b) / 3 / pixels;
            seen.fire += (r > 0.75f && r > b + 0.3f) / pixels;
        }
    return seen;
}

// Mean difference of two pictures' channels, and the share of channels off by more than 3 %.
// Devices add the floats of flames in any order, so pictures agree visually, not bit for bit.
std::pair<double, double> difference(const fs::path& a, const fs::path& b) {
    fwimport::FloatPicture one, other;
    std::string error;
    EXPECT_TRUE(fwimport::readPicture(a, one, error)) << error;
    EXPECT_TRUE(fwimport::readPicture(b, other, error)) << error;
    if (one.values.size() != other.values.size()) return {1, 1};
    double sum = 0, far = 0;
    for (size_t i = 0; i < one.values.size(); ++i) {
        const double off = std::abs(static_cast<double>(one.values[i] - other.values[i]));
        sum += off;
        far += off > 0.03;
    }
    return {sum / double(one.values.size()), far / double(one.values.size())};
}

TEST(EditorShot, ShowsTheScriptedFireAndAgainFromTheFile) {
    Yard yard;
    std::string error;
    if (!yard.host->device(error)) GTEST_SKIP() << "no Vulkan device: " << error;
    yard.run(kBoard);
    yard.run(
        "set settings daylight night pace 60\nset Board materials pine\nset Match radius "
        "0.15\nframe\nset camera distance 1.6\n"
        "play 0\nshot before.png 160x90\nplay 1.5\nshot during.png 160x90\n"
        "save yard.fwscene\nnew\nopen yard.fwscene\nplay 1.5\n"
        "shot again.png 160x90\n");
    const Seen before = lookAt(yard.folder / "before.png"),
               during = lookAt(yard.folder / "during.png");
    EXPECT_LT(before.fire, 0.001);
    EXPECT_GT(during.fire, 0.004);
    EXPECT_GT(during.light, before.light);
    const auto [mean, far] = difference(yard.folder / "during.png", yard.folder / "again.png");
    EXPECT_LT(mean, 0.002);
    EXPECT_LT(far, 0.01);
    // The difference measure works: other pictures do differ.
    EXPECT_GT(difference(yard.folder / "before.png", yard.folder / "during.png").second, 0.01);
}

}  // namespace
