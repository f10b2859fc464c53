// Meshes for tests and benches, generated or loaded from glTF files. The editor and the samples
// have their own importer.
#pragma once
#include "mesh/bake.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace fw::test {

struct Mesh {
    std::vector<float> positions;  // 3 per vertex, m
    std::vector<float> normals;    // 3 per vertex, or empty
    std::vector<float> uvs;        // 2 per vertex, or empty
    std::vector<uint32_t> indices;

    uint32_t addVertex(double x, double y, double z, double u = 0, double v = 0);
    void addTriangle(uint32_t a, uint32_t b, uint32_t c);
    [[nodiscard]] uint32_t vertexCount() const { return uint32_t(positions.size() / 3); }
    [[nodiscard]] uint32_t triangleCount() const { return uint32_t(indices.size() / 3); }
    // Spans into this mesh, defaults elsewhere, no noise.
    [[nodiscard]] mesh::BakeInput input(double texelsPerMetre = 128, uint32_t maxSide = 1024) const;
};

// width x height m in the plane z = 0, tilted about x; UVs rotated and stretched (aspect
// `stretch`).
Mesh makePlane(double width, double height, double turnDegrees = 0, double stretch = 1,
               double tiltDegrees = 0, int cells = 1);
// Six charts of cells x cells; `turned`: each rotated by its own angle. As a sphere: equal-angle.
Mesh makeCube(double size, int cells, bool sphere = false, bool turned = true, double gap = 0.05);
// Upright, lower left corner at the origin, with alternating diagonals.
Mesh makeSheet(double size, int cells);
// Open cylinder side about y in `cuts` charts.
Mesh makeCylinder(double radius, double height, int segments, int rows, int cuts, bool turned);
// Square of cells x cells x 2 triangles, each its own chart, shuffled over the atlas.
Mesh makeConfetti(double size, int cells, double gap);
// Square of strips along y, each its own chart.
Mesh makeStrips(double size, int strips, double gap);
// Degenerate, overlapping and non-manifold triangles.
Mesh makeSoup(uint32_t seed);
// The same surface with another unwrap: cut along random edges into islands of about
// `islandTriangles`, each flattened along its mean normal and rotated at random.
Mesh randomUnwrap(const Mesh& mesh, uint32_t seed, uint32_t islandTriangles);

// A file of $FLAMEWRIGHT_ASSETS or an absolute path. False, with the reason in `error`.
bool loadGlb(const std::string& nameOrPath, Mesh& mesh, std::string& error);
// Empty without assets.
std::string assetPath(const std::string& name);

}  // namespace fw::test
