// Buffers of a pass that asks the heat shield: shaders/lib/shield_uses.glsl names the same.
#pragma once
#include "gpu/passes/pass.h"

namespace fw::gpu {

// Its cells, and whether what fills them is still there.
inline constexpr Use kShieldUses[] = {
    {FW_BIND_SHIELD, Access::read},
    {FW_BIND_STATE, Access::read},
    {FW_BIND_HEAT, Access::read},
    {FW_BIND_MATERIALS, Access::read},
};

}  // namespace fw::gpu
