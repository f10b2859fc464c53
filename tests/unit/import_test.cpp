// The glTF importer: files that must load or be refused, messages, damaged bytes. Files of
// assimp-testmodels run where that package is installed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "import/gltf_import.h"
#include "support/sanitized.h"
#include "unit/gltf_maker.h"

namespace import_files {
namespace {

using fw::test::importRefusal;
using fw::test::loads;
using fw::test::Quad;
using fwimport::ImportedModel;
using ::testing::HasSubstr;

const std::filesystem::path kModels = "/usr/share/assimp/models/glTF2";

TEST(Import, QuadLoadsWithItsTransform) {
    Quad quad;
    quad.node = R"({"mesh":0,"translation":[10,0,0],"scale":[2,2,2]})";
    ImportedModel model;
    ASSERT_TRUE(loads(quad.bytes(), model));
    EXPECT_EQ(4u, model.vertexCount());
    EXPECT_EQ((std::vector<uint32_t>{0, 1, 2, 0, 2, 3}), model.indices);
    EXPECT_FLOAT_EQ(10.0f, model.low[0]);
    EXPECT_FLOAT_EQ(12.0f, model.high[0]);
    EXPECT_FLOAT_EQ(2.0f, model.high[1]);
    EXPECT_FALSE(model.hasNormals);
    EXPECT_FALSE(model.hasUvs);
    ASSERT_EQ(1u, model.materials.size());
    EXPECT_EQ(model.triangleCount(), model.triangleMaterials.size());
}

TEST(Import, AppliesParentTransforms) {
    Quad quad;
    quad.node = R"({"name":"root","translation":[1,2,3],"children":[1,2]},)"
                R"({"name":"arm","mesh":0,"rotation":[0,0.70710678,0,0.70710678],"children":[3]},)"
                R"({"name":"left","mesh":0,"translation":[5,0,0]},)"
                R"({"translation":[0,0,2]},{"name":"elsewhere"})";
    ImportedModel model;
    std::string error;
    ASSERT_TRUE(fwimport::importGltfBytes(quad.bytes(), "quad", "", model, error)) << error;
    EXPECT_EQ(4u, model.triangleCount());
    ASSERT_EQ(5u, model.nodes.size());
    EXPECT_EQ(1, model.nodes[3].parent);
    const double* tip = model.nodes[3].pose.data() + 12;
    EXPECT_NEAR(3, tip[0], 1e-6);
    EXPECT_NEAR(2, tip[1], 1e-6);
    EXPECT_NEAR(3, tip[2], 1e-6);
    EXPECT_EQ(2, fwimport::findNode(model.nodes, "left", error));
    EXPECT_EQ(3, fwimport::findNode(model.nodes, "#3", error));
    for (const char* none : {"", "#", "#4", "#5", "#-1", "#3x", "elsewhere"})
        EXPECT_EQ(-1, fwimport::findNode(model.nodes, none, error)) << none;
    EXPECT_THAT(error,
                HasSubstr("no node \"elsewhere\"; its nodes are #0 to #4: root, arm, left, #3"));

    // A single node, at its place.
    ImportedModel part;
    ASSERT_TRUE(fwimport::importGltfBytes(quad.bytes(), "quad", "", part, error, "left")) << error;
    EXPECT_EQ(2u, part.triangleCount());
    EXPECT_EQ(6, part.low[0]);
    ASSERT_TRUE(fwimport::importGltfBytes(quad.bytes(), "quad", "", part, error, "root")) << error;
    EXPECT_EQ(model.positions, part.positions);
    EXPECT_FALSE(fwimport::importGltfBytes(quad.bytes(), "quad", "", part, error, "right"));
    EXPECT_THAT(error, HasSubstr("quad: there is no node \"right\""));
}

TEST(Import, NamesFieldsOfTheWrongType) {
    const auto node = [](const char* text) {
        Quad quad;
        quad.node = text;
        return quad;
    };
    const auto material = [](const std::string& text) {
        Quad quad;
        quad.primitive += R"(,"material":0)";
        quad.extra = R"(,"materials":[)" + text + "]";
        quad.extra += R"(,"textures":[{}])";
        return quad;
    };
    const auto primitive = [](const char* text) {
        Quad quad;
        quad.primitive += text;
        return quad;
    };
    const struct {
        Quad quad;
        const char* says;
    } cases[] = {
        {node(R"({"mesh":0,"translation":"far"})"),
         "nodes[0].translation is a string; it takes 3 numbers"},
        {node(R"({"mesh":0,"translation":[1,2]})"),
         "nodes[0].translation is an array of 2; it takes 3 numbers"},
        {node(R"({"mesh":0,"scale":[1,"2",3]})"),
         "nodes[0].scale[1] is a string; it takes a number"},
        {node(R"({"mesh":"0"})"), "nodes[0].mesh is a string; it takes an integer"},
        {node(R"({"mesh":0.5})"), "nodes[0].mesh is 0.5; it takes an integer"},
        {node(R"({"mesh":0,"children":3})"), "nodes[0].children is a number; it takes an array"},
        {node("[]"), "nodes[0] is an array; it takes an object"},
        {primitive(R"(,"mode":true)"),
         "meshes[0].primitives[0].mode is true or false; it takes an integer"},
        {primitive(R"(,"material":{})"),
         "meshes[0].primitives[0].material is an object; it takes an integer"},
        {material(R"({"doubleSided":1})"),
         "materials[0].doubleSided is a number; it takes true or false"},
        {material(R"({"name":null})"), "materials[0].name is null; it takes a string"},
        {material(R"({"pbrMetallicRoughness":{"baseColorFactor":[1,1,1]}})"),
         "materials[0].pbrMetallicRoughness.baseColorFactor is an array of 3; it takes 4 numbers"},
        {material(R"({"pbrMetallicRoughness":{"roughnessFactor":"shiny"}})"),
         "roughnessFactor is a string; it takes a number"},
        {material(R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0,"extensions":)"
                  R"({"KHR_texture_transform":{"offset":[0]}}}}})"),
         "KHR_texture_transform.offset is an array of 1; it takes 2 numbers"},
    };
    for (const auto& one : cases) EXPECT_THAT(importRefusal(one.quad.bytes()), HasSubstr(one.says));
    // Fields that are not read, and the host's own, may have any type.
    Quad odd;
    odd.node = R"({"mesh":0,"camera":"w","extras":{"nodes":[{"mesh":"a \"[{ quoted\""}]}})";
    odd.extra = R"(,"extras":[1,"mesh",{"mesh":true}],"cameras":7)";
    ImportedModel model;
    EXPECT_TRUE(loads(odd.bytes(), model));
}

