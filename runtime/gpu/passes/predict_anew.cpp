// Whose prediction begins anew, because a view shows it again.
#include "gpu/passes/frame_graph.h"

namespace fw::gpu {
namespace {

constexpr Use kPredictAnewUses[] = {
    {FW_BIND_OBJECTS, Access::read},         {FW_BIND_TILE_STATE, Access::write},
    {FW_BIND_COUNTERS, Access::write},       {FW_BIND_PREDICT_LIST_A, Access::write},
    {FW_BIND_PREDICT_LIST_B, Access::write},
};

}  // namespace

const ComputePass kPredictAnewPass{"predict_anew", "predict_anew.comp", kPredictAnewUses,
                                   sizeof(StepPush)};

}  // namespace fw::gpu
