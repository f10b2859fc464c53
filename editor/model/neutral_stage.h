// A neutral stage: even light from all directions, a flat grey background, no floor, no shadow, no
// filmic curve. Equal models and cameras give equal pictures in every program.
#pragma once

#include <array>
#include <cstdint>

#include "flamewright/flamewright.h"

namespace fwmodel {

constexpr std::array<float, 3> kNeutralBackground{0.18f, 0.18f, 0.18f};  // linear

struct NeutralCamera {  // looks at the centre of the subject
    float yaw = 30;     // degrees, 0 looks along -z
    float pitch = 14;   // degrees above the horizon
};

// Frames the box from `low` to `high` (m, world, y up) with a margin. White renders as almost white
// without exposure.
FwView neutralView(const std::array<float, 3>& low, const std::array<float, 3>& high,
                   const NeutralCamera& camera, uint32_t width, uint32_t height);

// Sets a perspective projection in Vulkan clip space: depth 0 at `near` and 1 at `far`, m.
// fieldOfView: rad, vertical.
void setPerspective(FwView& view, float fieldOfView, float aspect, float near, float far);

}  // namespace fwmodel
