// Embers of the burning objects; include after shared/exchange_pass.h.

// Runs a statement for each ember, at source `at`. One thread per object slot.
#define FW_EACH_EMBER(statement)                                       \
    uint slot = gl_GlobalInvocationID.x;                               \
    if (slot >= push.count) return;                                    \
    if ((exchangeObjects[slot].flags & kExchangeLive) == 0u || objectCounters[slot].burning == 0u) \
        return;                                                        \
    uint at = exchangeObjects[slot].sourceBase;                        \
    for (uint end = at + exchangeObjects[slot].sourceCount; at < end; ++at) \
        for (bool sent = sendsEmber(sources[at]); sent; sent = false) statement
