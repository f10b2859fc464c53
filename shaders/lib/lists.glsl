// Lists of tiles and other work. A tile's membership is a flag bit, so it is in a list at most once
// and the order does not matter. Needs `counters`, the lists of tiles also `tileState`.
#ifndef FW_LIB_LISTS_GLSL
#define FW_LIB_LISTS_GLSL
// Access to lists that a pass may also read; FW_COHERENT: entries that its other threads write.
#ifndef FW_LISTS
#define FW_LISTS FW_READ_WRITE
#endif

// Makes the indirect groups `groups`X of `row` cover entry `slot`, `perGroup` entries each.
#define FW_COVER(row, groups, slot, perGroup)                                                 \
    if ((slot) % (perGroup) == 0u) {                                         \
        atomicMax(counters[row].groups##X, min((slot) / (perGroup) + 1u, kMaxGroups));        \
        if ((slot) == 0u) {                                                                   \
            counters[row].groups##Y = 1u;                                                     \
            counters[row].groups##Z = 1u;                                                     \
        }                                                                                     \
    }

// Slot of a new entry in the list of `row`.
uint listSlot(uint row, uint perGroup) {
    uint slot = atomicAdd(counters[row].listCount, 1u);
    FW_COVER(row, list, slot, perGroup)
    return slot;
}
#endif
