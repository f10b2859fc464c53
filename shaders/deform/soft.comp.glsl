// One step of sheets: every node moves to where its links, its bending and its pins allow, and on
// with the speed that this gives it. 64 nodes of one object a group.
#version 450
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#define FW_USE_OBJECT_QUADS
#define FW_USE_DEFORM_NODES
#define FW_USE_SHOWN FW_READ_WRITE
#define FW_USE_SOFT FW_READ_WRITE
#include "lib/deform_buffers.glsl"

void main() {
    DeformItem item = deformItem();
    uvec4 sizes = deformObjects[item.object], bases = deformObjects[item.object + 1u];
    uvec4 facts2 = deformObjects[item.object + 2u];
    if (item.number >= sizes.y) return;
    uint softBase = deformObjects[item.object + 3u].x;
    uint at = (sizes.x + item.number) * kDeformNodeQuads;
    uvec4 node = deformNodes[at];
    uint vertex = node.w;
    uvec4 facts = deformNodes[at + 2u];
    uvec4 lengths = deformNodes[at + 9u];
    uint materialAt = item.object + 4u + (facts.x & 7u) * 2u;
    float shrink = uintBitsToFloat(deformObjects[materialAt].z);
    float drag = uintBitsToFloat(deformObjects[materialAt + 1u].w);
    float scale = uintBitsToFloat(facts2.z);
    vec3 up = upHere(facts2);

    uint own = (softBase + vertex) * kSoftQuads;
    uvec4 self = soft[own + item.parity], bent = soft[own + 2u];
    vec3 x = uintBitsToFloat(self.xyz), normal = bentNormal(bent.x);
    vec2 reachBurnt = unpackHalf2x16(self.w);
    float burnt = reachBurnt.y, charred = charredShare(burnt);
    bool pinned = reachBurnt.x == 0.0;

    vec3 links = vec3(0.0);
    vec3 bending = nearBend(bent) + farBend(bent);
    float reach = kReachNone;
    FW_UNROLL for (uint k = 0u; k < kDeformRing; ++k) {
        uint other = deformNodes[at + 7u + k / 4u][k & 3u];
        vec2 pair = unpackHalf2x16(lengths[k / 2u]);
        float rest = (k & 1u) == 0u ? pair.x : pair.y;
        bool holds = (bent.x >> k & 1u) != 0u, farHolds = (bent.x >> (k + 8u) & 1u) != 0u;
        uint theirs = (softBase + other) * kSoftQuads;
        uvec4 there = soft[theirs + item.parity], otherBent = soft[theirs + 2u];
        vec2 otherFacts = unpackHalf2x16(there.w);
        float wanted = rest * (1.0 - shrink * 0.5 * (charred + charredShare(otherFacts.y)));
        vec3 p = linkPush(x, uintBitsToFloat(there.xyz), wanted, otherFacts.x == 0.0 ? 1.0 : 0.5);
        links += holds ? p : vec3(0.0);
        bending -= holds ? nearBend(otherBent) * bendShare(otherBent) : vec3(0.0);
        reach = holds ? min(reach, otherFacts.x + rest) : reach;
        uint farther = farHolds ? deformNodes[at + 10u + k / 4u][k & 3u] : vertex;
        otherBent = soft[(softBase + farther) * kSoftQuads + 2u];
        bending -= farHolds ? farBend(otherBent) * bendShare(otherBent) : vec3(0.0);
    }
    uint shownAt = (bases.x + vertex) * kShownQuads;
    vec3 last = shown[shownAt].xyz;
    vec3 moved = x + links * relaxAt(kLinkRelax, push.step) +
                 bending * (relaxAt(1.0, push.step) / kBendUnit);
    // No farther from the nearest pin than its way there over links that hold.
    if (reach < 0.5 * kReachNone) {
        vec3 anchor = vec3(0.0);
        float nearest = 1e30, radius = 0.0;
        for (uint i = 0u; i < bases.w; ++i) {
            vec4 from = uintBitsToFloat(deformObjects[item.object + 20u + i * 2u]);
            vec4 to = uintBitsToFloat(deformObjects[item.object + 21u + i * 2u]);
            vec3 point = pinPoint(moved, from.xyz, to.xyz);
            float d = length(moved - point);
            if (d < nearest) {
                nearest = d;
                anchor = point;
                radius = from.w;
            }
        }
        float most = reach + radius;
        if (nearest < 1e29 && nearest > most) moved = anchor + (moved - anchor) * (most / nearest);
    }
    float ground = uintBitsToFloat(facts2.x);
    float height = heightHere(facts2, moved);
    bool down = height < ground;
    if (down) moved += up * ((ground - height) / scale);

    vec3 velocity = noFasterThan((moved - last) / push.step, kFastest / scale);
    velocity *= down ? 0.5 : sheetDamping(charred, push.step);
    // The air goes with the wind, in gusts, and rises where it burns.
    float phase = dot(x, vec3(3.1, 2.3, 2.7)) * scale;
    float time = push.wind.w;
    float gust = 0.7 + 0.3 * sin(2.3 * time + phase) + 0.25 * sin(5.9 * time - 1.7 * phase);
    vec3 air = toObject(facts2, push.wind.xyz) * gust / scale;
    air += up * (1.2 / scale) * smoothstep(0.02, 0.2, burnt) * (1.0 - smoothstep(0.7, 1.0, burnt));
    float slowed = 1.0 - exp(-drag * (1.0 + 2.0 * charred) * push.step);
    velocity += normal * (dot(normal, air - velocity) * slowed);
    velocity -= up * (9.81 / scale * push.step);

    vec3 next = moved + velocity * push.step;
    if (pinned) {
        moved = next = uintBitsToFloat(node.xyz);
        reach = 0.0;
    }
    shown[shownAt] = vec4(moved, 0.0);
    soft[own + (item.parity ^ 1u)] =
        uvec4(floatBitsToUint(next), packHalf2x16(vec2(min(reach, kReachNone), burnt)));
}
