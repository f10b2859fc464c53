// The place of every triangle in the burn atlas. Uses the mesh's own UVs where they are unique and
// even enough; otherwise keeps its good islands, cuts the rest into flat charts and packs them all.
#pragma once
#include "mesh/surface.h"

namespace fw::mesh {

struct AtlasPlan {
    uint32_t width = 0, height = 0;  // texels, multiples of 8
    double density = 0;              // texels per metre, at most BakeInput::texelsPerMetre
    bool ownUv = false;              // the mesh's own layout, scaled
    uint32_t recharted = 0;          // triangles that got a chart of ours
};

// Sets uv (texels) of every triangle. Neighbours must be paired again afterwards.
AtlasPlan packAtlas(Surface& surface, const BakeInput& input);

// Strict uniqueness test by rasterising: a texel centre well inside two triangles is a conflict.
class Coverage {
 public:
    explicit Coverage(std::pmr::memory_resource* memory) : owner_(memory) {}
    void clear(uint32_t width, uint32_t height) {
        FW_ASSERT(width > 0 && height > 0, "%u x %u texels", width, height);
        width_ = width;
        height_ = height;
        owner_.assign(size_t(width) * height, 0);
    }
    // Triangle corners in texels. Returns conflicts; a triangle with any marks nothing.
    uint32_t add(const Triangle& t, glm::dvec2 offset, double scale);

 private:
    std::pmr::vector<uint8_t> owner_;
    uint32_t width_ = 0, height_ = 0;
};

// Triangles by chart; every triangle has one.
Groups groupByChart(const Surface& surface, uint32_t charts);

// Cuts the triangles of `pool` into flat charts numbered from `firstChart`; sets chart and uv in
// metres. No texel of a chart is stretched more than 2 : 1, none lies twice. `density` is texels
// per metre for the tests; `longest` m is the longest side a chart should have. Returns the number
// of charts after these.
uint32_t growCharts(Surface& surface, std::pmr::vector<uint32_t>& pool, uint32_t firstChart,
                    double density, double longest);

// Places charts (uv in metres) with at least two free texels between them; sets uv in texels.
// Lowers the density until all fit. Throws core::Error if they never do.
AtlasPlan packCharts(Surface& surface, uint32_t charts, double density, uint32_t maxSide);

}  // namespace fw::mesh
