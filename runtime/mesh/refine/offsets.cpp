// Rest place, direction and reach of receding vertices. An offset o has o.N = -1 for every face at
// the vertex, so that flat faces stay flat and a wall thins by the same depth everywhere.
#include "mesh/ray_tree.h"
#include "mesh/refine/coarse.h"
#include "mesh/texels.h"

#include <cmath>

namespace fw::mesh {
namespace {

constexpr double kSmoothCosine = 0.77;  // 40 degrees: flatter creases count as curved surface
constexpr double kReachUnit = 1e-5;     // m

double minAltitude(const CoarseMesh& coarse, const CoarseTriangle& t, double area) {
    double longest = 0;
    for (int k = 0; k < 3; ++k)
        longest = std::max(
            longest, glm::length(coarse.points[t.point[k]] - coarse.points[t.point[(k + 1) % 3]]));
    return 2 * area / std::max(longest, 1e-30);
}

struct Offsets {
    const Surface& surface;
    const CoarseMesh& coarse;
    const RefineOptions& options;
    RefineModel& model;
    RayTree tree{surface};
    std::pmr::vector<glm::dvec3> offset{coarse.points.size(), glm::dvec3(0), model.memory};
    std::pmr::vector<double> reach{coarse.points.size(), 0.0, model.memory};  // m, per point

    void run() {
        corners();
        for (uint32_t e = 0; e < model.edges.size(); ++e) edge(e);
        for (uint32_t i = 0; i < model.triangles.size(); ++i) interior(i);
    }
    // The nearest surface along a direction; RayTree::kReach or more: none.
    [[nodiscard]] double depth(glm::dvec3 from, glm::dvec3 direction) const {
        const float least = float(1e-4 * surface.extent);
        int64_t steps = RayTree::kMostSteps;  // of one ray: there is no budget of all
        return double(
            tree.cast(glm::vec3(from - surface.low), glm::vec3(direction), least, kNone, steps));
    }
    [[nodiscard]] const glm::dvec3& normal(uint32_t triangle) const {
        return surface.triangles[coarse.triangles[triangle].source].normal;
    }

    void put(uint32_t slot, glm::dvec3 place, glm::dvec3 out, double most) {
        FW_ASSERT(slot < model.slots.size(), "%u of %zu slots", slot, model.slots.size());
        FW_ASSERT(most >= 0, "%g m", most);
        gpu::RefineSlot& s = model.slots[slot];
        s.x = float(place.x);
        s.y = float(place.y);
        s.z = float(place.z);
        s.offset = packNormal(out / kLongestOffset);
        s.reach = uint32_t(std::clamp(most / kReachUnit, 0.0, 65535.0)) | 4096u << 16;
    }

    void corners() {
        std::pmr::vector<Faces> faces(coarse.points.size(), model.memory);
        std::pmr::vector<double> altitude(coarse.points.size(), 1e30, model.memory);
        for (uint32_t i = 0; i < coarse.triangles.size(); ++i) {
            const CoarseTriangle& t = coarse.triangles[i];
            const glm::dvec3 a = coarse.points[t.point[0]];
            const double area = 0.5 * glm::length(glm::cross(coarse.points[t.point[1]] - a,
                                                             coarse.points[t.point[2]] - a));
            const double low = minAltitude(coarse, t, area);
            for (const uint32_t p : t.point) {
                faces[p].add(normal(i), 1);
                altitude[p] = std::min(altitude[p], low);
            }
        }
        for (uint32_t p = 0; p < coarse.points.size(); ++p) {
            if (faces[p].weight > 0) offset[p] = faces[p].offset();
            const double length = glm::length(offset[p]);
            reach[p] = std::min(double(options.wall), double(options.altitudeShare) * altitude[p]);
            if (length > 1e-9)  // the distance receded is reach * length
                reach[p] = std::min(
                    reach[p], kDepthShare * depth(coarse.points[p], offset[p] / length) / length);
            put(p, coarse.points[p], offset[p], reach[p]);
        }
    }

    // Whether two owners meet there at less than the angle of a crease.
    [[nodiscard]] bool smooth(uint32_t e) const {
        const uint32_t start = model.ownerStart[e];
        return model.ownerStart[e + 1] - start == 2 &&
               glm::dot(normal(model.owners[start] >> 2), normal(model.owners[start + 1] >> 2)) >
                   kSmoothCosine;
    }

