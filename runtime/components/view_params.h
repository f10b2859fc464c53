// The host's view as the uniform block that shaders read.
#pragma once
#include "flamewright/flamewright.h"
#include "shared/look.h"

#include <cstdint>

namespace fw::components {

struct ViewInputs {          // values that are not in FwView
    float viewport[4] = {};  // px: x, y, width, height
    uint32_t now = 0;        // tick after the last step
    float tickFraction = 0;  // [0, 1) into the next
    uint32_t lightCount = 16;
    float lastLight = 1;  // (0, 1], share of its own fires that the last light takes
    uint32_t flameCapacity = gpu::kFlameCapacity;
    uint32_t seed = 1;
    float quadShare = 1;  // (0, 1]
    float up[3] = {0, 1, 0};
    float wind[3] = {};
    float paceFactor = 1;
};

[[nodiscard]] gpu::ViewParams makeViewParams(const FwView& view, const ViewInputs& inputs) noexcept;

}  // namespace fw::components
