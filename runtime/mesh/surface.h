// The bake's working surface: welded triangles with their place in the atlas and their neighbours.
// Internal to runtime/mesh; lives only while a bake runs. Doubles: nothing here is simulated.
#pragma once
#include "mesh/bake.h"

#include <algorithm>
#include <cmath>
#include <compare>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace fw::mesh {

// Limits of the offset from the outer skin to the inner one, per metre of thickness: its length
// where the surface bends, and its share of the distance to the wall behind.
constexpr double kLongestOffset = 2;
constexpr double kDepthShare = 0.45;

// The representative of the set of `i` (union-find with path halving).
inline uint32_t rootOf(std::span<uint32_t> parent, uint32_t i) noexcept {
    FW_ASSERT(i < parent.size(), "%u of %zu", i, parent.size());
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
}

struct Triangle {
    uint32_t source = 0;                            // triangle of the input
    uint32_t corner[3] = {};                        // vertices of the input
    uint32_t point[3] = {};                         // welded vertices
    glm::dvec3 position[3];                         // m
    glm::dvec2 uv[3] = {};                          // texels once the atlas is laid
    glm::dvec3 normal;                              // unit, by winding
    double area = 0;                                // m^2, > 0
    uint32_t neighbour[3] = {kNone, kNone, kNone};  // across edge e = corner e, corner e + 1
    uint8_t neighbourEdge[3] = {};                  // that edge's number over there
    bool seam[3] = {};                              // the atlas is cut along this edge
    uint32_t chart = kNone;                         // connected piece of the atlas
    uint32_t material = 0;
};

// An edge of a triangle by its points, for sorting; equal ones are one edge.
struct EdgeUse {
    uint32_t low, high, triangle, side;
    [[nodiscard]] bool sameEdge(const EdgeUse& o) const { return low == o.low && high == o.high; }
    auto operator<=>(const EdgeUse&) const = default;
};
// Of Triangle or CoarseTriangle.
template <class Triangles>
std::pmr::vector<EdgeUse> sortedUses(const Triangles& triangles,
                                     std::pmr::memory_resource* memory) {
    std::pmr::vector<EdgeUse> uses(memory);
    uses.reserve(triangles.size() * 3);
    for (uint32_t i = 0; i < triangles.size(); ++i)
        for (uint32_t e = 0; e < 3; ++e) {
            const uint32_t a = triangles[i].point[e], b = triangles[i].point[(e + 1) % 3];
            uses.push_back({std::min(a, b), std::max(a, b), i, e});
        }
    std::sort(uses.begin(), uses.end());
    return uses;
}

// Items listed by a key, in their own order: those of key k are items[start[k]] up to
// items[start[k + 1] - 1].
struct Groups {
    explicit Groups(std::pmr::memory_resource* memory) : start(memory), items(memory) {}
    std::pmr::vector<uint32_t> start, items;
    [[nodiscard]] std::span<const uint32_t> of(uint32_t key) const {
        FW_ASSERT(key + 1 < start.size(), "%u of %zu keys", key, start.size() - 1);
        return {items.data() + start[key], start[key + 1] - start[key]};
    }
};
// Items are 0 to `count`; keyOf(item) is below `keys`, or kNone: in no group.
template <class KeyOf>
Groups groupBy(uint32_t keys, uint32_t count, std::pmr::memory_resource* memory, KeyOf keyOf) {
    Groups groups(memory);
    groups.start.assign(size_t(keys) + 2, 0);
    for (uint32_t i = 0; i < count; ++i)
        if (const uint32_t key = keyOf(i); key != kNone) {
            FW_ASSERT(key < keys, "%u of %u keys", key, keys);
            ++groups.start[size_t(key) + 2];
        }
    for (size_t k = 2; k < groups.start.size(); ++k) groups.start[k] += groups.start[k - 1];
    groups.items.resize(groups.start.back());
    for (uint32_t i = 0; i < count; ++i)
        if (const uint32_t key = keyOf(i); key != kNone)
            groups.items[groups.start[size_t(key) + 1]++] = i;
    groups.start.pop_back();
    return groups;
}

// Faces at a vertex, summed up; and from them the offset o with o.N = -1 for every face: least
// squares, and along the mean normal where the faces leave a direction free. Zero between the two
// sides of a sheet, which cannot recede.
struct Faces {
    glm::dmat3 squares{0};  // sum of N * N^T
    glm::dvec3 sum{0};
    double weight = 0;
    void add(glm::dvec3 normal, double share) {
        squares += glm::outerProduct(normal, normal) * share;
        sum += normal * share;
        weight += share;
    }
    [[nodiscard]] glm::dvec3 offset() const;
};

