// Burning tiles into cells and lights. One group.
#include "gpu/passes/frame_graph.h"

namespace fw::gpu {
namespace {

constexpr Use kLightsUses[] = {
    {FW_BIND_OBJECTS, Access::read},      {FW_BIND_MATERIALS, Access::read},
    {FW_BIND_LOOKS, Access::read},        {FW_BIND_COUNTERS, Access::read},
    {FW_BIND_BURN_TILES, Access::read},   {FW_BIND_LIGHTS, Access::write},
    {FW_BIND_LIGHT_CELLS, Access::write}, {FW_BIND_DRAW_ARGS, Access::write},
    {FW_BIND_VIEW, Access::uniformView},
};

}  // namespace

const ComputePass kLightsPass{"lights", "lights.comp", kLightsUses, sizeof(StepPush)};

}  // namespace fw::gpu
