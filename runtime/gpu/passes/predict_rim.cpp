// Arrival ahead of the front, for looks: of rim texels.
#include "gpu/passes/frame_graph.h"

namespace fw::gpu {
namespace {

constexpr Use kPredictRimUses[] = {
    {FW_BIND_COUNTERS, Access::indirect},    {FW_BIND_SCRATCH, Access::write},
    {FW_BIND_OBJECTS, Access::read},         {FW_BIND_MATERIALS, Access::read},
    {FW_BIND_TEXELS, Access::read},          {FW_BIND_NORMALS, Access::read},
    {FW_BIND_SLOWNESS, Access::read},        {FW_BIND_LINKS, Access::read},
    {FW_BIND_READERS, Access::read},         {FW_BIND_TILES, Access::read},
    {FW_BIND_STATE, Access::read},           {FW_BIND_TILE_STATE, Access::write},
    {FW_BIND_COUNTERS, Access::write},       {FW_BIND_PREDICT, Access::read},
    {FW_BIND_GRADIENT, Access::write},       {FW_BIND_PREDICT_LIST_A, Access::write},
    {FW_BIND_PREDICT_LIST_B, Access::write},
};

}  // namespace

const ComputePass kPredictRimPass{"predict_rim", "predict_rim.comp", kPredictRimUses,
                                  sizeof(StepPush)};

}  // namespace fw::gpu
