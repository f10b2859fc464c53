// Radiation and plumes on the tiles of receivers; with a heat shield, by a shader that walks it.
#include "shared/exchange.h"
#include "gpu/passes/frame_graph.h"
#include "gpu/passes/shield_uses.h"

namespace fw::gpu {
namespace {

constexpr Use kExchangeUses[] = {
    {FW_BIND_COUNTERS, Access::indirect}, {FW_BIND_COUNTERS, Access::write},
    {FW_BIND_OBJECTS, Access::read},      {FW_BIND_OBJECT_COUNTERS, Access::write},
    {FW_BIND_TILE_STATE, Access::write},  {FW_BIND_TILE_HEAT, Access::write},
    {FW_BIND_HOT_LISTS, Access::write},   {FW_BIND_REMOTE_OBJECTS, Access::read},
    {FW_BIND_REMOTE_TILES, Access::read}, {FW_BIND_SOURCES, Access::read},
    {FW_BIND_RECEIVERS, Access::read},    {FW_BIND_BLOCKERS, Access::read},
};
constexpr auto kShieldedUses = joined(kExchangeUses, kShieldUses);

}  // namespace

const ComputePass kExchangePass{"exchange", "exchange.comp", kExchangeUses, sizeof(ExchangePush)};
const ComputePass kExchangeShieldPass{"exchange shield", "exchange_shield.comp", kShieldedUses,
                                      sizeof(ExchangePush)};

}  // namespace fw::gpu
