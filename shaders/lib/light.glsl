// Fire that comes to a texel from another object.
#ifndef FW_LIB_LIGHT_GLSL
#define FW_LIB_LIGHT_GLSL

// True: it caught. Whoever else lights it in the same dispatch does so at the same tick, or not at
// all.
bool lightTexel(uint object, uint texel, uint tick, uint by) {
    uint at = objects[object].stateBase + texel;
    uint before = state[at];
    if (!isReceptive(before)) return false;
    TexelPlace p = placeOfTexel(object, texel);
    if (!mayCatch(objectCounters[object].held, tileState[p.worldTile].flag)) return false;
    if (asksOnly() && !mayBurn(p.worldTile)) askToBurn(p.worldTile);
    if (asksOnly() || !mayBurn(p.worldTile)) return false;
    if (atomicCompSwap(state[at], before, tick) != before) return false;
    atomicAdd(objectCounters[object].ignited, 1u);
    nowBurns(object, p.worldTile, push.now);
    if ((objects[object].flags & kObjectHeat) != 0u) hotTouch(push.hotParity, p.worldTile);
    litFrom(object, by);
    atomicMin(objectCounters[object].playsUntil, push.now);
    texelChanged(object, texel, p, true);
    return true;
}
#endif
