// Ends a round of prediction: its times, then their gradients.
#include "gpu/passes/frame_graph.h"

namespace fw::gpu {
namespace {

constexpr Use kPredictCommitUses[] = {
    {FW_BIND_COUNTERS, Access::indirect}, {FW_BIND_COUNTERS, Access::read},
    {FW_BIND_SCRATCH, Access::read},      {FW_BIND_OBJECTS, Access::read},
    {FW_BIND_STATE, Access::read},        {FW_BIND_PREDICT, Access::write},
    {FW_BIND_GRADIENT, Access::write},
};

}  // namespace

const ComputePass kPredictCommitPass{"predict_commit", "predict_commit.comp", kPredictCommitUses,
                                     sizeof(StepPush)};

}  // namespace fw::gpu
