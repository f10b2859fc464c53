// The front list becomes due tiles and waiting tiles.
#include "gpu/passes/frame_graph.h"

namespace fw::gpu {
namespace {

constexpr Use kScheduleUses[] = {
    {FW_BIND_COUNTERS, Access::indirect},
    {FW_BIND_OBJECTS, Access::read},
    {FW_BIND_TILE_STATE, Access::write},
    {FW_BIND_LIST_A, Access::write},
    {FW_BIND_LIST_B, Access::write},
    {FW_BIND_COUNTERS, Access::write},
    {FW_BIND_RUN, Access::write},
    {FW_BIND_MASKS, Access::write},
    {FW_BIND_WAKE_GROUPS, Access::read},
    {FW_BIND_REMOTE_OBJECTS, Access::read},
    {FW_BIND_OBJECT_COUNTERS, Access::read},
};

}  // namespace

const ComputePass kSchedulePass{"schedule", "schedule.comp", kScheduleUses, sizeof(StepPush)};

}  // namespace fw::gpu
