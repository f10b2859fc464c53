// Whom others may warm, and by which sources.
#include "gpu/passes/frame_graph.h"
#include "shared/exchange.h"

namespace fw::gpu {
namespace {

constexpr Use kReceiversUses[] = {
    {FW_BIND_COUNTERS, Access::write},        {FW_BIND_OBJECTS, Access::read},
    {FW_BIND_OBJECT_COUNTERS, Access::write}, {FW_BIND_REMOTE_OBJECTS, Access::read},
    {FW_BIND_SOURCES, Access::read},          {FW_BIND_NEIGHBOURS, Access::read},
    {FW_BIND_RECEIVERS, Access::write},
};

}  // namespace

const ComputePass kReceiversPass{"receivers", "receivers.comp", kReceiversUses,
                                 sizeof(ExchangePush)};

}  // namespace fw::gpu
