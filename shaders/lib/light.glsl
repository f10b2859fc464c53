// Ignition of a texel by another object.
#include "lib/compute.glsl"
FW_READ(OBJECTS) FW_READ(TEXELS) FW_READ(EXCHANGE_OBJECTS) FW_READ_WRITE(STATE)
FW_READ_WRITE(TILE_STATE) FW_READ_WRITE(COUNTERS) FW_READ_WRITE(OBJECT_COUNTERS)
FW_PUSH(ExchangePush)
#include "lib/burn_budget.glsl"
#include "lib/change.glsl"
#include "lib/hot_list.glsl"

// True: it caught at this tick, by this flame or also by another one. Each counts, so the order of
// threads does not matter: all ignitions of a texel in one dispatch have the same tick.
bool lightTexel(uint object, uint texel, uint tick, uint by) {
    uint at = objects[object].stateBase + texel;
    uint before = state[at];
    bool shares = before == tick;
    if (!shares && !isReceptive(before)) return false;
    TexelPlace p = placeOfTexel(object, texel);
    if (!mayCatch(objectCounters[object].held, tileState[p.worldTile].flag)) return false;
    if (isRequestPass() && !mayBurn(p.worldTile)) requestToBurn(p.worldTile);
    if (isRequestPass() || !mayBurn(p.worldTile)) return false;
    if (!shares) shares = atomicCompSwap(state[at], before, tick) != before;
    litFrom(object, by);
    if (shares) return true;
    atomicAdd(objectCounters[object].ignited, 1u);
    nowBurns(object, p.worldTile, push.now);
    if ((objects[object].flags & kObjectHeat) != 0u) hotTouch(push.hotParity, p.worldTile);
    atomicMin(objectCounters[object].playsUntil, push.now);
    texelChanged(object, texel, p, true);
    return true;
}
