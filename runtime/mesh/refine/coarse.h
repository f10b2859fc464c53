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

// An edge of a triangle by its points, for sorting; equal ones are one edge.
struct CoarseUse {
    uint32_t low, high, triangle, side;
    [[nodiscard]] bool sameEdge(const CoarseUse& o) const { return low == o.low && high == o.high; }
    bool operator<(const CoarseUse& o) const {
        if (low != o.low) return low < o.low;
        if (high != o.high) return high < o.high;
        return triangle != o.triangle ? triangle < o.triangle : side < o.side;
    }
};
std::pmr::vector<CoarseUse> sortedUses(const CoarseMesh& mesh, std::pmr::memory_resource* memory);

// The drawn triangles of a domain as a surface again: welded, charts found. Triangle::source is the
// domain's, uv in texels.
Surface surfaceOf(const BurnDomain& domain, std::pmr::memory_resource* memory);
// Longest edges halved until none is longer than `longest` m (0: as it is), at most 2^5 pieces and
// `most` triangles.
CoarseMesh coarseMesh(const Surface& surface, double longest, uint32_t most,
                      std::pmr::memory_resource* memory);

// Directions, reach and burn-through of all slots; rest places are set. `opposite` too.
void bakeOffsets(const Surface& surface, const CoarseMesh& coarse, const BurnDomain& domain,
                 const RefineOptions& options, RefineModel& model,
                 std::pmr::memory_resource* memory);
// The texels that speak for each slot, and the tiles of triangles and edges.
void bakeSamples(const Surface& surface, const CoarseMesh& coarse, const BurnDomain& domain,
                 RefineModel& model, std::pmr::memory_resource* memory);

}  // namespace fw::mesh
