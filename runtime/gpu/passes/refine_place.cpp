// Where the vertices that move lie now.
#include "gpu/passes/frame_graph.h"
#include "shared/refine.h"

namespace fw::gpu {
namespace {

constexpr Use kRefinePlaceUses[] = {
    {FW_BIND_REFINE_WORK, Access::indirect}, {FW_BIND_REFINE_WORK, Access::read},
    {FW_BIND_REFINE_OBJECTS, Access::read},  {FW_BIND_REFINE_TRIANGLES, Access::read},
    {FW_BIND_REFINE_EDGES, Access::read},    {FW_BIND_REFINE_SLOTS, Access::read},
    {FW_BIND_REFINE_ITEMS, Access::read},    {FW_BIND_REFINE_HEAT, Access::write},
    {FW_BIND_REFINE_LEVELS, Access::read},   {FW_BIND_REFINE_VERTICES, Access::write},
    {FW_BIND_PREDICT, Access::read},         {FW_BIND_GRADIENT, Access::read},
};

}  // namespace

const ComputePass kRefinePlacePass{"refine_place", "refine_place.comp", kRefinePlaceUses,
                                   sizeof(RefinePush)};

}  // namespace fw::gpu
