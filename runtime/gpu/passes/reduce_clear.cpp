// Zeroes the figures and fire sources that the passes after it sum.
#include "gpu/passes/frame_graph.h"

namespace fw::gpu {
namespace {

constexpr Use kReduceClearUses[] = {
    {FW_BIND_OBJECT_COUNTERS, Access::write},
    {FW_BIND_REMOTE_OBJECTS, Access::read},
    {FW_BIND_SOURCES, Access::write},
};

}  // namespace

const ComputePass kReduceClearPass{"reduce_clear", "reduce_clear.comp", kReduceClearUses,
                                   sizeof(StepPush)};

}  // namespace fw::gpu
