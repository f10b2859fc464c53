// Panels to burn: closed slabs, and thin bent sheets of one layer.
#pragma once

#include <cstdint>
#include <vector>

struct Panel {
    std::vector<float> positions, normals, details;  // m; details continue around corners
    std::vector<uint32_t> indices;
};

// Creates a panel that stands on y = 0 and faces +z. `thickness` m; 0: a single-layer sheet, bent
// by `bend` m. `cells`: along each side of the front.
Panel makePanel(float width, float height, float thickness, float bend, uint32_t cells);
