// One step of the published mass-spring model, eqs. (3) to (8): structure and shear springs to the
// neighbours, flexion springs across, and the force of what decomposes. Semi-implicit Euler. 64 nodes
// of one object a group.
#version 450
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#define FW_USE_DEFORM_NODES
#define FW_USE_SHOWN FW_READ_WRITE
#define FW_USE_SOFT FW_READ_WRITE
#include "lib/deform_buffers.glsl"

void main() {
    DeformItem item = deformItem();
    uvec4 sizes = deformObjects[item.object], bases = deformObjects[item.object + 1u];
    if (item.number >= sizes.y) return;
    float stiffness = uintBitsToFloat(deformObjects[item.object + 2u].w) * kSpringShare;
    uint softBase = deformObjects[item.object + 3u].x;
    uint at = (sizes.x + item.number) * kDeformNodeQuads;
    uint vertex = deformNodes[at].w;
    uvec4 facts = deformNodes[at + 2u], lengths = deformNodes[at + 9u];
    uvec4 crossLengths = deformNodes[at + 12u];
    uint own = (softBase + vertex) * kSoftQuads, shownAt = (bases.x + vertex) * kShownQuads;
    uvec4 self = soft[own + item.parity];
    vec3 x = uintBitsToFloat(self.xyz);

    vec3 pull = vec3(0.0), turned = vec3(0.0), before = vec3(0.0), first = vec3(0.0);
    FW_UNROLL for (uint k = 0u; k < kDeformRing; ++k) {
        uint other = deformNodes[at + 7u + k / 4u][k & 3u];
        vec2 pair = unpackHalf2x16(lengths[k / 2u]);
        float rest = (k & 1u) == 0u ? pair.x : pair.y;
        vec3 y = uintBitsToFloat(soft[(softBase + other) * kSoftQuads + item.parity].xyz);
        pull += rest > 0.0 ? springPull(x, y, rest, stiffness) : vec3(0.0);
        turned += cross(before, y - x);
        if (k == 0u) first = y - x;
        before = y - x;
        uint over = deformNodes[at + 10u + k / 4u][k & 3u];
        pair = unpackHalf2x16(crossLengths[k / 2u]);
        rest = (k & 1u) == 0u ? pair.x : pair.y;
        y = uintBitsToFloat(
            soft[(softBase + (rest > 0.0 ? over : vertex)) * kSoftQuads + item.parity].xyz);
        pull += rest > 0.0 ? springPull(x, y, rest, stiffness) : vec3(0.0);
    }
    if ((facts.x & kNodeClosed) != 0u) turned += cross(before, first);
    float size = length(turned);
    vec3 normal = size > 1e-18 ? turned / size : vec3(0.0);

    vec3 last = shown[shownAt].xyz;
    float lost = shown[shownAt + 1u].y;  // m, in this step
    vec3 force = pull + decayPull(normal, lost, push.step) * kDecayShare;
    vec3 velocity = (x - last) * ((1.0 - kSpringDamping) / push.step) + force * push.step;
    shown[shownAt] = vec4(x, 0.0);
    soft[own + (item.parity ^ 1u)] =
        uvec4(floatBitsToUint(x + velocity * push.step), self.w);
}
