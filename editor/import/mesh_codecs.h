// Compressed geometry of glTF files: Draco and meshoptimizer, if the build has their libraries.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace fwimport {

struct Values {
    uint64_t count = 0, components = 0;
    std::vector<double> data;  // doubles represent every glTF type exactly
};

// False: the build lacks the library; reading throws Refusal with conversion advice.
bool readsDraco();
bool readsMeshopt();

// Conversion advice for compressed geometry.
constexpr const char* kConvertMesh =
    "; export the file again without mesh compression (Blender: Compression off; gltfpack: "
    "without -c)";

struct DracoMesh {
    uint64_t points = 0;
    std::vector<uint32_t> indices;  // 3 per triangle
    std::map<std::string, Values> attributes;
};
struct DracoAttribute {
    int64_t id = 0;  // unique within the data
    bool normalized = false;
};
DracoMesh readDraco(std::span<const uint8_t> bytes,
                    const std::map<std::string, DracoAttribute>& attributes,
                    const std::string& name);

struct MeshoptView {
    uint64_t count = 0, stride = 0;  // number of elements, bytes per element
    std::string mode, filter = "NONE";
};
std::vector<uint8_t> readMeshopt(std::span<const uint8_t> bytes, const MeshoptView& view,
                                 const std::string& name);

}  // namespace fwimport
