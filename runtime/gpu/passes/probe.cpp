// Gathers the texels that somebody asked for.
#include "gpu/passes/frame_graph.h"

namespace fw::gpu {
namespace {

constexpr Use kProbeUses[] = {
    {FW_BIND_OBJECTS, Access::read},  {FW_BIND_STATE, Access::read}, {FW_BIND_PROBES, Access::read},
    {FW_BIND_ANSWERS, Access::write}, {FW_BIND_HEAT, Access::read},
};

}  // namespace

const ComputePass kProbePass{"probe", "probe.comp", kProbeUses, sizeof(StepPush)};

}  // namespace fw::gpu
