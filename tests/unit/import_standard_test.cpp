// Rules of glTF 2.0 for a reader, one per test, on generated files: each gives what the standard
// says, and features that are not shown give a note.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "import/float_picture.h"
#include "import/gltf_import.h"
#include "import/gltf_uri.h"
#include "import/image_decode.h"
#include "unit/gltf_maker.h"

namespace import_standard {
namespace {

namespace fs = std::filesystem;
using fw::test::importRefusal;
using fw::test::loads;
using fw::test::Quad;
using fwimport::AlphaMode;
using fwimport::ImportedModel;
using ::testing::Contains;
using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

std::vector<uint8_t> bytesOf(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

// A one-pixel image as PNG, EXR or TIFF.
std::vector<uint8_t> pictureOf(const std::string& name, const std::vector<float>& pixels,
                               uint32_t width, uint32_t height) {
    fwimport::FloatPicture picture;
    picture.width = width;
    picture.height = height;
    picture.channels = 4;
    picture.whole = name.ends_with("png");
    picture.names = {"R", "G", "B", "A"};
    picture.values = pixels;
    const fs::path file = fs::path(testing::TempDir()) / ("fw_" + name);
    std::string error;
    EXPECT_TRUE(fwimport::writePicture(file, picture, error)) << error;
    std::vector<uint8_t> bytes = bytesOf(file);
    fs::remove(file);
    return bytes;
}

// A quad with an image, UVs and the given material fields.
Quad pictured(const std::vector<uint8_t>& picture, const std::string& material,
              const std::string& texture = R"({"source":0})") {
    Quad quad;
    const int uv = quad.add(std::vector<float>{0, 0, 1, 0, 1, 1, 0, 1}, 5126, "VEC2", 4);
    const int image = quad.add(picture, 5121, "SCALAR", picture.size());
    quad.primitive = R"("attributes":{"POSITION":0,"TEXCOORD_0":)" + std::to_string(uv) +
                     R"(},"indices":1,"material":0)";
    quad.extra += R"(,"materials":[{)" + material + R"(}],"textures":[)" + texture +
                  R"(],"images":[{"mimeType":"image/png","bufferView":)" + std::to_string(image) +
                  "}]";
    return quad;
}
constexpr const char* kTextured =
    R"("pbrMetallicRoughness":{"metallicFactor":0,"baseColorTexture":{"index":0}})";

std::vector<float> repeated(std::vector<float> pixel, size_t count) {
    std::vector<float> result;
    for (size_t i = 0; i < count; ++i) result.insert(result.end(), pixel.begin(), pixel.end());
    return result;
}

// ---- images and alpha

TEST(ImportAlpha, OpaqueMaterialsIgnoreAlpha) {
    for (const float alpha : {1.0f, 0.5f, 0.0f}) {
        ImportedModel model;
        ASSERT_TRUE(loads(
            pictured(pictureOf("a.png", repeated({200 / 255.f, 60 / 255.f, 30 / 255.f, alpha}, 64),
                               8, 8),
                     kTextured)
                .bytes(),
            model));
        ASSERT_EQ(1u, model.images.size());
        EXPECT_NEAR(200, model.images[0].rgba[0], 1) << alpha;
        EXPECT_NEAR(60, model.images[0].rgba[1], 1) << alpha;
        EXPECT_NEAR(30, model.images[0].rgba[2], 1) << alpha;
        EXPECT_NEAR(255 * alpha, model.images[0].rgba[3], 1);
        EXPECT_EQ(AlphaMode::Opaque, model.materials[0].alphaMode);
    }
}

TEST(ImportAlpha, UndoesPremultipliedAlpha) {
    fwimport::DecodedImage image;
    std::string error;
    // EXR stores premultiplied linear light.
    ASSERT_TRUE(fwimport::decodeImage(pictureOf("b.exr", repeated({0.25f, 0.5f, 0, 0.5f}, 4), 2, 2),
                                      image, error))
        << error;
    EXPECT_NEAR(188, image.rgba[0], 1) << "0.5 of light";
    EXPECT_NEAR(255, image.rgba[1], 1);
    EXPECT_NEAR(128, image.rgba[3], 1);
}

TEST(ImportAlpha, WritingKeepsAlpha) {
    const fs::path file = fs::path(testing::TempDir()) / "fw_straight.png";
    const auto bytes = pictureOf("straight.png", repeated({0.5f, 0.25f, 1, 0.25f}, 4), 2, 2);
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
    fwimport::FloatPicture read;
    std::string error;
    ASSERT_TRUE(fwimport::readPicture(file, read, error)) << error;
    EXPECT_NEAR(0.5, read.values[0], 1e-3);
    EXPECT_NEAR(0.25, read.values[1], 1e-3);
    EXPECT_NEAR(0.25, read.values[3], 1e-3);
    fs::remove(file);
}

TEST(ImportAlpha, MaskAndBlendReachTheMaterial) {
    std::vector<float> leaf = repeated({0, 1, 0, 1}, 16);
    for (size_t i = 0; i < 8; ++i) leaf[i * 4 + 3] = 0;
    const auto holes = pictureOf("leaf.png", leaf, 4, 4);
    const auto whole = pictureOf("glass.png", repeated({0, 1, 0, 0.25f}, 16), 4, 4);
    const auto read = [](const std::vector<uint8_t>& picture, const std::string& mode) {
        ImportedModel model;
        EXPECT_TRUE(loads(pictured(picture, kTextured + mode).bytes(), model));
        return model;
    };
    ImportedModel model =
        read(holes, R"(,"alphaMode":"MASK","alphaCutoff":0.3,"doubleSided":true)");
    EXPECT_EQ(AlphaMode::Mask, model.materials[0].alphaMode);
    EXPECT_FLOAT_EQ(0.3f, model.materials[0].alphaCutoff);
    EXPECT_TRUE(model.materials[0].doubleSided);
    EXPECT_THAT(model.notes, IsEmpty());
    model = read(holes, R"(,"alphaMode":"MASK")");
    EXPECT_FLOAT_EQ(0.5f, model.materials[0].alphaCutoff);
    model = read(holes, R"(,"alphaMode":"BLEND")");
    EXPECT_EQ(AlphaMode::Mask, model.materials[0].alphaMode);
    EXPECT_THAT(model.notes, Contains(HasSubstr("BLEND is shown as a cut-out")));
    model = read(whole, R"(,"alphaMode":"BLEND")");
    EXPECT_EQ(AlphaMode::Opaque, model.materials[0].alphaMode);
    EXPECT_THAT(model.notes, Contains(HasSubstr("BLEND is shown opaque")));
}

TEST(ImportAlpha, DropsTrianglesBelowTheCutoff) {
    std::vector<float> leaf = repeated({0, 1, 0, 1}, 16);
    for (size_t i = 0; i < 8; ++i) leaf[i * 4 + 3] = 0;
    const auto holes = pictureOf("leaf.png", leaf, 4, 4);
    const std::string faint =
        R"("pbrMetallicRoughness":{"metallicFactor":0,"baseColorFactor":[1,1,1,0.4],)"
        R"("baseColorTexture":{"index":0}},"alphaMode":")";
    EXPECT_THAT(importRefusal(pictured(holes, faint + R"(MASK")").bytes()),
                HasSubstr("below its alphaCutoff"));
    EXPECT_THAT(importRefusal(pictured(holes, std::string(kTextured) +
                                                  R"(,"alphaMode":"MASK","alphaCutoff":1.5)")
                                  .bytes()),
                HasSubstr("below its alphaCutoff"));
    ImportedModel model;
    ASSERT_TRUE(loads(pictured(holes, faint + R"(BLEND")").bytes(), model));
    EXPECT_FLOAT_EQ(0.2f, model.materials[0].alphaCutoff) << "0.5 of the picture's alpha";
    // The first triangle's corners have no alpha, the second has one with alpha.
    Quad quad;
    const int colors =
        quad.add(std::vector<uint8_t>{255, 0, 0, 0, 255, 0, 0, 0, 255, 0, 0, 0, 255, 0, 0, 255},
                 5121, "VEC4", 4, R"(,"normalized":true)");
    quad.primitive = R"("attributes":{"POSITION":0,"COLOR_0":)" + std::to_string(colors) +
                     R"(},"indices":1,"material":0)";
    quad.extra =
        R"(,"materials":[{"alphaMode":"MASK","pbrMetallicRoughness":{"metallicFactor":0}}])";
    ASSERT_TRUE(loads(quad.bytes(), model));
    EXPECT_EQ(1u, model.triangleCount());
    EXPECT_EQ(3u, model.vertexCount());
    EXPECT_THAT(model.notes, Contains(HasSubstr("alpha of COLOR_0 is left out")));
}

TEST(ImportAlpha, DropsFullyCutOutPrimitives) {
    Quad quad;
    quad.primitive += R"(,"material":0},{"attributes":{"POSITION":0},"indices":1)";
    quad.extra = R"(,"materials":[{"alphaMode":"MASK","pbrMetallicRoughness":{"metallicFactor":0,)"
                 R"("baseColorFactor":[1,1,1,0.2]}}])";
    ImportedModel model;
    ASSERT_TRUE(loads(quad.bytes(), model));
    EXPECT_EQ(2u, model.triangleCount());
    EXPECT_THAT(model.notes,
                Contains(HasSubstr("below its alphaCutoff (meshes[0].primitives[0])")));
}

// ---- skins, morph targets, instances

// Four corners, each with its joint.
Quad skinned(const std::string& skin, const std::vector<float>& matrices,
             std::vector<uint8_t> joints, std::vector<float> weights) {
    Quad quad;
    const int j = quad.add(joints, 5121, "VEC4", 4), w = quad.add(weights, 5126, "VEC4", 4);
    const int m = quad.add(matrices, 5126, "MAT4", matrices.size() / 16);
    quad.primitive = R"("attributes":{"POSITION":0,"JOINTS_0":)" + std::to_string(j) +
                     R"(,"WEIGHTS_0":)" + std::to_string(w) + R"(},"indices":1)";
    quad.extra = R"(,"skins":[{"inverseBindMatrices":)" + std::to_string(m) + "," + skin + "}]";
    return quad;
}

TEST(ImportSkin, PosesAreAppliedByJoints) {
    // Centimetres, lying down, as rigs often are: the armature scales by 0.01 and turns by -90
    // degrees.
    const std::vector<float> unit{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    Quad quad = skinned(R"("joints":[1])", unit, std::vector<uint8_t>(16, 0),
                        {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
    const float corners[] = {-20, 0, 0, 20, 0, 0, 20, 0, 180, -20, 0, 180};
    std::memcpy(quad.glb.binary.data(), corners, sizeof corners);
    quad.node =
        R"({"children":[1],"rotation":[-0.70710678,0,0,0.70710678],"scale":[0.01,0.01,0.01]},)"
        R"({"name":"Root"},{"mesh":0,"skin":0,"translation":[7,7,7]})";
    quad.roots = "0,2";
    ImportedModel model;
    ASSERT_TRUE(loads(quad.bytes(), model));
    EXPECT_NEAR(0, model.low[1], 1e-5);
    EXPECT_NEAR(1.8, model.high[1], 1e-5);
    EXPECT_NEAR(0.4, model.high[0] - model.low[0], 1e-5);
    EXPECT_NEAR(0, model.high[2] - model.low[2], 1e-5);
    EXPECT_THAT(model.notes, Each(Not(HasSubstr("bind pose"))));
}

TEST(ImportSkin, WeightsMixJointsAndAreNormalised) {
    std::vector<float> matrices{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    matrices.insert(matrices.end(), matrices.begin(), matrices.end());
    matrices[16 + 12] = -5;  // the second joint's inverse bind matrix
    Quad quad =
        skinned(R"("joints":[1,2])", matrices, {0, 9, 9, 9, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0},
                {1, 0, 0, 0, 1, 0, 0, 0, 2, 2, 0, 0, 0, 0, 0, 0});
    quad.node = R"({"mesh":0,"skin":0,"children":[1,2]},{"translation":[0,0,1]},)"
                R"({"translation":[15,0,0]})";
    ImportedModel model;
    ASSERT_TRUE(loads(quad.bytes(), model));
    const auto corner = [&](size_t i) {
        return std::vector<float>(model.positions.begin() + long(3 * i),
                                  model.positions.begin() + long(3 * i) + 3);
    };
    EXPECT_EQ((std::vector<float>{0, 0, 1}), corner(0)) << "a joint of weight 0 may be any number";
    EXPECT_EQ((std::vector<float>{11, 0, 0}), corner(1)) << "15 - 5 + 1";
    EXPECT_EQ((std::vector<float>{6, 1, 0.5f}), corner(2)) << "half of each";
    EXPECT_EQ((std::vector<float>{0, 1, 1}), corner(3)) << "no weights: the first joint";
    quad.glb.binary[60] = 7;
    EXPECT_THAT(importRefusal(quad.bytes()), HasSubstr("JOINTS names joint 7; skins[0] has 2"));
}

TEST(ImportMorph, DefaultWeightsShapeTheMesh) {
    Quad quad;
    const int delta =
        quad.add(std::vector<float>{0, 0, 4, 0, 0, 4, 0, 0, 4, 0, 0, 4}, 5126, "VEC3", 4);
    quad.primitive += R"(,"targets":[{"POSITION":)" + std::to_string(delta) + "}]";
    ImportedModel model;
    ASSERT_TRUE(loads(quad.bytes(), model));
    EXPECT_FLOAT_EQ(0, model.high[2]);
    quad.node = R"({"mesh":0,"weights":[0.25]})";
    ASSERT_TRUE(loads(quad.bytes(), model));
    EXPECT_FLOAT_EQ(1, model.low[2]);
    EXPECT_FLOAT_EQ(1, model.high[2]);
}

TEST(ImportInstancing, ImportsEveryInstance) {
    Quad quad;
    std::vector<float> places, turns, sizes;
    for (int i = 0; i < 125; ++i) {
        places.insert(places.end(), {2.0f * float(i), 0, 0});
        turns.insert(turns.end(), {0, 0, 1, 0});  // half a turn about z
        sizes.insert(sizes.end(), {1, i == 124 ? -3.0f : 1.0f, 1});
    }
    const int t = quad.add(places, 5126, "VEC3", 125), r = quad.add(turns, 5126, "VEC4", 125);
    const int s = quad.add(sizes, 5126, "VEC3", 125);
    quad.node = R"({"mesh":0,"translation":[0,10,0],"extensions":{"EXT_mesh_gpu_instancing":)"
                R"({"attributes":{"TRANSLATION":)" +
                std::to_string(t) + R"(,"ROTATION":)" + std::to_string(r) + R"(,"SCALE":)" +
                std::to_string(s) + "}}}}";
    ImportedModel model;
    ASSERT_TRUE(loads(quad.bytes(), model));
    EXPECT_EQ(125u, model.parts);
    EXPECT_EQ(250u, model.triangleCount());
    EXPECT_NEAR(-1, model.low[0], 1e-5);
    EXPECT_NEAR(248, model.high[0], 1e-4);
    EXPECT_NEAR(9, model.low[1], 1e-5);
    EXPECT_NEAR(13, model.high[1], 1e-5);
    // The mirrored instance keeps its winding.
    EXPECT_EQ(124u * 4 + 2, model.indices[124 * 6 + 1]);
    EXPECT_THAT(model.notes, IsEmpty());

    Quad odd;
    const int three = odd.add(std::vector<float>(9), 5126, "VEC3", 3);
    const int two = odd.add(std::vector<float>(6), 5126, "VEC3", 2);
    odd.node =
        R"({"mesh":0,"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":)" +
        std::to_string(three) + R"(,"SCALE":)" + std::to_string(two) + "}}}}";
    EXPECT_THAT(importRefusal(odd.bytes()), HasSubstr("SCALE has 2 elements; the others have 3"));
}

// ---- materials

TEST(ImportMaterial, ConvertsSpecularGlossiness) {
    const auto read = [](const std::string& fields) {
        Quad quad;
        quad.primitive += R"(,"material":0)";
        quad.extra = R"(,"materials":[{"extensions":{"KHR_materials_pbrSpecularGlossiness":{)" +
                     fields +
                     R"(}}}],"extensionsRequired":["KHR_materials_pbrSpecularGlossiness"])";
        ImportedModel model;
        EXPECT_TRUE(loads(quad.bytes(), model));
        return model.materials.at(0);
    };
    auto made = read(R"("diffuseFactor":[0.05,0.6,0.1,1])");
    EXPECT_FLOAT_EQ(0.05f, made.baseColor[0]);
    EXPECT_FLOAT_EQ(0.6f, made.baseColor[1]);
    EXPECT_FLOAT_EQ(0, made.roughness);
    made =
        read(R"("diffuseFactor":[0,0,0,1],"specularFactor":[0.9,0.6,0.2],"glossinessFactor":0.7)");
    EXPECT_FLOAT_EQ(0.9f, made.baseColor[0]) << "a metal has its colour in the reflection";
    EXPECT_FLOAT_EQ(0.3f, made.roughness);
    made = read(R"("diffuseFactor":[0.4,0.5,0.6,1],"specularFactor":[0.04,0.04,0.04])");
    EXPECT_FLOAT_EQ(0.6f, made.baseColor[2]);

    const auto picture = pictureOf("diffuse.png", repeated({1, 0.5f, 0, 1}, 4), 2, 2);
    ImportedModel model;
    ASSERT_TRUE(loads(pictured(picture, R"("extensions":{"KHR_materials_pbrSpecularGlossiness":)"
                                        R"({"diffuseTexture":{"index":0}}})")
                          .bytes(),
                      model));
    ASSERT_EQ(0, model.materials[0].image);
    EXPECT_EQ(255, model.images[0].rgba[0]);
}

TEST(ImportMaterial, NotesEveryUnsupportedChannelOnce) {
    Quad quad;
    quad.primitive += R"(,"material":0},{"attributes":{"POSITION":0},"indices":1,"material":1)";
    quad.extra = R"(,"materials":[{"normalTexture":{"index":0},"emissiveFactor":[1,0,0]},)"
                 R"({"normalTexture":{"index":0},"extensions":{"KHR_materials_clearcoat":{}}}],)"
                 R"("textures":[{}],"animations":[{},{}],"cameras":[{}],)"
                 R"("extensions":{"KHR_lights_punctual":{"lights":[]}})";
    ImportedModel model;
    ASSERT_TRUE(loads(quad.bytes(), model));
    EXPECT_THAT(model.notes, ::testing::UnorderedElementsAre(
                                 "normalTexture is left out (materials[0] and 1 more)",
                                 "emissiveFactor is left out (materials[0])",
                                 "KHR_materials_clearcoat is left out (materials[1])",
                                 "KHR_lights_punctual is left out (the root)",
                                 "animations (2) are left out: the rest pose is shown",
                                 "cameras (1) are left out"));
}

TEST(ImportMaterial, AppliesClampAndMirrorWrapModes) {
    // Four columns: 0, 80, 160, 240 of red.
    std::vector<float> columns;
    for (int y = 0; y < 2; ++y)
        for (int x = 0; x < 4; ++x) columns.insert(columns.end(), {float(80 * x) / 255, 0, 0, 1});
    const auto picture = pictureOf("s.png", columns, 4, 2);
    const auto read = [&](const std::string& sampler, float from, float to) {
        Quad quad = pictured(picture, kTextured, R"({"source":0,"sampler":0})");
        quad.extra += R"(,"samplers":[{)" + sampler + "}]";
        const float uvs[] = {from, 0, to, 0, to, 1, from, 1};
        std::memcpy(quad.glb.binary.data() + 60, uvs, sizeof uvs);
        ImportedModel model;
        EXPECT_TRUE(loads(quad.bytes(), model));
        return model;
    };
    // The nearest texel of the imported (repeating) image at a UV of the file.
    const auto redAt = [](const ImportedModel& model, double u, double from, double to) {
        const double share = (u - from) / (to - from);
        const double own = double(model.uvs[0]) + share * double(model.uvs[2] - model.uvs[0]);
        const auto& image = model.images.at(0);
        const double column = (own - std::floor(own)) * image.width;
        return int(image.rgba[4 * size_t(column)]);
    };
    ImportedModel model = read(R"("wrapS":33071,"wrapT":33648)", 0, 1);
    EXPECT_EQ(4u, model.images[0].width) << "no UV is beyond the edge";
    model = read(R"("wrapS":33071)", -1, 3);
    EXPECT_EQ(0, redAt(model, -0.9, -1, 3));
    EXPECT_EQ(80, redAt(model, 0.3, -1, 3));
    EXPECT_EQ(240, redAt(model, 2.9, -1, 3));
    EXPECT_EQ(2u, model.images[0].height);
    model = read(R"("wrapS":33648)", 0, 6);
    EXPECT_EQ(8u, model.images[0].width);
    EXPECT_EQ(80, redAt(model, 0.3, 0, 6));
    EXPECT_EQ(160, redAt(model, 1.3, 0, 6));
    EXPECT_EQ(80, redAt(model, 2.3, 0, 6));
    EXPECT_EQ(160, redAt(model, 5.3, 0, 6));
    EXPECT_THAT(model.notes, IsEmpty());
    model = read(R"("wrapS":33071)", 0, 1e5f);
    EXPECT_THAT(model.notes, Contains(HasSubstr("are shown as REPEAT")));
    model = read(R"("magFilter":9728,"minFilter":9986)", 0, 1);
    EXPECT_THAT(model.notes,
                ::testing::ElementsAre("magFilter NEAREST is shown as LINEAR (samplers[0])",
                                       "minFilter NEAREST is shown as LINEAR (samplers[0])"));
    model = read(R"("wrapS":7)", 0, 1);
    EXPECT_THAT(model.notes, Contains(HasSubstr("samplers[0].wrapS is 7")));
}

TEST(ImportMaterial, TextureTransformScalesRotatesThenTranslates) {
    const auto picture = pictureOf("t.png", repeated({1, 0.5f, 0, 1}, 4), 2, 2);
    Quad quad = pictured(picture,
                         R"("pbrMetallicRoughness":{"baseColorTexture":{"index":0,"texCoord":3,)"
                         R"("extensions":{"KHR_texture_transform":{"offset":[10,20],"scale":[2,4],)"
                         R"("rotation":1.5707963267948966,"texCoord":0}}}})");
    ImportedModel model;
    ASSERT_TRUE(loads(quad.bytes(), model));
    // (1, 1) scaled is (2, 4); a quarter turn gives (4, -2).
    EXPECT_NEAR(14, model.uvs[4], 1e-5);
    EXPECT_NEAR(18, model.uvs[5], 1e-5);
}

TEST(ImportMaterial, UsesTheImageThatCanBeDecoded) {
    const auto picture = pictureOf("w.png", repeated({1, 0.5f, 0, 1}, 4), 2, 2);
    ImportedModel model;
    for (const char* texture : {R"({"extensions":{"EXT_texture_webp":{"source":0}}})",
                                R"({"source":0,"extensions":{"KHR_texture_basisu":{"source":1}}})",
                                R"({"source":0,"extensions":{"EXT_texture_webp":{"source":1}}})"}) {
        Quad quad = pictured(picture, kTextured, texture);
        quad.extra.insert(quad.extra.size() - 1, R"(,{"uri":"data:image/webp;base64,AAAA"})");
        ASSERT_TRUE(loads(quad.bytes(), model));
        EXPECT_EQ(0, model.materials[0].image) << texture;
    }
    Quad quad =
        pictured(picture, kTextured, R"({"extensions":{"KHR_texture_basisu":{"source":1}}})");
    quad.extra.insert(quad.extra.size() - 1,
                      R"(,{"uri":"data:image/ktx2;base64,q0tUWCAyMLsNChoK"})");
    ASSERT_TRUE(loads(quad.bytes(), model));
    EXPECT_EQ(-1, model.materials[0].image);
    EXPECT_THAT(model.notes,
                Contains("images[1] is left out: it is KTX; convert it to PNG or JPEG"));
}

TEST(ImportMaterial, SmallImagesAreNotEnlargedWithoutLimit) {
    Quad quad = pictured(pictureOf("dot.png", {1, 0, 0, 1}, 1, 1), kTextured,
                         R"({"source":0,"sampler":0})");
    quad.extra += R"(,"samplers":[{"wrapS":33071,"wrapT":33071}])";
    const float uvs[] = {0, 0, 8000, 0, 8000, 8000, 0, 8000};
    std::memcpy(quad.glb.binary.data() + 60, uvs, sizeof uvs);
    ImportedModel model;
    ASSERT_TRUE(loads(quad.bytes(), model));
    EXPECT_EQ(1u, model.images.at(0).width) << "one pixel must not need 256 MiB";
    EXPECT_THAT(model.notes, Contains(HasSubstr("reach too far beyond the picture")));
}

// ---- memory

// `count` instances at zero, which need no bytes of the file.
std::vector<uint8_t> instanced(const std::string& count) {
    Quad quad;
    quad.accessors += R"(,{"componentType":5126,"count":)" + count + R"(,"type":"VEC3"})";
    quad.node = R"({"mesh":0,"extensions":{"EXT_mesh_gpu_instancing":{"attributes":)"
                R"({"TRANSLATION":2}}}})";
    return quad.bytes();
}

TEST(ImportMemory, AFewBytesMakeNoHugeModel) {
    ImportedModel model;
    ASSERT_TRUE(loads(instanced("1000"), model));
    EXPECT_EQ(1000u, model.parts);
    EXPECT_THAT(importRefusal(instanced("5000000")),
                HasSubstr("accessors[2] (nodes[0].extensions.EXT_mesh_gpu_instancing.attributes"
                          ".TRANSLATION) has 5000000 x 3 numbers; the memory left for"));
    EXPECT_THAT(importRefusal(instanced("1500000")),
                HasSubstr("meshes[0].primitives[0] brings the memory of the model to"));

    Quad sparse;
    const int places = sparse.add(std::vector<uint32_t>{0, 1, 2}, 5125, "SCALAR", 3);
    const int values = sparse.add(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0}, 5126, "VEC3", 3);
    sparse.positionAccessor =
        R"({"componentType":5126,"count":16777216,"type":"VEC3","sparse":{"count":3,"indices":)"
        R"({"bufferView":)" +
        std::to_string(places) + R"(,"componentType":5125},"values":{"bufferView":)" +
        std::to_string(values) + "}}}";
    EXPECT_THAT(importRefusal(sparse.bytes()), HasSubstr("accessors[0]"));
}

// A file with `images` images of one picture, each used by a material and a triangle pair.
std::vector<uint8_t> repeatedImages(const std::vector<uint8_t>& picture, int images) {
    Quad quad;
    const int view = quad.add(picture, 5121, "SCALAR", picture.size());
    std::string materials, textures, list;
    quad.primitive += R"(,"material":0)";
    for (int i = 0; i < images; ++i) {
        const std::string comma = i ? "," : "", number = std::to_string(i);
        materials += comma + R"({"alphaMode":"BLEND","pbrMetallicRoughness":{"metallicFactor":0,)" +
                     R"("baseColorTexture":{"index":)" + number + "}}}";
        textures += comma + R"({"source":)" + number + "}";
        list += comma + R"({"mimeType":"image/png","bufferView":)" + std::to_string(view) + "}";
        if (i)
            quad.primitive += R"(},{"attributes":{"POSITION":0},"indices":1,"material":)" + number;
    }
    quad.extra = R"(,"materials":[)" + materials + R"(],"textures":[)" + textures +
                 R"(],"images":[)" + list + "]";
    return quad.bytes();
}

TEST(ImportMemory, ImagesOfOnePictureShareTheLimitOfTheFile) {
    constexpr uint32_t kSide = 1200;
    const auto picture =
        pictureOf("w.png", repeated({1, 0.5f, 0, 1}, size_t{kSide} * kSide), kSide, kSide);
    const std::vector<uint8_t> bytes = repeatedImages(picture, 60);
    ASSERT_LT(bytes.size(), 500000u);
    ImportedModel model;
    ASSERT_TRUE(loads(bytes, model));
    ASSERT_EQ(60u, model.materials.size());
    EXPECT_GT(model.images.size(), 8u);
    EXPECT_LE(model.images.size() * kSide * kSide * 4, fwimport::mostUnpacked(bytes.size()));
    EXPECT_THAT(model.notes, Contains(HasSubstr("images[59] is left out: its 1200 x 1200 pixels "
                                                "take 17280000 bytes of memory")));
}

TEST(ImportMemory, SmallFilesOfLargePicturesAreRefused) {
    // The header of a lossless WebP: sides less one, 14 bits each.
    const std::string header("RIFF\x20\0\0\0WEBPVP8L\x14\0\0\0\x2f\xff\xdf\xff\x07", 25);
    std::vector<uint8_t> webp(header.begin(), header.end());
    webp.resize(40);
    fwimport::DecodedImage image;
    std::string error;
    EXPECT_FALSE(fwimport::decodeImage(webp, image, error));
    EXPECT_THAT(error, HasSubstr("its 8192 x 8192 pixels take 805306368 bytes of memory; the limit "
                                 "for a file of its size is 251658240"));
}

// ---- extensions

TEST(ImportExtensions, AcceptsRequiredExtensionsThatDoNotShapeTheMesh) {
    for (const char* name :
         {"KHR_lights_punctual", "KHR_materials_clearcoat", "KHR_materials_emissive_strength",
          "KHR_materials_ior", "KHR_materials_pbrSpecularGlossiness", "KHR_materials_specular",
          "KHR_materials_transmission", "KHR_materials_variants", "EXT_texture_webp",
          "KHR_texture_basisu", "VENDOR_of_tomorrow"}) {
        Quad quad;
        quad.primitive += R"(,"material":0)";
        quad.extra = R"(,"materials":[{"extensions":{")" + std::string(name) +
                     R"(":{}}}],"extensionsRequired":[")" + name + R"("])";
        ImportedModel model;
        ASSERT_TRUE(loads(quad.bytes(), model)) << name;
        EXPECT_EQ(2u, model.triangleCount());
        const bool read =
            std::string(name).ends_with("Glossiness") || std::string(name).ends_with("webp");
        if (!read) {
            EXPECT_THAT(model.notes, Contains(HasSubstr(name)));
        }
        quad = Quad();
        quad.extra = R"(,"extensionsRequired":[")" + std::string(name) + R"("])";
        EXPECT_TRUE(loads(quad.bytes(), model)) << "also where nothing uses it";
    }
    Quad quad;
    quad.primitive += R"(,"extensions":{"VENDOR_triangles":{}})";
    quad.extra = R"(,"extensionsRequired":["VENDOR_triangles"])";
    EXPECT_THAT(importRefusal(quad.bytes()),
                HasSubstr("VENDOR_triangles, which meshes[0].primitives[0] uses"));
}

TEST(ImportExtensions, OmitsHiddenNodes) {
    Quad quad;
    quad.node = R"({"mesh":0,"children":[1]},{"mesh":0,"translation":[5,0,0],"children":[2],)"
                R"("extensions":{"KHR_node_visibility":{"visible":false}}},{"mesh":0})";
    ImportedModel model;
    ASSERT_TRUE(loads(quad.bytes(), model));
    EXPECT_EQ(2u, model.triangleCount());
    EXPECT_THAT(model.notes, Contains(HasSubstr("KHR_node_visibility hides it (nodes[1] and 1")));
}

// ---- numbers

TEST(ImportNumbers, AcceptsIntegersWrittenAsFloats) {
    Quad quad;
    quad.indexAccessor = R"({"bufferView":1.0,"componentType":5123.0,"count":6e0,"type":"SCALAR"})";
    ImportedModel model;
    quad.node = R"({"mesh":0,"skin":-1})";
    ASSERT_TRUE(loads(quad.bytes(), model)) << "-1 is no skin";
    EXPECT_EQ(2u, model.triangleCount());
}

TEST(ImportNumbers, QuantizedPositionsAndNormalsAreScaled) {
    Quad quad;
    const int p = quad.add(std::vector<int16_t>{-32768, 0, 0, 0, 32767, 0, 0, 0, 0, 32767, 0, 0},
                           5122, "VEC3", 4, R"(,"normalized":true)");
    const int n =
        quad.add(std::vector<int8_t>{0, 0, 127, 0, 0, 0, 127, 0, 0, 0, 127, 0, 0, 0, 127, 0}, 5120,
                 "VEC3", 4, R"(,"normalized":true)");
    const std::string stride = R"(,"byteStride":4)";
    quad.views.insert(quad.views.size() - 1, stride);
    quad.primitive = R"("attributes":{"POSITION":)" + std::to_string(p) + R"(,"NORMAL":)" +
                     std::to_string(n) + R"(},"indices":1)";
    quad.extra = R"(,"extensionsRequired":["KHR_mesh_quantization"])";
    ImportedModel model;
    ASSERT_TRUE(loads(quad.bytes(), model));
    EXPECT_FLOAT_EQ(-1, model.low[0]) << "-32768 is -1, too";
    EXPECT_FLOAT_EQ(1, model.high[1]);
    EXPECT_FLOAT_EQ(1, model.normals[2]);
}

TEST(ImportNumbers, IndicesBeyond32BitsDoNotWrapAround) {
    Quad quad;
    quad.positionAccessor =
        R"({"bufferView":4294967296,"componentType":5126,"count":4,"type":"VEC3"})";
    EXPECT_THAT(importRefusal(quad.bytes()), HasSubstr("bufferView is 4294967296; there are 2"));
    const auto picture = pictureOf("w.png", repeated({1, 0, 0, 1}, 4), 2, 2);
    quad = pictured(picture, R"("pbrMetallicRoughness":{"baseColorTexture":{"index":0,)"
                             R"("texCoord":4294967296}})");
    ImportedModel model;
    ASSERT_TRUE(loads(quad.bytes(), model));
    EXPECT_THAT(model.notes, Contains(HasSubstr("there is no TEXCOORD_4294967296")));
    quad = pictured(picture, kTextured);
    quad.extra =
        quad.extra.substr(0, quad.extra.find(R"("bufferView")")) + R"("bufferView":4294967299}])";
    ASSERT_TRUE(loads(quad.bytes(), model));
    EXPECT_TRUE(model.images.empty());
    EXPECT_THAT(model.notes, Contains(HasSubstr("bufferView is 4294967299")));
}

TEST(ImportNumbers, DropsUnusedVertices) {
    Quad quad({0, 1, 2, 0, 1, 2});
    const float far[] = {std::nanf(""), 900, 0};
    std::memcpy(quad.glb.binary.data() + 36, far, sizeof far);  // the fourth
    ImportedModel model;
    ASSERT_TRUE(loads(quad.bytes(), model));
    EXPECT_EQ(3u, model.vertexCount());
    EXPECT_EQ(1, model.high[1]);
    EXPECT_THAT(model.indices, ::testing::ElementsAre(0, 1, 2, 0, 1, 2));
}

TEST(ImportNumbers, NotesEmptyPrimitivesAndUnusedMeshes) {
    Quad quad;
    const int empty = quad.add(std::vector<float>(3), 5126, "VEC3", 0);
    quad.primitive += R"(},{"attributes":{"POSITION":)" + std::to_string(empty) + "}";
    ImportedModel model;
    ASSERT_TRUE(loads(quad.bytes(), model));
    EXPECT_EQ(2u, model.triangleCount());
    EXPECT_THAT(model.notes, Contains(HasSubstr(".count of 0 (meshes[0].primitives[1])")));
    quad = Quad();
    quad.primitive += R"(}]},{"primitives":[{"attributes":{"POSITION":0},"indices":1)";
    ASSERT_TRUE(loads(quad.bytes(), model));
    EXPECT_EQ(2u, model.triangleCount());
    EXPECT_THAT(model.notes, Contains("mesh is left out: no node shows it (meshes[1])"));
    quad = Quad();
    quad.node += R"(,{"children":[2]},{"mesh":0})";
    ASSERT_TRUE(loads(quad.bytes(), model));
    EXPECT_THAT(model.notes, Contains("node is left out: no scene holds it (nodes[2])"));
}

TEST(ImportNumbers, RepeatedSceneNodesAreImportedOnce) {
    Quad quad;
    quad.node =
        R"({"mesh":0,"translation":[2,0,0]},{"mesh":0,"translation":[1,0,0],"children":[0]})";
    quad.roots = "0,1,1";
    ImportedModel model;
    ASSERT_TRUE(loads(quad.bytes(), model));
    EXPECT_EQ(4u, model.triangleCount());
    EXPECT_EQ(4, model.high[0]) << "the child stands where its parent puts it";
    EXPECT_THAT(model.notes,
                Contains("scene's second mention of a node is left out (nodes[1] and 1 more)"));
}

TEST(ImportNumbers, AttributesWithoutValuesAreZero) {
    Quad quad;
    quad.accessors = R"(,{"componentType":5126,"count":4,"type":"VEC3"})";
    quad.primitive = R"("attributes":{"POSITION":0,"COLOR_0":2},"indices":1)";
    ImportedModel model;
    ASSERT_TRUE(loads(quad.bytes(), model));
    EXPECT_EQ(0xff000000u, model.colors[0]);
}

TEST(ImportNumbers, ComputesOnlyMissingNormals) {
    Quad quad;
    const int n = quad.add(std::vector<float>{1, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 0}, 5126, "VEC3", 4);
    quad.primitive = R"("attributes":{"POSITION":0,"NORMAL":)" + std::to_string(n) +
                     R"(},"indices":1},{"attributes":{"POSITION":0},"indices":1)";
    ImportedModel model;
    ASSERT_TRUE(loads(quad.bytes(), model));
    EXPECT_TRUE(model.hasNormals);
    EXPECT_FLOAT_EQ(1, model.normals[0]);
    EXPECT_FLOAT_EQ(1, model.normals[3 * 3 + 2]) << "the normal of zero length";
    EXPECT_FLOAT_EQ(1, model.normals[4 * 3 + 2]) << "the primitive without normals";
    EXPECT_THAT(model.notes, Contains("1 normals have no length: they are computed"));
    EXPECT_THAT(model.notes, Contains("1 primitives have no normals: they are computed"));
}

TEST(ImportNumbers, NotesNodesThatFlattenAMeshToALine) {
    Quad quad;
    quad.node = R"({"mesh":0,"children":[1]},{"mesh":0,"scale":[0,0,0]})";
    ImportedModel model;
    ASSERT_TRUE(loads(quad.bytes(), model));
    EXPECT_EQ(2u, model.triangleCount());
    EXPECT_THAT(model.notes, Contains(HasSubstr("squeezes it onto a line")));
    quad.node = R"({"mesh":0,"scale":[1,1,0]})";
    ASSERT_TRUE(loads(quad.bytes(), model));
    EXPECT_THAT(model.notes, IsEmpty()) << "flat is fine";
}

// ---- containers and URIs

std::vector<uint8_t> words(const std::vector<uint32_t>& values) {
    std::vector<uint8_t> bytes(values.size() * 4);
    std::memcpy(bytes.data(), values.data(), bytes.size());
    return bytes;
}

TEST(ImportGlb, ChunksMayBePaddedAndUnknownOnesAreSkipped) {
    const std::vector<uint8_t> good = Quad().bytes();
    uint32_t json = 0;
    std::memcpy(&json, &good[12], 4);
    const auto sized = [](std::vector<uint8_t> bytes) {
        const auto length = static_cast<uint32_t>(bytes.size());
        std::memcpy(&bytes[8], &length, 4);
        return bytes;
    };
    ImportedModel model;
    // A chunk of another kind before the binary chunk and one after it.
    std::vector<uint8_t> more = good;
    const std::vector<uint8_t> other = words({8, 0x12345678u, 1, 2});
    more.insert(more.begin() + 20 + long(json), other.begin(), other.end());
    more.insert(more.end(), other.begin(), other.end());
    EXPECT_TRUE(loads(sized(more), model));
    // JSON padded with zeros, with uncounted padding, without padding.
    std::vector<uint8_t> zeros = good;
    for (size_t i = 20 + json; zeros[--i] == ' ';) zeros[i] = 0;
    EXPECT_TRUE(loads(zeros, model));
    for (const bool padded : {true, false}) {
        std::vector<uint8_t> uncounted = good;
        uncounted.insert(uncounted.begin() + 20 + long(json), padded ? 4 : 2, ' ');
        const uint32_t size = json + 2;
        std::memcpy(&uncounted[12], &size, 4);
        EXPECT_TRUE(loads(sized(uncounted), model)) << padded;
    }
    // Bytes after the end given by the header are ignored.
    std::vector<uint8_t> longer = good;
    longer.insert(longer.end(), 100, 0xff);
    EXPECT_TRUE(loads(longer, model));
    // Names that are not UTF-8.
    std::vector<uint8_t> latin = good;
    const std::string_view text(reinterpret_cast<const char*>(latin.data()), latin.size());
    latin[text.find("\"mesh\"") + 2] = 0xe9;
    EXPECT_THAT(importRefusal(latin), HasSubstr("no triangle")) << "the field has another name";
    EXPECT_THAT(importRefusal(latin), HasSubstr("not all UTF-8"));
}

class ImportUri : public testing::Test {
 protected:
    void SetUp() override {
        folder_ = fs::path(testing::TempDir()) / "fw_uri_test";
        fs::remove_all(folder_);
        fs::create_directories(folder_ / "sub");
    }
    void TearDown() override { fs::remove_all(folder_); }
    void put(const std::string& name) const { std::ofstream(folder_ / name) << name; }
    [[nodiscard]] std::string read(const std::string& uri, const char* below = "") const {
        try {
            const auto bytes = fwimport::readUri(uri, folder_ / below, "images[0].uri").bytes;
            return {bytes.begin(), bytes.end()};
        } catch (const std::exception& failure) {
            return std::string("!") + failure.what();
        }
    }
    fs::path folder_;
};

TEST_F(ImportUri, DecodesUris) {
    for (const char* name : {"a b.png", "wood.png", "50%.png", "what?.png", "no#1.png", "%41.png",
                             "sub/in.png", "grün.png", "A.png"})
        put(name);
    EXPECT_EQ("a b.png", read("a%20b.png"));
    EXPECT_EQ("a b.png", read("a b.png"));
    EXPECT_EQ("wood.png", read("./wood.png"));
    EXPECT_EQ("wood.png", read("wood.png?version=2#top"));
    EXPECT_EQ("50%.png", read("50%.png"));
    EXPECT_EQ("50%.png", read("50%25.png"));
    EXPECT_EQ("what?.png", read("what%3F.png"));
    EXPECT_EQ("what?.png", read("what?.png"));
    EXPECT_EQ("no#1.png", read("no#1.png"));
    EXPECT_EQ("A.png", read("%41.png")) << "the standard's reading comes first";
    EXPECT_EQ("grün.png", read("gr%C3%BCn.png"));
    EXPECT_EQ("sub/in.png", read("sub/in.png"));
    EXPECT_EQ("sub/in.png", read("sub\\in.png"));
    EXPECT_EQ("wood.png", read("../wood.png", "sub"));
    EXPECT_TRUE(fwimport::readUri("../wood.png", folder_ / "sub", "u").outside);
    EXPECT_FALSE(fwimport::readUri("sub/../wood.png", folder_, "u").outside);
}

TEST_F(ImportUri, ReadsEveryKindOfDataUri) {
    EXPECT_EQ("Hi!", read("data:application/octet-stream;base64,SGkh"));
    EXPECT_EQ("Hi!", read("DATA:;Base64,SGkh"));
    EXPECT_EQ("Hi", read("data:image/png;name=x;base64,SGk="));
    EXPECT_EQ("Hi", read("data:image/png;base64,SG%6B%3D"));
    EXPECT_EQ("a b", read("data:,a%20b"));
    EXPECT_THAT(read("data:image/png;base64,S*kh"), HasSubstr("character 1 of its base64"));
    EXPECT_THAT(read("data:image/png;base64"), HasSubstr("without a comma"));
}

TEST_F(ImportUri, RefusesUrisOutsideTheFolder) {
    EXPECT_THAT(read("."), HasSubstr("images[0].uri \".\" is a folder"));
    EXPECT_THAT(read("sub/"), HasSubstr("is a folder"));
    EXPECT_THAT(read(""), HasSubstr("is empty"));
    EXPECT_THAT(read("gone.png"), HasSubstr("\"gone.png\" does not exist"));
    EXPECT_THAT(read("/etc/passwd"), HasSubstr("is absolute"));
    EXPECT_THAT(read("file:///etc/passwd"), HasSubstr("is absolute"));
    EXPECT_THAT(read("http://example.com/a.png"), HasSubstr("is absolute"));
    EXPECT_THAT(read("C:\\art\\a.png"), HasSubstr("is absolute"));
    EXPECT_THAT(read("a%00.png"), HasSubstr("zero byte"));
    EXPECT_THAT(read("../../../../../../../../dev/zero"), HasSubstr("is no regular file"));
}

TEST(Import, OmitsAnImageThatIsAFolder) {
    Quad quad;
    quad.extra = R"(,"images":[{"uri":"."}])";
    ImportedModel model;
    ASSERT_TRUE(loads(quad.bytes(), model));
    EXPECT_EQ(2u, model.triangleCount());
    EXPECT_THAT(model.notes, Contains(HasSubstr("images[0]")));
    quad = pictured({1, 2, 3, 4}, kTextured);
    quad.extra = quad.extra.substr(0, quad.extra.find(R"("images")")) + R"("images":[{"uri":"."}])";
    ASSERT_TRUE(loads(quad.bytes(), model));
    EXPECT_THAT(model.notes,
                Contains(HasSubstr("images[0] is left out: images[0].uri \".\" is a folder")));
}

}  // namespace
}  // namespace import_standard
