// Thickness of the solid under a texel: distance to the first surface that an inward ray meets.
#include "mesh/ray_tree.h"
#include "mesh/texels.h"

namespace fw::mesh {
namespace {

constexpr double kUnit = 1e-4;  // m per unit of thickness

}  // namespace

void bakeThickness(const Surface& surface, const TexelGrid& grid,
                   std::pmr::vector<uint16_t>& thickness) {
    thickness.assign(grid.count(), 0xFFFF);
    const RayTree tree(surface);
    // Skips the texel's own surface, and its neighbours where the surface bends.
    const float least = float(std::max(0.01 * grid.side, 1e-5 * surface.extent));
    FW_ASSERT(least > 0, "%g m", double(least));
    int64_t stepsLeft = RayTree::kStepBudget + RayTree::kStepsPerTexel * int64_t(grid.count());
    for (uint32_t texel = 0; texel < grid.count(); ++texel) {
        if (!grid.real(texel)) continue;
        const glm::vec3 inward(-surface.triangles[grid.owner[texel]].normal);
        const float distance =
            tree.cast(grid.position[texel], inward, least, grid.owner[texel], stepsLeft);
        if (distance < RayTree::kReach)
            thickness[texel] = uint16_t(std::max(1.0, std::floor(double(distance) / kUnit + 0.5)));
    }
}

}  // namespace fw::mesh
