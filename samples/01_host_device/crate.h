// A wooden crate as one closed surface: frame, boards and a diagonal batten on each side. It must
// be watertight, because fire crosses an edge only where two triangles share it.
#pragma once

#include <cstdint>
#include <vector>

struct CrateMesh {
    std::vector<float> positions;  // 3 per vertex, m, resting on y = 0
    std::vector<float> normals;    // 3 per vertex
    std::vector<float> details;    // 2 per vertex, m, y along the grain of the board
    std::vector<uint32_t> colors;  // RGBA8 linear, one shade per board
    std::vector<uint32_t> indices;
};

// Creates a crate. `side`: m.
CrateMesh makeCrate(float side);
