// Output triangles of the objects whose levels changed.
#include "gpu/passes/frame_graph.h"
#include "shared/refine.h"

namespace fw::gpu {
namespace {

constexpr Use kRefineEmitUses[] = {
    {FW_BIND_REFINE_WORK, Access::indirect},  {FW_BIND_REFINE_WORK, Access::read},
    {FW_BIND_REFINE_OBJECTS, Access::read},   {FW_BIND_REFINE_WORDS, Access::read},
    {FW_BIND_REFINE_TRIANGLES, Access::read}, {FW_BIND_REFINE_LEVELS, Access::read},
    {FW_BIND_REFINE_INDICES, Access::write},
};

}  // namespace

const ComputePass kRefineEmitPass{"refine_emit", "refine_emit.comp", kRefineEmitUses,
                                  sizeof(RefinePush)};

}  // namespace fw::gpu