TEST(Import, MirroredNodesKeepTheirWinding) {
    Quad quad;
    quad.node = R"({"mesh":0,"scale":[-1,1,1]})";
    ImportedModel model;
    ASSERT_TRUE(loads(quad.bytes(), model));
    EXPECT_EQ((std::vector<uint32_t>{0, 2, 1, 0, 3, 2}), model.indices);
}

TEST(Import, StripFanAndUnindexedBecomeTriangles) {
    Quad strip({0, 1, 3, 2, 2, 2});
    strip.primitive += R"(,"mode":5)";
    ImportedModel model;
    ASSERT_TRUE(loads(strip.bytes(), model));
    EXPECT_EQ((std::vector<uint32_t>{0, 1, 3, 1, 2, 3}), model.indices);

    Quad fan({0, 1, 2, 3, 3, 3});
    fan.primitive += R"(,"mode":6)";
    ASSERT_TRUE(loads(fan.bytes(), model));
    EXPECT_EQ((std::vector<uint32_t>{0, 1, 2, 0, 2, 3}), model.indices);

    Quad plain;
    plain.primitive = R"("attributes":{"POSITION":0})";
    ASSERT_TRUE(loads(plain.bytes(), model));
    EXPECT_EQ((std::vector<uint32_t>{0, 1, 2}), model.indices);
    EXPECT_THAT(model.notes, ::testing::Contains(HasSubstr("4 indices")));
}

TEST(Import, ReadsIndicesOfEveryWidth) {
    for (int type : {5121, 5123, 5125}) {
        Quad quad;
        size_t offset = 0;
        if (type == 5121) offset = quad.glb.put(std::vector<uint8_t>{0, 1, 2, 0, 2, 3});
        if (type == 5123) offset = quad.glb.put(std::vector<uint16_t>{0, 1, 2, 0, 2, 3});
        if (type == 5125) offset = quad.glb.put(std::vector<uint32_t>{0, 1, 2, 0, 2, 3});
        const int size = type == 5121 ? 6 : type == 5123 ? 12 : 24;
        quad.indexView = R"({"buffer":0,"byteOffset":)" + std::to_string(offset) +
                         R"(,"byteLength":)" + std::to_string(size) + "}";
        quad.indexAccessor = R"({"bufferView":1,"componentType":)" + std::to_string(type) +
                             R"(,"count":6,"type":"SCALAR"})";
        ImportedModel model;
        ASSERT_TRUE(loads(quad.bytes(), model)) << type;
        EXPECT_EQ((std::vector<uint32_t>{0, 1, 2, 0, 2, 3}), model.indices) << type;
    }
}

