// Where a vertex rests, which way it recedes and how far it may. An offset o has o.N = -1 for every
// face at the vertex, so that flat faces stay flat and a wall thins by the same depth everywhere.
#include "mesh/ray_tree.h"
#include "mesh/refine/coarse.h"

#include <cmath>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

namespace fw::mesh {
namespace {

constexpr double kSmoothCosine = 0.77;  // 40 degrees: flatter creases count as curved surface
constexpr double kReachUnit = 1e-5;     // m

// Faces at a vertex, summed up.
struct Faces {
    glm::dmat3 squares{0};  // sum of N * N^T
    glm::dvec3 sum{0};
    double count = 0;
    void add(glm::dvec3 n) {
        squares += glm::outerProduct(n, n);
        sum += n;
        count += 1;
    }
};

// Least squares over the faces; directions they say nothing about stay along the mean normal.
glm::dvec3 mitre(const Faces& faces) {
    const glm::dvec3 mean = faces.sum / faces.count;
    const double square = glm::dot(mean, mean);
    if (square < 1e-6) return glm::dvec3(0);  // the two sides of a sheet: it cannot recede
    const glm::dvec3 guess = -mean / std::max(square, 0.25);
    const double weight = 1e-3 * faces.count;
    glm::dvec3 o = glm::inverse(faces.squares + glm::dmat3(weight)) * (guess * weight - faces.sum);
    const double length = glm::length(o);
    return length > kLongestOffset ? o * (kLongestOffset / length) : o;
}

double leastAltitude(const CoarseMesh& coarse, const CoarseTriangle& t, double area) {
    double longest = 0;
    for (int k = 0; k < 3; ++k)
        longest = std::max(
            longest, glm::length(coarse.points[t.point[k]] - coarse.points[t.point[(k + 1) % 3]]));
    return 2 * area / std::max(longest, 1e-30);
}

uint32_t packOffset(glm::dvec3 o) {
    const auto field = [](double v, int one) {
        return uint32_t(std::clamp(int(std::floor(v / kLongestOffset * one + 0.5)), -one, one));
    };
    return (field(o.x, 1023) & 0x7FFu) | (field(o.y, 1023) & 0x7FFu) << 11 |
           (field(o.z, 511) & 0x3FFu) << 22;
}

class Offsets {
 public:
    Offsets(const Surface& surface, const CoarseMesh& coarse, const RefineOptions& options,
            RefineModel& model, std::pmr::memory_resource* memory)
        : surface_(surface),
          coarse_(coarse),
          options_(options),
          model_(model),
          tree_(surface, memory),
          offset_(coarse.points.size(), glm::dvec3(0), memory),
          reach_(coarse.points.size(), 0.0, memory) {}

    void run(std::pmr::memory_resource* memory) {
        corners(memory);
        for (uint32_t e = 0; e < model_.edges.size(); ++e) edge(e);
        for (uint32_t i = 0; i < model_.triangles.size(); ++i) interior(i);
    }
    // The nearest surface along a direction; RayTree::kReach or more: none.
    [[nodiscard]] double depth(glm::dvec3 from, glm::dvec3 direction) const {
        const float least = float(1e-4 * surface_.extent);
        return double(
            tree_.cast(glm::vec3(from - surface_.low), glm::vec3(direction), least, kNone));
    }
    [[nodiscard]] const glm::dvec3& normal(uint32_t triangle) const {
        return surface_.triangles[coarse_.triangles[triangle].source].normal;
    }

 private:
    void put(uint32_t slot, glm::dvec3 place, glm::dvec3 offset, double reach) {
        gpu::RefineSlot& s = model_.slots[slot];
        s.x = float(place.x);
        s.y = float(place.y);
        s.z = float(place.z);
        s.offset = packOffset(offset);
        s.reach = uint32_t(std::clamp(reach / kReachUnit, 0.0, 65535.0)) | 4096u << 16;
    }

    void corners(std::pmr::memory_resource* memory) {
        std::pmr::vector<Faces> faces(coarse_.points.size(), memory);
        std::pmr::vector<double> altitude(coarse_.points.size(), 1e30, memory);
        for (uint32_t i = 0; i < coarse_.triangles.size(); ++i) {
            const CoarseTriangle& t = coarse_.triangles[i];
            const glm::dvec3 a = coarse_.points[t.point[0]];
            const double area = 0.5 * glm::length(glm::cross(coarse_.points[t.point[1]] - a,
                                                             coarse_.points[t.point[2]] - a));
            const double low = leastAltitude(coarse_, t, area);
            for (const uint32_t p : t.point) {
                faces[p].add(normal(i));
                altitude[p] = std::min(altitude[p], low);
            }
        }
        for (uint32_t p = 0; p < coarse_.points.size(); ++p) {
            if (faces[p].count > 0) offset_[p] = mitre(faces[p]);
            const double length = glm::length(offset_[p]);
            reach_[p] =
                std::min(double(options_.wall), double(options_.altitudeShare) * altitude[p]);
            if (length > 1e-9)  // the way gone is reach * length
                reach_[p] =
                    std::min(reach_[p],
                             kDepthShare * depth(coarse_.points[p], offset_[p] / length) / length);
            put(p, coarse_.points[p], offset_[p], reach_[p]);
        }
    }

