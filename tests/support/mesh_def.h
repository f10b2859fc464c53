// A generated or loaded mesh as a host passes it.
#pragma once
#include "flamewright/flamewright.h"
#include "support/meshes.h"

namespace fw::test {

// Points into the mesh.
inline FwMeshDef meshDefOf(const Mesh& mesh) {
    FwMeshDef def = fwDefaultMeshDef();
    def.positions = mesh.positions.data();
    def.normals = mesh.normals.empty() ? nullptr : mesh.normals.data();
    def.uvs = mesh.uvs.empty() ? nullptr : mesh.uvs.data();
    def.indices = mesh.indices.data();
    def.vertexCount = mesh.vertexCount();
    def.indexCount = uint32_t(mesh.indices.size());
    return def;
}

}  // namespace fw::test
