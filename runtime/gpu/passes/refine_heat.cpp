// The heat of the fire's tiles on the edges and interiors around them.
#include "gpu/passes/frame_graph.h"
#include "shared/refine.h"

namespace fw::gpu {
namespace {

constexpr Use kRefineHeatUses[] = {
    {FW_BIND_COUNTERS, Access::indirect}, {FW_BIND_COUNTERS, Access::read},
    {FW_BIND_OBJECTS, Access::read},      {FW_BIND_TILE_STATE, Access::read},
    {FW_BIND_LIST_A, Access::read},       {FW_BIND_LIST_B, Access::read},
    {FW_BIND_BURN_A, Access::read},       {FW_BIND_BURN_B, Access::read},
    {FW_BIND_REFINE_WORK, Access::read},  {FW_BIND_REFINE_OBJECTS, Access::read},
    {FW_BIND_REFINE_WORDS, Access::read}, {FW_BIND_REFINE_HEAT, Access::write},
    {FW_BIND_PREDICT, Access::read},      {FW_BIND_GRADIENT, Access::read},
};

}  // namespace

const ComputePass kRefineHeatPass{"refine_heat", "refine_heat.comp", kRefineHeatUses,
                                  sizeof(RefinePush)};

}  // namespace fw::gpu
