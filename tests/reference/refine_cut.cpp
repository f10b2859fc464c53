// One lane per small triangle: keeps the polygon in front of the hole's line, and closes it.
#include "reference/refine_cut.h"

#include "mesh/refine/table.h"

#include <algorithm>

namespace fw::mesh {
namespace {

glm::vec3 placeOf(const RefineModel& model, const RefineState& state, uint32_t slot, bool inner) {
    if (inner) return gpu::refineInnerSkin(model.slots[slot]);
    const gpu::RefineVertex& v = state.vertices[slot];
    return {v.x, v.y, v.z};
}

// Sides of a small triangle on open edges of the mesh, one bit each.
uint32_t openSides(const RefineModel& model, const gpu::RefineTriangle& t, uint32_t levels,
                   const glm::uvec3& codes) {
    uint32_t open = 0;
    for (uint32_t e = 0; e < 3; ++e) open |= (model.edges[t.edge[e]].flags >> 4 & 1) << e;
    if (open == 0) return 0;
    uint32_t bits = 0;
    for (uint32_t k = 0; k < 3; ++k) {
        const uint32_t both = gpu::refineSidesOf(levels, codes[int(k)]) &
                              gpu::refineSidesOf(levels, codes[int(gpu::refineNext(k))]);
        if ((both & open) != 0) bits |= 1u << k;
    }
    return bits;
}

// Triangles: outer skin, inner skin, two per wall.
uint32_t cutCount(const gpu::RefineCut& cut, bool inner) {
    if (cut.points == 0) return 0;
    const uint32_t fan = cut.points - 2;
    return inner ? 2 * fan + 2 * gpu::refineCutWalls(cut) : fan;
}

// A polygon point of a small triangle with these slots.
RefineCorner cutCorner(const gpu::RefineCut& cut, uint32_t point, const glm::uvec3& slots) {
    const uint32_t at = cut.corner[point & 3], a = slots[int(at & 3)];
    const uint32_t b = at < 4 ? a : slots[int(gpu::refineNext(at & 3))];
    return {std::min(a, b), std::max(a, b) | (point >= 4 ? kRefineInside : 0)};
}

}  // namespace

void refineShell(const RefineModel& model, const RefineState& state, float now, bool inner,
                 RefineShell& shell) {
    shell.corners.clear();
    shell.outer = shell.inner = shell.rim = shell.wall = shell.gone = 0;
    for (size_t i = 0; i < model.triangles.size(); ++i) {
        const gpu::RefineTriangle& t = model.triangles[i];
        const uint32_t levels = state.levels[i], count = gpu::refineCount(levels);
        for (uint32_t q = 0; q < count; ++q) {
            const glm::uvec3 codes = refineTriangle(levels, q);
            glm::uvec3 slots(0);
            uint32_t solid = 0;
            for (int k = 0; k < 3; ++k) {
                slots[k] = model.draws[gpu::refineDrawVertex(t, levels, codes[k])].slot;
                if (gpu::secondsToHole(state.vertices[slots[k]].hole, now) > 0) solid |= 1u << k;
            }
            const gpu::RefineCut cut = gpu::refineCut(solid, openSides(model, t, levels, codes));
            if (cut.points == 0) {
                ++shell.gone;
                continue;
            }
            for (uint32_t k = 0; k < cutCount(cut, inner); ++k) {
                const glm::uvec3 points = gpu::refineCutTriangle(cut, k);
                for (int v = 0; v < 3; ++v)
                    shell.corners.push_back(cutCorner(cut, points[v], slots));
            }
            shell.outer += cut.points - 2;
            if (!inner) continue;
            shell.inner += cut.points - 2;
            const uint32_t rim = cut.rim < 4 ? 2 : 0;
            shell.rim += rim;
            shell.wall += 2 * gpu::refineCutWalls(cut) - rim;
        }
    }
}

glm::vec3 refineCornerPlace(const RefineModel& model, const RefineState& state, float now,
                            const RefineCorner& corner) {
    const bool inner = (corner.high & kRefineInside) != 0;
    const uint32_t high = corner.high & ~kRefineInside;
    const glm::vec3 a = placeOf(model, state, corner.low, inner);
    if (high == corner.low) return a;
    return gpu::refineCutPoint(a, placeOf(model, state, high, inner),
                               gpu::secondsToHole(state.vertices[corner.low].hole, now),
                               gpu::secondsToHole(state.vertices[high].hole, now));
}

bool refineHoled(const RefineModel& model, const RefineState& state, float now, uint32_t triangle) {
    const gpu::RefineTriangle& t = model.triangles[triangle];
    const uint32_t levels = state.levels[triangle], m = gpu::refineInterior(levels), n = 1u << m;
    const auto gone = [&](uint32_t slot) { return state.vertices[slot].hole <= now; };
    for (uint32_t e = 0; e < 3; ++e) {
        const gpu::RefineEdge& edge = model.edges[t.edge[e]];
        const uint32_t l = gpu::refineSide(levels, e);
        for (uint32_t i = 0; i <= 1u << l; ++i)
            if (gone(gpu::refineEdgeSlot(edge, i, l))) return true;
    }
    if (m < 2) return false;
    for (uint32_t c2 = 1; c2 + 1 < n; ++c2)
        for (uint32_t c1 = 1; c1 + c2 < n; ++c1)
            if (gone(gpu::refineInnerSlot(t, c1, c2, m))) return true;
    return false;
}

}  // namespace fw::mesh
