// Heat, view and budget to levels of edges and interiors, and of triangles.
#include "gpu/passes/frame_graph.h"
#include "shared/refine.h"

namespace fw::gpu {
namespace {

constexpr Use kRefineLevelsUses[] = {
    {FW_BIND_REFINE_WORK, Access::write},     {FW_BIND_REFINE_OBJECTS, Access::read},
    {FW_BIND_REFINE_TRIANGLES, Access::read}, {FW_BIND_REFINE_EDGES, Access::read},
    {FW_BIND_REFINE_SLOTS, Access::read},     {FW_BIND_REFINE_HEAT, Access::write},
    {FW_BIND_REFINE_ITEMS, Access::write},    {FW_BIND_REFINE_LEVELS, Access::write},
};

}  // namespace

const ComputePass kRefineLevelsPass{"refine_levels", "refine_levels.comp", kRefineLevelsUses,
                                    sizeof(RefinePush)};

}  // namespace fw::gpu
