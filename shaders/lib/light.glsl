// Fire that comes to a texel from another object.
#ifndef FW_LIB_LIGHT_GLSL
#define FW_LIB_LIGHT_GLSL

// True: it caught at that tick, by this flame or by another one as well: each counts, so that the
// order of threads decides nothing. All that light a texel in one dispatch do so at the same tick.
bool lightTexel(uint object, uint texel, uint tick, uint by) {
    uint at = objects[object].stateBase + texel;
    uint before = state[at];
    bool shares = before == tick;
    if (!shares && !isReceptive(before)) return false;
    TexelPlace p = placeOfTexel(object, texel);
    if (!mayCatch(objectCounters[object].held, tileState[p.worldTile].flag)) return false;
    if (asksOnly() && !mayBurn(p.worldTile)) askToBurn(p.worldTile);
    if (asksOnly() || !mayBurn(p.worldTile)) return false;
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
#endif
