// See outline.h.
#include "viewport/outline.h"

#include <glm/gtc/type_ptr.hpp>
#include <map>
#include <unordered_map>

namespace fwview {

OutlineEdges findEdges(const fwimport::ImportedModel& model) {
    std::map<std::array<float, 3>, uint32_t> places;
    std::vector<uint32_t> welded(model.vertexCount());
    for (uint32_t i = 0; i < model.vertexCount(); ++i) {
        const float* p = &model.positions[3 * size_t{i}];
        welded[i] = places.emplace(std::array<float, 3>{p[0], p[1], p[2]}, i).first->second;
    }
    OutlineEdges result;
    std::unordered_map<uint64_t, size_t> known;
    for (uint32_t t = 0; t < model.triangleCount(); ++t) {
        for (uint32_t k = 0; k < 3; ++k) {
            uint32_t a = welded[model.indices[3 * size_t{t} + k]];
            uint32_t b = welded[model.indices[3 * size_t{t} + (k + 1) % 3]];
            if (a == b) continue;
            if (a > b) std::swap(a, b);
            const auto [found, fresh] = known.emplace(uint64_t{a} << 32 | b, result.edges.size());
            if (fresh) {
                result.edges.push_back({a, b, t});
            } else {
                result.edges[found->second].right = t;
            }
        }
    }
    return result;
}

void findOutline(const fwimport::ImportedModel& model, const OutlineEdges& edges, glm::vec3 eye,
                 std::vector<glm::vec3>& lines) {
    auto vertex = [&](uint32_t i) { return glm::make_vec3(&model.positions[3 * size_t{i}]); };
    std::vector<uint8_t> faces(model.triangleCount());
    for (size_t t = 0; t < faces.size(); ++t) {
        const glm::vec3 a = vertex(model.indices[3 * t]);
        const glm::vec3 normal =
            glm::cross(vertex(model.indices[3 * t + 1]) - a, vertex(model.indices[3 * t + 2]) - a);
        faces[t] = glm::dot(normal, eye - a) > 0;
    }
    lines.clear();
    for (const OutlineEdges::Edge& edge : edges.edges) {
        if (edge.right != ~0u && faces[edge.left] == faces[edge.right]) continue;
        lines.push_back(vertex(edge.from));
        lines.push_back(vertex(edge.to));
    }
}

}  // namespace fwview
