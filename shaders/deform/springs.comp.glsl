// One step of the published mass-spring model, eqs. (3) to (8): structure and shear springs to the
// neighbours, flexion springs across, and the force of what decomposes. Semi-implicit Euler.
// kDeformGroup nodes of one object a group.
#version 450
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#define FW_USE_DEFORM_NODES
#define FW_USE_SHOWN FW_READ_WRITE
#define FW_USE_SOFT FW_READ_WRITE
#include "lib/deform_buffers.glsl"

void main() {
    DeformItem item = deformItem();
    uvec2 sizes = deformObjects[item.object].xy;
    uint shownBase = deformObjects[item.object + 1u].x;
    float stiffness = uintBitsToFloat(deformObjects[item.object + 2u].w) * kSpringShare;
    uint softBase = deformObjects[item.object + 3u].x;

    uint last = min(item.end, sizes.y);
    uint number = item.number;
    if (number >= last) return;
    do {
        uint at = (sizes.x + number) * kDeformNodeQuads;
        uvec2 facts = deformNodes[at].xy;
        uint vertex = facts.x;
        uvec4 ring[2] = uvec4[2](deformNodes[at + 1u], deformNodes[at + 2u]);
        uvec4 over[2] = uvec4[2](deformNodes[at + 5u], deformNodes[at + 6u]);
        uvec4 lengths = deformNodes[at + 3u], overLengths = deformNodes[at + 7u];
        uint own = (softBase + number) * kSoftQuads, shownAt = (shownBase + vertex) * kShownQuads;
        uvec4 self = soft[own + item.parity];
        vec3 x = uintBitsToFloat(self.xyz);

        vec3 pull = vec3(0.0), turned = vec3(0.0), before = vec3(0.0), first = vec3(0.0);
        FW_UNROLL for (uint k = 0u; k < kDeformRing; ++k) {
            uint other = ring[k / 4u][k & 3u] & kDeformNode;
            vec2 pair = unpackHalf2x16(lengths[k / 2u]);
            float rest = (k & 1u) == 0u ? pair.x : pair.y;
            vec3 y = uintBitsToFloat(soft[(softBase + other) * kSoftQuads + item.parity].xyz);
            pull += rest > 0.0 ? springPull(x, y, rest, stiffness) : vec3(0.0);
            turned += cross(before, y - x);
            if (k == 0u) first = y - x;
            before = y - x;
            pair = unpackHalf2x16(overLengths[k / 2u]);
            rest = (k & 1u) == 0u ? pair.x : pair.y;
            other = over[k / 4u][k & 3u] & kDeformNode;
            y = uintBitsToFloat(soft[(softBase + other) * kSoftQuads + item.parity].xyz);
            pull += rest > 0.0 ? springPull(x, y, rest, stiffness) : vec3(0.0);
        }
        if ((facts.y & kNodeClosed) != 0u) turned += cross(before, first);
        float size = length(turned);
        vec3 normal = size > 1e-18 ? turned / size : vec3(0.0);

        vec3 from = shown[shownAt].xyz;
        float lost = shown[shownAt + 1u].y;  // m, in this step
        vec3 force = pull + decayPull(normal, lost, push.step) * kDecayShare;
        vec3 velocity = (x - from) * ((1.0 - kSpringDamping) / push.step) + force * push.step;
        shown[shownAt] = vec4(x, 0.0);
        soft[own + (item.parity ^ 1u)] =
            uvec4(floatBitsToUint(x + velocity * push.step), self.w);
        number += 64u;
    } while (number < last);
}
