// Per object: who lit it, whether it may continue, world positions of its sources, and which of
// them send an ember. Wakes the objects that they may heat. One thread per object slot.
#version 450
#extension GL_GOOGLE_include_directive : require
#include "lib/compute.glsl"
FW_READ(COUNTERS) FW_READ(EXCHANGE_OBJECTS) FW_READ(NEIGHBOURS) FW_READ_WRITE(OBJECT_COUNTERS)
FW_READ_WRITE(SOURCES) FW_PUSH(ExchangePush)

void settle(uint slot, uint hops, bool gives, uint strength) {
    ExchangeObject o = exchangeObjects[slot];
    for (uint cell = 0u; cell < o.sourceCount; ++cell) {
        uint at = o.sourceBase + cell;
        if (!gives) {
            sources[at].watts = 0u;
            continue;
        }
        FireSource s = sources[at];
        s.power = mulShift(s.power, strength, 8u);
        settleSource(s, o);
        s.object = slot;
        s.hops = hops;
        s.ember = 0u;
        if ((push.flags & kExchangeEmbers) != 0u && s.watts != 0u)
            s.ember = emberOf(push.seed, slot, cell, push.now, s.power, push.brands);
        sources[at] = s;
    }
}

void main() {
    uint slot = gl_GlobalInvocationID.x;
    if (slot >= push.count || (exchangeObjects[slot].flags & kExchangeLive) == 0u) return;
    ObjectCounters c = objectCounters[slot];
    recordFire(c, exchangeObjects[slot], push);
    objectCounters[slot].litBy = c.litBy;
    objectCounters[slot].litTick = c.litTick;
    objectCounters[slot].stopTick = c.stopTick;
    objectCounters[slot].spotTexel = c.spotTexel;
    objectCounters[slot].held =
        heldBits(counters[kRowBurn + push.burnParity].runCount, push.maxTiles, c.burningTiles,
                 exchangeObjects[slot].maxTiles, c.stopTick, push.now);
    for (bool once = c.burning != 0u; once; once = false) {
        uint hops = hopsOf(c.litBy);
        bool gives = mayTransfer(exchangeObjects[slot], hops, push.hopsMost);
        settle(slot, hops, gives, airStrength(c.air));
        uint warms = gives && (push.flags & (kExchangeRadiation | kExchangePlume)) != 0u
                         ? exchangeObjects[slot].neighbourCount : 0u;
        for (uint n = 0u; n < warms; ++n)
            atomicMax(
                objectCounters[neighbours[exchangeObjects[slot].neighbourFirst + n] & 0xFFFFFFu]
                    .until,
                push.now + kExchangeRounds * kExchangeTicks);
    }
}
