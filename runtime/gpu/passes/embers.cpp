// Embers come down.
#include "gpu/passes/frame_graph.h"
#include "shared/exchange.h"

namespace fw::gpu {
namespace {

constexpr Use kEmbersUses[] = {
    {FW_BIND_OBJECTS, Access::read},          {FW_BIND_TILES, Access::read},
    {FW_BIND_READERS, Access::read},          {FW_BIND_STATE, Access::write},
    {FW_BIND_TILE_STATE, Access::write},      {FW_BIND_LIST_A, Access::write},
    {FW_BIND_LIST_B, Access::write},          {FW_BIND_COUNTERS, Access::write},
    {FW_BIND_OBJECT_COUNTERS, Access::write}, {FW_BIND_BURN_A, Access::write},
    {FW_BIND_BURN_B, Access::write},          {FW_BIND_PREDICT_LIST_A, Access::write},
    {FW_BIND_PREDICT_LIST_B, Access::write},  {FW_BIND_PUBLISHED, Access::write},
    {FW_BIND_REMOTE_OBJECTS, Access::read},   {FW_BIND_TEXELS, Access::read},
    {FW_BIND_REMOTE_TILES, Access::read},     {FW_BIND_SOURCES, Access::read},
    {FW_BIND_HOT_LISTS, Access::write},
};

}  // namespace

const ComputePass kEmbersPass{"embers", "embers.comp", kEmbersUses, sizeof(ExchangePush)};

}  // namespace fw::gpu
