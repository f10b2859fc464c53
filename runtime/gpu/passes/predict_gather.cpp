// The texels whose shown arrival may change, packed densely.
#include "gpu/passes/frame_graph.h"

namespace fw::gpu {
namespace {

constexpr Use kPredictGatherUses[] = {
    {FW_BIND_COUNTERS, Access::indirect},    {FW_BIND_OBJECTS, Access::read},
    {FW_BIND_READERS, Access::read},         {FW_BIND_TILES, Access::read},
    {FW_BIND_STATE, Access::read},           {FW_BIND_TILE_STATE, Access::write},
    {FW_BIND_COUNTERS, Access::write},       {FW_BIND_SCRATCH, Access::write},
    {FW_BIND_PREDICT, Access::read},         {FW_BIND_GRADIENT, Access::write},
    {FW_BIND_PREDICT_LIST_A, Access::write}, {FW_BIND_PREDICT_LIST_B, Access::write},
};

}  // namespace

const ComputePass kPredictGatherPass{"predict_gather", "predict_gather.comp", kPredictGatherUses,
                                     sizeof(StepPush)};

}  // namespace fw::gpu
