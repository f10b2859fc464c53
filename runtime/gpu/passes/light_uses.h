// Buffers of a pass that lights texels (lightTexel in shaders/lib/light.glsl):
// shaders/lib/light_uses.glsl names the same.
#pragma once
#include "gpu/passes/pass.h"

namespace fw::gpu {

inline constexpr Use kLightUses[] = {
    {FW_BIND_OBJECTS, Access::read},          {FW_BIND_TILES, Access::read},
    {FW_BIND_READERS, Access::read},          {FW_BIND_STATE, Access::write},
    {FW_BIND_TILE_STATE, Access::write},      {FW_BIND_LIST_A, Access::write},
    {FW_BIND_LIST_B, Access::write},          {FW_BIND_COUNTERS, Access::write},
    {FW_BIND_OBJECT_COUNTERS, Access::write}, {FW_BIND_BURN_A, Access::write},
    {FW_BIND_BURN_B, Access::write},          {FW_BIND_PREDICT_LIST_A, Access::write},
    {FW_BIND_PREDICT_LIST_B, Access::write},  {FW_BIND_HOT_LISTS, Access::write},
    {FW_BIND_PUBLISHED, Access::write},       {FW_BIND_REMOTE_OBJECTS, Access::read},
    {FW_BIND_TEXELS, Access::read},
};

}  // namespace fw::gpu
