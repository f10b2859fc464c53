// Fire across gaps between parts of one mesh.
#include "gpu/passes/frame_graph.h"
#include "gpu/passes/light_uses.h"
#include "shared/exchange.h"

namespace fw::gpu {
namespace {

constexpr Use kPartsOwn[] = {
    {FW_BIND_MATERIALS, Access::read},
    {FW_BIND_REMOTE_TILES, Access::read},
    {FW_BIND_BURN_TILES, Access::read},
    {FW_BIND_COUNTERS, Access::indirect},
};
constexpr auto kPartsUses = joined(kLightUses, kPartsOwn);

}  // namespace

const ComputePass kPartsPass{"parts", "parts.comp", kPartsUses, sizeof(ExchangePush)};

}  // namespace fw::gpu
