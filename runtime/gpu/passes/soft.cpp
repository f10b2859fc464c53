// One step of the nodes of sheets.
#include "gpu/passes/frame_graph.h"

namespace fw::gpu {
namespace {

constexpr Use kSoftUses[] = {
    {FW_BIND_DEFORM_OBJECTS, Access::read}, {FW_BIND_DEFORM_GROUPS, Access::read},
    {FW_BIND_OBJECTS, Access::read},        {FW_BIND_DEFORM_NODES, Access::readTexels},
    {FW_BIND_SHOWN, Access::readTexels},    {FW_BIND_SHOWN, Access::write},
    {FW_BIND_SOFT, Access::readTexels},     {FW_BIND_SOFT, Access::write},
};

}  // namespace

const ComputePass kSoftPass{"soft", "soft.comp", kSoftUses, sizeof(DeformPush), "soft_texels.comp"};

}  // namespace fw::gpu
