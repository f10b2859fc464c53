// holeDelay of shaders/surface/appearance.glsl, for slots.
#include "mesh/refine/model.h"

#include <algorithm>
#include <cmath>

namespace fw::mesh {
namespace {

constexpr float kPlank = 0.15f;  // m

float zigzag(float x) { return std::abs(x - std::floor(x) - 0.5f) * 4 - 1; }

// Coordinates of the pattern without detail coordinates: along the axis that the surface faces
// most, with ragged joins.
void flatten(const float* p, uint32_t normal, float* d) {
    const float n[3] = {float(int(normal << 21) >> 21) / 1023,
                        float(int(normal << 10) >> 21) / 1023, float(int(normal) >> 22) / 511};
    const float da = zigzag(5.0f * (p[0] + p[2]) + 0.8f * zigzag(7.3f * p[1] + 0.2f));
    const float db = zigzag(4.3f * (p[1] + 0.7f * p[2]) + 0.8f * zigzag(9.2f * p[0]));
    const float x = std::abs(n[0]) + 0.1f * da, y = std::abs(n[1]) + 0.1f * db,
                z = std::abs(n[2]) - 0.05f * (da + db);
    const bool facesX = x > y && x > z, facesY = !facesX && y > z;
    d[0] = facesX ? p[2] : p[0];
    d[1] = facesY ? p[2] : p[1];
}

float sample(std::span<const uint8_t> noise, uint32_t side, float u, float v) {
    FW_ASSERT(side > 0 && noise.size() >= size_t(side) * side, "side %u", side);
    const float x = u * float(side) - 0.5f, y = v * float(side) - 0.5f;
    const float fx = x - std::floor(x), fy = y - std::floor(y);
    const auto at = [&](int i, int j) {
        const uint32_t column = uint32_t(int(std::floor(x)) + i) % side;
        const uint32_t row = uint32_t(int(std::floor(y)) + j) % side;
        return float(noise[row * side + column]);
    };
    const float below = at(0, 0) * (1 - fx) + at(1, 0) * fx;
    const float above = at(0, 1) * (1 - fx) + at(1, 1) * fx;
    return (below * (1 - fy) + above * fy) / 255;
}

}  // namespace

void refineRoughen(const BurnDomain& domain, const RefineModel& model,
                   std::span<const RefineHoles> materials, std::span<const uint8_t> noise,
                   uint32_t side, std::span<gpu::RefineSlot> slots) noexcept {
    FW_ASSERT(slots.size() <= model.draws.size() && noise.size() >= size_t(side) * side,
              "%zu slots, %zu bytes of noise", slots.size(), noise.size());
    const bool solid = hasInside(domain, model);
    for (uint32_t i = 0; i < slots.size(); ++i) {
        gpu::RefineSlot& slot = slots[i];
        const uint32_t material = slot.texel >> 24;
        if (material >= materials.size() || model.draws[i].triangle == kNone) continue;
        const RefineHoles& holes = materials[material];
        if (!(holes.variation > 0)) continue;
        const RenderVertex v = refineRenderVertex(domain, model, i);
        float d[2] = {v.detail[0], v.detail[1]};
        // Walls that burn through together have the same holes, whatever their patterns. So have
        // all walls of a solid except planks.
        const bool detailed =
            domain.hasDetail && slot.opposite == gpu::kRefineOpposed && (holes.wood || !solid);
        if (!detailed) flatten(v.position, v.normal, d);
        if (holes.wood) {
            const float plank = detailed ? std::floor(d[0] / kPlank + 64) : 3;
            d[0] += plank * 0.77f;
            d[1] += plank * 1.31f;
        }
        float n = (sample(noise, side, d[0] * holes.tilesX, d[1] * holes.tilesY) - 0.5f) * 1.8f;
        n = n < 0 ? n : 0.45f * n;
        const float scale = std::max(1 + holes.variation * n, 0.1f);
        const auto through = std::min(float(slot.reach >> 16) * scale, 65535.0f);
        slot.reach = (slot.reach & 0xFFFFu) | uint32_t(through) << 16;
    }
}

}  // namespace fw::mesh
