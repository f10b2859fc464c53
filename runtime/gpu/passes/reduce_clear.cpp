// Zeroes the figures that the two passes after it count.
#include "gpu/passes/frame_graph.h"

namespace fw::gpu {
namespace {

constexpr Use kUses[] = {
    {FW_BIND_OBJECT_COUNTERS, Access::write},
};

}  // namespace

const ComputePass kReduceClearPass{"reduce_clear", "reduce_clear.comp", kUses, sizeof(StepPush)};

}  // namespace fw::gpu
