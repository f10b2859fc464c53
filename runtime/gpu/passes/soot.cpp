// Soot above flames, for looks: it stays where they laid it.
#include "gpu/passes/frame_graph.h"

namespace fw::gpu {
namespace {

constexpr Use kSootUses[] = {
    {FW_BIND_OBJECTS, Access::read},     {FW_BIND_TEXELS, Access::read},
    {FW_BIND_TILE_STATE, Access::write}, {FW_BIND_PREDICT, Access::read},
    {FW_BIND_GRADIENT, Access::write},   {FW_BIND_SKIN_TEXELS, Access::read},
    {FW_BIND_SHOWN, Access::read},       {FW_BIND_LIGHTS, Access::read},
    {FW_BIND_VIEW, Access::uniformView},
};

}  // namespace

const ComputePass kSootPass{"soot", "soot.comp", kSootUses, sizeof(StepPush)};

}  // namespace fw::gpu
