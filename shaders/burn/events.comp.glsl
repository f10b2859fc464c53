// Applies a step's texel events, 64 per group: a texel's run of events by the thread of its first,
// in order. FW_ALL_TEXELS: runs that address all texels of an object, one thread per texel. The
// front kernel reacts in the same step.
#include "lib/compute.glsl"
FW_READ(OBJECTS) FW_READ(EVENTS) FW_READ(TEXELS) FW_READ_WRITE(STATE) FW_READ_WRITE(TILE_STATE)
FW_READ_WRITE(COUNTERS) FW_READ_WRITE(OBJECT_COUNTERS) FW_READ_WRITE(HEAT)
FW_PUSH(StepPush)
#include "lib/hot_list.glsl"
#include "lib/burn_budget.glsl"
#include "lib/heat_material.glsl"
#include "lib/tile.glsl"
#include "lib/change.glsl"

// Does a jet pass all gates on its path?
bool gatesLet(uint kind) {
    uint gate = kind >> kEventKindBits;
    bool lets = true, more = gate != 0u;
    for (uint k = 0u; k < kGates; ++k) {
        uint i = more ? gate - 1u + k : 0u;
        TexelEvent at = events[i];
        bool heats = more && (objects[at.object].flags & kObjectHeat) != 0u;
        HeatTexel x = unpackHeat(heat[objects[at.object].heatBase + (heats ? at.texel : 0u)]);
        uint t = state[objects[at.object].stateBase + at.texel];
        lets = lets && (!more || (heats && gateOpens(at.kind, at.tick, x, t, push.now)));
        more = more && (at.kind & kGateMore) != 0u;
    }
    return lets;
}

bool continuesRun(uint i, uint object, uint texel) {
    return i < push.count && events[i].object == object && events[i].texel == texel &&
           eventKind(events[i].kind) != kEventPlaybackSpan;
}

// True: the texel is a source now.
bool writeState(uint object, uint at, uint worldTile, uint before, uint now) {
    state[at] = now;
    if (isSource(now) != isSource(before))
        atomicAdd(objectCounters[object].ignited, isSource(now) ? 1u : 0xFFFFFFFFu);
    if (isSource(now)) nowBurns(object, worldTile, push.now + kStepTicks);
    return isSource(now);
}

// Applies the run of events that begins at `first` to one of its texels.
void applyRun(uint first, uint texel) {
    uint object = events[first].object;
    uint addressed = events[first].texel;
    uint at = objects[object].stateBase + texel;
    uint before = state[at];
    uint now = before;
    uint last = first;
    bool heats = (objects[object].flags & kObjectHeat) != 0u;
    bool warms = false;
    bool byFlame = false;  // lit by a jet's heat; ignition by the host is not limited
    uvec2 has = uvec2(0u);
    uint plays = objectCounters[object].playsUntil;
    if (heats) {
        uint heatAt = objects[object].heatBase + texel;
        HeatMaterial m = heatMaterial(materialOfTexel(object, texel));
        uvec2 had = heat[heatAt];
        HeatTexel x = unpackHeat(had);
        do {
            uint kind_ = events[last].kind;
            bool lets = !eventHasGates(kind_) || gatesLet(kind_);
            uint was = now;
            if (lets)
                now = heatEvent(x, m, now, playedKind(kind_, plays, push.now), events[last].tick,
                                push.now);
            byFlame = isSource(was) ? byFlame : isSource(now) && eventKind(kind_) == kEventHeat;
            ++last;
        } while (continuesRun(last, object, addressed));
        has = packHeat(x);
        warms = has != had || now != before;
    } else {
        do {
            now = applyEvent(now, playedKind(events[last].kind, plays, push.now), events[last].tick,
                             push.now);
            ++last;
        } while (continuesRun(last, object, addressed));
    }
    if (now == before && !warms) return;

    TexelPlace p = placeOfTexel(object, texel);
    bool lights = isSource(now) && !isSource(before);
    if (isRequestPass()) {
        if (lights && byFlame) requestToBurn(p.worldTile);
        else if (lights) nowBurns(object, p.worldTile, push.now + kStepTicks);
        return;
    }
    if (lights && byFlame && !mayBurn(p.worldTile)) return;
    if (heats) heat[objects[object].heatBase + texel] = has;
    if (warms) hotTouch(push.hotParity, p.worldTile);
    if (now == before) return;
    if (writeState(object, at, p.worldTile, before, now) && !isSource(before))
        litFrom(object, kLitByHand);
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
    uint at = objects[object].stateBase + texel;
    uint before = state[at], now = state[objects[from].stateBase + events[i].tick];
    if (isRequestPass() || !carries(now, before)) return;
    TexelPlace p = placeOfTexel(object, texel);
    if ((objects[object].flags & kObjectHeat) != 0u) {
        uint heatAt = objects[object].heatBase + texel;
        HeatMaterial m = heatMaterial(materialOfTexel(object, texel));
        uvec2 had = heat[heatAt];
        HeatTexel x = carriedTexel(unpackHeat(heat[objects[from].heatBase + events[i].tick]), m);
        now = wetState(now, isBarrierByWater(x, m));
        uvec2 has = packHeat(x);
        if (has == had && now == before) return;
        recordCarriedEnergy(object, unpackHeat(had).fuel, x.fuel, m.energy);
        heat[heatAt] = has;
        hotTouch(push.hotParity, p.worldTile);
    }
    if (now == before) return;
    if (writeState(object, at, p.worldTile, before, now)) {
        atomicMax(objectCounters[object].litBy, objectCounters[from].litBy);
        atomicMax(objectCounters[object].litTick, objectCounters[from].litTick);
        atomicMax(objectCounters[object].stopTick, objectCounters[from].stopTick);
    }
    texelChanged(object, texel, p, isSource(now));
}

bool addressesAll(uint i) {
    uint kind = eventKind(events[i].kind);
    return events[i].texel == kNoneTexel && kind != kEventGate && kind != kEventPlaybackSpan;
}

#ifdef FW_ALL_TEXELS
// Tiles by group, one event per row; push.object: the event of the first row.
void main() {
    uint i = push.object + gl_WorkGroupID.y;
    if (i >= push.count || !addressesAll(i)) return;
    uint object = events[i].object;
    if (i > 0u && addressesAll(i - 1u) && events[i - 1u].object == object) return;
    for (uint tile = gl_WorkGroupID.x; tile < objects[object].tileCount;
         tile += gl_NumWorkGroups.x) {
        uint texel = texelOf(object, tile, gl_LocalInvocationID.x);
        uint flags = texels[objects[object].texelBase + texel].y >> 16u;
        if ((flags & kTexelReal) != 0u) applyRun(i, texel);
    }
}
#else
void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.count) return;
    uint object = events[i].object;
    uint texel = events[i].texel;
    if (eventKind(events[i].kind) == kEventGate) return;
    if (eventKind(events[i].kind) == kEventCarry) {
        carryTexel(i);
        return;
    }
    if (eventKind(events[i].kind) == kEventPlaybackSpan) {
        // both never occur in one step
        if (events[i].tick == kNever) atomicMax(objectCounters[object].playsUntil, kNever);
        else atomicMin(objectCounters[object].playsUntil, events[i].tick);
        return;
    }
    if (texel == kNoneTexel) return;  // all texels: FW_ALL_TEXELS
    if (i > 0u && events[i - 1u].object == object && events[i - 1u].texel == texel) return;
    applyRun(i, texel);
}
#endif