    // Two owners and hardly a crease between them.
    [[nodiscard]] bool smooth(uint32_t e) const {
        const uint32_t start = model_.ownerStart[e];
        return model_.ownerStart[e + 1] - start == 2 &&
               glm::dot(normal(model_.owners[start] >> 2), normal(model_.owners[start + 1] >> 2)) >
                   kSmoothCosine;
    }

    // A crease moves as its two faces say, and along itself as its ends do.
    void edge(uint32_t e) {
        const gpu::RefineEdge& edge = model_.edges[e];
        const uint32_t steps = 1u << (edge.flags & 15);
        if (steps == 1) return;
        const glm::dvec3 a = coarse_.points[edge.low], b = coarse_.points[edge.high];
        Faces faces;
        for (uint32_t o = model_.ownerStart[e]; o < model_.ownerStart[e + 1]; ++o)
            faces.add(normal(model_.owners[o] >> 2));
        const glm::dvec3 crease = mitre(faces), along = glm::normalize(b - a);
        const bool curved = smooth(e);
        for (uint32_t i = 1; i < steps; ++i) {
            const double f = double(i) / steps;
            const glm::dvec3 ends = offset_[edge.low] * (1 - f) + offset_[edge.high] * f;
            const glm::dvec3 o =
                curved ? ends : crease + along * (glm::dot(ends, along) - glm::dot(crease, along));
            put(edge.slot + i - 1, a * (1 - f) + b * f, o,
                reach_[edge.low] * (1 - f) + reach_[edge.high] * f);
        }
    }

    // A flat interior recedes along its normal, and in its plane as the corners do.
    void interior(uint32_t i) {
        const gpu::RefineTriangle& t = model_.triangles[i];
        const uint32_t n = 1u << gpu::refineInteriorDepth(t.flags);
        const uint32_t* p = coarse_.triangles[i].point;
        const glm::dvec3 up = normal(i);
        const bool curved = smooth(t.edge[0]) && smooth(t.edge[1]) && smooth(t.edge[2]);
        for (uint32_t c2 = 1; c2 + 1 < n; ++c2)
            for (uint32_t c1 = 1; c1 + c2 < n; ++c1) {
                const glm::dvec3 w = glm::dvec3(n - c1 - c2, c1, c2) / double(n);
                const glm::dvec3 mixed =
                    offset_[p[0]] * w.x + offset_[p[1]] * w.y + offset_[p[2]] * w.z;
                put(t.slot + gpu::refineInnerPoint(c1, c2, n),
                    coarse_.points[p[0]] * w.x + coarse_.points[p[1]] * w.y +
                        coarse_.points[p[2]] * w.z,
                    curved ? mixed : mixed - up * (glm::dot(mixed, up) + 1),
                    reach_[p[0]] * w.x + reach_[p[1]] * w.y + reach_[p[2]] * w.z);
            }
    }

    const Surface& surface_;
    const CoarseMesh& coarse_;
    const RefineOptions& options_;
    RefineModel& model_;
    RayTree tree_;
    std::pmr::vector<glm::dvec3> offset_;  // per point
    std::pmr::vector<double> reach_;       // m, per point
};

// Texels around the point where a ray leaves the solid, if that wall is thin enough to burn through
// together with this one.
void findOpposites(const Surface& surface, const BurnDomain& domain, const RefineOptions& options,
                   const Offsets& offsets, RefineModel& model, std::pmr::memory_resource* memory) {
    std::pmr::vector<uint32_t> surfaceOf(domain.indices.size() / 3, kNone, memory);
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
        // Where between texels: the triangle's own map, unless the point lies outside it.
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
                 const RefineOptions& options, RefineModel& model,
                 std::pmr::memory_resource* memory) {
    Offsets offsets(surface, coarse, options, model, memory);
    offsets.run(memory);
    findOpposites(surface, domain, options, offsets, model, memory);
}

}  // namespace fw::mesh
