// Imports glTF 2.0 (.gltf and .glb) into plain arrays in world space, ready to bake. Imports
// geometry, base colours and nodes, and the rest pose of skins, morph targets and instances. No
// animation, cameras or lights; skipped features become notes. All ranges are validated, and errors
// name the field.
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
    Opaque,  // ignores the image's alpha
    Mask,    // points with alpha below alphaCutoff are cut out
};

struct ImportedMaterial {
    std::string name;
    std::array<float, 4> baseColor{1, 1, 1, 1};  // linear factor
    float roughness = 1.0f;                      // [0, 1]
    int32_t image = -1;                          // into ImportedModel::images; -1: none
    // BLEND is imported as Mask if the image has holes (at 0.5 of its alpha), otherwise as Opaque,
    // with a note. Alpha of a point: baseColor[3] x image alpha. Triangles whose vertex colours
    // bring it below the cut-off are dropped.
    AlphaMode alphaMode = AlphaMode::Opaque;
    float alphaCutoff = 0.5f;  // Mask only; [0, baseColor[3]] for used materials
    bool doubleSided = false;
};

struct ImportedNode {      // in the rest pose
    std::string name;      // as in the file; may be empty or duplicate
    int32_t parent = -1;   // into ImportedModel::nodes; -1: none
    bool inScene = false;  // false: it belongs to another scene of the file and has no pose
    std::array<double, 16> pose{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};  // node to model
};

struct ImportedModel {
    std::vector<float> positions;             // 3 per vertex, m, node transforms applied
    std::vector<float> normals;               // 3 per vertex, unit; 0,0,0 if the file has none
    std::vector<float> uvs;                   // 2 per vertex, from the base colour's UV set
    std::vector<uint32_t> colors;             // RGBA8 linear per vertex, default white
    std::vector<uint32_t> indices;            // 3 per triangle, counter-clockwise outside
    std::vector<uint32_t> triangleMaterials;  // 1 per triangle, into `materials`
    std::vector<ImportedMaterial> materials;  // used materials; at least one
    std::vector<DecodedImage> images;         // used base colour images; straight alpha
    std::vector<ImportedNode> nodes;          // all nodes of the file, in file order
    bool hasNormals = false, hasUvs = false, hasColors = false;  // for all vertices
    std::array<float, 3> low{}, high{};                          // m, bounds of the positions
    size_t parts = 0;                // number of primitives, counting each instance
    std::vector<std::string> notes;  // skipped or approximated features, with reasons

    size_t vertexCount() const { return positions.size() / 3; }
    size_t triangleCount() const { return indices.size() / 3; }
};

constexpr uint64_t kMaxFileBytes = 1ull << 30;
constexpr uint64_t kMaxVertices = 1ull << 24;
constexpr uint64_t kMaxTriangles = 1ull << 24;

// `part`: a node as in findNode; imports only its subtree, at its place in the file. Empty: the
// whole file. On failure returns false; `error` has the file, the field, its value and the allowed
// values. `model` is then unchanged.
bool importGltf(const std::filesystem::path& path, ImportedModel& model, std::string& error,
                std::string_view part = {});

// The same for a file in memory. `name`: for messages; `folder`: base of its URIs.
bool importGltfBytes(std::span<const uint8_t> bytes, const std::string& name,
                     const std::filesystem::path& folder, ImportedModel& model, std::string& error,
                     std::string_view part = {});

// Returns the first node of that name in the scene, otherwise the node of that number ("#3").
// Returns -1 if there is none; `error` lists the available nodes.
int32_t findNode(std::span<const ImportedNode> nodes, std::string_view which, std::string& error);

}  // namespace fwimport
