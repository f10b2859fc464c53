// Link cache of sheets: links and bending constraints that hold, pinned neighbours, charred shares,
// and the nearest pin point. Runs every kLinkCacheSteps steps. kDeformGroup particles of one object
// per group.
#include "lib/deform.glsl"
FW_READ(DEFORM_PARTICLES) FW_READ_WRITE(SOFT)

void main() {
    DeformItem item = deformItem();
    uvec2 sizes = deformObjects[item.object].xy;
    uint pins = deformObjects[item.object + 1u].w, softBase = deformObjects[item.object + 3u].x;

    uint last = min(item.end, sizes.y);
    uint number = item.number;
    if (number >= last) return;
    do {
        uint at = sizes.x * kDeformParticleQuads + number;
        uint flags = deformParticle(at).y;
        uint own = softBase * kSoftQuads + number, seenAt = own + kSoftFacts * sizes.y;
        uint mine = soft(seenAt).x;
        float burnt = burntOf(mine);

        uint holding = 0u, charreds = 0u, ends = 0u, count = 0u;
        uint turn = 0u, turns = linkPasses(flags), all = turns + bendPasses(flags) * kBendSets;
        do {  // neighbours, then all bending sets
            bool bends = turn >= turns;
            uint set = turn - turns;
            uvec4 two = deformParticle(at + (bends ? kParticleBends + set : kParticleLinks + turn) *
                                                sizes.y);
            FW_UNROLL for (uint i = 0u; i < kLinksPerPass; ++i) {
                uint k = (bends ? set : turn) * kLinksPerPass + i;
                float rest = unpackHalf2x16(two.z)[i];
                uint there = soft(seenAt - number + (two[i] & kDeformLinkIndex)).x;
                bool holds = rest > 0.0 && linkHolds(burnt, burntOf(there), two[i] >> 24u);
                uint charred = charredOf(there) << (4u * k);
                holding |= holds ? 1u << ((bends ? kLinkCacheBends : 0u) + k) : 0u;
                ends |= bends ? charred : 0u;
                if (bends) continue;
                charreds |= charred;
                holding |= pinnedOf(there) << (kLinkCachePinned + k);
                count += holds ? 1u : 0u;
            }
        } while (++turn < all);
        bool whole =
            (flags & kParticleClosed) != 0u && count == (flags >> kParticleRingShift & 15u);
        holding |= whole ? kLinkCacheWhole : 0u;

        vec3 x = placeOf(soft(own + item.parity * sizes.y));
        vec4 anchor = vec4(0.0);
        float nearest = 1e30;
        uint i = 0u;
        do {
            vec4 from = uintBitsToFloat(deformObjects[item.object + 20u + i * 2u]);
            vec4 to = uintBitsToFloat(deformObjects[item.object + 21u + i * 2u]);
            vec3 point = pinPoint(x, from.xyz, to.xyz);
            float away = length(x - point);
            anchor = away < nearest ? vec4(point, from.w) : anchor;
            nearest = min(nearest, away);
        } while (++i < pins);
        softOut[own + kSoftAnchor * sizes.y] = floatBitsToUint(anchor);
        softOut[own + kSoftLinkCache * sizes.y] = uvec4(holding, charreds, ends, mine);
        number += 64u;
    } while (number < last);
}