TEST(Import, AppliesSparseAccessors) {
    Quad quad;
    const size_t places = quad.glb.put(std::vector<uint16_t>{2});
    const size_t values = quad.glb.put(std::vector<float>{5, 6, 7});
    quad.views = R"(,{"buffer":0,"byteOffset":)" + std::to_string(places) +
                 R"(,"byteLength":2},{"buffer":0,"byteOffset":)" + std::to_string(values) +
                 R"(,"byteLength":12})";
    const std::string sparse =
        R"("sparse":{"count":1,"indices":{"bufferView":2,"byteOffset":0,"componentType":5123},)"
        R"("values":{"bufferView":3,"byteOffset":0}})";
    quad.positionAccessor =
        R"({"bufferView":0,"componentType":5126,"count":4,"type":"VEC3",)" + sparse + "}";
    ImportedModel model;
    ASSERT_TRUE(loads(quad.bytes(), model));
    EXPECT_FLOAT_EQ(5.0f, model.positions[6]);
    EXPECT_FLOAT_EQ(7.0f, model.positions[8]);
    EXPECT_FLOAT_EQ(1.0f, model.positions[3]);

    const std::string outside =
        R"("sparse":{"count":1,"indices":{"bufferView":0,"byteOffset":12,"componentType":5123},)"
        R"("values":{"bufferView":3,"byteOffset":0}})";  // 0x0000 0x3f80: half of 1.0f
    quad.positionAccessor =
        R"({"bufferView":0,"componentType":5126,"count":4,"type":"VEC3",)" + outside + "}";
    ASSERT_TRUE(loads(quad.bytes(), model));
    const std::string beyond =
        R"("sparse":{"count":1,"indices":{"bufferView":0,"byteOffset":14,"componentType":5123},)"
        R"("values":{"bufferView":3,"byteOffset":0}})";
    quad.positionAccessor =
        R"({"bufferView":0,"componentType":5126,"count":4,"type":"VEC3",)" + beyond + "}";
    EXPECT_THAT(importRefusal(quad.bytes()), HasSubstr("sparse.indices[0] is 16256"));
}

TEST(Import, ReadsColoursAndQuantizedUvs) {
    Quad quad;
    const size_t colors = quad.glb.put(
        std::vector<uint8_t>{255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 128, 128, 128, 255});
    const size_t uvs = quad.glb.put(std::vector<uint16_t>{0, 0, 65535, 0, 65535, 65535, 0, 65535});
    quad.views = R"(,{"buffer":0,"byteOffset":)" + std::to_string(colors) +
                 R"(,"byteLength":16},{"buffer":0,"byteOffset":)" + std::to_string(uvs) +
                 R"(,"byteLength":16})";
    quad.accessors =
        R"(,{"bufferView":2,"componentType":5121,"normalized":true,"count":4,"type":"VEC4"})"
        R"(,{"bufferView":3,"componentType":5123,"normalized":true,"count":4,"type":"VEC2"})";
    quad.primitive = R"("attributes":{"POSITION":0,"COLOR_0":2,"TEXCOORD_0":3},"indices":1)";
    ImportedModel model;
    ASSERT_TRUE(loads(quad.bytes(), model));
    EXPECT_TRUE(model.hasColors);
    EXPECT_TRUE(model.hasUvs);
    EXPECT_EQ(0xff0000ffu, model.colors[0]);
    EXPECT_EQ(0xff808080u, model.colors[3]);
    EXPECT_FLOAT_EQ(1.0f, model.uvs[2]);
}

