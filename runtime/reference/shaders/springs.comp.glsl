// One step of the reference's mass-spring model, eqs. (3) to (8): structure and shear springs to
// the neighbours, flexion springs across, and the force of decomposition. Semi-implicit Euler.
// kDeformGroup particles of one object per group.
#include "lib/deform.glsl"
#include "reference/springs.h"
// Of particles: links of pass 0 of all, then of pass 1.
#define FW_BUFFER_EXTENSION_WORDS(access) FW_BUFFER(EXTENSION_WORDS, access, uvec4, farLinks)
FW_READ(DEFORM_PARTICLES) FW_READ(EXTENSION_WORDS) FW_READ_WRITE(SHOWN) FW_READ_WRITE(SOFT)

void main() {
    DeformItem item = deformItem();
    uvec2 sizes = deformObjects[item.object].xy;
    uint shownBase = deformObjects[item.object + 1u].x;
    uint farBase = deformObjects[item.object + 2u].w;
    float stiffness = springStiffness() * kSpringShare;
    uint softBase = deformObjects[item.object + 3u].x;

    uint last = min(item.end, sizes.y);
    uint number = item.number;
    if (number >= last) return;
    do {
        uint at = sizes.x * kDeformParticleQuads + number;
        uvec2 facts = deformParticle(at).xy;
        uint vertex = facts.x;
        uint own = softBase * kSoftQuads + number, shownAt = (shownBase + vertex) * kShownQuads;
        uint places = own - number + item.parity * sizes.y;
        uvec4 self = soft(places + number);
        vec3 x = uintBitsToFloat(self.xyz);

        vec3 pull = vec3(0.0), turned = vec3(0.0), before = vec3(0.0), first = vec3(0.0);
        uint turn = 0u, turns = linkPasses(facts.y);
        do {
            uvec4 two = deformParticle(at + (kParticleLinks + turn) * sizes.y),
                  over = farLinks[farBase + turn * sizes.y + number];
            FW_UNROLL for (uint i = 0u; i < kLinksPerPass; ++i) {
                uint other = two[i] & kDeformLinkIndex;
                float rest = unpackHalf2x16(two.z)[i];
                vec3 y = uintBitsToFloat(soft(places + other).xyz);
                pull += rest > 0.0 ? springPull(x, y, rest, stiffness) : vec3(0.0);
                turned += cross(before, y - x);
                if (turn + i == 0u) first = y - x;
                before = y - x;
                other = over[i] & kDeformLinkIndex;
                rest = unpackHalf2x16(over.z)[i];
                y = uintBitsToFloat(soft(places + other).xyz);
                pull += rest > 0.0 ? springPull(x, y, rest, stiffness) : vec3(0.0);
            }
        } while (++turn < turns);
        if ((facts.y & kParticleClosed) != 0u) turned += cross(before, first);
        float size = length(turned);
        vec3 normal = size > 1e-18 ? turned / size : vec3(0.0);

        vec3 from = shown(shownAt).xyz;
        float lost = shown(shownAt + 1u).y;  // m, in this step
        vec3 force = pull + decayPull(normal, lost, push.step) * kDecayShare;
        vec3 velocity = (x - from) * ((1.0 - kSpringDamping) / push.step) + force * push.step;
        readBeforeWritten();
        shownOut[shownAt] = floatBitsToUint(vec4(x, 0.0));
        softOut[own + (item.parity ^ 1u) * sizes.y] =
            uvec4(floatBitsToUint(x + velocity * push.step), self.w);
        number += 64u;
    } while (number < last);
}
