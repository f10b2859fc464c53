// What stops embers on their way.
#include "gpu/passes/frame_graph.h"
#include "gpu/passes/shield_uses.h"
#include "shared/exchange.h"

namespace fw::gpu {
namespace {

constexpr Use kEmberWaysOwn[] = {
    {FW_BIND_OBJECTS, Access::read},        {FW_BIND_OBJECT_COUNTERS, Access::read},
    {FW_BIND_REMOTE_OBJECTS, Access::read}, {FW_BIND_REMOTE_TILES, Access::read},
    {FW_BIND_SOURCES, Access::write},       {FW_BIND_BLOCKERS, Access::read},
};
constexpr auto kEmberWaysUses = joined(kShieldUses, kEmberWaysOwn);

}  // namespace

const ComputePass kEmberWaysPass{"ember_ways", "ember_ways.comp", kEmberWaysUses,
                                 sizeof(ExchangePush)};

}  // namespace fw::gpu
