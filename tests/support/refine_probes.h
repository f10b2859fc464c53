// Points fixed on a refined surface, followed from frame to frame: they must not jump when levels
// change.
#pragma once
#include "mesh/refine/table.h"
#include "support/refine_scene.h"

namespace fw::test {

struct Probe {
    uint32_t triangle;
    double b1, b2;
};
inline std::vector<Probe> probesOn(const mesh::RefineModel& model, uint32_t perTriangle) {
    std::mt19937 random(3);
    std::vector<Probe> probes;
    const auto unit = [&] { return double(random() % 1000) / 1000; };
    for (uint32_t i = 0; i < model.triangles.size(); ++i)
        for (uint32_t k = 0; k < perTriangle; ++k) {
            double a = unit(), b = unit();
            if (a + b > 1) {
                a = 1 - a;
                b = 1 - b;
            }
            probes.push_back({i, a, b});
        }
    return probes;
}
inline std::vector<glm::vec3> placesOf(const mesh::RefineModel& model,
                                       const mesh::RefineState& state,
                                       const std::vector<Probe>& probes) {
    std::vector<glm::vec3> places;
    size_t next = 0;
    for (uint32_t i = 0; i < model.triangles.size() && next < probes.size(); ++i) {
        const uint32_t levels = state.levels[i], count = gpu::refineCount(levels);
        struct Small {
            glm::dvec2 p[3];
            glm::vec3 at[3];
        };
        std::vector<Small> small(count);
        for (uint32_t k = 0; k < count; ++k) {
            const glm::uvec3 codes = mesh::refineTriangle(levels, k);
            for (int v = 0; v < 3; ++v) {
                const glm::uvec3 w = gpu::refineWeights(levels, codes[v]);
                small[k].p[v] = glm::dvec2(w.y, w.z) / 32.0;
                const uint32_t draw = gpu::refineDrawVertex(model.triangles[i], levels, codes[v]);
                const gpu::RefineVertex& x = state.vertices[model.draws[draw].slot];
                small[k].at[v] = {x.x, x.y, x.z};
            }
        }
        for (; next < probes.size() && probes[next].triangle == i; ++next) {
            const glm::dvec2 x(probes[next].b1, probes[next].b2);
            double best = -1e9;
            glm::vec3 place(0);
            for (const Small& s : small) {
                const auto cross2 = [](glm::dvec2 a, glm::dvec2 b) {
                    return a.x * b.y - a.y * b.x;
                };
                const double area = cross2(s.p[1] - s.p[0], s.p[2] - s.p[0]);
                const double w1 = cross2(x - s.p[0], s.p[2] - s.p[0]) / area;
                const double w2 = cross2(s.p[1] - s.p[0], x - s.p[0]) / area;
                const double inside = std::min({1 - w1 - w2, w1, w2});
                if (inside <= best) continue;
                best = inside;
                place = s.at[0] * float(1 - w1 - w2) + s.at[1] * float(w1) + s.at[2] * float(w2);
                if (inside >= 0) break;
            }
            places.push_back(place);
        }
    }
    return places;
}

}  // namespace fw::test
