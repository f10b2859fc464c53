// States that are no arrival, passed on to what is shown.
#include "gpu/passes/frame_graph.h"

namespace fw::gpu {
namespace {

constexpr Use kPredictStatesUses[] = {
    {FW_BIND_COUNTERS, Access::indirect},   {FW_BIND_COUNTERS, Access::read},
    {FW_BIND_OBJECTS, Access::read},        {FW_BIND_STATE, Access::read},
    {FW_BIND_TILE_STATE, Access::write},    {FW_BIND_PREDICT, Access::write},
    {FW_BIND_GRADIENT, Access::write},      {FW_BIND_PREDICT_LIST_A, Access::read},
    {FW_BIND_PREDICT_LIST_B, Access::read},
};

}  // namespace

const ComputePass kPredictStatesPass{"predict_states", "predict_states.comp", kPredictStatesUses,
                                     sizeof(StepPush)};

}  // namespace fw::gpu
