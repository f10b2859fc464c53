// Shows a thing as it is: the same even light from everywhere and a flat grey behind it; no floor,
// no shadow, no film curve. The same model and camera give the same picture, whichever
// program draws it.
#pragma once

#include <array>
#include <cstdint>

#include "flamewright/flamewright.h"

namespace fwmodel {

constexpr std::array<float, 3> kNeutralBackground{0.18f, 0.18f, 0.18f};  // linear

struct NeutralCamera {  // looks at the middle of what it shows
    float yaw = 30;     // degrees, 0 looks along -z
    float pitch = 14;   // degrees above the horizon
};

// All that lies between `low` and `high` (m, world, y up) in the middle of the picture, with a
// margin. The light is such that white is drawn nearly white without exposure.
FwView neutralView(const std::array<float, 3>& low, const std::array<float, 3>& high,
                   const NeutralCamera& camera, uint32_t width, uint32_t height);

// Sets the view's projection: Vulkan's clip space, depth 0 at `near` and 1 at `far`, both in m.
// fieldOfView: rad, vertical.
void setPerspective(FwView& view, float fieldOfView, float aspect, float near, float far);

}  // namespace fwmodel
