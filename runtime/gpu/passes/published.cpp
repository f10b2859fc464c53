// The published sixteen-tap kernel, for comparison.
#include "gpu/passes/frame_graph.h"

namespace fw::gpu {
namespace {

constexpr Use kUses[] = {
    {FW_BIND_OBJECTS, Access::read},          {FW_BIND_STATE, Access::write},
    {FW_BIND_TILE_STATE, Access::write},      {FW_BIND_COUNTERS, Access::write},
    {FW_BIND_OBJECT_COUNTERS, Access::write}, {FW_BIND_BURN_A, Access::write},
    {FW_BIND_BURN_B, Access::write},          {FW_BIND_PREDICT_LIST_A, Access::write},
    {FW_BIND_PREDICT_LIST_B, Access::write},  {FW_BIND_PUBLISHED, Access::write},
};

}  // namespace

const ComputePass kPublishedPass{"published", "published.comp", kUses, sizeof(StepPush)};

uint32_t publishedGroups(const BurnObject& object) {
    constexpr uint32_t kSide = 64;  // texels of a group, as in the shader
    return ((object.width + kSide - 1) / kSide) * ((object.height + kSide - 1) / kSide);
}

}  // namespace fw::gpu
