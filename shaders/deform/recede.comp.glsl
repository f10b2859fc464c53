// How much of each node has burnt, and where that leaves it. 64 nodes of one object a group.
#version 450
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#define FW_USE_STATE readonly
#define FW_USE_DEFORM_NODES
#define FW_USE_SHOWN FW_READ_WRITE
#define FW_USE_SOFT FW_READ_WRITE
#include "lib/deform_buffers.glsl"

void main() {
    DeformItem item = deformItem();
    uvec4 sizes = deformObjects[item.object], bases = deformObjects[item.object + 1u];
    if (item.number >= sizes.y) return;
    uint at = (sizes.x + item.number) * kDeformNodeQuads;
    uvec4 rest = deformNodes[at], out_ = deformNodes[at + 1u], facts = deformNodes[at + 2u];
    uint materialAt = item.object + 4u + (facts.x & 7u) * 2u;
    uvec4 material = deformObjects[materialAt], holes = deformObjects[materialAt + 1u];

    float sum = 0.0, known = 0.0;
    FW_UNROLL for (uint q = 0u; q < kDeformTexels / 4u; ++q) {
        uvec4 texels = deformNodes[at + 3u + q];
        FW_UNROLL for (uint k = 0u; k < 4u; ++k) {
            bool there = texels[k] != kNoneTexel;
            uint t = state[bases.y + (there ? texels[k] : 0u)];
            sum += there ? burntShare(t, push.now, push.up.w, material.x) : 0.0;
            known += there ? 1.0 : 0.0;
        }
    }
    uint vertex = (bases.x + rest.w) * kShownQuads;
    // What was put out stays as it is: the share never falls.
    float before_ = item.reset ? 0.0 : shown[vertex + 1u].x;
    float burnt = max(before_, sum / max(known, 1.0));

    float lead = 0.0;
    if (facts.y != kNoneTexel)
        lead = uintBitsToFloat(holes.y) *
               burntShare(state[bases.y + facts.y], push.now, push.up.w, holes.x);

    vec3 place = uintBitsToFloat(rest.xyz);
    float depth = uintBitsToFloat(material.y), lost = 0.0, kept = 0.0;
    bool moves = (bases.z & (kDeformShell | kDeformSprings)) != 0u;
    if (moves) {
        // Places are the solver's: here it learns what burnt, and at first where things rest.
        uint own = (deformObjects[item.object + 3u].x + rest.w) * kSoftQuads;
        uvec4 before = soft[own + item.parity];
        vec2 reachBurnt = unpackHalf2x16(before.w);
        float reach = reachBurnt.x;
        if (item.reset) {
            before.xyz = rest.xyz;
            reach = kReachNone;
            for (uint i = 0u; i < bases.w; ++i) {
                vec4 from = uintBitsToFloat(deformObjects[item.object + 20u + i * 2u]);
                vec4 to = uintBitsToFloat(deformObjects[item.object + 21u + i * 2u]);
                // Known from the start, or a sheet would fall until word of its pins came to it.
                float away = length(place - pinPoint(place, from.xyz, to.xyz)) - from.w;
                reach = min(reach, max(away, 0.0));
            }
        }
        if (reach == 0.0 && burnt > kPinBurns) reach = kReachNone;
        before.w = packHalf2x16(vec2(reach, burnt));
        soft[own + item.parity] = before;
        if (!item.reset) place = shown[vertex].xyz;
        // What the springs are told of a frame, in equal parts for its steps.
        float steps = float(push.parity >> 1u);
        kept = (item.reset ? 0.0 : shown[vertex + 1u].z) + depth * (burnt - before_);
        if (item.reset) kept = 0.0;
        if (steps > 0.5) {
            lost = kept / steps;
            kept = 0.0;
        }
    } else {
        place += uintBitsToFloat(out_.xyz) * recession(burnt, depth, uintBitsToFloat(out_.w));
    }
    shown[vertex] = vec4(place, 0.0);
    shown[vertex + 1u] = vec4(burnt, lost, kept, 0.0);
    shown[vertex + 2u] = vec4(0.0, 0.0, 0.0, lead);
}