TEST(Import, RefusalsNameTheCause) {
    struct Case {
        const char* expected;
        std::function<void(Quad&)> spoil;
    };
    const std::vector<Case> cases = {
        {"indices[0] is 255; there are 4 vertices", [](Quad& q) { q.glb.binary[48] = 255; }},
        {"its buffer view has 12",
         [](Quad& q) {
             q.indexAccessor = R"({"bufferView":1,"componentType":5123,"count":7,"type":"SCALAR"})";
         }},
        {"bufferViews[1] is 1200 bytes",
         [](Quad& q) { q.indexView = R"({"buffer":0,"byteOffset":48,"byteLength":1200})"; }},
        {"bufferViews[1].buffer is 3",
         [](Quad& q) { q.indexView = R"({"buffer":3,"byteOffset":48,"byteLength":12})"; }},
        {"from 4000000000",
         [](Quad& q) { q.indexView = R"({"buffer":0,"byteOffset":4000000000,"byteLength":12})"; }},
        {".count is 4000000000; the limit is",
         [](Quad& q) {
             q.positionAccessor =
                 R"({"bufferView":0,"componentType":5126,"count":4000000000,"type":"VEC3"})";
         }},
        {"count",
         [](Quad& q) {
             q.positionAccessor =
                 R"({"bufferView":0,"componentType":5126,"count":-4,"type":"VEC3"})";
         }},
        {"have a .count of 0",
         [](Quad& q) {
             q.positionAccessor =
                 R"({"bufferView":0,"componentType":5126,"count":0,"type":"VEC3"})";
         }},
        {"has neither a bufferView nor sparse values",
         [](Quad& q) { q.positionAccessor = R"({"componentType":5126,"count":4,"type":"VEC3"})"; }},
        {"POSITION has 2 components",
         [](Quad& q) {
             q.positionAccessor =
                 R"({"bufferView":0,"componentType":5126,"count":4,"type":"VEC2"})";
         }},
        {"indices are of type 5126",
         [](Quad& q) {
             q.indexAccessor = R"({"bufferView":1,"componentType":5126,"count":3,"type":"SCALAR"})";
         }},
        {"POSITION is accessor 9; there are 2",
         [](Quad& q) { q.primitive = R"("attributes":{"POSITION":9})"; }},
        {"nodes[0].mesh is 5; there are 1", [](Quad& q) { q.node = R"({"mesh":5})"; }},
        {"has more than one parent", [](Quad& q) { q.node = R"({"mesh":0,"children":[0]})"; }},
        {"child 7", [](Quad& q) { q.node = R"({"mesh":0,"children":[7]})"; }},
        {".material is 3; there are 0", [](Quad& q) { q.primitive += R"(,"material":3)"; }},
        {".mode is 9", [](Quad& q) { q.primitive += R"(,"mode":9)"; }},
        {"points and lines", [](Quad& q) { q.primitive += R"(,"mode":1)"; }},
        {"NORMAL has 3 elements; POSITION has 4",
         [](Quad& q) {
             q.accessors = R"(,{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"})";
             q.primitive = R"("attributes":{"POSITION":0,"NORMAL":2},"indices":1)";
         }},
        {"POSITION[0] is inf",
         [](Quad& q) {
             const float bad = std::numeric_limits<float>::infinity();
             std::memcpy(q.glb.binary.data(), &bad, 4);
         }},
        {"POSITION[1] is nan",
         [](Quad& q) {
             const float bad = std::numeric_limits<float>::quiet_NaN();
             std::memcpy(q.glb.binary.data() + 12, &bad, 4);
         }},
        {"byteStride",
         [](Quad& q) {
             q.positionView = R"({"buffer":0,"byteOffset":0,"byteLength":48,"byteStride":4})";
         }},
    };
    for (const Case& entry : cases) {
        Quad quad;
        entry.spoil(quad);
        EXPECT_THAT(importRefusal(quad.bytes()), HasSubstr(entry.expected));
    }
}

TEST(Import, RefusesBrokenContainers) {
    const std::vector<uint8_t> good = Quad().bytes();
    EXPECT_THAT(importRefusal({}), HasSubstr("empty"));
    EXPECT_THAT(importRefusal({'g', 'l', 'T', 'F'}), HasSubstr("need 20"));
    EXPECT_THAT(importRefusal({'h', 'e', 'l', 'l', 'o'}), HasSubstr("test.glb"));
    std::vector<uint8_t> bad = good;
    bad[4] = 1;
    EXPECT_THAT(importRefusal(bad), HasSubstr("version is 1"));
    bad = good;
    bad[15] = 0x7f;
    EXPECT_THAT(importRefusal(bad), HasSubstr("JSON chunk"));
    bad = good;
    bad.resize(good.size() - 8);
    EXPECT_THAT(importRefusal(bad), HasSubstr("the file has"));
    const std::string deep = std::string(100000, '[');
    EXPECT_THAT(importRefusal(std::vector<uint8_t>(deep.begin(), deep.end())),
                HasSubstr("nests deeper"));
    ImportedModel model;
    std::string error;
    EXPECT_FALSE(fwimport::importGltf("/nowhere/at/all.glb", model, error));
    EXPECT_THAT(error, HasSubstr("/nowhere/at/all.glb"));
}

