// Arrival ahead of the front, for looks.
#include "gpu/passes/frame_graph.h"

namespace fw::gpu {
namespace {

constexpr Use kPredictUses[] = {
    {FW_BIND_COUNTERS, Access::indirect},    {FW_BIND_SCRATCH, Access::write},
    {FW_BIND_OBJECTS, Access::read},         {FW_BIND_MATERIALS, Access::read},
    {FW_BIND_TEXELS, Access::read},          {FW_BIND_NORMALS, Access::read},
    {FW_BIND_SLOWNESS, Access::read},        {FW_BIND_READERS, Access::read},
    {FW_BIND_TILES, Access::read},           {FW_BIND_STATE, Access::read},
    {FW_BIND_TILE_STATE, Access::write},     {FW_BIND_COUNTERS, Access::write},
    {FW_BIND_PREDICT, Access::read},         {FW_BIND_GRADIENT, Access::write},
    {FW_BIND_PREDICT_LIST_A, Access::write}, {FW_BIND_PREDICT_LIST_B, Access::write},
};

}  // namespace

const ComputePass kPredictPass{"predict", "predict.comp", kPredictUses, sizeof(StepPush)};

}  // namespace fw::gpu
