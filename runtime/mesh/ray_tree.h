// A median-split tree over a surface's triangles, for the bake's rays. Floats, relative to
// Surface::low. Internal to runtime/mesh.
#pragma once
#include "mesh/surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fw::mesh {

class RayTree {
 public:
    static constexpr float kReach = 6.5534f;  // m, length of a ray
    // Limits of the boxes and triangles tested per ray and in all, so that a bake of thousands of
    // overlapping triangles does not take minutes. Once the budget of all rays is used up, a ray
    // has kWeakSteps.
    static constexpr uint32_t kMostSteps = 4096, kWeakSteps = 48;
    static constexpr int64_t kStepBudget = 1 << 26, kStepsPerTexel = 192;

    explicit RayTree(const Surface& surface) : surface_(surface) {
        const uint32_t count = uint32_t(surface.triangles.size());
        FW_ASSERT(count > 0);
        for (uint32_t i = 0; i < count; ++i) {
            order_.push_back(i);
            centres_.push_back(glm::vec3(centreOf(surface.triangles[i]) - surface.low));
        }
        nodes_.reserve(size_t(count) + 2);
        build(0, count);
        shapes_.reserve(count);
        for (uint32_t i : order_) {
            const Triangle& t = surface.triangles[i];
            shapes_.push_back({glm::vec3(t.position[0] - surface.low),
                               glm::vec3(t.position[1] - t.position[0]),
                               glm::vec3(t.position[2] - t.position[0]), i});
        }
    }

    // Distance to the first tested triangle beyond `least`, other than `self`; kReach or more:
    // none. Subtracts the ray's steps from `stepsLeft`.
    [[nodiscard]] float cast(glm::vec3 from, glm::vec3 direction, float least, uint32_t self,
                             int64_t& stepsLeft) const {
        const glm::vec3 inverse(invert(direction.x), invert(direction.y), invert(direction.z));
        float nearest = kReach;
        const uint32_t most = stepsLeft > 0 ? kMostSteps : kWeakSteps;
        uint32_t steps = 0;
        struct Visit {
            uint32_t node;
            float enter;
        } stack[64];
        int depth = 0;
        stack[depth++] = {0, enter(nodes_[0], from, inverse, nearest)};
        while (depth > 0 && steps < most) {
            const Visit visit = stack[--depth];
            ++steps;
            if (!(visit.enter <= nearest)) continue;
            const Node& node = nodes_[visit.node];
            if (node.count > 0) {
                steps += node.count;
                for (uint32_t i = node.first; i < node.first + node.count; ++i)
                    if (shapes_[i].triangle != self)
                        nearest = std::min(nearest, hit(shapes_[i], from, direction, least));
                continue;
            }
            const Visit a{visit.node + 1, enter(nodes_[visit.node + 1], from, inverse, nearest)};
            const Visit b{node.first, enter(nodes_[node.first], from, inverse, nearest)};
            const bool aFirst = a.enter <= b.enter;  // the nearer one goes on top
            FW_ASSERT(depth + 2 <= 64, "depth %d", depth);
            stack[depth++] = aFirst ? b : a;
            stack[depth++] = aFirst ? a : b;
        }
        stepsLeft -= steps;
        return nearest;
    }

 private:
    static constexpr uint32_t kLeaf = 4;  // triangles

    struct Node {
        glm::vec3 low, high;
        uint32_t first = 0;  // leaf: into shapes_; inner: the second child (the first one follows)
        uint32_t count = 0;  // leaf: triangles; inner: 0
    };

    struct Shape {  // of a triangle, relative to Surface::low
        glm::vec3 corner, edge1, edge2;
        uint32_t triangle;
    };
    static float invert(float v) { return std::abs(v) > 1e-20f ? 1 / v : (v < 0 ? -1e20f : 1e20f); }

    void build(uint32_t begin, uint32_t end) {
        FW_ASSERT(begin < end && end <= order_.size(), "triangles %u to %u", begin, end);
        const uint32_t index = uint32_t(nodes_.size());
        Node node{glm::vec3(1e30f), glm::vec3(-1e30f)};
        glm::vec3 low(1e30f), high(-1e30f);  // of the centres
        for (uint32_t i = begin; i < end; ++i) {
            for (const glm::dvec3& p : surface_.triangles[order_[i]].position) {
                const glm::vec3 q(p - surface_.low);
                node.low = glm::min(node.low, q - pad_);
                node.high = glm::max(node.high, q + pad_);
            }
            low = glm::min(low, centres_[order_[i]]);
            high = glm::max(high, centres_[order_[i]]);
        }
        if (end - begin <= kLeaf) {
            node.first = begin;
            node.count = end - begin;
            nodes_.push_back(node);
            return;
        }
        nodes_.push_back(node);
        const glm::vec3 size = high - low;
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const uint32_t middle = begin + (end - begin) / 2;
        std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                         [&](uint32_t a, uint32_t b) {
                             const float ca = centres_[a][axis], cb = centres_[b][axis];
                             return ca != cb ? ca < cb : a < b;
                         });
        build(begin, middle);
        nodes_[index].first = uint32_t(nodes_.size());
        build(middle, end);
    }

    // Distance at which a ray enters a node's box; infinity: it misses the box before `nearest`.
    static float enter(const Node& node, glm::vec3 from, glm::vec3 inverse, float nearest) {
        const glm::vec3 a = (node.low - from) * inverse, b = (node.high - from) * inverse;
        const glm::vec3 in = glm::min(a, b), out = glm::max(a, b);
        const float first = std::max({in.x, in.y, in.z, 0.0f});
        const float last = std::min({out.x, out.y, out.z, nearest});
        return first <= last ? first : std::numeric_limits<float>::infinity();
    }

    [[nodiscard]] static float hit(const Shape& shape, glm::vec3 from, glm::vec3 direction,
                                   float least) {
        const glm::vec3 p = glm::cross(direction, shape.edge2);
        const float determinant = glm::dot(shape.edge1, p);
        if (std::abs(determinant) < 1e-30f) return kReach;
        const glm::vec3 s = from - shape.corner;
        const float inverse = 1 / determinant;
        const float u = glm::dot(s, p) * inverse;
        if (!(u >= -1e-5f) || !(u <= 1.00001f)) return kReach;
        const glm::vec3 q = glm::cross(s, shape.edge1);
        const float v = glm::dot(direction, q) * inverse;
        if (!(v >= -1e-5f) || !(u + v <= 1.00001f)) return kReach;
        const float distance = glm::dot(shape.edge2, q) * inverse;
        return distance > least ? distance : kReach;
    }

    const Surface& surface_;
    // m: a texel on the rim of a box must not miss it by rounding.
    float pad_ = float(1e-6 * surface_.extent);
    std::pmr::vector<Node> nodes_{surface_.memory};
    std::pmr::vector<Shape> shapes_{surface_.memory};
    std::pmr::vector<uint32_t> order_{surface_.memory};
    std::pmr::vector<glm::vec3> centres_{surface_.memory};
};

}  // namespace fw::mesh
