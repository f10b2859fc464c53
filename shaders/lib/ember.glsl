// Embers of the burning objects; include after shared/exchange_pass.h.

// Range of sources of a burning slot.
uvec2 sourcesOf(uint slot) {
    bool burns =
        (exchangeObjects[slot].flags & kExchangeLive) != 0u && objectCounters[slot].burning != 0u;
    uint first = exchangeObjects[slot].sourceBase;
    return uvec2(first, burns ? first + exchangeObjects[slot].sourceCount : first);
}

// Runs a statement for each ember, at source `at`. One thread per object slot.
#define FW_EACH_EMBER(statement)                                       \
    uint slot = gl_GlobalInvocationID.x;                               \
    if (slot >= push.count) return;                                    \
    uvec2 range = sourcesOf(slot);                                     \
    for (uint at = range.x; at < range.y; ++at)                        \
        for (bool sent = sendsEmber(sources[at]); sent; sent = false) statement
