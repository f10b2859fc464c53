// The due tiles' texels that have something to answer to, packed densely.
#include "gpu/passes/frame_graph.h"

namespace fw::gpu {
namespace {

constexpr Use kGatherUses[] = {
    {FW_BIND_COUNTERS, Access::indirect}, {FW_BIND_OBJECTS, Access::read},
    {FW_BIND_TILES, Access::read},        {FW_BIND_STATE, Access::read},
    {FW_BIND_TILE_STATE, Access::write},  {FW_BIND_RUN, Access::read},
    {FW_BIND_SCRATCH, Access::write},     {FW_BIND_COUNTERS, Access::write},
    {FW_BIND_MASKS, Access::write},       {FW_BIND_PENDING, Access::read},
    {FW_BIND_SETTLED, Access::read},
};

}  // namespace

const ComputePass kGatherPass{"gather", "gather.comp", kGatherUses, sizeof(StepPush)};

}  // namespace fw::gpu
