// Compressed glTF meshes: what this file packs, the importer unpacks. Damaged data is refused with
// a message. Without a codec the message says how to convert.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "import/gltf_import.h"
#include "import/mesh_codecs.h"
#include "unit/gltf_maker.h"

#ifdef FW_HAS_Draco
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#endif
#ifdef FW_HAS_Meshoptimizer
#include <meshoptimizer.h>
#endif

namespace import_packed {
namespace {

using fw::test::importRefusal;
using fw::test::loads;
using fw::test::Quad;
using fwimport::ImportedModel;
using ::testing::HasSubstr;

// A quad whose views are compressed: positions (float VEC3), then indices (16 bits).
std::string packedView(size_t offset, size_t size, const std::string& rest, size_t plain) {
    return R"({"buffer":1,"byteLength":)" + std::to_string(plain) +
           R"(,"extensions":{"EXT_meshopt_compression":{"buffer":0,"byteOffset":)" +
           std::to_string(offset) + R"(,"byteLength":)" + std::to_string(size) + rest + "}}}";
}

#ifdef FW_HAS_Meshoptimizer

template <typename T>
std::vector<uint8_t> packVertices(const std::vector<T>& values, size_t count) {
    const size_t stride = values.size() * sizeof(T) / count;
    std::vector<uint8_t> bytes(meshopt_encodeVertexBufferBound(count, stride));
    bytes.resize(
        meshopt_encodeVertexBuffer(bytes.data(), bytes.size(), values.data(), count, stride));
    return bytes;
}

Quad packedQuad(const std::string& extension = "EXT_meshopt_compression") {
    Quad quad;
    const auto positions = packVertices(std::vector<float>{0, 0, 5, 1, 0, 5, 1, 1, 5, 0, 1, 5}, 4);
    const unsigned int order[] = {0, 1, 2, 0, 2, 3};
    std::vector<uint8_t> indices(meshopt_encodeIndexBufferBound(6, 4));
    indices.resize(meshopt_encodeIndexBuffer(indices.data(), indices.size(), order, 6));
    const size_t p = quad.glb.put(positions), i = quad.glb.put(indices);
    quad.positionView =
        packedView(p, positions.size(), R"(,"byteStride":12,"count":4,"mode":"ATTRIBUTES")", 48);
    quad.indexView =
        packedView(i, indices.size(), R"(,"byteStride":2,"count":6,"mode":"TRIANGLES")", 12);
    quad.extra = R"(,"extensionsRequired":[")" + extension + R"("])";
    // The second buffer is for readers without the codec and has no bytes.
    quad.buffers =
        R"(,{"byteLength":60,"extensions":{"EXT_meshopt_compression":{"fallback":true}}})";
    return quad;
}

TEST(ImportMeshopt, CompressedViewsAreRead) {
    if (!fwimport::readsMeshopt()) GTEST_SKIP() << "this build reads no meshopt data";
    ImportedModel model;
    ASSERT_TRUE(loads(packedQuad().bytes(), model));
    EXPECT_EQ(4u, model.vertexCount());
    EXPECT_FLOAT_EQ(5, model.low[2]);
    EXPECT_FLOAT_EQ(1, model.high[0]);
    // The codec may rotate a triangle's corners.
    EXPECT_EQ(2u, model.triangleCount());

    Quad later = packedQuad("KHR_meshopt_compression");
    for (std::string* view : {&later.positionView, &later.indexView})
        view->replace(view->find("EXT_"), 3, "KHR");
    ASSERT_TRUE(loads(later.bytes(), model));
    EXPECT_FLOAT_EQ(5, model.high[2]);
}

TEST(ImportMeshopt, FiltersAreApplied) {
    if (!fwimport::readsMeshopt()) GTEST_SKIP() << "this build reads no meshopt data";
    std::vector<float> normals{0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0};
    std::vector<int8_t> octahedral(16);  // four of four bytes
    meshopt_encodeFilterOct(octahedral.data(), 4, 4, 8, normals.data());
    const auto packed = packVertices(octahedral, 4);
    // Luma, two differences, alpha: red is 255, -, - in eight bits scaled by alpha's range.
    const std::vector<int8_t> color{63, 63, 0, 127, 63, 63, 0, 127, 63, 63, 0, 127, 63, 63, 0, 127};
    const auto packedColor = packVertices(color, 4);
    Quad quad = packedQuad();
    const size_t at = quad.glb.put(packed), colorAt = quad.glb.put(packedColor);
    quad.views = "," +
                 packedView(at, packed.size(),
                            R"(,"byteStride":4,"count":4,"mode":"ATTRIBUTES","filter":)"
                            R"("OCTAHEDRAL")",
                            16) +
                 "," +
                 packedView(colorAt, packedColor.size(),
                            R"(,"byteStride":4,"count":4,"mode":"ATTRIBUTES","filter":)"
                            R"("COLOR")",
                            16);
    quad.accessors =
        R"(,{"bufferView":2,"componentType":5120,"normalized":true,"count":4,"type":"VEC3"})"
        R"(,{"bufferView":3,"componentType":5121,"normalized":true,"count":4,"type":"VEC4"})";
    quad.primitive = R"("attributes":{"POSITION":0,"NORMAL":2,"COLOR_0":3},"indices":1)";
    // Three bytes in a stride of four.
    quad.views.insert(quad.views.find("\"byteLength\":16"), "\"byteStride\":4,");
    ImportedModel model;
    ASSERT_TRUE(loads(quad.bytes(), model));
    EXPECT_NEAR(1, model.normals[2], 0.02);
    EXPECT_NEAR(1, model.normals[4], 0.02);
    EXPECT_NEAR(-1, model.normals[10], 0.02);
    EXPECT_EQ(0xffu, model.colors[0] >> 24);
    EXPECT_NEAR(253, model.colors[0] & 255, 3);
    EXPECT_NEAR(126, model.colors[0] >> 8 & 255, 3);
    EXPECT_EQ(0u, model.colors[0] >> 16 & 255);
}

TEST(ImportMeshopt, RefusesDamagedData) {
    if (!fwimport::readsMeshopt()) GTEST_SKIP() << "this build reads no meshopt data";
    const auto refusal = [](const std::string& from, const std::string& to) {
        Quad quad = packedQuad();
        quad.positionView.replace(quad.positionView.find(from), from.size(), to);
        return importRefusal(quad.bytes());
    };
    EXPECT_THAT(refusal(R"("count":4)", R"("count":4000000000)"), HasSubstr("count is 4000000000"));
    EXPECT_THAT(refusal(R"("count":4)", R"("count":40000000)"), HasSubstr("480000000 bytes"));
    EXPECT_THAT(refusal(R"("byteStride":12)", R"("byteStride":13)"), HasSubstr("byteStride is 13"));
    EXPECT_THAT(refusal("ATTRIBUTES", "NONSENSE"), HasSubstr("byteStride is 12"));
    EXPECT_THAT(refusal(R"("count":4)", R"("count":400)"), HasSubstr("cannot be decoded"));
    EXPECT_THAT(refusal(R"("mode":)", R"("filter":"OCTAHEDRAL","mode":)"),
                HasSubstr("OCTAHEDRAL takes ATTRIBUTES and a byteStride of 4 or 8"));
    EXPECT_THAT(refusal(R"("mode":)", R"("filter":"MAGIC","mode":)"), HasSubstr("\"MAGIC\""));
    Quad quad = packedQuad();
    quad.glb.binary[60] ^= 0xff;
    EXPECT_THAT(importRefusal(quad.bytes()), HasSubstr("without mesh compression"));
}

#endif

Quad dracoQuad(const std::vector<uint8_t>& data, const std::string& attributes) {
    Quad quad;
    const size_t at = quad.glb.put(data);
    quad.views = R"(,{"buffer":0,"byteOffset":)" + std::to_string(at) + R"(,"byteLength":)" +
                 std::to_string(data.size()) + "}";
    quad.positionAccessor = R"({"componentType":5126,"count":4,"type":"VEC3"})";
    quad.indexAccessor = R"({"componentType":5123,"count":6,"type":"SCALAR"})";
    quad.primitive += R"(,"extensions":{"KHR_draco_mesh_compression":{"bufferView":2,)"
                      R"("attributes":{)" +
                      attributes + "}}}";
    quad.extra = R"(,"extensionsRequired":["KHR_draco_mesh_compression"])";
    return quad;
}

#ifdef FW_HAS_Draco

std::vector<uint8_t> packDraco(int& id) {
    draco::TriangleSoupMeshBuilder builder;
    builder.Start(2);
    id = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
    const float a[] = {0, 0, 5}, b[] = {1, 0, 5}, c[] = {1, 1, 5}, d[] = {0, 1, 5};
    builder.SetAttributeValuesForFace(id, draco::FaceIndex(0), a, b, c);
    builder.SetAttributeValuesForFace(id, draco::FaceIndex(1), a, c, d);
    const std::unique_ptr<draco::Mesh> mesh = builder.Finalize();
    id = static_cast<int>(mesh->attribute(id)->unique_id());
    draco::Encoder encoder;
    encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, 14);
    draco::EncoderBuffer buffer;
    EXPECT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());
    return {buffer.data(), buffer.data() + buffer.size()};
}

