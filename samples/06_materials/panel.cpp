// See panel.h.
#include "panel.h"

#include <cmath>
#include <glm/glm.hpp>

namespace {

void addFace(Panel& panel, glm::vec3 corner, glm::vec3 x, glm::vec3 y, glm::uvec2 cells,
             glm::vec2 detail, float bend) {
    const auto first = static_cast<uint32_t>(panel.positions.size() / 3);
    const glm::vec3 flat = glm::normalize(glm::cross(x, y));
    for (uint32_t j = 0; j <= cells.y; ++j) {
        for (uint32_t i = 0; i <= cells.x; ++i) {
            const float u = static_cast<float>(i) / static_cast<float>(cells.x);
            const float v = static_cast<float>(j) / static_cast<float>(cells.y);
            // One and a half waves across, slightly deeper at the top.
            const float angle = 3.0f * 3.14159265f * (u - 0.5f), depth = bend * (0.7f + 0.3f * v);
            const float slope = -3.0f * 3.14159265f * depth * std::sin(angle) / glm::length(x);
            const glm::vec3 p = corner + x * u + y * v + flat * (depth * std::cos(angle));
            const glm::vec3 n = glm::normalize(flat - glm::normalize(x) * slope);
            panel.positions.insert(panel.positions.end(), {p.x, p.y, p.z});
            panel.normals.insert(panel.normals.end(), {n.x, n.y, n.z});
            panel.details.insert(panel.details.end(),
                                 {detail.x + u * glm::length(x), detail.y + v * glm::length(y)});
        }
    }
    for (uint32_t j = 0; j < cells.y; ++j) {
        for (uint32_t i = 0; i < cells.x; ++i) {
            const uint32_t a = first + j * (cells.x + 1) + i, b = a + cells.x + 1;
            for (const uint32_t k : {a, a + 1, b + 1, a, b + 1, b}) panel.indices.push_back(k);
        }
    }
}

}  // namespace

Panel makePanel(float width, float height, float thickness, float bend, uint32_t cells) {
    Panel panel;
    const float w = 0.5f * width, t = 0.5f * thickness;
    const glm::vec3 x(width, 0, 0), y(0, height, 0), z(0, 0, thickness);
    addFace(panel, {-w, 0, t}, x, y, {cells, cells}, {0, 0}, bend);
    if (!(thickness > 0)) return panel;
    addFace(panel, {w, 0, -t}, -x, y, {cells, cells}, {width + thickness, 0}, 0);
    addFace(panel, {w, 0, t}, -z, y, {1, cells}, {width, 0}, 0);
    addFace(panel, {-w, 0, -t}, z, y, {1, cells}, {-thickness, 0}, 0);
    addFace(panel, {-w, height, t}, x, -z, {cells, 1}, {0, height}, 0);
    addFace(panel, {-w, 0, -t}, x, z, {cells, 1}, {0, -thickness}, 0);
    return panel;
}
