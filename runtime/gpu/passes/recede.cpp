// How much of each node of a deforming object has burnt, and where that leaves it.
#include "gpu/passes/frame_graph.h"

namespace fw::gpu {
namespace {

constexpr Use kRecedeUses[] = {
    {FW_BIND_DEFORM_OBJECTS, Access::read},     {FW_BIND_DEFORM_GROUPS, Access::read},
    {FW_BIND_DEFORM_NODES, Access::readTexels}, {FW_BIND_STATE, Access::read},
    {FW_BIND_SHOWN, Access::readTexels},        {FW_BIND_SHOWN, Access::write},
    {FW_BIND_SOFT, Access::readTexels},         {FW_BIND_SOFT, Access::write},
};

}  // namespace

const ComputePass kRecedePass{"recede", "recede.comp", kRecedeUses, sizeof(DeformPush),
                              "recede_texels.comp"};

}  // namespace fw::gpu
