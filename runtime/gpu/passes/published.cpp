// The published sixteen-tap kernel, for comparison.
#include "gpu/passes/frame_graph.h"

#include "shared/published.h"

namespace fw::gpu {
namespace {

constexpr Use kPublishedUses[] = {
    {FW_BIND_OBJECTS, Access::read},          {FW_BIND_STATE, Access::write},
    {FW_BIND_TILE_STATE, Access::write},      {FW_BIND_COUNTERS, Access::write},
    {FW_BIND_OBJECT_COUNTERS, Access::write}, {FW_BIND_BURN_A, Access::write},
    {FW_BIND_BURN_B, Access::write},          {FW_BIND_PREDICT_LIST_A, Access::write},
    {FW_BIND_PREDICT_LIST_B, Access::write},  {FW_BIND_PUBLISHED, Access::write},
};

}  // namespace

const ComputePass kPublishedPass{"published", "published.comp", kPublishedUses, sizeof(StepPush)};

uint32_t publishedGroups(const BurnObject& object) {
    const uint32_t blocks = object.width / kPublishedBlockX *
                            ((object.height + kPublishedBlockY - 1) / kPublishedBlockY);
    return (blocks + 63) / 64;
}

}  // namespace fw::gpu
