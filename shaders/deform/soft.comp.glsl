// One step of sheets: every node moves to where its links, its bending and its pins allow, and on
// with the speed that this gives it. kDeformGroup nodes of one object a group.
#version 450
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#define FW_USE_OBJECT_QUADS
#define FW_USE_DEFORM_NODES
#define FW_USE_SHOWN
#define FW_USE_SOFT
#include "lib/deform_buffers.glsl"

void main() {
    DeformItem item = deformItem();
    uvec2 sizes = deformObjects[item.object].xy;
    uvec4 bases = deformObjects[item.object + 1u];
    uvec4 facts2 = deformObjects[item.object + 2u];
    uint softBase = deformObjects[item.object + 3u].x;
    uvec4 material0 = deformObjects[item.object + 4u], more0 = deformObjects[item.object + 5u];
    float ground = uintBitsToFloat(facts2.x), scale = uintBitsToFloat(facts2.z);
    vec3 up = upHere(facts2), wind = toObject(facts2, push.wind.xyz) / scale;
    vec4 height = heightHere(facts2);

    uint last = min(item.end, sizes.y);
    uint number = item.number;
    if (number >= last) return;
    do {
        uint at = sizes.x * kDeformNodeQuads + number;
        uvec2 facts = deformNode(at).xy;
        uint vertex = facts.x;
        float shrink = uintBitsToFloat(material0.z), drag = uintBitsToFloat(more0.w);
        if ((facts.y & 7u) != 0u) {
            uint materialAt = item.object + 4u + (facts.y & 7u) * 2u;
            shrink = uintBitsToFloat(deformObjects[materialAt].z);
            drag = uintBitsToFloat(deformObjects[materialAt + 1u].w);
        }

        uint own = softBase * kSoftQuads + number;
        uint seenAt = own - number + kSoftSeen * sizes.y, ownAt = seenAt + sizes.y;
        uvec4 seen = soft(seenAt + number), bent = soft(ownAt + number);
        vec3 x = uintBitsToFloat(seen.xyz), normal = bentNormal(bent.x);
        float burnt = burntOf(bent.z), reach = reachOf(bent.z), charred = charredShare(burnt);
        bool pinned = reach == 0.0;
        // Both ends of a link agree on its length.
        float shrunk = shrink * 0.5 / kCharredSteps, mine = floor(charred * kCharredSteps + 0.5);

        vec3 links = vec3(0.0);
        vec3 bending = shareOf(seen.w) * nearCount(bent.x) + shareOf(bent.w) * 2.0;
        uint turn = 0u, turns = nodeTurns(facts.y), all = turns + nodeArms(facts.y);
        do {  // the neighbours, and arms at last
            bool arms = turn == turns;
            uvec4 two = deformNode(at + (arms ? kNodeArms + (push.parity >> 1u) : kNodeNear + turn) * sizes.y);
            FW_UNROLL for (uint i = 0u; i < kDeformLinks; ++i) {
                uint k = (arms ? 8u : turn * kDeformLinks) + i;
                bool holds = (bent.x >> k & 1u) != 0u;
                uvec4 there = soft((arms ? ownAt : seenAt) + (two[i] & kDeformNode));
                bending -= holds ? shareOf(there.w) : vec3(0.0);
                if (arms) continue;
                float theirs = float(bent.y >> (4u * k) & 15u);
                float wanted = unpackHalf2x16(two.z)[i] * (1.0 - shrunk * (mine + theirs));
                vec3 p = linkPush(x, uintBitsToFloat(there.xyz), wanted,
                                  (bent.z >> (24u + k) & 1u) != 0u ? 1.0 : 0.5);
                links += holds ? p : vec3(0.0);
            }
        } while (++turn < all);
        uint shownAt = (bases.x + vertex) * kShownQuads;
        vec3 before = shown(shownAt).xyz;
        vec3 moved = x + links * relaxAt(kLinkRelax, push.step) +
                     bending * (relaxAt(1.0, push.step) / kBendUnit);
        // No farther from the nearest pin than its way there over links that hold.
        if (reach < 0.5 * kReachNone) {
            vec3 anchor = vec3(0.0);
            float nearest = 1e30, radius = 0.0;
            uint i = 0u;
            do {
                vec4 from = uintBitsToFloat(deformObjects[item.object + 20u + i * 2u]);
                vec4 to = uintBitsToFloat(deformObjects[item.object + 21u + i * 2u]);
                vec3 point = pinPoint(moved, from.xyz, to.xyz);
                float d = length(moved - point);
                if (d < nearest) {
                    nearest = d;
                    anchor = point;
                    radius = from.w;
                }
            } while (++i < bases.w);
            float most = reach * kReachSlack + radius;
            if (nearest > most) moved = anchor + (moved - anchor) * (most / nearest);
        }
        float above = dot(height.xyz, moved) + height.w - ground;
        bool down = above < 0.0;
        if (down) moved -= up * (above / scale);

        vec3 velocity = noFasterThan((moved - before) / push.step, kFastest / scale);
        velocity *= down ? 0.5 : sheetDamping(charred, push.step);
        vec3 air = wind * gustAt(x, scale, push.wind.w) + up * (updraftAt(burnt) / scale);
        float slowed = drag * (1.0 + 2.0 * charred) * push.step;
        velocity += normal * (dot(normal, air - velocity) * slowed / (1.0 + slowed));
        velocity -= up * (9.81 / scale * push.step);

        vec3 next = moved + velocity * push.step;
        if (pinned) moved = next = x;  // where it has been from the first
        readBeforeWritten();
        shownOut[shownAt] = floatBitsToUint(vec4(moved, 0.0));
        softOut[own + (item.parity ^ 1u) * sizes.y] =
            uvec4(floatBitsToUint(next), packFacts(reach, burnt) | (bent.z & kReachKnown));
        number += 64u;
    } while (number < last);
}
