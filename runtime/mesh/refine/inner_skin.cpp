// The inner skin of an unrefined mesh: the offsets of refinement at the mesh's own vertices.
#include "mesh/refine/model.h"

#include <glm/geometric.hpp>

namespace fw::mesh {
namespace {

constexpr size_t kMostTriangles = 1u << 16;  // each costs about 4 us of the first creation call
// Nothing recedes here, so triangles smaller than the wall's thickness may move by more than their
// altitude: they keep their shape where the surface is nearly flat.
constexpr float kAltitudes = 8;

glm::vec3 restOf(const gpu::RefineSlot& slot) noexcept { return {slot.x, slot.y, slot.z}; }

}  // namespace

bool hasInside(const BurnDomain& domain, const RefineModel& model) noexcept {
    const glm::vec3 low(domain.boundsLow[0], domain.boundsLow[1], domain.boundsLow[2]),
        high(domain.boundsHigh[0], domain.boundsHigh[1], domain.boundsHigh[2]);
    const glm::vec3 middle = (low + high) * 0.5f, size = high - low;
    double volume = 0;
    for (const gpu::RefineTriangle& t : model.triangles) {
        glm::vec3 p[3];
        for (int k = 0; k < 3; ++k)
            p[k] = restOf(model.slots[model.draws[t.corner[k]].slot]) - middle;
        volume += double(glm::dot(p[0], glm::cross(p[1], p[2]))) / 6;
    }
    return volume > 0.05 * double(size.x * size.y * size.z) && volume > 0;
}

std::pmr::vector<glm::vec3> innerSkin(const BurnDomain& domain, float wall,
                                      std::pmr::memory_resource* memory) {
    std::pmr::vector<glm::vec3> places(memory);
    if (domain.indices.size() / 3 > kMostTriangles) return places;
    RefineOptions options;
    options.wall = wall;
    options.depth = 0;
    options.splitTexels = 0;
    options.altitudeShare = kAltitudes;
    options.twoWalls = false;
    const RefineModel model = bakeRefine(domain, options, memory);
    if (model.openEdges > 0 || !hasInside(domain, model)) return places;
    places.reserve(domain.vertices.size());
    for (const RenderVertex& v : domain.vertices) places.push_back(v.place());
    for (const gpu::RefineTriangle& t : model.triangles)
        for (size_t k = 0; k < 3; ++k) {
            // The welded point of this corner.
            FW_ASSERT(size_t{t.source} * 3 + k < domain.indices.size(), "triangle %u", t.source);
            const uint32_t vertex = domain.indices[size_t{t.source} * 3 + k];
            const glm::vec3 rest = domain.vertices[vertex].place();
            const gpu::RefineSlot* nearest = nullptr;
            for (const uint32_t corner : t.corner) {
                const gpu::RefineSlot& slot = model.slots[model.draws[corner].slot];
                if (!nearest ||
                    glm::distance(restOf(slot), rest) < glm::distance(restOf(*nearest), rest))
                    nearest = &slot;
            }
            FW_ASSERT(vertex < places.size() && nearest, "vertex %u", vertex);
            places[vertex] = rest + (gpu::refineInnerSkin(*nearest) - restOf(*nearest));
        }
    return places;
}

}  // namespace fw::mesh