struct Surface {
    explicit Surface(std::pmr::memory_resource* of) : memory(of) {}

    std::pmr::memory_resource* memory;             // of the bake
    std::pmr::vector<Triangle> triangles{memory};  // degenerate ones are not here
    uint32_t pointCount = 0;
    uint32_t chartCount = 0;
    glm::dvec3 low{0}, high{0};  // m
    double extent = 0;           // m, longest side
    double area = 0;             // m^2
    BakeReport report;           // of the steps so far
};

// How a triangle's texels lie on the surface: metres per texel along atlas u and v.
struct TexelShape {
    glm::dvec3 alongU{0}, alongV{0};  // m per texel
    double longer = 0, shorter = 0;   // m, singular values
    bool usable = false;              // false: the triangle has no area in the atlas
};

// A box in the atlas.
struct Extent2 {
    glm::dvec2 low{1e300}, high{-1e300};
    void add(glm::dvec2 uv) {
        low = glm::min(low, uv);
        high = glm::max(high, uv);
    }
    void add(const Triangle& t) {
        for (const glm::dvec2& u : t.uv) add(u);
    }
    [[nodiscard]] glm::dvec2 size() const { return high - low; }
};
// The box of those of the triangles `members` that have a chart.
Extent2 extentOf(const Surface& surface, std::span<const uint32_t> members);

inline double cross2(glm::dvec2 a, glm::dvec2 b) { return a.x * b.y - a.y * b.x; }
inline double uvArea(const Triangle& t) {  // texels^2, signed
    return 0.5 * cross2(t.uv[1] - t.uv[0], t.uv[2] - t.uv[0]);
}
template <class T>
T mixed(const T& a, const T& b, const T& c, glm::dvec3 weights) {
    return a * weights.x + b * weights.y + c * weights.z;
}
inline glm::dvec3 positionAt(const Triangle& t, glm::dvec3 weights) {
    return mixed(t.position[0], t.position[1], t.position[2], weights);
}
inline glm::dvec2 uvAt(const Triangle& t, glm::dvec3 weights) {
    return mixed(t.uv[0], t.uv[1], t.uv[2], weights);
}
inline glm::dvec3 centreOf(const Triangle& t) {
    return (t.position[0] + t.position[1] + t.position[2]) / 3.0;
}
inline uint32_t roundUp8(double texels) { return (uint32_t(std::ceil(texels)) + 7) & ~7u; }
// `otherwise` where `v` has no direction.
inline glm::dvec3 unitOr(glm::dvec3 v, glm::dvec3 otherwise) {
    const double length = glm::length(v);
    return length > 1e-300 ? v / length : otherwise;
}
// Columns that a triangle of the atlas touches in texel row y; first > last: none.
struct RowSpan {
    int first = 0, last = -1;
};
RowSpan rowSpan(const Triangle& t, int y, int width);
// Rows likewise.
RowSpan rowsOf(const Triangle& t, int height);
// Calls visit(x, y) for the texels of an atlas that a triangle touches, row by row.
template <class Visit>
void eachTouched(const Triangle& t, uint32_t width, uint32_t height, Visit visit) {
    const RowSpan rows = rowsOf(t, int(height));
    for (int y = rows.first; y <= rows.last; ++y) {
        const RowSpan span = rowSpan(t, y, int(width));
        for (int x = span.first; x <= span.last; ++x) visit(x, y);
    }
}
// Weights of a point of the atlas; false if the triangle has no area there.
bool weightsAt(const Triangle& t, glm::dvec2 uv, glm::dvec3& weights);
TexelShape texelShape(const Triangle& t);

// Throws core::Error naming the array, the element, the value and the limit.
void validate(const BakeInput& input);
// Weld and collect. `weldDistance` m. The mesh's own UVs (unscaled) or zero are put in uv.
Surface collectSurface(const BakeInput& input, double weldDistance,
                       std::pmr::memory_resource* memory);
// Neighbours, seams and charts from the welded points and uv. Non-manifold edges are paired: UV
// continuity first, then opposite winding; an edge left alone is open.
void pairEdges(Surface& surface, bool uvMeaningful);

}  // namespace fw::mesh