TEST(Import, ReportsImagesThatCannotBeDecoded) {
    Quad quad;
    const size_t offset =
        quad.glb.put(std::vector<uint8_t>{'n', 'o', 't', ' ', 'a', ' ', 'p', 'n'});
    quad.views = R"(,{"buffer":0,"byteOffset":)" + std::to_string(offset) + R"(,"byteLength":8})";
    quad.primitive += R"(,"material":0)";
    quad.extra = R"(,"materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}],)"
                 R"("textures":[{"source":0}],"images":[{"bufferView":2,"mimeType":"image/png"}])";
    ImportedModel model;
    ASSERT_TRUE(loads(quad.bytes(), model));
    EXPECT_TRUE(model.images.empty());
    EXPECT_EQ(-1, model.materials[0].image);
    EXPECT_THAT(model.notes, ::testing::Contains(HasSubstr("none of PNG, JPEG, EXR")));
}

// ---- the files of assimp-testmodels

#define REQUIRE_MODELS()                                                                   \
    if (!std::filesystem::exists(kModels)) {                                               \
        GTEST_SKIP() << "assimp-testmodels is not installed (" << kModels.string() << ")"; \
    }

TEST(Import, LoadsValidTestModels) {
    REQUIRE_MODELS();
    struct Row {
        const char* path;
        size_t vertices, triangles, images;
    };
    const Row rows[] = {
        {"BoxTextured-glTF/BoxTextured.gltf", 24, 12, 1},
        {"BoxTextured-glTF-Binary/BoxTextured.glb", 24, 12, 1},
        {"BoxTextured-glTF-Embedded/BoxTextured.gltf", 24, 12, 1},
        {"BoxTexcoords-glTF/boxTexcoords.gltf", 24, 12, 1},
        {"BoxBadNormals-glTF-Binary/BoxBadNormals.glb", 24, 12, 0},
        {"2CylinderEngine-glTF-Binary/2CylinderEngine.glb", 84657, 110342, 0},
        {"ClearCoat-glTF/ClearCoatTest.gltf", 20106, 37116, 1},
        {"textureTransform/TextureTransformTest.gltf", 48, 24, 7},
        {"cameras/Cameras.gltf", 4, 2, 0},
        {"simple_skin/simple_skin.gltf", 10, 8, 0},
        {"IncorrectVertexArrays/Cube.gltf", 138, 46, 0},
        {"glTF-Sample-Models/AnimatedMorphCube-glTF/AnimatedMorphCube.gltf", 24, 12, 0},
        {"BoxTextured-glTF-techniqueWebGL/BoxTextured.gltf", 24, 12, 0},
        {"BoxTextured-glTF-pbrSpecularGlossiness/BoxTextured.gltf", 24, 12, 1},
    };
    for (const Row& row : rows) {
        ImportedModel model;
        std::string error;
        ASSERT_TRUE(fwimport::importGltf(kModels / row.path, model, error)) << error;
        EXPECT_EQ(row.vertices, model.vertexCount()) << row.path;
        EXPECT_EQ(row.triangles, model.triangleCount()) << row.path;
        EXPECT_EQ(row.images, model.images.size()) << row.path;
        for (uint32_t index : model.indices) ASSERT_LT(index, model.vertexCount()) << row.path;
    }
}

TEST(Import, RefusesInvalidTestModels) {
    REQUIRE_MODELS();
    const std::pair<const char*, const char*> rows[] = {
        {"BoxWithInfinites-glTF-Binary/BoxWithInfinites.glb", "POSITION[0] is -inf"},
        {"IndexOutOfRange/IndexOutOfRange.gltf", "indices[0] is 255; there are 24 vertices"},
        {"IndexOutOfRange/AllIndicesOutOfRange.gltf", "indices[0] is 65535"},
        {"MissingBin/BoxTextured.gltf", "BoxTextured0.bin"},
        {"RecursiveNodes/RecursiveNodes.gltf", "more than one parent"},
        {"TestNoRootNode/NoScene.gltf", "no triangle"},
        {"TestNoRootNode/SceneWithoutNodes.gltf", "no triangle"},
        {"wrongTypes/badArray.gltf", "meshes[0].primitives is an object; it takes an array"},
        {"../glTF/BoxTextured-glTF/BoxTextured.gltf", "2.x is read"},
        {"../glTF/BoxTextured-glTF-Binary/BoxTextured.glb", "version is 1"},
    };
    for (const auto& [path, expected] : rows) {
        ImportedModel model;
        std::string error;
        EXPECT_FALSE(fwimport::importGltf(kModels / path, model, error)) << path;
        EXPECT_THAT(error, HasSubstr(expected));
    }
}

