// The bake's working surface: welded triangles with their place in the atlas and their neighbours.
// Internal to runtime/mesh; lives only while a bake runs. Doubles: nothing here is simulated.
#pragma once
#include "mesh/bake.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace fw::mesh {

// Of the way from a point of the outer skin to where the inner one lies, per metre of thickness:
// how long it may be where the surface bends, and how much of the way to the wall behind it may
// take.
constexpr double kLongestOffset = 2;
constexpr double kDepthShare = 0.45;

// The one that stands for all that are joined with `i` (union-find; parents are shortened on the
// way).
inline uint32_t rootOf(std::span<uint32_t> parent, uint32_t i) noexcept {
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

struct Surface {
    explicit Surface(std::pmr::memory_resource* memory) : triangles(memory) {}

    std::pmr::vector<Triangle> triangles;  // degenerate ones are not here
    uint32_t pointCount = 0;
    uint32_t chartCount = 0;
    glm::dvec3 low{0}, high{0};  // m
    double extent = 0;           // m, longest side
    double area = 0;             // m^2
    uint32_t degenerate = 0, openEdges = 0, nonManifoldEdges = 0, seamEdges = 0;
};

// How a triangle's texels lie on the surface: metres per texel along atlas u and v.
struct TexelShape {
    glm::dvec3 alongU{0}, alongV{0};  // m per texel
    double longer = 0, shorter = 0;   // m, singular values
    bool usable = false;              // false: the triangle has no area in the atlas
};

inline double cross2(glm::dvec2 a, glm::dvec2 b) { return a.x * b.y - a.y * b.x; }
inline double uvArea(const Triangle& t) {  // texels^2, signed
    return 0.5 * cross2(t.uv[1] - t.uv[0], t.uv[2] - t.uv[0]);
}
inline glm::dvec3 positionAt(const Triangle& t, glm::dvec3 weights) {
    return t.position[0] * weights.x + t.position[1] * weights.y + t.position[2] * weights.z;
}
inline glm::dvec2 uvAt(const Triangle& t, glm::dvec3 weights) {
    return t.uv[0] * weights.x + t.uv[1] * weights.y + t.uv[2] * weights.z;
}
// Columns that a triangle of the atlas touches in texel row y; first > last: none.
struct RowSpan {
    int first = 0, last = -1;
};
RowSpan rowSpan(const Triangle& t, int y, int width);
// Rows likewise.
RowSpan rowsOf(const Triangle& t, int height);
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
void pairEdges(Surface& surface, bool uvMeaningful, std::pmr::memory_resource* memory);

}  // namespace fw::mesh
