// Counts the front's tiles per object.
#include "gpu/passes/frame_graph.h"

namespace fw::gpu {
namespace {

constexpr Use kReduceFrontUses[] = {
    {FW_BIND_COUNTERS, Access::indirect},     {FW_BIND_OBJECTS, Access::read},
    {FW_BIND_TILE_STATE, Access::read},       {FW_BIND_LIST_A, Access::read},
    {FW_BIND_LIST_B, Access::read},           {FW_BIND_COUNTERS, Access::read},
    {FW_BIND_OBJECT_COUNTERS, Access::write},
};

}  // namespace

const ComputePass kReduceFrontPass{"reduce_front", "reduce_front.comp", kReduceFrontUses,
                                   sizeof(StepPush)};

}  // namespace fw::gpu
