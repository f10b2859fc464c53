// A limit of burning tiles: who of those that ask to burn may. Integers, the same everywhere; the
// mechanism is in lib/lists.glsl and runtime/ARCHITECTURE.md.
// GLSL too, and laid out by hand.
// clang-format off
#ifndef FW_SHARED_GRANT_H
#define FW_SHARED_GRANT_H
#include "shared/exchange.h"

FW_SHARED_BEGIN

// Beside kSwitchGoverned: how many tiles may burn is limited.
FW_SHARED_CONST uint kSwitchCapped = 0x20000u;
// A pass lights nothing, it only asks. Of `grant`: the front's due tiles ask with it.
FW_SHARED_CONST uint kSwitchAsks = 0x40000u;

// How many more tiles may burn.
FW_SHARED_FN uint roomFor(uint burning, uint most) { return most - leastOf(burning, most); }
// In which order tiles get leave to burn where not all may: by chance, and by place where that is
// equal, so that the order in which they asked is of no matter.
FW_SHARED_FN uint askOrder(uint object, uint local, uint now) {
    return mixed(mixed(now, object), local);
}
FW_SHARED_FN bool asksBefore(FW_IN(uvec4) a, FW_IN(uvec4) b) {  // order, object, local tile
    if (a.x != b.x) return a.x < b.x;
    return a.y != b.y ? a.y < b.y : a.z < b.z;
}

FW_SHARED_END
#endif
