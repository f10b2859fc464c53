// The front kernel over the gathered rim texels.
#include "gpu/passes/frame_graph.h"

namespace fw::gpu {
namespace {

constexpr Use kArrivalRimUses[] = {
    {FW_BIND_COUNTERS, Access::indirect}, {FW_BIND_OBJECTS, Access::read},
    {FW_BIND_MATERIALS, Access::read},    {FW_BIND_TEXELS, Access::read},
    {FW_BIND_NORMALS, Access::read},      {FW_BIND_SLOWNESS, Access::read},
    {FW_BIND_LINKS, Access::read},        {FW_BIND_TILES, Access::read},
    {FW_BIND_STATE, Access::read},        {FW_BIND_PENDING, Access::write},
    {FW_BIND_TILE_STATE, Access::write},  {FW_BIND_RUN, Access::read},
    {FW_BIND_SCRATCH, Access::write},     {FW_BIND_MASKS, Access::write},
    {FW_BIND_COUNTERS, Access::read},
};

}  // namespace

const ComputePass kArrivalRimPass{"arrival_rim", "arrival_rim.comp", kArrivalRimUses,
                                  sizeof(StepPush)};

}  // namespace fw::gpu
