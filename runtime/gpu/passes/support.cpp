// What holds what, for looks: burnt pieces that nothing holds fall to ash.
#include "gpu/passes/frame_graph.h"

namespace fw::gpu {
namespace {

constexpr Use kSupportUses[] = {
    {FW_BIND_OBJECTS, Access::read},  {FW_BIND_MATERIALS, Access::read},
    {FW_BIND_TEXELS, Access::read},   {FW_BIND_READERS, Access::read},
    {FW_BIND_TILES, Access::read},    {FW_BIND_STATE, Access::read},
    {FW_BIND_PREDICT, Access::write}, {FW_BIND_TILE_STATE, Access::write},
    {FW_BIND_SCRATCH, Access::write},
};

}  // namespace

const ComputePass kSupportPass{"support", "support.comp", kSupportUses, sizeof(StepPush)};

}  // namespace fw::gpu
