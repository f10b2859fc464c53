// The step of particle fields: what their cells give each other, what dies and is emitted.
#include "shared/field.h"
#include "gpu/passes/frame_graph.h"

namespace fw::gpu {
namespace {

constexpr Use kFieldUses[] = {
    {FW_BIND_FIELDS, Access::read},       {FW_BIND_FIELD_RUNS, Access::read},
    {FW_BIND_FIELD_MASKS, Access::read},  {FW_BIND_FIELD_CELLS, Access::readTexels},
    {FW_BIND_FIELD_CELLS, Access::write}, {FW_BIND_FIELD_COUNTERS, Access::write},
};

}  // namespace

const ComputePass kFieldPass{"field", "field.comp", kFieldUses, sizeof(FieldPush),
                             "field_texels.comp"};

}  // namespace fw::gpu