// All files of the package, broken ones too: a model or a message, in bounded time.
TEST(Import, EveryTestModelLoadsOrIsRefusedWithAMessage) {
    REQUIRE_MODELS();
    using Clock = std::chrono::steady_clock;
    int read = 0, refused = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(kModels.parent_path())) {
        const std::string ending = entry.path().extension();
        if (ending != ".gltf" && ending != ".glb") continue;
        ImportedModel model;
        std::string error;
        const Clock::time_point begin = Clock::now();
        if (fwimport::importGltf(entry.path(), model, error)) {
            ++read;
            EXPECT_GT(model.triangleCount(), 0u) << entry.path();
        } else {
            ++refused;
            EXPECT_THAT(error, HasSubstr(entry.path().filename().string()));
            EXPECT_GT(error.size(), entry.path().filename().string().size() + 10) << entry.path();
        }
        const std::chrono::duration<double> took = Clock::now() - begin;
        EXPECT_LT(took.count(), 5 * fw::test::rounds(1, 4)) << entry.path();
    }
    std::printf("           %d read, %d refused\n", read, refused);
    EXPECT_GT(read, 15);
    EXPECT_GT(refused, 10);
}

TEST(Import, ReadsEveryPrimitiveMode) {
    REQUIRE_MODELS();
    for (int i = 0; i <= 15; ++i) {
        char name[64];
        std::snprintf(name, sizeof name, "Mesh_PrimitiveMode_%02d.gltf", i);
        ImportedModel model;
        std::string error;
        const bool good = fwimport::importGltf(
            kModels / "glTF-Asset-Generator/Mesh_PrimitiveMode" / name, model, error);
        // 00..03 and 07..10 are points and lines, the rest triangles in all forms.
        const bool triangles = (i >= 4 && i <= 6) || i >= 11;
        EXPECT_EQ(triangles, good) << name << ": " << error;
        if (triangles) {
            EXPECT_EQ(2u, model.triangleCount()) << name;
        }
    }
}

// ---- damaged bytes

// The answer is a valid model or a message, never a crash.
void mustSurvive(const std::vector<uint8_t>& bytes) {
    ImportedModel model;
    std::string error;
    if (!fwimport::importGltfBytes(bytes, "fuzz.glb", "", model, error)) {
        ASSERT_FALSE(error.empty());
        return;
    }
    for (uint32_t index : model.indices) ASSERT_LT(index, model.vertexCount());
    for (uint32_t index : model.triangleMaterials) ASSERT_LT(index, model.materials.size());
    for (float value : model.positions) ASSERT_TRUE(std::isfinite(value));
}

void fuzz(const std::vector<uint8_t>& good, size_t step) {
    for (size_t size = 0; size < good.size(); size += step) {
        mustSurvive(std::vector<uint8_t>(good.begin(), good.begin() + static_cast<long>(size)));
    }
    for (size_t at = 0; at < good.size(); at += step) {
        for (uint8_t flip : {0x01, 0x10, 0x80, 0xff}) {
            std::vector<uint8_t> bad = good;
            bad[at] = static_cast<uint8_t>(bad[at] ^ flip);
            mustSurvive(bad);
        }
    }
}

TEST(ImportFuzz, SurvivesEveryByteOfAQuad) { fuzz(Quad().bytes(), 1); }

TEST(ImportFuzz, SurvivesATruncatedAndFlippedTestModel) {
    REQUIRE_MODELS();
    for (const char* name : {"BoxTextured-glTF-Binary/BoxTextured.glb",
                             "BoxBadNormals-glTF-Binary/BoxBadNormals.glb"}) {
        std::FILE* file = std::fopen((kModels / name).string().c_str(), "rb");
        ASSERT_NE(nullptr, file);
        std::vector<uint8_t> bytes(1 << 16);
        bytes.resize(std::fread(bytes.data(), 1, bytes.size(), file));
        std::fclose(file);
        fuzz(bytes, 97);
    }
}

}  // namespace
}  // namespace import_files
