// The inner skin of what recedes.
#include "gpu/passes/frame_graph.h"

namespace fw::gpu {
namespace {

constexpr Use kInnerUses[] = {
    {FW_BIND_DEFORM_OBJECTS, Access::read},     {FW_BIND_DEFORM_GROUPS, Access::read},
    {FW_BIND_DEFORM_COATS, Access::readTexels}, {FW_BIND_VERTICES, Access::read},
    {FW_BIND_SHOWN, Access::readTexels},        {FW_BIND_SHOWN, Access::write},
};

}  // namespace

const ComputePass kInnerPass{"inner", "inner.comp", kInnerUses, sizeof(DeformPush),
                             "inner_texels.comp"};

}  // namespace fw::gpu
