// glTF files made by tests: a quad in a GLB whose every field can be replaced.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "import/gltf_import.h"

namespace fw::test {

// A GLB under construction: the test writes the JSON, the put functions the binary chunk.
struct Glb {
    std::vector<uint8_t> binary;

    template <typename T>
    size_t put(const std::vector<T>& values) {
        while (binary.size() % 4) binary.push_back(0);
        const size_t offset = binary.size();
        const auto* from = reinterpret_cast<const uint8_t*>(values.data());
        binary.insert(binary.end(), from, from + values.size() * sizeof(T));
        return offset;
    }

    std::vector<uint8_t> pack(std::string json) const {
        while (json.size() % 4) json += ' ';
        std::vector<uint8_t> body = binary;
        while (body.size() % 4) body.push_back(0);
        std::vector<uint8_t> out;
        auto word = [&](uint32_t value) {
            for (int i = 0; i < 4; ++i) out.push_back(static_cast<uint8_t>(value >> (8 * i)));
        };
        word(0x46546c67u);
        word(2);
        word(static_cast<uint32_t>(28 + json.size() + body.size()));
        word(static_cast<uint32_t>(json.size()));
        word(0x4e4f534au);
        out.insert(out.end(), json.begin(), json.end());
        word(static_cast<uint32_t>(body.size()));
        word(0x004e4942u);
        out.insert(out.end(), body.begin(), body.end());
        return out;
    }
};

// One quad: four positions (48 bytes at 0), six 16-bit indices (12 bytes at 48), and free space.
struct Quad {
    Glb glb;
    std::string views, accessors, primitive = R"("attributes":{"POSITION":0},"indices":1)";
    std::string roots = "0", buffers;
    int added = 0;
    std::string node = R"({"mesh":0})", extra;
    std::string positionAccessor =
        R"({"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],"max":[1,1,0]})";
    std::string indexAccessor =
        R"({"bufferView":1,"componentType":5123,"count":6,"type":"SCALAR"})";
    std::string positionView = R"({"buffer":0,"byteOffset":0,"byteLength":48})";
    std::string indexView = R"({"buffer":0,"byteOffset":48,"byteLength":12})";

    explicit Quad(std::vector<uint16_t> indices = {0, 1, 2, 0, 2, 3}) {
        glb.put(std::vector<float>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
        glb.put(indices);
    }
    // Appends an accessor with its own view and returns its index.
    template <typename T>
    int add(const std::vector<T>& values, int componentType, const std::string& type, size_t count,
            const std::string& rest = "") {
        const size_t offset = glb.put(values);
        const std::string number = std::to_string(2 + added);
        views += R"(,{"buffer":0,"byteOffset":)" + std::to_string(offset) + R"(,"byteLength":)" +
                 std::to_string(values.size() * sizeof(T)) + "}";
        accessors += R"(,{"bufferView":)" + number + R"(,"componentType":)" +
                     std::to_string(componentType) + R"(,"count":)" + std::to_string(count) +
                     R"(,"type":")" + type + "\"" + rest + "}";
        return 2 + added++;
    }
    std::vector<uint8_t> bytes() const {
        return glb.pack(R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[)" + roots +
                        R"(]}],"nodes":[)" + node + R"(],"meshes":[{"primitives":[{)" + primitive +
                        R"(}]}],"accessors":[)" + positionAccessor + "," + indexAccessor +
                        accessors + R"(],"bufferViews":[)" + positionView + "," + indexView +
                        views + R"(],"buffers":[{"byteLength":)" +
                        std::to_string(glb.binary.size()) + "}" + buffers + "]" + extra + "}");
    }
};

inline ::testing::AssertionResult loads(const std::vector<uint8_t>& bytes,
                                        fwimport::ImportedModel& model) {
    std::string error;
    if (fwimport::importGltfBytes(bytes, "test.glb", "", model, error)) {
        return ::testing::AssertionSuccess();
    }
    return ::testing::AssertionFailure() << error;
}

// The message of a refusal. Fails if the import succeeds or the model was changed.
inline std::string importRefusal(const std::vector<uint8_t>& bytes) {
    fwimport::ImportedModel model;
    model.indices = {7};
    std::string error;
    EXPECT_FALSE(fwimport::importGltfBytes(bytes, "test.glb", "", model, error));
    EXPECT_EQ(1u, model.indices.size()) << "a refused file must leave the model alone";
    EXPECT_THAT(error, ::testing::HasSubstr("test.glb"));
    return error;
}

}  // namespace fw::test
