// A new object's planes, one group per tile.
#include "gpu/passes/frame_graph.h"

namespace fw::gpu {
namespace {

constexpr Use kResetUses[] = {
    {FW_BIND_OBJECTS, Access::read},        {FW_BIND_MATERIALS, Access::read},
    {FW_BIND_TEXELS, Access::read},         {FW_BIND_NORMALS, Access::read},
    {FW_BIND_SLOWNESS, Access::read},       {FW_BIND_STATE, Access::write},
    {FW_BIND_TILE_STATE, Access::write},    {FW_BIND_PREDICT, Access::write},
    {FW_BIND_GRADIENT, Access::write},      {FW_BIND_PUBLISHED, Access::write},
    {FW_BIND_HEAT, Access::write},          {FW_BIND_TILE_HEAT, Access::write},
    {FW_BIND_HEAT_MATERIALS, Access::read}, {FW_BIND_TILE_FIRE, Access::write},
};

}  // namespace

const ComputePass kResetPass{"reset", "reset.comp", kResetUses, sizeof(StepPush)};

}  // namespace fw::gpu
