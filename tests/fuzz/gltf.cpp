// glTF files in memory, without others beside them.
#include "fuzz/fuzzer.h"
#include "import/gltf_import.h"
#include "unit/gltf_maker.h"

namespace fuzz {
namespace {

// Every feature of the importer that a small file can have.
Bytes richQuad() {
    fw::test::Quad quad;
    const int normals =
        quad.add(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, 5126, "VEC3", 4);
    const int uvs = quad.add(std::vector<uint16_t>{0, 0, 65535, 0, 65535, 65535, 0, 65535}, 5123,
                             "VEC2", 4, R"(,"normalized":true)");
    const int colours =
        quad.add(std::vector<uint8_t>(16, 200), 5121, "VEC4", 4, R"(,"normalized":true)");
    const int morph = quad.add(std::vector<float>(12, 0.25f), 5126, "VEC3", 4);
    quad.primitive +=
        R"(,"material":0,"mode":4,"targets":[{"POSITION":)" + std::to_string(morph) + "}]";
    const std::string position = R"("POSITION":0)";
    quad.primitive.replace(quad.primitive.find(position), position.size(),
                           position + R"(,"NORMAL":)" + std::to_string(normals) +
                               R"(,"TEXCOORD_0":)" + std::to_string(uvs) + R"(,"COLOR_0":)" +
                               std::to_string(colours));
    quad.node = R"({"mesh":0,"weights":[0.5],"name":"root","children":[1]},)"
                R"({"mesh":0,"translation":[1,2,3],"rotation":[0,0,0,1],"scale":[1,2,1]})";
    quad.extra = R"(,"materials":[{"name":"wood","pbrMetallicRoughness":{"baseColorFactor":)"
                 R"([1,0.5,0.25,1],"roughnessFactor":0.5},"alphaMode":"MASK","alphaCutoff":0.5,)"
                 R"("doubleSided":true}])";
    return quad.bytes();
}

std::vector<Bytes> gltfSeeds() {
    std::vector<Bytes> seeds{fw::test::Quad{}.bytes(), richQuad()};
    const std::filesystem::path folder = "/usr/share/assimp/models/glTF2";
    for (const char* file :
         {"BoxTextured-glTF-Binary/BoxTextured.glb", "BoxTextured-glTF-Embedded/BoxTextured.gltf"})
        if (exists(folder / file)) seeds.push_back(bytesOf(folder / file));
    return seeds;
}

const Fuzzer kGltf{
    "gltf", gltfSeeds, [](Input input) {
        fwimport::ImportedModel model;
        std::string error;
        if (!fwimport::importGltfBytes(input, "fuzz.glb", "/nonexistent", model, error)) {
            EXPECT_FALSE(error.empty());
            return false;
        }
        for (const uint32_t index : model.indices) EXPECT_LT(index, model.vertexCount());
        for (const uint32_t material : model.triangleMaterials)
            EXPECT_LT(material, model.materials.size());
        return true;
    }};

}  // namespace
}  // namespace fuzz
