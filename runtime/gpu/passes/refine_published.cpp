// Vertices and indices of objects that are refined by the published scheme.
#include "gpu/passes/frame_graph.h"

namespace fw::gpu {
namespace {

constexpr Use kRefinePublishedUses[] = {
    {FW_BIND_ARP_GROUPS, Access::read},       {FW_BIND_ARP_LIST, Access::read},
    {FW_BIND_REFINE_OBJECTS, Access::read},   {FW_BIND_REFINE_TRIANGLES, Access::read},
    {FW_BIND_REFINE_SLOTS, Access::read},     {FW_BIND_VERTICES, Access::read},
    {FW_BIND_REFINE_VERTICES, Access::write}, {FW_BIND_REFINE_INDICES, Access::write},
    {FW_BIND_PREDICT, Access::read},          {FW_BIND_GRADIENT, Access::read},
};

}  // namespace

const ComputePass kRefinePublishedPass{"refine_published", "refine_published.comp",
                                       kRefinePublishedUses, sizeof(ArpPush)};

}  // namespace fw::gpu
