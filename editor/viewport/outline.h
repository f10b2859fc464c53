// The outline of a model as seen: edges between a triangle that faces the eye and one that does
// not.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <vector>

#include "import/gltf_import.h"

namespace fwview {

struct OutlineEdges {  // of one model, made once
    struct Edge {
        uint32_t from, to;           // vertices
        uint32_t left, right = ~0u;  // triangles; right ~0: an open edge
    };
    std::vector<Edge> edges;
};
// Vertices at one place count as one.
OutlineEdges findEdges(const fwimport::ImportedModel& model);
// Pairs of points, model space, as seen from `eye`, model space too.
void findOutline(const fwimport::ImportedModel& model, const OutlineEdges& edges, glm::vec3 eye,
                 std::vector<glm::vec3>& lines);

}  // namespace fwview
