// Burning tiles into fire sources, summed.
#include "gpu/passes/frame_graph.h"
#include "shared/exchange.h"

namespace fw::gpu {
namespace {

constexpr Use kFireCellsUses[] = {
    {FW_BIND_COUNTERS, Access::indirect},   {FW_BIND_COUNTERS, Access::read},
    {FW_BIND_OBJECTS, Access::read},        {FW_BIND_BURN_TILES, Access::read},
    {FW_BIND_REMOTE_OBJECTS, Access::read}, {FW_BIND_REMOTE_TILES, Access::read},
    {FW_BIND_SOURCES, Access::write},
};

}  // namespace

const ComputePass kFireCellsPass{"fire cells", "fire_cells.comp", kFireCellsUses,
                                 sizeof(ExchangePush)};

}  // namespace fw::gpu
