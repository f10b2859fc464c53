// The bake's data for refinement: the mesh's coarse triangles and unique edges with a slot for
// every vertex of every level. A vertex has one slot, one rest place and one sampled texel for all
// its triangles, so no combination of levels opens a crack. Immutable once baked.
#pragma once
#include "mesh/burn_domain.h"
#include "shared/refine.h"

#include <glm/vec3.hpp>

namespace fw::mesh {

struct RefineOptions {
    float wall = 0.02f;      // m, > 0, thickness of the shell unless another wall is nearer
    float cellTexels = 2;    // the shortest edge segment; 0: down to `depth` everywhere
    uint32_t depth = 5;      // 0..5, deepest level
    float splitTexels = 48;  // longer edges are halved at the bake, up to five times; 0: none
    uint32_t maxTriangles = 1u << 16;  // after that splitting; splitTexels is doubled to keep it
    // A vertex recedes by at most this share of the least altitude of the triangles around it.
    float altitudeShare = 0.5f;
    bool twoWalls = true;  // walls nearer than 2 * wall burn through together; false: each alone
};

struct RefineModel {
    explicit RefineModel(std::pmr::memory_resource* of) : memory(of) {}

    std::pmr::memory_resource* memory;
    uint32_t cornerCount = 0;  // the first slots, in order of the welded points
    uint32_t openEdges = 0, nonManifoldEdges = 0;
    uint32_t farSlots = 0;      // slots without a texel of their chart near: they use the nearest
    uint32_t textureWidth = 0;  // texels of the burn domain per row
    uint32_t tileCount = 0;

    std::pmr::vector<gpu::RefineTriangle> triangles{memory};
    std::pmr::vector<gpu::RefineEdge> edges{memory};
    std::pmr::vector<uint32_t> ownerStart{memory};  // edges + 1
    std::pmr::vector<uint32_t> owners{memory};      // triangle << 2 | side
    std::pmr::vector<gpu::RefineSlot> slots{memory};
    // The first slots.size() are the slots with their canonical owner's attributes, in order; then
    // one per further chart, or set of attributes, that meets there.
    std::pmr::vector<gpu::RefineDraw> draws{memory};
    // The items that a tile's heat warms: edges (by number) inside it or within 1.5 cells of its
    // texels, and interiors (edges.size() + triangle) that it touches.
    std::pmr::vector<uint32_t> tileStart{memory}, tileItems{memory};  // tiles + 1

    // Triangles with every edge and interior at its deepest.
    [[nodiscard]] uint64_t fullCount() const noexcept;
};

// Deterministic. Throws core::Error (an option out of range, too many slots) and std::bad_alloc.
RefineModel bakeRefine(const BurnDomain& domain, const RefineOptions& options,
                       std::pmr::memory_resource* memory);

// Whether the mesh encloses a volume, of at least a twentieth of its bounds; a sheet does not.
bool hasInside(const BurnDomain& domain, const RefineModel& model) noexcept;

// Places of the domain's vertices on the inner skin of its walls: `wall` m in along every face (see
// offsets.cpp), less where another wall is near. Drawn from inside where nothing is refined. Empty
// if the mesh has no inside, an open edge (no wall would join the two skins) or more than 65536
// triangles.
std::pmr::vector<glm::vec3> innerSkin(const BurnDomain& domain, float wall,
                                      std::pmr::memory_resource* memory);

struct RefineHoles {      // of a material
    float variation = 0;  // of the noise, as a share of the time to a hole; 0: smooth
    float tilesX = 0;     // of the noise, per metre
    float tilesY = 0;     // the same, along the grain
    bool wood = false;    // every plank (or the whole object) shows another place of the noise
};

// Ragged holes: scales every slot's burn-through time by the noise that discards fragments of far
// objects, so that near objects are cut where far ones discard. `slots`: a copy of the model's.
// `noise`: side * side tiling bytes.
void refineRoughen(const BurnDomain& domain, const RefineModel& model,
                   std::span<const RefineHoles> materials, std::span<const uint8_t> noise,
                   uint32_t side, std::span<gpu::RefineSlot> slots) noexcept;

// A draw vertex in full: the corners' attributes mixed, the place at rest.
RenderVertex refineRenderVertex(const BurnDomain& domain, const RefineModel& model, uint32_t draw);

}  // namespace fw::mesh
