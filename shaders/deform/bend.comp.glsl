// How each node of a sheet lies among its neighbours: its normal, and what bending and curling ask of
// it. Half a step: soft.comp does the other. 64 nodes of one object a group.
#version 450
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#define FW_USE_OBJECT_QUADS
#define FW_USE_DEFORM_NODES
#define FW_USE_SOFT FW_READ_WRITE
#include "lib/deform_buffers.glsl"

void main() {
    DeformItem item = deformItem();
    uvec4 sizes = deformObjects[item.object], bases = deformObjects[item.object + 1u];
    if (item.number >= sizes.y) return;
    uint softBase = deformObjects[item.object + 3u].x;
    uint at = (sizes.x + item.number) * kDeformNodeQuads;
    uint vertex = deformNodes[at].w;
    uvec4 facts = deformNodes[at + 2u];
    uvec4 lengths = deformNodes[at + 9u], crossLengths = deformNodes[at + 12u];
    uint materialAt = item.object + 4u + (facts.x & 7u) * 2u;
    float curl = uintBitsToFloat(deformObjects[materialAt].w);
    float bend = uintBitsToFloat(deformObjects[materialAt + 1u].z);
    vec3 up = upHere(deformObjects[item.object + 2u]);
    float scale = uintBitsToFloat(deformObjects[item.object + 2u].z);

    uvec4 self = soft[(softBase + vertex) * kSoftQuads + item.parity];
    vec3 x = uintBitsToFloat(self.xyz);
    float burnt = unpackHalf2x16(self.w).y;

    vec3 turned = vec3(0.0), before = vec3(0.0), first = vec3(0.0);
    vec3 sums[2] = vec3[2](vec3(0.0), vec3(0.0));
    float counts[2] = float[2](0.0, 0.0), squares[2] = float[2](0.0, 0.0);
    uint links = 0u;
    FW_UNROLL for (uint k = 0u; k < kDeformRing; ++k) {
        FW_UNROLL for (uint far = 0u; far < 2u; ++far) {
            uint other = deformNodes[at + 7u + far * 3u + k / 4u][k & 3u];
            vec2 pair = unpackHalf2x16(far == 0u ? lengths[k / 2u] : crossLengths[k / 2u]);
            float rest = (k & 1u) == 0u ? pair.x : pair.y;
            bool there_ = far == 0u || rest > 0.0;
            uvec4 there = soft[(softBase + (there_ ? other : vertex)) * kSoftQuads + item.parity];
            vec3 arm = uintBitsToFloat(there.xyz) - x;
            bool holds = rest > 0.0 && linkHolds(burnt, unpackHalf2x16(there.w).y, vertex, other) &&
                         (far == 0u || length(arm) <= 1.3 * rest);
            links |= holds ? 1u << (k + 8u * far) : 0u;
            sums[far] += holds ? arm : vec3(0.0);
            squares[far] += holds ? rest * rest : 0.0;
            counts[far] += holds ? 1.0 : 0.0;
            if (far == 1u) continue;
            turned += cross(before, arm);
            if (k == 0u) first = arm;
            before = arm;
        }
    }
    if ((facts.x & kNodeClosed) != 0u) turned += cross(before, first);
    float size = length(turned);
    vec3 normal = size > 1e-18 ? turned / size : up;

    float charred = charredShare(burnt);
    curl *= curlSide(normal, up) * scale * charred;
    // Charring stiffens what held its shape only loosely.
    float stiff = mix(bend, max(bend, 0.9), charred);
    vec3 asked[2];
    float ring = float(facts.x >> kNodeRingShift & 15u);
    FW_UNROLL for (uint far = 0u; far < 2u; ++far) {
        float mean = 1.0 / max(counts[far], 1.0);
        float rise = (far == 0u ? 1.0 : 4.0) * uintBitsToFloat(facts.w) +
                     curlRise(curl, squares[far] * mean);
        bool even = (facts.x & (far == 0u ? kNodeEven : kNodeFarEven)) != 0u;
        bool whole = (facts.x & kNodeClosed) != 0u && counts[far] == ring && (even || far == 0u);
        vec3 b = bendOf(sums[far] * mean, normal, rise, counts[far], stiff, even);
        asked[far] = whole ? b * kBendUnit : vec3(0.0);
    }
    soft[(softBase + vertex) * kSoftQuads + 2u] =
        uvec4(packBent(normal, links), packHalf2x16(asked[0].xy),
              packHalf2x16(vec2(asked[0].z, asked[1].x)), packHalf2x16(asked[1].yz));
}
