// New walls and paint of particle fields; fresh ones become empty.
#include "gpu/passes/frame_graph.h"
#include "shared/field.h"

namespace fw::gpu {
namespace {

constexpr Use kFieldMaskUses[] = {
    {FW_BIND_FIELDS, Access::read},          {FW_BIND_FIELD_RUNS, Access::read},
    {FW_BIND_FIELD_CELLS, Access::write},    {FW_BIND_FIELD_MASKS, Access::read},
    {FW_BIND_FIELD_COUNTERS, Access::write},
};

}  // namespace

const ComputePass kFieldMaskPass{"field mask", "field_mask.comp", kFieldMaskUses,
                                 sizeof(FieldPush)};

}  // namespace fw::gpu
