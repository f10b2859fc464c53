// Drawn vertices of deforming objects: places and normals from their nodes.
#include "gpu/passes/frame_graph.h"

namespace fw::gpu {
namespace {

constexpr Use kDrapeUses[] = {
    {FW_BIND_DEFORM_OBJECTS, Access::read},
    {FW_BIND_DEFORM_GROUPS, Access::read},
    {FW_BIND_DEFORM_COATS, Access::readTexels},
    {FW_BIND_SHOWN, Access::readTexels},
    {FW_BIND_SHOWN, Access::write},
};

}  // namespace

const ComputePass kDrapePass{"drape", "drape.comp", kDrapeUses, sizeof(DeformPush),
                             "drape_texels.comp"};

}  // namespace fw::gpu
