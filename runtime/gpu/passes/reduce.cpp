// What burns, tile by tile; drops the tiles that burnt out.
#include "gpu/passes/frame_graph.h"

namespace fw::gpu {
namespace {

constexpr Use kReduceUses[] = {
    {FW_BIND_COUNTERS, Access::indirect},
    {FW_BIND_OBJECTS, Access::read},
    {FW_BIND_MATERIALS, Access::read},
    {FW_BIND_TEXELS, Access::read},
    {FW_BIND_NORMALS, Access::read},
    {FW_BIND_STATE, Access::read},
    {FW_BIND_TILE_STATE, Access::write},
    {FW_BIND_COUNTERS, Access::write},
    {FW_BIND_OBJECT_COUNTERS, Access::write},
    {FW_BIND_BURN_A, Access::write},
    {FW_BIND_BURN_B, Access::write},
    {FW_BIND_BURN_TILES, Access::write},
    {FW_BIND_HEAT, Access::read},
    {FW_BIND_TILE_FIRE, Access::read},
    {FW_BIND_SKIN_TEXELS, Access::read},
    {FW_BIND_SHOWN, Access::read},
};

}  // namespace

const ComputePass kReducePass{"reduce", "reduce.comp", kReduceUses, sizeof(StepPush)};

}  // namespace fw::gpu
