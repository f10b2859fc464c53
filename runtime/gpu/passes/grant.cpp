// Which of the tiles that asked to burn may, where their number is limited.
#include "gpu/passes/frame_graph.h"

namespace fw::gpu {
namespace {

constexpr Use kGrantUses[] = {
    {FW_BIND_OBJECTS, Access::read},
    {FW_BIND_TILE_STATE, Access::write},
    {FW_BIND_RUN, Access::read},
    {FW_BIND_MASKS, Access::read},
    {FW_BIND_COUNTERS, Access::write},
    {FW_BIND_OBJECT_COUNTERS, Access::write},
    {FW_BIND_BURN_A, Access::write},
    {FW_BIND_BURN_B, Access::write},
    {FW_BIND_PREDICT_LIST_A, Access::write},
    {FW_BIND_PREDICT_LIST_B, Access::write},
    {FW_BIND_REMOTE_OBJECTS, Access::read},
};

}  // namespace

const ComputePass kGrantPass{"grant", "grant.comp", kGrantUses, sizeof(StepPush)};

}  // namespace fw::gpu