    // A crease moves across itself by its two faces' offset, and along itself as its ends do.
    void edge(uint32_t e) {
        const gpu::RefineEdge& edge = model.edges[e];
        const uint32_t steps = 1u << (edge.flags & 15);
        if (steps == 1) return;
        const glm::dvec3 a = coarse.points[edge.low], b = coarse.points[edge.high];
        FW_ASSERT(edge.slot + steps - 1 <= model.slots.size(), "slot %u", edge.slot);
        Faces faces;
        for (uint32_t o = model.ownerStart[e]; o < model.ownerStart[e + 1]; ++o)
            faces.add(normal(model.owners[o] >> 2), 1);
        const glm::dvec3 crease = faces.offset(), along = glm::normalize(b - a);
        const bool curved = smooth(e);
        for (uint32_t i = 1; i < steps; ++i) {
            const double f = double(i) / steps;
            const glm::dvec3 ends = offset[edge.low] * (1 - f) + offset[edge.high] * f;
            const glm::dvec3 o =
                curved ? ends : crease + along * (glm::dot(ends, along) - glm::dot(crease, along));
            put(edge.slot + i - 1, a * (1 - f) + b * f, o,
                reach[edge.low] * (1 - f) + reach[edge.high] * f);
        }
    }

    // A flat interior recedes along its normal, and within its plane as the corners do.
    void interior(uint32_t i) {
        const gpu::RefineTriangle& t = model.triangles[i];
        const uint32_t* p = coarse.triangles[i].point;
        const glm::dvec3 up = normal(i);
        const bool curved = smooth(t.edge[0]) && smooth(t.edge[1]) && smooth(t.edge[2]);
        const auto within = [&](const auto& of, glm::dvec3 w) {
            return mixed(of[p[0]], of[p[1]], of[p[2]], w);
        };
        eachInner(1u << gpu::refineInteriorDepth(t.flags), [&](uint32_t number, glm::dvec3 w) {
            const glm::dvec3 o = within(offset, w);
            put(t.slot + number, within(coarse.points, w),
                curved ? o : o - up * (glm::dot(o, up) + 1), within(reach, w));
        });
    }
};

// Texels around the point where an inward ray leaves the solid, if the wall is thin enough for both
// sides to burn through together.
void findOpposites(const Surface& surface, const BurnDomain& domain, const RefineOptions& options,
                   const Offsets& offsets, RefineModel& model) {
    std::pmr::vector<uint32_t> surfaceOf(domain.indices.size() / 3, kNone, model.memory);
    for (uint32_t i = 0; i < surface.triangles.size(); ++i)
        surfaceOf[surface.triangles[i].source] = i;
    for (uint32_t s = 0; s < model.slots.size(); ++s) {
        gpu::RefineSlot& slot = model.slots[s];
        slot.opposite = gpu::kRefineOpposed;
        const uint32_t own =
            model.draws[s].triangle == kNone ? kNone : surfaceOf[model.draws[s].triangle];
        if (!options.twoWalls || own == kNone) continue;
        const glm::dvec3 down = -surface.triangles[own].normal;
        const glm::dvec3 from(slot.x, slot.y, slot.z);
        const double depth = offsets.depth(from, down);
        if (!(depth < 2 * double(options.wall))) continue;
        const glm::dvec3 far = from + down * depth;
        const float point[3] = {float(far.x), float(far.y), float(far.z)};
        const uint32_t texel = nearestTexel(domain, point, 4 * domain.texelSide);
        if (texel == kNone || domain.triangleOf[texel] == kNone) continue;
        const uint32_t there = surfaceOf[domain.triangleOf[texel]];
        if (there == kNone || glm::dot(surface.triangles[there].normal, down) < 0.5) continue;
        // The triangle's own map gives the place between texels, unless the point lies outside it.
        const Triangle& t = surface.triangles[there];
        const glm::dvec3 e1 = t.position[1] - t.position[0], e2 = t.position[2] - t.position[0];
        const glm::dvec3 q = glm::cross(e1, e2), d = far - t.position[0];
        const double w1 = glm::dot(glm::cross(d, e2), q) / glm::dot(q, q);
        const double w2 = glm::dot(glm::cross(e1, d), q) / glm::dot(q, q);
        glm::dvec2 uv = uvAt(t, {1 - w1 - w2, w1, w2}) - 0.5;
        const glm::dvec2 middle(texel % domain.width, texel / domain.width);
        uv = glm::clamp(uv, middle - 0.99, middle + 0.99);
        uv = glm::clamp(uv, glm::dvec2(0), glm::dvec2(domain.width - 2, domain.height - 2));
        const glm::dvec2 base = glm::floor(uv);
        const auto part = [](double f) { return std::min(uint32_t(f * 16 + 0.5), 15u); };
        slot.opposite = uint32_t(base.y) * domain.width + uint32_t(base.x);
        slot.opposite |= part(uv.x - base.x) << 24 | part(uv.y - base.y) << 28;
        const double through = std::clamp(depth / double(options.wall), 0.05, 15.9);
        slot.reach = (slot.reach & 0xFFFFu) | uint32_t(through * 4096) << 16;
    }
}

}  // namespace

void bakeOffsets(const Surface& surface, const CoarseMesh& coarse, const BurnDomain& domain,
                 const RefineOptions& options, RefineModel& model) {
    Offsets offsets{surface, coarse, options, model};
    offsets.run();
    findOpposites(surface, domain, options, offsets, model);
}

}  // namespace fw::mesh
