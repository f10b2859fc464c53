// How each node of a sheet lies among its neighbours: its normal, and what bending and curling ask of
// it. Half a step: soft.comp does the other. kDeformGroup nodes of one object a group.
#version 450
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#define FW_USE_OBJECT_QUADS
#define FW_USE_DEFORM_NODES
#define FW_USE_SOFT FW_READ_WRITE
#include "lib/deform_buffers.glsl"

void main() {
    DeformItem item = deformItem();
    uvec2 sizes = deformObjects[item.object].xy;
    uvec4 facts2 = deformObjects[item.object + 2u];
    uint softBase = deformObjects[item.object + 3u].x;
    uvec4 material0 = deformObjects[item.object + 4u], more0 = deformObjects[item.object + 5u];
    vec3 up = upHere(facts2);
    float scale = uintBitsToFloat(facts2.z);

    uint last = min(item.end, sizes.y);
    uint number = item.number;
    if (number >= last) return;
    do {
        uint at = (sizes.x + number) * kDeformNodeQuads;
        uvec4 facts = deformNodes[at];
        uint own = (softBase + number) * kSoftQuads;
        uvec4 self = soft[own + item.parity];
        vec3 x = uintBitsToFloat(self.xyz);
        float burnt = burntOf(self.w), reach = kReachNone, charred = charredShare(burnt);
        float curl = uintBitsToFloat(material0.w), bend = uintBitsToFloat(more0.z);
        if ((facts.y & 7u) != 0u) {
            uint materialAt = item.object + 4u + (facts.y & 7u) * 2u;
            curl = uintBitsToFloat(deformObjects[materialAt].w);
            bend = uintBitsToFloat(deformObjects[materialAt + 1u].z);
        }
        // Charring stiffens what held its shape only loosely.
        float stiff = mix(bend, max(bend, 0.9), charred);

        vec3 turned = vec3(0.0), before = vec3(0.0), first = vec3(0.0), normal = up;
        uint charreds = 0u, masks = 0u, links = 0u, share = 0u, nearShare = 0u;
        uint far = 0u, turns = (facts.y & kNodeFarHeard) != 0u ? 2u : 1u;
        do {  // the neighbours, then those two steps away
            uint ringAt = at + 1u + 4u * far;
            uvec4 ring[2] = uvec4[2](deformNodes[ringAt], deformNodes[ringAt + 1u]);
            uvec4 lengths = deformNodes[ringAt + 2u];
            vec3 sum = vec3(0.0);
            float squares = 0.0, count = 0.0;
            FW_UNROLL for (uint k = 0u; k < kDeformRing; ++k) {
                vec2 pair = unpackHalf2x16(lengths[k / 2u]);
                float rest = (k & 1u) == 0u ? pair.x : pair.y;
                uint other = ring[k / 4u][k & 3u];
                uvec4 there = soft[(softBase + (other & kDeformNode)) * kSoftQuads + item.parity];
                vec3 arm = uintBitsToFloat(there.xyz) - x;
                bool holds = rest > 0.0 && linkHolds(burnt, burntOf(there.w), other >> 24u) &&
                             (far == 0u || dot(arm, arm) <= 1.69 * rest * rest);
                links |= holds ? 1u << (k + 8u * far) : 0u;
                sum += holds ? arm : vec3(0.0);
                squares += holds ? rest * rest : 0.0;
                count += holds ? 1.0 : 0.0;
                if (far != 0u) continue;
                charreds |= charredOf(there.w) << (4u * k);
                masks |= pinnedOf(there.w) << (24u + k);
                reach = holds ? min(reach, reachOf(there.w) + rest) : reach;
                turned += cross(before, arm);
                if (k == 0u) first = arm;
                before = arm;
            }
            if (far == 0u) {
                if ((facts.y & kNodeClosed) != 0u) turned += cross(before, first);
                float size = length(turned);
                normal = size > 1e-18 ? turned / size : up;
                curl *= curlSide(normal, up) * scale * charred;
            }
            float mean = 1.0 / max(count, 1.0);
            float rise = (far == 0u ? 1.0 : 4.0) * uintBitsToFloat(facts.z) +
                         curlRise(curl, squares * mean);
            bool even = (facts.y & (far == 0u ? kNodeEven : kNodeFarEven)) != 0u;
            bool whole = (facts.y & kNodeClosed) != 0u && (even || far == 0u) &&
                         count == float(facts.y >> kNodeRingShift & 15u);
            vec3 b = bendOf(sum * mean, normal, rise, count, stiff, even);
            nearShare = share;
            share = packShare(whole ? b * (mean * kBendUnit) : vec3(0.0));
        } while (++far < turns);
        // What the last turn found is the far one's, if there was one.
        uint farShare = turns == 2u ? share : 0u;
        nearShare = turns == 2u ? nearShare : share;
        soft[own + kSoftSeen] = uvec4(self.xyz, nearShare);
        if (pinnedOf(self.w) != 0u) reach = 0.0;
        uint known = packHalf2x16(vec2(min(reach, kReachNone), 0.0)) & 0xFFFFu;
        soft[own + kSoftOwn] = uvec4(packBent(normal, links), charreds,
                                     known | (self.w & 0xFF0000u) | masks, farShare);
        number += 64u;
    } while (number < last);
}
