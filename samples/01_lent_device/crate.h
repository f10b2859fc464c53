// A wooden crate as one closed surface: frame, boards and a diagonal batten on every side. It is
// watertight on purpose, for fire crosses an edge only where two triangles share it.
#pragma once

#include <cstdint>
#include <vector>

struct CrateMesh {
    std::vector<float> positions;  // 3 per vertex, m, standing on y = 0
    std::vector<float> normals;    // 3 per vertex
    std::vector<float> details;    // 2 per vertex, m, y along the grain of its board
    std::vector<uint32_t> colors;  // RGBA8 linear, a shade for each board
    std::vector<uint32_t> indices;
};

// `side`: m.
CrateMesh makeCrate(float side);
