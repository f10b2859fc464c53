// Imported files in samples, editor and tools: slots, colours, images, cut-outs.
#include "model/model_surfaces.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdlib>

#include "editor/boards.h"
#include "editor/text_of.h"
#include "editor/yard.h"
#include "flamewright/flamewright_debug.h"
#include "import/float_picture.h"
#include "model/neutral_stage.h"
#include "support/paths.h"

namespace {

using namespace fwtest;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

fwimport::ImportedModel modelOfRow(const Yard& yard, const std::vector<BoardMaterial>& materials,
                                   uint32_t grid = 1) {
    writeBoardRow(yard.folder, "row", materials, grid);
    fwimport::ImportedModel model;
    std::string error;
    EXPECT_TRUE(fwimport::importGltf(yard.folder / "row.gltf", model, error)) << error;
    return model;
}

constexpr std::array<float, 3> kYellow{0.8f, 0.8f, 0.1f}, kBlue{0.1f, 0.2f, 0.8f};

std::vector<BoardMaterial> tenMaterials() {
    std::vector<BoardMaterial> row;
    for (int k = 0; k < 7; ++k) row.push_back({k % 2 ? kBlue : kYellow, {}, "", ""});
    row.push_back({{1, 1, 1}, plainPng(220, 20, 20), "", ""});
    row.push_back({{1, 1, 1}, plainPng(20, 200, 40), "", ""});
    row.push_back({{0.9f, 0.9f, 0.9f}, {}, "", ""});
    return row;
}

std::vector<BoardMaterial> manyPictures(uint32_t count) {
    std::vector<BoardMaterial> row;
    for (uint32_t k = 0; k < count; ++k) {
        const auto red = static_cast<uint8_t>(k * 255 / count);
        row.push_back({{1, 1, 1},
                       pngOf(64, 64,
                             [=](uint32_t, uint32_t) {
                                 return Pixel{red, static_cast<uint8_t>(255 - red), 90, 255};
                             }),
                       "",
                       "board " + std::to_string(k)});
    }
    return row;
}

TEST(ModelSurfaces, GivesEachOfEightMaterialsASlot) {
    const Yard yard;
    std::vector<BoardMaterial> row(8, {kYellow, {}, "", ""});
    const auto surfaces = fwmodel::surfacesOf(modelOfRow(yard, row));
    EXPECT_EQ(8u, surfaces.slotCount);
    EXPECT_THAT(surfaces.slots, ElementsAre(0, 1, 2, 3, 4, 5, 6, 7));
    EXPECT_THAT(surfaces.notes, IsEmpty());
}

TEST(ModelSurfaces, MaterialsBeyondEightShareSlotsByAppearance) {
    const Yard yard;
    const auto surfaces = fwmodel::surfacesOf(modelOfRow(yard, tenMaterials()));
    EXPECT_EQ(5u, surfaces.slotCount);  // yellow, blue, two images, white
    EXPECT_THAT(surfaces.slots, ElementsAre(0, 1, 0, 1, 0, 1, 0, 2, 3, 4));
    EXPECT_EQ(0, surfaces.pictures[2].image);
    EXPECT_EQ(1, surfaces.pictures[3].image);
    EXPECT_EQ(-1, surfaces.pictures[4].image);
    ASSERT_EQ(1u, surfaces.notes.size());
    EXPECT_THAT(surfaces.notes[0], HasSubstr("10 materials share 5"));
}

TEST(ModelSurfaces, ImagesBeyondTheLastSlotShowTheirMeanColour) {
    const Yard yard;
    const auto model = modelOfRow(yard, manyPictures(9));
    const auto surfaces = fwmodel::surfacesOf(model);
    EXPECT_EQ(8u, surfaces.slotCount);
    EXPECT_THAT(surfaces.slots, ElementsAre(0, 1, 2, 3, 4, 5, 6, 7, 7));
    EXPECT_EQ(-1, surfaces.pictures[7].image);
    ASSERT_EQ(1u, surfaces.notes.size());
    EXPECT_THAT(surfaces.notes[0], HasSubstr("\"board 7\", \"board 8\""));
    // sRGB 226, 29, 90: linear 0.760, 0.0123, 0.102
    const uint32_t color = surfaces.colors[8 * 4];
    EXPECT_NEAR(0.760 * 255, color & 255, 1);
    EXPECT_NEAR(0.0123 * 255, color >> 8 & 255, 1);
    EXPECT_NEAR(0.102 * 255, color >> 16 & 255, 1);
    EXPECT_EQ(0xffffffffu, surfaces.colors[0]);
}

TEST(ModelSurfaces, TwoHundredImagesCostLittleMoreThanTwenty) {
    const Yard yard;
    const auto seconds = [&](uint32_t count) {
        // 40,000 vertices whose image has no slot.
        const auto model = modelOfRow(yard, manyPictures(count), 200);
        const auto start = std::chrono::steady_clock::now();
        EXPECT_EQ(8u, fwmodel::surfacesOf(model).slotCount);
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    };
    const double few = seconds(20), many = seconds(200);
    std::printf("20 pictures %.3f s, 200 pictures %.3f s\n", few, many);
    EXPECT_LT(many, few + 0.5);
}

TEST(ModelSurfaces, GreyFilesTakeTheirMaterialsColour) {
    const Yard yard;
    const auto surfaces = fwmodel::surfacesOf(modelOfRow(yard, {{{0.8f, 0.8f, 0.8f}, {}, "", ""}}));
    EXPECT_FALSE(surfaces.ownColors());
    EXPECT_GT(1, fwmodel::materialDefOf(FW_MATERIAL_PINE, false).baseColor[0]);
    EXPECT_EQ(1, fwmodel::materialDefOf(FW_MATERIAL_PINE, true).baseColor[0]);
}

TEST(ModelSurfaces, MasksCutOutAndFactorAlphaMovesTheCutoff) {
    const Yard yard;
    fwimport::ImportedModel model = modelOfRow(
        yard, {{{1, 1, 1}, leavesPng(), ",\"alphaMode\":\"MASK\",\"alphaCutoff\":0.4", ""},
               {{1, 1, 1}, leavesPng(), "", ""}});
    auto surfaces = fwmodel::surfacesOf(model);
    EXPECT_FLOAT_EQ(0.4f, surfaces.pictures[0].alphaCutoff);
    EXPECT_EQ(0, surfaces.pictures[1].alphaCutoff);
    EXPECT_FLOAT_EQ(0.4f, fwmodel::imageDefOf(model, surfaces.pictures[0]).alphaCutoff);
    EXPECT_FALSE(surfaces.twoSided);
    model.materials[0].baseColor[3] = 0.8f;
    model.materials[0].doubleSided = true;
    surfaces = fwmodel::surfacesOf(model);
    EXPECT_FLOAT_EQ(0.5f, surfaces.pictures[0].alphaCutoff);
    EXPECT_TRUE(surfaces.twoSided);
}

TEST(ModelSurfaces, OpenSheetsAreTwoSidedAndSolidsAreNot) {
    const Yard yard;
    fwimport::ImportedModel model =
        modelOfRow(yard, {{{1, 1, 1}, {}, "", "a"}, {{1, 1, 1}, {}, "", "b"}});
    EXPECT_FALSE(fwmodel::surfacesOf(model).twoSided);
    for (auto& material : model.materials) material.doubleSided = true;
    EXPECT_TRUE(fwmodel::surfacesOf(model).twoSided);
    for (size_t i = 6; i < 12; i += 3) std::swap(model.indices[i + 1], model.indices[i + 2]);
    EXPECT_TRUE(fwmodel::surfacesOf(model).twoSided) << "the second board turns its back";
    // A tetrahedron.
    model.positions = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    model.indices = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
    model.triangleMaterials.assign(4, 0);
    model.colors.assign(4, 0xffffffffu);
    EXPECT_FALSE(fwmodel::surfacesOf(model).twoSided);
}

TEST(ModelSurfaces, CutOutPartsCastNoShadow) {
    const Yard yard;
    const auto model = modelOfRow(yard, {{{1, 1, 1}, leavesPng(), ",\"alphaMode\":\"MASK\"", ""},
                                         {{1, 1, 1}, leavesPng(), "", ""}});
    const auto solid = fwmodel::solidTrianglesOf(model, fwmodel::surfacesOf(model));
    double areas[2] = {};
    for (size_t i = 0; i < solid.indices.size(); i += 3) {
        const float* corners[3];
        for (size_t k = 0; k < 3; ++k)
            corners[k] = &solid.positions[size_t{solid.indices[i + k]} * 3];
        const auto side = [&](size_t k, size_t c) {
            return static_cast<double>(corners[k][c] - corners[0][c]);
        };
        areas[corners[0][0] > 0.22f] += 0.5 * (side(1, 0) * side(2, 1) - side(2, 0) * side(1, 1));
    }
    const double share = 3.14159 * 24 * 24 / (64 * 64);
    EXPECT_NEAR(share * 0.12, areas[0], 0.005);
    EXPECT_NEAR(0.12, areas[1], 1e-6);
}

TEST(ModelSurfaces, CookedScenesKeepTheColoursOfTheirFiles) {
    Yard yard;
    writeBoardRow(yard.folder, "ten", tenMaterials());
    yard.run("import ten.gltf name=Boards materials pine\ncook game\nsnippet game/boards.c\n");
    size_t pictures = 0;
    for (const auto& entry : fs::directory_iterator(yard.folder / "game"))
        pictures += entry.path().extension() == ".rgba";
    EXPECT_EQ(2u, pictures);
    const std::string code = textOf(yard.folder / "game" / "boards.c");
    EXPECT_THAT(code, HasSubstr("def.baseColor[0] = def.baseColor[1] = def.baseColor[2] = 1.0f;"));
    EXPECT_THAT(code, HasSubstr("def.baseColors[2] = scene->colors[0];"));
    EXPECT_THAT(code, HasSubstr("def.baseColors[3] = scene->colors[1];"));
}

// ---- pictures

struct Shot {
    fwimport::FloatPicture picture;
    explicit Shot(const fs::path& file) {
        std::string error;
        EXPECT_TRUE(fwimport::readPicture(file, picture, error)) << error;
    }
    // 0 to 255, mean over a square around a place in [0, 1].
    [[nodiscard]] std::array<double, 3> at(double x, double y) const {
        std::array<double, 3> sum{};
        const auto cx = static_cast<int>(x * picture.width),
                   cy = static_cast<int>(y * picture.height);
        for (int dy = -2; dy <= 2; ++dy)
            for (int dx = -2; dx <= 2; ++dx)
                for (uint32_t c = 0; c < 3; ++c)
                    sum[c] += 255 / 25.0 *
                              static_cast<double>(picture.at(static_cast<uint32_t>(cx + dx),
                                                             static_cast<uint32_t>(cy + dy), c));
        return sum;
    }
    [[nodiscard]] double differenceFrom(const Shot& other) const {  // RMS, in 1/255
        double sum = 0;
        size_t count = 0;
        for (uint32_t y = 0; y < picture.height; ++y)
            for (uint32_t x = 0; x < picture.width; ++x)
                for (uint32_t c = 0; c < 3; ++c, ++count) {
                    const double d = 255.0 * static_cast<double>(picture.at(x, y, c) -
                                                                 other.picture.at(x, y, c));
                    sum += d * d;
                }
        return std::sqrt(sum / static_cast<double>(count));
    }
};

// Places of the boards of a row in a neutral picture from the front: the row fills 0.9 of it.
double placeOf(size_t board, size_t boards) {
    const double length = 0.25 * static_cast<double>(boards) - 0.05;
    return 0.05 + 0.9 * (0.25 * static_cast<double>(board) + 0.1) / length;
}

bool hasDevice(Yard& yard) {
    std::string error;
    return yard.host->device(error) != nullptr;
}

TEST(NeutralStage, TheEditorShowsEachMaterialsColour) {
    Yard yard;
    if (!hasDevice(yard)) GTEST_SKIP() << "no Vulkan device";
    writeBoardRow(yard.folder, "ten", tenMaterials());
    yard.run(
        "import ten.gltf name=Boards materials pine\nshot ten.png 640x160 neutral 0 0\n"
        "set Boards materials noncombustible\nshot stone.png 640x160 neutral 0 0\n");
    for (const char* file : {"ten.png", "stone.png"}) {
        const Shot shot(yard.folder / file);
        const auto colour = [&](size_t board) { return shot.at(placeOf(board, 10), 0.5); };
        EXPECT_GT(colour(7)[0], 3 * colour(7)[1]) << file;  // red
        EXPECT_GT(colour(8)[1], 2 * colour(8)[0]) << file;  // green
        const auto white = colour(9);
        for (const double channel : white) {
            EXPECT_GT(channel, 170) << file;
            EXPECT_NEAR(white[0], channel, 15) << file << ": no tint of the material";
        }
        EXPECT_GT(colour(1)[2], 150) << file;  // blue
        EXPECT_GT(colour(0)[0], 2 * colour(0)[2]) << file;
    }
}

TEST(NeutralStage, SampleAndEditorShowEveryFileEqually) {
    Yard yard;
    if (!hasDevice(yard)) GTEST_SKIP() << "no Vulkan device";
    if (!*fw::test::kBurningMesh) GTEST_SKIP() << "this build has no samples";
    struct Case {
        const char* name;
        std::vector<BoardMaterial> row;
        std::string ofNode{};
        uint32_t grid = 1;
        bool leans = false;
    };
    const std::vector<uint8_t> half = plainPng(200, 60, 30, 128), none = plainPng(200, 60, 30, 0);
    const Case cases[] = {
        {"ten_materials", tenMaterials()},
        {"many_pictures", manyPictures(12)},
        {"flat_colours",
         {{{1, 0, 0}, {}, "", ""},
          {{0, 1, 0}, {}, "", ""},
          {{0, 0, 1}, {}, "", ""},
          {{1, 1, 1}, {}, "", ""}}},
        {"opaque_alpha",
         {{{1, 1, 1}, plainPng(200, 60, 30), "", ""},
          {{1, 1, 1}, half, "", ""},
          {{1, 1, 1}, none, "", ""}}},
        {"cut_outs",
         {{{1, 1, 1}, leavesPng(), ",\"alphaMode\":\"MASK\",\"doubleSided\":true", ""},
          {{0.5f, 0.7f, 1}, leavesPng(), "", ""}}},
        {"specular_glossiness",
         {{{1, 1, 1},
           {},
           ",\"extensions\":{\"KHR_materials_pbrSpecularGlossiness\":{\"diffuseFactor\":"
           "[0.1,0.7,0.2,1]}}",
           ""}}},
        // Each corner position of the first board carries all of the boards.
        {"instances",
         {{{1, 0.2f, 0.2f}, {}, "", ""}, {{0.2f, 0.2f, 1}, {}, "", ""}},
         ",\"extensions\":{\"EXT_mesh_gpu_instancing\":{\"attributes\":{\"TRANSLATION\":0}}}"},
        {"grey", {{{0.8f, 0.8f, 0.8f}, {}, "", ""}}},
        {"skin", {{{0.8f, 0.8f, 0.8f}, {}, "", ""}}, "", 8, true},
    };
    double worst = 0;
    for (const Case& one : cases) {
        const std::string name = one.name;
        writeBoardRow(yard.folder, name, one.row, one.grid, one.ofNode, one.leans);
        yard.run("new\nimport " + name + ".gltf materials pine\nshot " + name +
                 "_editor.png 320x180 neutral 20 10\n");
        const fs::path out = yard.folder / (name + "_sample");
        const std::string command = std::string(fw::test::kBurningMesh) +
                                    " --headless --neutral --no-cache --size 320x180 --yaw 20 "
                                    "--pitch 10 --out " +
                                    out.string() + " " + (yard.folder / (name + ".gltf")).string() +
                                    " > /dev/null";
        ASSERT_EQ(0, std::system(command.c_str())) << command;
        const double difference =
            Shot(yard.folder / (name + "_editor.png")).differenceFrom(Shot(out / "neutral.png"));
        std::printf("%-16s RMS %.2f of 255\n", one.name, difference);
        EXPECT_LE(difference, 3) << name;
        worst = std::max(worst, difference);
    }
    EXPECT_GT(
        Shot(yard.folder / "skin_editor.png").differenceFrom(Shot(yard.folder / "grey_editor.png")),
        10)
        << "its joints bend the board";
    std::printf("worst: %.2f\n", worst);
}

}  // namespace
