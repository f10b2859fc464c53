// glTF 2.0 (.gltf and .glb) into plain arrays in world space, ready to be baked.
// Geometry, base colours and the nodes they hang on; skins, morph targets and instances as the file
// puts them at rest. No animation, cameras or lights: what is not shown has a note.
// Every range is checked before it is read; what cannot be used is refused by name.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "import/image_decode.h"

namespace fwimport {

enum class AlphaMode : uint8_t {
    Opaque,  // the picture's alpha means nothing
    Mask,    // a point whose alpha is below alphaCutoff is not there
};

struct ImportedMaterial {
    std::string name;
    std::array<float, 4> baseColor{1, 1, 1, 1};  // linear factor
    float roughness = 1.0f;                      // [0, 1]
    int32_t image = -1;                          // into ImportedModel::images; -1: none
    // glTF's BLEND is read as Mask where its picture has holes (at 0.5 of the picture's alpha),
    // else as Opaque; a note says so. A point's alpha is baseColor[3] x the picture's alpha.
    // Triangles whose vertex colours bring it below the cut-off are left out.
    AlphaMode alphaMode = AlphaMode::Opaque;
    float alphaCutoff = 0.5f;  // Mask only; [0, baseColor[3]] of materials that triangles use
    bool doubleSided = false;
};

struct ImportedNode {      // at rest
    std::string name;      // as the file has it; may be empty, or another one's too
    int32_t parent = -1;   // into ImportedModel::nodes; -1: none
    bool inScene = false;  // else it is in another scene of the file, and has no place
    std::array<double, 16> pose{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};  // to the model
};

struct ImportedModel {
    std::vector<float> positions;             // 3 per vertex, m, node transforms applied
    std::vector<float> normals;               // 3 per vertex, unit; 0,0,0 where the file has none
    std::vector<float> uvs;                   // 2 per vertex, of the base colour's set
    std::vector<uint32_t> colors;             // RGBA8 linear per vertex, white where none
    std::vector<uint32_t> indices;            // 3 per triangle, counter-clockwise outside
    std::vector<uint32_t> triangleMaterials;  // 1 per triangle, into `materials`
    std::vector<ImportedMaterial> materials;  // those that are used; at least one
    std::vector<DecodedImage> images;         // base colours, those that are used; straight alpha
    std::vector<ImportedNode> nodes;          // all of the file, by its numbers
    bool hasNormals = false, hasUvs = false, hasColors = false;  // for every vertex
    std::array<float, 3> low{}, high{};                          // m, bounds of the positions
    size_t parts = 0;                // primitives that are in it, each instance counted
    std::vector<std::string> notes;  // what is left out or shown otherwise, and why

    size_t vertexCount() const { return positions.size() / 3; }
    size_t triangleCount() const { return indices.size() / 3; }
};

constexpr uint64_t kMaxFileBytes = 1ull << 30;
constexpr uint64_t kMaxVertices = 1ull << 24;
constexpr uint64_t kMaxTriangles = 1ull << 24;

// `part`: a node, as findNode takes it; only what hangs on it is taken, where it stands in the
// file. Empty: the whole file. False: `error` names the file, the field, its value and what is
// allowed; `model` is untouched.
bool importGltf(const std::filesystem::path& path, ImportedModel& model, std::string& error,
                std::string_view part = {});

// As above for a file in memory; `name` is for messages, `folder` is where its URIs begin.
bool importGltfBytes(std::span<const uint8_t> bytes, const std::string& name,
                     const std::filesystem::path& folder, ImportedModel& model, std::string& error,
                     std::string_view part = {});

// The first node of that name in the scene, else the one of that number: "#3". -1: there is none,
// and `error` says which there are.
int32_t findNode(std::span<const ImportedNode> nodes, std::string_view which, std::string& error);

}  // namespace fwimport
