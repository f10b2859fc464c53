// Burn budget: which of the requesting tiles may burn, by the remaining capacity of each object and
// of the world, in hashed order (requestOrder). They join the burn list, and only listed tiles are
// lit afterwards. With kSwitchRequests the front's due tiles request here. One group.
#include "lib/compute.glsl"
FW_READ(OBJECTS) FW_READ(RUN) FW_READ(MASKS) FW_READ(EXCHANGE_OBJECTS) FW_READ_WRITE(TILE_STATE)
FW_READ_WRITE(OBJECT_COUNTERS) FW_COHERENT(COUNTERS) FW_PUSH(StepPush)
#define FW_LISTS FW_COHERENT
#include "lib/burn_budget.glsl"
#include "lib/tile.glsl"

uint asked(uint i) { return predictLists[2u * i + (push.predictParity ^ 1u)]; }
uint markOf(uint worldTile) { return burnLists[markAt(worldTile)]; }
void setMark(uint worldTile, uint mark) { burnLists[markAt(worldTile)] = mark; }

uvec4 orderOf(uint worldTile) {
    TileRef tile = tileRef(worldTile);
    return uvec4(requestOrder(tile.object, tile.local, push.now), tile.object, tile.local,
                 worldTile);
}

// Number of requests with at least this mark that precede `own`; alike: of the same object.
uint before(uvec4 own, uint count, uint mark, bool alike) {
    uint sum = 0u;
    for (uint i = 0u; i < count; ++i) {
        uint other = asked(i);
        if (markOf(other) < mark) continue;
        uvec4 theirs = orderOf(other);
        sum += (!alike || theirs.y == own.y) && requestPrecedes(theirs, own) ? 1u : 0u;
    }
    return sum;
}

void main() {
    uint lane = gl_LocalInvocationID.x;
    uint asks = kRowBurn + (push.burnParity ^ 1u);
    uint due = (push.switches & kSwitchRequests) != 0u ? counters[push.row].runCount : 0u;
    for (uint i = lane; i < due; i += 64u)
        if ((masks[i].z | masks[i].w) != 0u && !mayBurn(run[i].x)) requestToBurn(run[i].x);
    syncBuffers();
    uint count = counters[asks].workCount;
    uint room = remainingTiles(counters[kRowBurn + push.burnParity].listCount, push.maxTiles);
    // Tiles lit by the host meanwhile burn without a request.
    for (uint i = lane; i < count; i += 64u)
        if ((tileState[asked(i)].flag & kTileBurning) != 0u) setMark(asked(i), 0u);
    syncBuffers();
    for (uint i = lane; i < count; i += 64u) {
        uvec4 own = orderOf(asked(i));
        if (markOf(own.w) != kRequested) continue;
        ExchangeObject limits = exchangeObjects[own.y];
        uint most = (limits.flags & kExchangeLive) != 0u ? limits.maxTiles : kNoneTexel;
        uint objectRoom = remainingTiles(objectCounters[own.y].burningTiles, most);
        uint fits = 1u;
        if (count > objectRoom) fits = before(own, count, kRequested, true) < objectRoom ? 1u : 0u;
        // Marks of finished lanes still count as requests.
        if (fits != 0u) setMark(own.w, kRequested + kRequestFitsObject);
    }
    syncBuffers();
    for (uint i = lane; i < count; i += 64u) {
        uvec4 own = orderOf(asked(i));
        if (markOf(own.w) != kRequested + kRequestFitsObject) continue;
        uint may = 1u;
        if (count > room)
            may = before(own, count, kRequested + kRequestFitsObject, false) < room ? 1u : 0u;
        if (may != 0u) setMark(own.w, kRequested + kRequestAllocated);
    }
    syncBuffers();
    for (uint i = lane; i < count; i += 64u) {
        uint worldTile = asked(i);
        uint mark = markOf(worldTile);
        setMark(worldTile, 0u);
        if (mark != kRequested + kRequestAllocated) continue;
        atomicOr(tileState[worldTile].flag, kTileBurning);
        burnAppend(push.burnParity, worldTile);
        atomicAdd(objectCounters[tileState[worldTile].object].burningTiles, 1u);
    }
    barrier();
    if (lane == 0u) counters[asks].workCount = 0u;
}
