// See crate.h.
#include "crate.h"

#include <glm/glm.hpp>

namespace {

struct Face {  // a side of the crate: u points right, v up, w outwards
    glm::vec3 center, u, v, w;
};

struct Builder {
    CrateMesh& mesh;
    Face face{};
    uint32_t board = 0;

    glm::vec3 at(glm::vec3 p) const {
        return face.center + face.u * p.x + face.v * p.y + face.w * p.z;
    }

    // Fans a counter-clockwise polygon, in the face's coordinates, from its first corner. The first
    // corner must not be collinear with the next two. `along`: direction of the grain.
    void polygon(const std::vector<glm::vec3>& corners, glm::vec2 along, float shade) {
        const auto base = static_cast<uint32_t>(mesh.positions.size() / 3);
        glm::vec3 normal(0);
        for (size_t i = 1; i + 1 < corners.size(); ++i) {
            normal +=
                glm::cross(at(corners[i]) - at(corners[0]), at(corners[i + 1]) - at(corners[0]));
        }
        normal = glm::normalize(normal);
        const glm::vec2 grain = glm::normalize(along), across(grain.y, -grain.x);
        // Offset each board to its own part of the wood texture.
        const glm::vec2 piece(0.37f * static_cast<float>(board % 17),
                              0.71f * static_cast<float>(board));
        const auto light = static_cast<uint32_t>(255.0f * shade);
        for (const glm::vec3& corner : corners) {
            const glm::vec3 p = at(corner);
            const glm::vec2 flat(corner);
            for (int c = 0; c < 3; ++c) {
                mesh.positions.push_back(p[c]);
                mesh.normals.push_back(normal[c]);
            }
            mesh.details.push_back(glm::dot(flat, across) + piece.x + corner.z);
            mesh.details.push_back(glm::dot(flat, grain) + piece.y);
            mesh.colors.push_back(0xff000000u | light << 16 | light << 8 | light);
        }
        for (uint32_t i = 1; i + 1 < corners.size(); ++i) {
            for (uint32_t k : {0u, i, i + 1}) mesh.indices.push_back(base + k);
        }
    }

    float nextBoard() {  // shade of the next board
        ++board;
        const uint32_t bits = (board * 2654435761u) >> 24;
        return 0.74f + 0.26f * static_cast<float>(bits) / 255.0f;
    }

    // Adds one side. Wherever a corner touches an edge, the polygon beyond has that corner too, so
    // the surface stays watertight.
    void side(float half) {
        const float inner = 0.78f * half, width = 0.24f * half;  // frame, half the batten
        const float split = inner - width;                       // where the batten ends
        const float wallDepth = -0.085f * half,
                    lean = -0.030f * half;  // height of boards and batten: below the frame
        const float joints[3] = {-0.5f * inner, 0.0f, 0.5f * inner};  // between the boards
        const glm::vec3 quarter[4] = {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}};
        for (int k = 0; k < 4; ++k) {
            const glm::vec3 x = quarter[k], y = quarter[(k + 1) % 4];
            auto p = [&](float a, float z) { return a * x - inner * y + glm::vec3(0, 0, z); };
            const glm::vec3 left = -half * (x + y), right = half * (x - y);
            const glm::vec2 grain(x);
            const float tone = nextBoard();
            if (k % 2 == 0) {  // the batten meets the start of this edge
                polygon({left, right, p(inner, 0), p(-split, 0), p(-inner, 0)}, grain, tone);
                polygon({p(-inner, 0), p(-split, 0), p(-split, lean), p(-inner, lean)}, grain,
                        tone);
                polygon({p(inner, 0), p(inner, wallDepth), p(-split, wallDepth), p(-split, lean),
                         p(-split, 0)},
                        grain, tone);
            } else {  // the batten meets its end, and the boards end here
                polygon({left, right, p(inner, 0), p(split, 0), p(-inner, 0)}, grain, tone);
                polygon({p(split, 0), p(inner, 0), p(inner, lean), p(split, lean)}, grain, tone);
                polygon({p(-inner, 0), p(split, 0), p(split, lean), p(split, wallDepth),
                         p(joints[2], wallDepth), p(joints[1], wallDepth), p(joints[0], wallDepth),
                         p(-inner, wallDepth)},
                        grain, tone);
            }
        }
        const float tone = nextBoard();
        auto low = [&](float v, float z) { return glm::vec3(v + width, v, z); };
        auto high = [&](float v, float z) { return glm::vec3(v - width, v, z); };
        polygon({{-inner, -inner, lean},
                 low(-inner, lean),
                 low(split, lean),
                 {inner, inner, lean},
                 high(inner, lean),
                 high(-split, lean)},
                {1, 1}, tone);
        polygon({low(-inner, lean), low(-inner, wallDepth), low(joints[0], wallDepth),
                 low(joints[1], wallDepth), low(joints[2], wallDepth), low(split, wallDepth),
                 low(split, lean)},
                {1, 1}, tone);
        polygon({high(inner, lean), high(inner, wallDepth), high(joints[2], wallDepth),
                 high(joints[1], wallDepth), high(joints[0], wallDepth), high(-split, wallDepth),
                 high(-split, lean)},
                {1, 1}, tone);
        auto wallR = [&](float v) { return glm::vec3(inner, v, wallDepth); };
        auto wallL = [&](float v) { return glm::vec3(-inner, v, wallDepth); };
        const glm::vec2 level(1, 0);
        polygon(
            {low(-inner, wallDepth), wallR(-inner), wallR(joints[0]), low(joints[0], wallDepth)},
            level, nextBoard());
        for (int i = 0; i < 2; ++i) {
            polygon({low(joints[i], wallDepth), wallR(joints[i]), wallR(joints[i + 1]),
                     low(joints[i + 1], wallDepth)},
                    level, nextBoard());
            polygon({wallL(joints[i]), high(joints[i], wallDepth), high(joints[i + 1], wallDepth),
                     wallL(joints[i + 1])},
                    level, nextBoard());
        }
        polygon({low(joints[2], wallDepth), wallR(joints[2]), wallR(split)}, level, nextBoard());
        polygon({wallL(-split), high(joints[0], wallDepth), wallL(joints[0])}, level, nextBoard());
        polygon(
            {wallL(joints[2]), high(joints[2], wallDepth), high(inner, wallDepth), wallL(inner)},
            level, nextBoard());
    }
};

}  // namespace

CrateMesh makeCrate(float side) {
    CrateMesh mesh;
    Builder builder{mesh};
    const float half = 0.5f * side;
    const glm::vec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int i = 0; i < 6; ++i) {
        const float sign = i & 1 ? -1.0f : 1.0f;
        const glm::vec3 w = sign * axes[i / 2];
        const glm::vec3 up = i / 2 == 1 ? glm::vec3(0, 0, -sign) : axes[1];
        builder.face = {glm::vec3(0, half, 0) + half * w, glm::cross(up, w), up, w};
        builder.side(half);
    }
    return mesh;
}
