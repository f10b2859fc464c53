// Which links and arms of a sheet hold.
#include "gpu/passes/frame_graph.h"

namespace fw::gpu {
namespace {

constexpr Use kTiesUses[] = {
    {FW_BIND_DEFORM_OBJECTS, Access::read},
    {FW_BIND_DEFORM_GROUPS, Access::read},
    {FW_BIND_DEFORM_NODES, Access::readTexels},
    {FW_BIND_SOFT, Access::readTexels},
    {FW_BIND_SOFT, Access::write},
};

}  // namespace

const ComputePass kTiesPass{"ties", "ties.comp", kTiesUses, sizeof(DeformPush), "ties_texels.comp"};

}  // namespace fw::gpu
