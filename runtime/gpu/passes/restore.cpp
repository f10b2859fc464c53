// Tiles of a restored object join the lists that they were in.
#include "gpu/passes/frame_graph.h"

namespace fw::gpu {
namespace {

constexpr Use kRestoreUses[] = {
    {FW_BIND_OBJECTS, Access::read},         {FW_BIND_TILE_STATE, Access::write},
    {FW_BIND_LIST_A, Access::write},         {FW_BIND_LIST_B, Access::write},
    {FW_BIND_COUNTERS, Access::write},       {FW_BIND_BURN_A, Access::write},
    {FW_BIND_BURN_B, Access::write},         {FW_BIND_HOT_LISTS, Access::write},
    {FW_BIND_PREDICT_LIST_A, Access::write}, {FW_BIND_PREDICT_LIST_B, Access::write},
};

}  // namespace

const ComputePass kRestorePass{"restore", "restore.comp", kRestoreUses, sizeof(StepPush)};

}  // namespace fw::gpu
