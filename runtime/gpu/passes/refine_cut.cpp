// Holes cut out of refined triangles, and the walls along them.
#include "gpu/passes/frame_graph.h"
#include "shared/refine.h"

namespace fw::gpu {
namespace {

constexpr Use kRefineCutUses[] = {
    {FW_BIND_REFINE_WORK, Access::indirect},   {FW_BIND_REFINE_WORK, Access::write},
    {FW_BIND_REFINE_OBJECTS, Access::read},    {FW_BIND_REFINE_WORDS, Access::read},
    {FW_BIND_REFINE_TRIANGLES, Access::read},  {FW_BIND_REFINE_SLOTS, Access::read},
    {FW_BIND_REFINE_HEAT, Access::write},      {FW_BIND_REFINE_LEVELS, Access::read},
    {FW_BIND_REFINE_VERTICES, Access::read},   {FW_BIND_VERTICES, Access::read},
    {FW_BIND_REFINE_INDICES, Access::write},   {FW_BIND_REFINE_CUTS, Access::write},
    {FW_BIND_REFINE_CUT_DRAWS, Access::write}, {FW_BIND_REFINE_EDGES, Access::read},
    {FW_BIND_PREDICT, Access::read},           {FW_BIND_GRADIENT, Access::read},
};

}  // namespace

const ComputePass kRefineCutPass{"refine_cut", "refine_cut.comp", kRefineCutUses,
                                 sizeof(RefinePush)};

}  // namespace fw::gpu
