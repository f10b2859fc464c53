// Refined vertex of this frame, from the arrivals around its texel and around the opposite wall.
// Needs `refined`, `predict` and `gradient`.

bool isDoused(uint t) { return t == kOut || t == kOutWet; }

// As the surface shows it: unsupported pieces turn to ash early, and a texel that was put out keeps
// its age.
float arrivalAt(uint object, uint base, uint weights, uint nowTick) {
    uint at = refined[object].stateBase + base;
    uint up = at + refined[object].textureWidth;
    uvec4 t = uvec4(predict[at], predict[at + 1u], predict[up], predict[up + 1u]);
    bool doused = isDoused(t.x) || isDoused(t.y) || isDoused(t.z) || isDoused(t.w);
    while (doused) {
        uvec4 burnt = uvec4(gradient[at], gradient[at + 1u], gradient[up], gradient[up + 1u]);
        for (int k = 0; k < 4; ++k)
            if (isDoused(t[k])) t[k] = nowTick - min(burnt[k], nowTick);
        doused = false;
    }
    return refineArrival(t, weights, nowTick, refined[object].epochTick);
}

// behind: s since the object's epoch when the opposite wall was lit; unlit: assumed one
// burn-through time ahead, so that corners around a lit area know the distance to it.
RefineVertex evaluateSlotNow(uint object, RefineSlot slot, uint nowTick, float recede,
                             out float behind) {
    float own = arrivalAt(object, slot.texel & 0xFFFFFFu, slot.weights, nowTick);
    behind = kRefineNever;
    bool walled = slot.opposite != kRefineOpposed;
    while (walled) {
        behind = arrivalAt(object, slot.opposite & 0xFFFFFFu, refineOppositeWeights(slot.opposite),
                           nowTick);
        walled = false;
    }
    uint material = slot.texel >> 24u;
    vec4 low = refined[object].burnSeconds0;
    vec4 high = refined[object].burnSeconds1;
    float seconds = material < 4u ? low[material & 3u] : high[material & 3u];
    vec4 v = evaluateSlot(slot, own, behind, refined[object].now, seconds, recede);
    behind = min(behind, refined[object].now + abs(seconds));
    return RefineVertex(v.x, v.y, v.z, v.w);
}
