// The front kernel over the gathered rows of texels.
#include "gpu/passes/frame_graph.h"

namespace fw::gpu {
namespace {

constexpr Use kArrivalUses[] = {
    {FW_BIND_COUNTERS, Access::indirect}, {FW_BIND_OBJECTS, Access::read},
    {FW_BIND_MATERIALS, Access::read},    {FW_BIND_TEXELS, Access::read},
    {FW_BIND_NORMALS, Access::read},      {FW_BIND_SLOWNESS, Access::read},
    {FW_BIND_STATE, Access::read},        {FW_BIND_PENDING, Access::write},
    {FW_BIND_TILE_STATE, Access::write},  {FW_BIND_RUN, Access::read},
    {FW_BIND_SCRATCH, Access::write},     {FW_BIND_MASKS, Access::write},
    {FW_BIND_COUNTERS, Access::read},     {FW_BIND_SETTLED, Access::write},
};

}  // namespace

const ComputePass kArrivalPass{"arrival", "arrival.comp", kArrivalUses, sizeof(StepPush)};

}  // namespace fw::gpu
