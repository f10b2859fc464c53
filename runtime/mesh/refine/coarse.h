// The refinement bake's working mesh: welded points and coarse triangles, split where they are too
// long. Internal to runtime/mesh/refine; lives only while a bake runs.
#pragma once
#include "mesh/refine/model.h"
#include "mesh/surface.h"

namespace fw::mesh {

struct CoarseTriangle {
    uint32_t point[3];
    glm::dvec3 weight[3];  // of the source's corners, per corner
    uint32_t source;       // triangle of the surface
};

struct CoarseMesh {
    explicit CoarseMesh(std::pmr::memory_resource* memory) : points(memory), triangles(memory) {}
    std::pmr::vector<glm::dvec3> points;  // m
    std::pmr::vector<CoarseTriangle> triangles;
};

// Calls visit(number, weights) for the points of a triangle's lattice of n steps a side that lie
// inside it.
template <class Visit>
void eachInner(uint32_t n, Visit visit) {
    for (uint32_t c2 = 1; c2 + 1 < n; ++c2)
        for (uint32_t c1 = 1; c1 + c2 < n; ++c1)
            visit(gpu::refineInnerPoint(c1, c2, n), glm::dvec3(n - c1 - c2, c1, c2) / double(n));
}

// The drawn triangles of a domain as a surface again: welded, charts found. Triangle::source is the
// domain's, uv in texels.
Surface surfaceOf(const BurnDomain& domain, std::pmr::memory_resource* memory);
// Halves edges until none is longer than `longest` m (0: no limit), to at most 2^5 pieces an edge
// and `most` triangles.
CoarseMesh coarseMesh(const Surface& surface, double longest, uint32_t most);

// Sets rest place, direction, reach, burn-through time and `opposite` of all slots.
void bakeOffsets(const Surface& surface, const CoarseMesh& coarse, const BurnDomain& domain,
                 const RefineOptions& options, RefineModel& model);
// Sets the texels that each slot samples, and the tiles of triangles and edges.
void bakeSamples(const Surface& surface, const CoarseMesh& coarse, const BurnDomain& domain,
                 RefineModel& model);

}  // namespace fw::mesh
