// Where burning tiles are limited, no tile is lit that is not on the burn list. A lighting pass
// runs twice: first it requests tiles, then it lights those that `burn_budget` put on the list in
// between; all else stays unchanged. Requests use storage that is free meanwhile: the predict list
// that the frame's prediction will write, and, as marks per world tile, the burn list that the next
// reduction will write. Needs `objectCounters` and `push`.
#include "lib/burn_list.glsl"
#include "lib/predict_list.glsl"
#include "shared/exchange.h"

const uint kRequested = 0xFFFFFFF0u;  // exceeds any world tile
const uint kRequestFitsObject = 1u;       // + these: fits the object's limit, the world's
const uint kRequestAllocated = 2u;
uint markAt(uint worldTile) { return 2u * worldTile + (push.burnParity ^ 1u); }
bool isRequestPass() { return (push.switches & kSwitchRequests) != 0u; }
bool mayBurn(uint worldTile) {
    return (push.switches & kSwitchCapped) == 0u ||
           (tileState[worldTile].flag & kTileBurning) != 0u;
}
void requestToBurn(uint worldTile) {
    if (atomicExchange(burnLists[markAt(worldTile)], kRequested) == kRequested) return;
    uint slot = atomicAdd(counters[kRowBurn + (push.burnParity ^ 1u)].workCount, 1u);
    predictLists[2u * slot + (push.predictParity ^ 1u)] = worldTile;
}

// end: end tick of the window in which a texel caught.
void nowBurns(uint object, uint worldTile, uint end) {
    atomicMax(objectCounters[object].lastIgnition, end);
    if ((atomicOr(tileState[worldTile].flag, kTileBurning) & kTileBurning) == 0u) {
        burnAppend(push.burnParity, worldTile);
        atomicAdd(objectCounters[object].burningTiles, 1u);
    }
}
void addEnergy(uint object, uint low, uint high) {
    uint before = atomicAdd(objectCounters[object].energyLow, low);
    atomicAdd(objectCounters[object].energyHigh, high + (before + low < low ? 1u : 0u));
}
