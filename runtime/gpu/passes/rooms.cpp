// What fires leave of the air in rooms.
#include "gpu/passes/frame_graph.h"

namespace fw::gpu {
namespace {

constexpr Use kRoomsUses[] = {
    {FW_BIND_OBJECTS, Access::read},
    {FW_BIND_OBJECT_COUNTERS, Access::write},
    {FW_BIND_ROOMS, Access::read},
    {FW_BIND_ROOM_AIR, Access::write},
};

}  // namespace

const ComputePass kRoomsPass{"rooms", "rooms.comp", kRoomsUses, sizeof(StepPush)};

}  // namespace fw::gpu
