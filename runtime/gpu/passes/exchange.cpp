// Radiation and plumes on the tiles of receivers; with a heat shield, by a shader that walks it.
#include "shared/exchange.h"
#include "gpu/passes/frame_graph.h"

namespace fw::gpu {
namespace {

constexpr Use kExchangeUses[] = {
    {FW_BIND_COUNTERS, Access::indirect},
    {FW_BIND_COUNTERS, Access::write},
    {FW_BIND_OBJECTS, Access::read},
    {FW_BIND_OBJECT_COUNTERS, Access::write},
    {FW_BIND_TILE_STATE, Access::write},
    {FW_BIND_TILE_HEAT, Access::write},
    {FW_BIND_HOT_LISTS, Access::write},
    {FW_BIND_REMOTE_OBJECTS, Access::read},
    {FW_BIND_REMOTE_TILES, Access::read},
    {FW_BIND_SOURCES, Access::read},
    {FW_BIND_RECEIVERS, Access::read},
    {FW_BIND_BLOCKERS, Access::read},
    // With a shield, also whether what fills its cells is still there.
    {FW_BIND_SHIELD, Access::read},
    {FW_BIND_STATE, Access::read},
    {FW_BIND_HEAT, Access::read},
    {FW_BIND_MATERIALS, Access::read},
};
constexpr std::span kAllUses(kExchangeUses);

}  // namespace

const ComputePass kExchangePass{"exchange", "exchange.comp", kAllUses.first(kAllUses.size() - 4),
                                sizeof(ExchangePush)};
const ComputePass kExchangeShieldPass{"exchange shield", "exchange_shield.comp", kExchangeUses,
                                      sizeof(ExchangePush)};

}  // namespace fw::gpu
