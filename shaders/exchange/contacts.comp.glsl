// Fire across gaps of a few centimetres: a texel's run of links by the thread of its first link.
#version 450
#extension GL_GOOGLE_include_directive : require
#include "lib/light.glsl"
FW_READ(MATERIALS) FW_READ(CONTACTS)
#include "lib/gives.glsl"

// Tick at which this link's source lights its target, or kNever.
uint linkTick(uint i, out uint by) {
    uint from = contacts[i].fromObject;
    by = 0u;
    if (!gives(from, contacts[i].object)) return kNever;
    uint texel = contacts[i].fromTexel;
    uint tick = contactTick(state[objects[from].stateBase + texel],
                            materials[materialOfTexel(from, texel)].flameTicks, contacts[i].delay,
                            contacts[i].since, push.now);
    if (tick != kNever) by = litBy(hopsOf(objectCounters[from].litBy), from);
    return tick;
}

void main() {
    uint first = gl_GlobalInvocationID.x;
    if (first >= push.count) return;
    uint object = contacts[first].object;
    uint texel = contacts[first].texel;
    if (object == kNoneTexel) return;  // padding between two objects' links
    if (first > 0u && contacts[first - 1u].object == object && contacts[first - 1u].texel == texel)
        return;
    if ((exchangeObjects[object].flags & kExchangeLive) == 0u) return;
    uint best = kNever;
    uint by = 0u;
    uint i = first;
    do {
        uint key;
        uint tick = linkTick(i, key);
        if (tick < best || (tick == best && key > by)) by = key;
        best = min(best, tick);
        ++i;
    } while (i < push.count && contacts[i].object == object && contacts[i].texel == texel);
    if (best != kNever) lightTexel(object, texel, best, by);
}
