// Panels to burn: slabs with all six sides, and thin sheets that stand because they are bent.
#pragma once

#include <cstdint>
#include <vector>

struct Panel {
    std::vector<float> positions, normals, details;  // m; details run on around corners
    std::vector<uint32_t> indices;
};

// Stands on y = 0, faces +z. `thickness` m; 0: a sheet of one layer, bent by `bend` m.
Panel makePanel(float width, float height, float thickness, float bend);
