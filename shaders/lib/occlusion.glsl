// Heat-occlusion tests: shared/exchange.h with the buffers. The CPU backend's twin is
// gpu/cpu/cpu_exchange.cpp.
FW_READ(HEAT_OCCLUSION) FW_READ(STATE) FW_READ(HEAT) FW_READ(MATERIALS)

// Does the texel that fills an occlusion cell still stand?
bool isOccluderStanding(uint what, uint texel) {
    bool stands = (what & kOcclusionPermanent) != 0u;
    for (bool asks = !stands; asks; asks = false) {
        uint slot = what & kOcclusionSlotMask;
        uint holes = materials[slot * kMaterialsPerObject + ((what >> 24u) & 7u)].holeTicks;
        uint t = state[objects[slot].stateBase + texel];
        bool gone = isSource(t) && t <= push.now && push.now - t >= holes;
        if (gone && (objects[slot].flags & kObjectHeat) != 0u)
            gone = gateOpens(kEventGate, holes, unpackHeat(heat[objects[slot].heatBase + texel]), t,
                             push.now);
        stands = !gone;
    }
    return stands;
}

// Two loops: a software device executes a branch's body for all lanes of its group, so the
// expensive test of a solid cell stays out of the walk over empty ones.
bool isOccluded(OcclusionEnds ends, ivec3 a, ivec3 b) {
    OcclusionWalk w = beginOcclusionWalk(push, a, b);
    uint words = occlusionWords(push.occlusionCounts);
    bool cut = false;
    while (w.within && !cut) {
        uint what = 0u, texel = 0u;
        bool stops = false;  // in a solid cell
        while (w.within && !stops) {
            uint at = w.cell >> 5u, bit = 1u << (w.cell & 31u);
            for (bool solid = (occlusion[at] & bit) != 0u; solid; solid = false) {
                uint baked = occlusion[words + 2u * at];
                what = kOcclusionPermanent | kOcclusionSlotMask;
                if ((baked & bit) != 0u) {
                    uint i = occlusion[words + 2u * at + 1u] + uint(bitCount(baked & (bit - 1u)));
                    what = occlusion[3u * words + 2u * i];
                    texel = occlusion[3u * words + 2u * i + 1u];
                }
                uint slot = what & kOcclusionSlotMask;
                stops = !isNearWalkEnd(w, ends, slot == kOcclusionSlotMask ? kNoneTexel : slot,
                                       push.occlusionCell);
            }
            stepOcclusionWalk(w, push.occlusionCell);
        }
        for (; stops; stops = false) cut = isOccluderStanding(what, texel);
    }
    return cut;
}
