// Panels to burn: slabs with all six sides, and thin sheets, bent, of one layer.
#pragma once

#include <cstdint>
#include <vector>

struct Panel {
    std::vector<float> positions, normals, details;  // m; details run on around corners
    std::vector<uint32_t> indices;
};

// Stands on y = 0, faces +z. `thickness` m; 0: a sheet of one layer, bent by `bend` m. `cells`
// along each side of the front.
Panel makePanel(float width, float height, float thickness, float bend, uint32_t cells);
