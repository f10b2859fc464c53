// Defs for worlds that tests and benches create without the C edge and its defaults.
#pragma once
#include "flamewright/flamewright.h"
#include "support/meshes.h"

namespace fw::test {

inline FwWorldDef plainWorldDef(uint32_t flags) {
    FwWorldDef def{};
    def.structSize = sizeof def;
    def.flags = flags;
    def.up[1] = 1;
    def.paceFactor = 1;
    def.seed = 1;
    def.maxStepsPerFrame = 64;
    def.maxLights = 4;
    def.maxFlames = 256;
    def.maxRefinedTriangles = 1000;
    def.spreadChance = 1;
    def.volumePixelSize = 2;
    def.rayStepCount = 64;
    def.arrivalTiles = 1024;
    def.volumeOctaves = 4;
    return def;
}

// Positions and indices only; points into the mesh.
inline FwMeshDef plainMeshDef(const Mesh& mesh, float texelsPerMetre) {
    FwMeshDef def{};
    def.structSize = sizeof def;
    def.positions = mesh.positions.data();
    def.vertexCount = mesh.vertexCount();
    def.indices = mesh.indices.data();
    def.indexCount = uint32_t(mesh.indices.size());
    def.indexSize = 4;
    def.mapSize = 128;
    def.texelsPerMetre = texelsPerMetre;
    def.noiseFeature = 0.05f;
    return def;
}

inline FwBurnableMeshDef plainBurnableDef(FwMeshId mesh) {
    FwBurnableMeshDef def{};
    def.structSize = sizeof def;
    def.mesh = mesh;
    def.tint[0] = def.tint[1] = def.tint[2] = 1;
    def.spreadChance = 1;
    def.refinePixelsPerEdge = 8;
    return def;
}

}  // namespace fw::test
