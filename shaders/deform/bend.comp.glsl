// How each node of a sheet lies among its neighbours: its normal, and what bending and curling ask of
// it. Half a step: soft.comp does the other. kDeformGroup nodes of one object a group.
#version 450
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#define FW_USE_OBJECT_QUADS
#define FW_USE_DEFORM_NODES
#define FW_USE_SOFT
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
        uint at = sizes.x * kDeformNodeQuads + number;
        uvec4 facts = deformNode(at);
        uint own = softBase * kSoftQuads + number, places = own - number + item.parity * sizes.y;
        uvec4 self = soft(places + number);
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

        vec3 turned = vec3(0.0), before = vec3(0.0), first = vec3(0.0), sum = vec3(0.0), nearSum = vec3(0.0);
        vec2 squares = vec2(0.0), nearSquares = vec2(0.0);  // of rest lengths, and how many
        float rise = 0.0, across = 0.0;  // of arms
        uint charreds = 0u, masks = 0u, links = 0u, way = push.parity >> 1u;
        uint turn = 0u, turns = nodeTurns(facts.y), all = turns + nodeArms(facts.y);
        do {  // the neighbours, and arms at last
            bool arms = turn == turns;
            uvec4 two = deformNode(at + (arms ? kNodeArms + way : kNodeNear + turn) * sizes.y);
            nearSum = arms ? sum : nearSum;
            nearSquares = arms ? squares : nearSquares;
            sum = arms ? vec3(0.0) : sum;
            squares = arms ? vec2(0.0) : squares;
            rise = uintBitsToFloat(two.w);
            float ends[2];
            FW_UNROLL for (uint i = 0u; i < kDeformLinks; ++i) {
                uint k = (arms ? 8u : turn * kDeformLinks) + i, other = two[i];
                float rest = unpackHalf2x16(two.z)[i];
                uvec4 there = soft(places + (other & kDeformNode));
                vec3 arm = uintBitsToFloat(there.xyz) - x;
                bool holds = rest > 0.0 && linkHolds(burnt, burntOf(there.w), other >> 24u) &&
                             (!arms || dot(arm, arm) <= kArmTears * kArmTears * rest * rest);
                links |= holds ? 1u << k : 0u;
                sum += holds ? arm : vec3(0.0);
                squares += holds ? vec2(rest * rest, 1.0) : vec2(0.0);
                ends[i] = float(charredOf(there.w)) / kCharredSteps;
                if (arms) continue;
                charreds |= charredOf(there.w) << (4u * k);
                masks |= pinnedOf(there.w) << (24u + k);
                reach = holds ? min(reach, reachOf(there.w) + rest) : reach;
                turned += cross(before, arm);
                if (k == 0u) first = arm;
                before = arm;
            }
            across = armCurl(ends[0], ends[1]);
        } while (++turn < all);
        bool reaches = all != turns;
        nearSum = reaches ? nearSum : sum;
        nearSquares = reaches ? nearSquares : squares;

        if ((facts.y & kNodeClosed) != 0u) turned += cross(before, first);
        float size = length(turned);
        vec3 normal = size > 1e-18 ? turned / size : up;
        curl *= curlSide(normal, up) * scale * charred;
        float count = nearSquares.y, mean = 1.0 / max(count, 1.0);
        bool whole = (facts.y & kNodeClosed) != 0u && count == float(facts.y >> kNodeRingShift & 15u);
        vec3 b = bendOf(nearSum * mean, normal,
                        uintBitsToFloat(facts.z) + curlRise(curl, nearSquares.x * mean), count,
                        stiff * kBendRelax, (facts.y & kNodeEven) != 0u);
        uint nearShare = packShare(whole ? b * (mean * kBendUnit) : vec3(0.0));
        b = bendOf(sum * 0.5, normal, rise + kArmCurls * across * curlRise(curl, squares.x * 0.5), 2.0,
                   armFirm(stiff, charred, across),
                   (facts.y & kNodeArmsEven << way) != 0u);
        uint armShare = packShare(reaches && squares.y == 2.0 ? b * (0.5 * kBendUnit) : vec3(0.0));
        softOut[own + kSoftSeen * sizes.y] = uvec4(self.xyz, nearShare);
        float was = reachOf(self.w), found = min(reach, kReachNone);
        uint knew = self.w & kReachKnown;
        reach = pinnedOf(self.w) != 0u ? 0.0 : reachNext(found, was, knew != 0u);
        uint known = (packHalf2x16(vec2(reach, 0.0)) & 0x7FFFu) |
                     (reachKnown(found, was) ? kReachKnown : knew);
        softOut[own + kSoftOwn * sizes.y] = uvec4(packBent(normal, links), charreds,
                                      known | (self.w & 0xFF0000u) | masks, armShare);
        number += 64u;
    } while (number < last);
}
