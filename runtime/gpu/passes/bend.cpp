// How each node of a sheet lies among its neighbours, and what bending and curling ask of it.
#include "gpu/passes/frame_graph.h"

namespace fw::gpu {
namespace {

constexpr Use kUses[] = {
    {FW_BIND_DEFORM_OBJECTS, Access::read}, {FW_BIND_DEFORM_GROUPS, Access::read},
    {FW_BIND_OBJECTS, Access::read},        {FW_BIND_DEFORM_NODES, Access::readTexels},
    {FW_BIND_SOFT, Access::readTexels},     {FW_BIND_SOFT, Access::write},
};

}  // namespace

const ComputePass kBendPass{"bend", "bend.comp", kUses, sizeof(DeformPush), "bend_texels.comp"};

}  // namespace fw::gpu
