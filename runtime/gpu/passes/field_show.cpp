// What cells of particle fields show between two steps, once a frame; and their shade.
#include "gpu/passes/frame_graph.h"

namespace fw::gpu {
namespace {

constexpr Use kFieldShowUses[] = {
    {FW_BIND_FIELD_DRAWS, Access::read},
    {FW_BIND_FIELD_CELLS, Access::read},
    {FW_BIND_FIELD_SHOWN, Access::write},
    {FW_BIND_VIEW, Access::uniformView},
};

}  // namespace

const ComputePass kFieldShowPass{"field show", "field_show.comp", kFieldShowUses, 0};

}  // namespace fw::gpu
