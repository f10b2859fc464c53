// Texel events of one step, applied in order.
#include "gpu/passes/frame_graph.h"

namespace fw::gpu {
namespace {

constexpr Use kEventsUses[] = {
    {FW_BIND_OBJECTS, Access::read},         {FW_BIND_TILES, Access::read},
    {FW_BIND_READERS, Access::read},         {FW_BIND_STATE, Access::write},
    {FW_BIND_TILE_STATE, Access::write},     {FW_BIND_LIST_A, Access::write},
    {FW_BIND_LIST_B, Access::write},         {FW_BIND_COUNTERS, Access::write},
    {FW_BIND_EVENTS, Access::read},          {FW_BIND_OBJECT_COUNTERS, Access::write},
    {FW_BIND_BURN_A, Access::write},         {FW_BIND_BURN_B, Access::write},
    {FW_BIND_PREDICT_LIST_A, Access::write}, {FW_BIND_PREDICT_LIST_B, Access::write},
    {FW_BIND_PUBLISHED, Access::write},      {FW_BIND_TEXELS, Access::read},
    {FW_BIND_HEAT, Access::write},           {FW_BIND_HEAT_MATERIALS, Access::read},
    {FW_BIND_HOT_LISTS, Access::write},
};

}  // namespace

const ComputePass kEventsPass{"events", "events.comp", kEventsUses, sizeof(StepPush)};
const ComputePass kEventsAllPass{"events_all", "events_all.comp", kEventsUses, sizeof(StepPush)};

}  // namespace fw::gpu
