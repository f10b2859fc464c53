// Landing of embers. They are rare: each tests all objects, then the tiles of one.

ivec3 worldUp() { return ivec3(push.upX, push.upY, push.upZ); }

Ember emberFrom(FireSource source) {
    ivec3 wind = ivec3(push.windX, push.windY, push.windZ) +
                 unpackWind(uint(exchangeObjects[source.object].high.w));
    return flyingEmber(source, source.ember, worldUp(), wind);
}

// Returns the object and sets its tile; kNoneTexel: none.
uint landsOn(ivec3 at, uint axis, out uint tile) {
    uint object = kNoneTexel;
    tile = kNoneTexel;
    int top = kNoTop;
    for (uint slot = 0u; slot < push.count; ++slot) {
        if ((exchangeObjects[slot].flags & kExchangeLive) == 0u) continue;
        int here = topBelow(exchangeObjects[slot], at, axis);
        if (here > top) {
            top = here;
            object = slot;
        }
    }
    uint least = kMisses;
    uint tiles = 0u, base = 0u;
    for (bool found = object != kNoneTexel; found; found = false) {
        tiles = objects[object].tileCount;
        base = objects[object].tileBase;
    }
    for (uint i = 0u; i < tiles; ++i) {
        uint miss = landingMiss(exchangeObjects[object], exchangeTiles[base + i], at, top, axis);
        if (miss < least) {
            least = miss;
            tile = i;
        }
    }
    return object;
}

// Range of sources of a burning slot.
uvec2 sourcesOf(uint slot) {
    bool burns =
        (exchangeObjects[slot].flags & kExchangeLive) != 0u && objectCounters[slot].burning != 0u;
    uint first = exchangeObjects[slot].sourceBase;
    return uvec2(first, burns ? first + exchangeObjects[slot].sourceCount : first);
}
bool sendsEmber(uint at) { return sources[at].ember != 0u && sources[at].watts != 0u; }

// Runs a statement for each ember, at source `at`. One thread per object slot.
#define FW_EACH_EMBER(statement)                                       \
    uint slot = gl_GlobalInvocationID.x;                               \
    if (slot >= push.count) return;                                    \
    uvec2 range = sourcesOf(slot);                                     \
    for (uint at = range.x; at < range.y; ++at)                        \
        for (bool sent = sendsEmber(at); sent; sent = false) statement
