// A picture of a scene's depth as a shape that flames flow around. Each texel of it is a small
// patch where the surface is and as it lies; what the picture does not show is not there. Cosmetic.
#pragma once
#include "volume/collide.h"

#include <glm/mat4x4.hpp>

#include <memory_resource>
#include <vector>

namespace fw::volume {

constexpr uint32_t kMaxDepthSide = 512;  // texels

struct DepthTexel {
    vec3 place{0.0f};                   // m, from the eye
    bool shown = false, known = false;  // there is something there; and how it lies
    vec3 normal{0.0f};                  // unit, to the eye's side
    vec3 across{0.0f}, down{0.0f};      // m, to the places of the texels beside and below
};

struct DepthPicture {
    explicit DepthPicture(std::pmr::memory_resource* memory) : texels(memory) {}
    uint32_t columns = 0, rows = 0;
    vec3 eye{0.0f};                       // m, world
    glm::mat4 toClip{1.0f};               // of places from the eye
    std::pmr::vector<DepthTexel> texels;  // row after row, top first
};

// `depths`: clip z over w of each texel; both matrices as FwView has them. Throws core::Error where
// no depth can be told from them, or memory for more texels than before is not there; `picture` is
// then unchanged.
void setDepthPicture(DepthPicture& picture, std::span<const float> depths, uint32_t columns,
                     uint32_t rows, const float view[16], const float projection[16]);

// Of what is shown within `reach` m around a point the nearest. A little behind a surface it is
// inside; further behind, or beside the picture, nothing is known and far away, but for the
// underside of what is seen from above with room below it.
Surface surfaceOf(const DepthPicture& picture, float reach, vec3 point) noexcept;

}  // namespace fw::volume
