// Burn budget: which of the tiles that request to burn may do so. Integers, equal on all devices.
// The mechanism is in lib/burn_budget.glsl and runtime/ARCHITECTURE.md.
// clang-format off
#ifndef FW_SHARED_BURN_BUDGET_H
#define FW_SHARED_BURN_BUDGET_H
#include "shared/exchange.h"

FW_SHARED_BEGIN

// Set beside kSwitchGoverned: the number of burning tiles is limited.
FW_CONST uint kSwitchCapped = 0x20000u;
// The pass only requests and lights nothing. In `burn_budget`: the front's due tiles request
// through it.
FW_CONST uint kSwitchRequests = 0x40000u;

// Tiles that may still start to burn.
FW_FN uint remainingTiles(uint burning, uint most) { return most - minU(burning, most); }
// Allocation order: by hash, then by place, so the order of requests does not matter.
FW_FN uint requestOrder(uint object, uint local, uint now) {
    return mixed(mixed(now, object), local);
}
FW_FN bool requestPrecedes(FW_IN(uvec4) a, FW_IN(uvec4) b) {  // order, object, local tile
    if (a.x != b.x) return a.x < b.x;
    return a.y != b.y ? a.y < b.y : a.z < b.z;
}

FW_SHARED_END
#endif
