// Writes the due tiles' new ticks and touches who reads them.
#include "gpu/passes/frame_graph.h"

namespace fw::gpu {
namespace {

constexpr Use kCommitUses[] = {
    {FW_BIND_COUNTERS, Access::indirect},    {FW_BIND_OBJECTS, Access::read},
    {FW_BIND_TILES, Access::read},           {FW_BIND_READERS, Access::read},
    {FW_BIND_STATE, Access::write},          {FW_BIND_PENDING, Access::read},
    {FW_BIND_TILE_STATE, Access::write},     {FW_BIND_LIST_A, Access::write},
    {FW_BIND_LIST_B, Access::write},         {FW_BIND_RUN, Access::read},
    {FW_BIND_SCRATCH, Access::read},         {FW_BIND_MASKS, Access::read},
    {FW_BIND_COUNTERS, Access::write},       {FW_BIND_OBJECT_COUNTERS, Access::write},
    {FW_BIND_BURN_A, Access::write},         {FW_BIND_BURN_B, Access::write},
    {FW_BIND_PREDICT_LIST_A, Access::write}, {FW_BIND_PREDICT_LIST_B, Access::write},
    {FW_BIND_HOT_LISTS, Access::write},
};

}  // namespace

const ComputePass kCommitPass{"commit", "commit.comp", kCommitUses, sizeof(StepPush)};

}  // namespace fw::gpu
