// What a host says of a view, made into the uniform block that shaders read. Pure; no device.
#pragma once
#include "flamewright/flamewright.h"
#include "shared/look.h"

#include <cstdint>

namespace fw::components {

struct ViewInputs {          // what the host's view does not know
    float viewport[4] = {};  // px: x, y, width, height
    uint32_t now = 0;        // tick after the last step
    float tickFraction = 0;  // [0, 1) into the next
    uint32_t lightCount = 16;
    float lastLight = 1;  // (0, 1], share of its own fires that the last of them shines for
    uint32_t flameCapacity = gpu::kFlameCapacity;
    uint32_t seed = 1;
    float quadShare = 1;  // (0, 1]
    float up[3] = {0, 1, 0};
    float wind[3] = {};
    float paceFactor = 1;
};

[[nodiscard]] gpu::ViewParams makeViewParams(const FwView& view, const ViewInputs& inputs) noexcept;

}  // namespace fw::components