TEST(ImportDraco, CompressedMeshIsRead) {
    if (!fwimport::readsDraco()) GTEST_SKIP() << "this build reads no Draco data";
    int id = 0;
    const auto data = packDraco(id);
    Quad quad = dracoQuad(data, R"("POSITION":)" + std::to_string(id));
    ImportedModel model;
    ASSERT_TRUE(loads(quad.bytes(), model));
    EXPECT_EQ(4u, model.vertexCount());
    EXPECT_EQ(2u, model.triangleCount());
    EXPECT_NEAR(5, model.low[2], 1e-3);
    EXPECT_NEAR(1, model.high[1], 1e-3);
    double area = 0;
    for (size_t i = 0; i < 6; i += 3) {
        const float* p[3];
        for (size_t k = 0; k < 3; ++k) p[k] = &model.positions[3 * model.indices[i + k]];
        area += 0.5 * double((p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) -
                             (p[2][0] - p[0][0]) * (p[1][1] - p[0][1]));
    }
    EXPECT_NEAR(1, area, 1e-3) << "faces keep their winding";
    quad = dracoQuad(data, R"("POSITION":77)");
    EXPECT_THAT(importRefusal(quad.bytes()), HasSubstr("POSITION is attribute 77"));
    // Damaged data is refused or gives a valid model.
    for (size_t at = 0; at < data.size(); ++at) {
        for (const uint8_t flip : {0x01, 0x40, 0xff}) {
            std::vector<uint8_t> bad = data;
            bad[at] = static_cast<uint8_t>(bad[at] ^ flip);
            std::string error;
            const auto bytes = dracoQuad(bad, R"("POSITION":)" + std::to_string(id)).bytes();
            if (!fwimport::importGltfBytes(bytes, "bad", "", model, error)) continue;
            for (const uint32_t corner : model.indices) ASSERT_LT(corner, model.vertexCount());
        }
    }
}

#endif

TEST(ImportPacked, RefusalWithoutACodecExplainsConversion) {
    if (!fwimport::readsDraco()) {
        EXPECT_THAT(importRefusal(dracoQuad({1, 2, 3}, R"("POSITION":0)").bytes()),
                    HasSubstr("export the file again without mesh compression"));
    }
    Quad quad;
    quad.buffers = R"(,{"byteLength":48})";  // without bytes
    quad.positionView = packedView(0, 48, R"(,"byteStride":12,"count":4,"mode":"ATTRIBUTES")", 48);
    if (!fwimport::readsMeshopt()) {
        EXPECT_THAT(importRefusal(quad.bytes()),
                    HasSubstr("export the file again without mesh compression"));
    }
}

}  // namespace
}  // namespace import_packed
