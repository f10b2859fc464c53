// Compressed geometry of glTF files: Draco and meshoptimizer, each where the build has its library.
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
    std::vector<double> data;  // exact for every type that glTF has
};

// False: the build has no such library; reading throws Refusal, which says how to convert.
bool readsDraco();
bool readsMeshopt();

// Tells the user how to convert a file whose compressed geometry is not read.
constexpr const char* kConvertMesh =
    "; export the file again without mesh compression (Blender: Compression off; gltfpack: "
    "without -c)";

struct DracoMesh {
    uint64_t points = 0;
    std::vector<uint32_t> indices;  // 3 per triangle
    std::map<std::string, Values> attributes;
};
struct DracoAttribute {
    int64_t id = 0;  // unique in the data
    bool normalized = false;
};
DracoMesh readDraco(std::span<const uint8_t> bytes,
                    const std::map<std::string, DracoAttribute>& attributes,
                    const std::string& name);

struct MeshoptView {
    uint64_t count = 0, stride = 0;  // elements, bytes of one
    std::string mode, filter = "NONE";
};
std::vector<uint8_t> readMeshopt(std::span<const uint8_t> bytes, const MeshoptView& view,
                                 const std::string& name);

}  // namespace fwimport
