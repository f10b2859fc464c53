// Fire across gaps between objects that touch.
#include "gpu/passes/frame_graph.h"
#include "gpu/passes/light_uses.h"
#include "shared/exchange.h"

namespace fw::gpu {
namespace {

constexpr Use kContactsOwn[] = {
    {FW_BIND_MATERIALS, Access::read},
    {FW_BIND_CONTACTS, Access::read},
};
constexpr auto kContactsUses = joined(kLightUses, kContactsOwn);

}  // namespace

const ComputePass kContactsPass{"contacts", "contacts.comp", kContactsUses, sizeof(ExchangePush)};

}  // namespace fw::gpu
