#include "common/cube.h"

namespace sample {

// Lists the corners face by face.
FwMeshId makeCube(FireHost& fire) {
    std::vector<float> positions;
    std::vector<uint32_t> indices;
    for (int face = 0; face < 6; ++face) {
        const int axis = face / 2, a = (axis + 1) % 3, b = (axis + 2) % 3;
        const float side = face % 2 ? 0.5f : -0.5f;
        const auto first = static_cast<uint32_t>(positions.size() / 3);
        for (int i = 0; i < 4; ++i) {
            float p[3];
            p[axis] = side;
            p[a] = (i == 1 || i == 2) == (face % 2 != 0) ? 0.5f : -0.5f;
            p[b] = i >= 2 ? 0.5f : -0.5f;
            positions.insert(positions.end(), p, p + 3);
        }
        for (const uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) indices.push_back(first + i);
    }
    FwMeshDef def = fwDefaultMeshDef();
    def.positions = positions.data();
    def.vertexCount = static_cast<uint32_t>(positions.size() / 3);
    def.indices = indices.data();
    def.indexCount = static_cast<uint32_t>(indices.size());
    def.texelsPerMetre = 40;
    FwMeshId mesh{};
    fire.check(fwWorld_CreateMesh(fire.world, &def, &mesh), "fwWorld_CreateMesh");
    return mesh;
}

}  // namespace sample
