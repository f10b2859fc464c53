// Who burns, who may go on, and where their sources stand.
#include "gpu/passes/frame_graph.h"
#include "shared/exchange.h"

namespace fw::gpu {
namespace {

constexpr Use kFireSourcesUses[] = {
    {FW_BIND_COUNTERS, Access::read},       {FW_BIND_OBJECT_COUNTERS, Access::write},
    {FW_BIND_REMOTE_OBJECTS, Access::read}, {FW_BIND_SOURCES, Access::write},
    {FW_BIND_NEIGHBOURS, Access::read},
};

}  // namespace

const ComputePass kFireSourcesPass{"fire sources", "fire_sources.comp", kFireSourcesUses,
                                   sizeof(ExchangePush)};

}  // namespace fw::gpu
