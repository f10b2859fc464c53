// One step of the published mass-spring model.
#include "gpu/passes/frame_graph.h"

namespace fw::gpu {
namespace {

constexpr Use kSpringsUses[] = {
    {FW_BIND_DEFORM_OBJECTS, Access::read},
    {FW_BIND_DEFORM_GROUPS, Access::read},
    {FW_BIND_DEFORM_NODES, Access::readTexels},
    {FW_BIND_SHOWN, Access::readTexels},
    {FW_BIND_SHOWN, Access::write},
    {FW_BIND_SOFT, Access::readTexels},
    {FW_BIND_SOFT, Access::write},
};

}  // namespace

const ComputePass kSpringsPass{"springs", "springs.comp", kSpringsUses, sizeof(DeformPush),
                               "springs_texels.comp"};

}  // namespace fw::gpu
