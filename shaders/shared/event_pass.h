// Bodies of the events pass, for GLSL and for the cpu backend, which includes them in a class as it
// does those of exchange_pass.h.
// clang-format off
// GLSL too, and laid out by hand.
#ifndef __cplusplus
#define stateOf(object, texel) state[objects[object].stateBase + (texel)]
#define heatOf(object, texel) heat[objects[object].heatBase + (texel)]
#define hasHeat(object) ((objects[object].flags & kObjectHeat) != 0u)
#define heatMaterialOf(object, texel) heatMaterial(materialOfTexel(object, texel))
#endif

#ifdef FW_PASS_EVENTS
// Does a jet pass all gates on its path, of which this event's kind holds the first?
bool gatesLet(uint kind) {
    uint i = (kind >> kEventKindBits) - 1u;
    bool lets = false, more = true;
    do {
        TexelEvent gate = events[i];
        lets = hasHeat(gate.object) &&
               gateOpens(gate.kind, gate.tick, unpackHeat(heatOf(gate.object, gate.texel)),
                         stateOf(gate.object, gate.texel), push.now);
        more = (gate.kind & kGateMore) != 0u;
        ++i;
    } while (lets && more);
    return lets;
}

bool continuesRun(uint i, uint object, uint texel) {
    return i < push.count && events[i].object == object && events[i].texel == texel &&
           eventKind(events[i].kind) != kEventPlaybackSpan;
}

bool addressesAll(uint i) {
    uint kind = eventKind(events[i].kind);
    return events[i].texel == kNoneTexel && kind != kEventGate && kind != kEventPlaybackSpan;
}

// State of a texel after the run of events that begins at `first`. has: its heat, packed; byFlame:
// the heat of a jet lit it. Ignition by the host is not limited.
uint afterRun(uint first, uint texel, FW_OUT(uvec2) has, FW_OUT(bool) byFlame) {
    uint object = events[first].object, addressed = events[first].texel;
    uint now = stateOf(object, texel), last = first, plays = objectCounters[object].playsUntil;
    has = uvec2(0u);
    byFlame = false;
    if (hasHeat(object)) {
        FW_IN(HeatMaterial) m = heatMaterialOf(object, texel);
        HeatTexel x = unpackHeat(heatOf(object, texel));
        do {
            uint kind = events[last].kind, was = now;
            if (!eventHasGates(kind) || gatesLet(kind))
                now = heatEvent(x, m, now, playedKind(kind, plays, push.now), events[last].tick,
                                push.now);
            byFlame = isSource(was) ? byFlame : isSource(now) && eventKind(kind) == kEventHeat;
            ++last;
        } while (continuesRun(last, object, addressed));
        has = packHeat(x);
    } else {
        do {
            now = applyEvent(now, playedKind(events[last].kind, plays, push.now), events[last].tick,
                             push.now);
            ++last;
        } while (continuesRun(last, object, addressed));
    }
    return now;
}

// Applies the run of events that begins at `first` to one of its texels.
void applyRun(uint first, uint texel) {
    uint object = events[first].object, before = stateOf(object, texel);
    uvec2 has;
    bool byFlame;
    uint now = afterRun(first, texel, has, byFlame);
    bool warms = hasHeat(object) && (has != heatOf(object, texel) || now != before);
    if (now == before && !warms) return;
    TexelPlace p = placeOfTexel(object, texel);
    bool lights = isSource(now) && !isSource(before);
    if (isRequestPass()) {
        if (lights && byFlame) requestToBurn(p.worldTile);
        else if (lights) nowBurns(object, p.worldTile, push.now + kStepTicks);
        return;
    }
    if (lights && byFlame && !mayBurn(p.worldTile)) return;
    if (warms) {
        heatOf(object, texel) = has;
        hotTouch(push.hotParity, p.worldTile);
    }
    if (now == before) return;
    writeState(object, texel, p.worldTile, before, now);
    if (lights) litFrom(object, kLitByHand);
    texelChanged(object, texel, p, isSource(now));
}

// Fuel that burnt on the source mesh counts as a loss of the target; its room has already accounted
// for it.
void recordCarriedEnergy(uint object, uint had, uint has, uint energy) {
    uint high, low;
    umulExtended(had > has ? had - has : has - had, energy, high, low);
    if (had < has) {  // it has gained fuel
        high = ~high + (low == 0u ? 1u : 0u);
        low = ~low + 1u;
    }
    if ((low | high) == 0u) return;
    addEnergy(object, low, high);
    uint before = atomicAdd(objectCounters[object].drawnLow, low);
    atomicAdd(objectCounters[object].drawnHigh, high + (before + low < low ? 1u : 0u));
}

void carryTexel(uint i) {
    uint object = events[i].object, texel = events[i].texel;
    uint from = (events[i].kind >> kEventKindBits) - 1u;
    uint before = stateOf(object, texel), now = stateOf(from, events[i].tick);
    if (isRequestPass() || !carries(now, before)) return;
    TexelPlace p = placeOfTexel(object, texel);
    if (hasHeat(object)) {
        FW_IN(HeatMaterial) m = heatMaterialOf(object, texel);
        uvec2 had = heatOf(object, texel);
        HeatTexel x = carriedTexel(unpackHeat(heatOf(from, events[i].tick)), m);
        now = wetState(now, isBarrierByWater(x, m));
        uvec2 has = packHeat(x);
        if (has == had && now == before) return;
        recordCarriedEnergy(object, unpackHeat(had).fuel, x.fuel, m.energy);
        heatOf(object, texel) = has;
        hotTouch(push.hotParity, p.worldTile);
    }
    if (now == before) return;
    writeState(object, texel, p.worldTile, before, now);
    if (isSource(now)) {
        atomicMax(objectCounters[object].litBy, objectCounters[from].litBy);
        atomicMax(objectCounters[object].litTick, objectCounters[from].litTick);
        atomicMax(objectCounters[object].stopTick, objectCounters[from].stopTick);
    }
    texelChanged(object, texel, p, isSource(now));
}

// Applies event i, and the run that begins with it; later events of a run are no work of their own.
void applyOne(uint i) {
    uint object = events[i].object, texel = events[i].texel, kind = eventKind(events[i].kind);
    if (kind == kEventCarry) {
        carryTexel(i);
    } else if (kind == kEventPlaybackSpan) {
        // Both never occur in one step.
        if (events[i].tick == kNever) atomicMax(objectCounters[object].playsUntil, kNever);
        else atomicMin(objectCounters[object].playsUntil, events[i].tick);
    } else if (kind != kEventGate && texel != kNoneTexel) {  // of all texels: applyRun of each
        if (i == 0u || events[i - 1u].object != object || events[i - 1u].texel != texel)
            applyRun(i, texel);
    }
}
#endif
