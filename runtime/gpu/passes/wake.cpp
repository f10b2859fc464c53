// A wind or pose latch wakes the tiles that may answer to it.
#include "gpu/passes/frame_graph.h"

namespace fw::gpu {
namespace {

constexpr Use kWakeUses[] = {
    {FW_BIND_OBJECTS, Access::read},         {FW_BIND_TILE_STATE, Access::write},
    {FW_BIND_LIST_A, Access::write},         {FW_BIND_LIST_B, Access::write},
    {FW_BIND_COUNTERS, Access::write},       {FW_BIND_WAKE_GROUPS, Access::read},
    {FW_BIND_PREDICT_LIST_A, Access::write}, {FW_BIND_PREDICT_LIST_B, Access::write},
};

}  // namespace

const ComputePass kWakePass{"wake", "wake.comp", kWakeUses, sizeof(StepPush)};

}  // namespace fw::gpu
