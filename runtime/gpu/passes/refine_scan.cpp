// Where the output of every triangle begins, and what of it must be emitted.
#include "gpu/passes/frame_graph.h"
#include "shared/refine.h"

namespace fw::gpu {
namespace {

constexpr Use kRefineScanUses[] = {
    {FW_BIND_REFINE_WORK, Access::write},     {FW_BIND_REFINE_OBJECTS, Access::read},
    {FW_BIND_REFINE_LEVELS, Access::write},   {FW_BIND_REFINE_DRAWS, Access::write},
    {FW_BIND_OBJECT_COUNTERS, Access::write},
};

}  // namespace

const ComputePass kRefineScanPass{"refine_scan", "refine_scan.comp", kRefineScanUses,
                                  sizeof(RefinePush)};

}  // namespace fw::gpu
