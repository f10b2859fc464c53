// Embers come down.
#include "gpu/passes/frame_graph.h"
#include "gpu/passes/light_uses.h"
#include "shared/exchange.h"

namespace fw::gpu {
namespace {

constexpr Use kEmbersOwn[] = {
    {FW_BIND_REMOTE_TILES, Access::read},
    {FW_BIND_SOURCES, Access::read},
};
constexpr auto kEmbersUses = joined(kLightUses, kEmbersOwn);

}  // namespace

const ComputePass kEmbersPass{"embers", "embers.comp", kEmbersUses, sizeof(ExchangePush)};

}  // namespace fw::gpu
