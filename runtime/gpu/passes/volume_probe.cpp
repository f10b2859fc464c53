// Where volumetric flames of the frame's view show anything, in tiles of it: most of a flame's
// bounds is empty.
#include "gpu/passes/frame_graph.h"

namespace fw::gpu {
namespace {

constexpr Use kVolumeProbeUses[] = {
    {FW_BIND_VIEW, Access::uniformView},
    {FW_BIND_VOLUMES, Access::each},
    {FW_BIND_VOLUME_RAYS, Access::write},
    {FW_BIND_VOLUME_WORK, Access::write},
};

}  // namespace

const ComputePass kVolumeProbePass{
    "volume probe", "volume_probe.comp", kVolumeProbeUses, sizeof(VolumeMarch), nullptr, true};

}  // namespace fw::gpu
