// A depth picture of a scene as a shape that flames flow around: each texel is a small patch with
// the surface's place and slope. Surfaces outside the picture do not exist. Cosmetic.
#pragma once
#include "volume/collide.h"

#include <glm/mat4x4.hpp>

#include <memory_resource>
#include <vector>

namespace fw::volume {

constexpr uint32_t kMaxDepthSide = 512;  // texels

struct DepthTexel {
    vec3 place{0.0f};                   // m, from the camera
    bool shown = false, known = false;  // has a surface; and its slope is known
    vec3 normal{0.0f};                  // unit, towards the camera
    vec3 across{0.0f}, down{0.0f};      // m, to the places of the texels beside and below
};

struct DepthPicture {
    explicit DepthPicture(std::pmr::memory_resource* memory) : texels(memory) {}
    uint32_t columns = 0, rows = 0;
    vec3 eye{0.0f};                       // m, world, of the camera
    glm::mat4 toClip{1.0f};               // for places from the camera
    std::pmr::vector<DepthTexel> texels;  // row after row, top first
};

// `depths`: clip z over w of each texel; matrices as in FwView. Throws core::Error if they have no
// inverse, std::bad_alloc without memory for more texels; `picture` is then unchanged.
void setDepthPicture(DepthPicture& picture, std::span<const float> depths, uint32_t columns,
                     uint32_t rows, const float view[16], const float projection[16]);

// The nearest patch within `reach` m of a point. A point slightly behind a surface is inside it.
// Points further behind, or beside the picture, are far away from everything, except from the
// underside of a shelf that is seen from above with room below it.
Surface surfaceOf(const DepthPicture& picture, float reach, vec3 point) noexcept;

}  // namespace fw::volume
