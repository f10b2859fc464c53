// Buffers of the deformation passes, by words of four. As lib/buffers.glsl: a shader defines
// FW_USE_<NAME>. What is read per node is a texel buffer with FW_TEXELS: a software device reads a
// texel faster than four words of a storage buffer. It writes words faster than texels.
// Nodes, coats and what moves lie quad by quad, the first of all nodes of the mesh or object, then
// the second: nodes that are read one after another are near each other, and what a pass does not
// read costs it nothing.
#ifndef FW_LIB_DEFORM_BUFFERS_GLSL
#define FW_LIB_DEFORM_BUFFERS_GLSL
#include "lib/buffers.glsl"
#include "shared/deform.h"

#ifdef FW_TEXELS
#define FW_QUADS(number, block, name) \
    layout(rgba32ui, set = 0, binding = FW_BIND_COUNT + number) readonly uniform uimageBuffer name
#define FW_QUAD(name, at) imageLoad(name, int(at))
// Between a read and a write of the same quad, which are two resources.
void readBeforeWritten() { memoryBarrier(); }
#else
#define FW_QUADS(number, block, name) FW_BUFFER(number, FW_READ_WRITE, block, uvec4, name)
#define FW_QUAD(name, at) name[at]
#define shownOut shownQuads
#define softOut softQuads
void readBeforeWritten() {}
#endif

FW_BUFFER(FW_BIND_DEFORM_OBJECTS, readonly, DeformObjectsBuffer, uvec4, deformObjects);
FW_BUFFER(FW_BIND_DEFORM_GROUPS, readonly, DeformGroupsBuffer, uvec2, deformGroups);
#ifdef FW_USE_DEFORM_NODES
FW_QUADS(FW_BIND_DEFORM_NODES, DeformNodesBuffer, nodeQuads);
uvec4 deformNode(uint quad) { return FW_QUAD(nodeQuads, quad); }
// Loops over a node's links ask at their end; every node of a run takes as many turns, so on devices
// that run several as one none leaves before the others.
uint nodeTurns(uint flags) { return flags >> kNodeTurnsShift & 7u; }
uint nodeArms(uint flags) { return (flags & kNodeHasArms) != 0u ? 1u : 0u; }  // so many turns more
#endif
#ifdef FW_USE_DEFORM_COATS
FW_QUADS(FW_BIND_DEFORM_COATS, DeformCoatsBuffer, coatQuads);
uvec4 deformCoat(uint quad) { return FW_QUAD(coatQuads, quad); }
#endif
#ifdef FW_USE_SHOWN
FW_QUADS(FW_BIND_SHOWN, ShownBuffer, shownQuads);
#ifdef FW_TEXELS
FW_BUFFER(FW_BIND_SHOWN, writeonly, ShownOutBuffer, uvec4, shownOut);
#endif
vec4 shown(uint quad) { return uintBitsToFloat(FW_QUAD(shownQuads, quad)); }
#endif
#ifdef FW_USE_SHOWN_WORDS
FW_BUFFER(FW_BIND_SHOWN, writeonly, ShownWordsBuffer, uint, shownWords);
#endif

#ifdef FW_USE_SOFT
// Per node: two places, each with its facts; what neighbours see of bend.comp's result, the
// place and a share; what is the node's own of it: normal and links that hold (near, arms << 8),
// neighbours' charred shares, way to a pin and which of them are pinned, a share for arms' ends.
FW_QUADS(FW_BIND_SOFT, SoftBuffer, softQuads);
#ifdef FW_TEXELS
FW_BUFFER(FW_BIND_SOFT, writeonly, SoftOutBuffer, uvec4, softOut);
#endif
uvec4 soft(uint quad) { return FW_QUAD(softQuads, quad); }
const uint kSoftSeen = 2u, kSoftOwn = 3u;

const float kCharredSteps = 15.0;  // in which neighbours know of it
// Way to a pin, burnt share (8 bits), charred share (4 bits) and whether it is pinned.
uint packFacts(float reach, float burnt) {
    return (packHalf2x16(vec2(reach, 0.0)) & 0xFFFFu) | uint(burnt * 255.0) << 16u |
           uint(charredShare(burnt) * kCharredSteps + 0.5) << 24u | (reach == 0.0 ? 1u << 28u : 0u);
}
float reachOf(uint facts) { return unpackHalf2x16(facts & 0x7FFFu).x; }
const uint kReachKnown = 0x8000u;  // beside it: it once was what it had been
float burntOf(uint facts) { return float(facts >> 16u & 255u) * (1.0 / 255.0); }
uint charredOf(uint facts) { return facts >> 24u & 15u; }
uint pinnedOf(uint facts) { return facts >> 28u; }

uint packBent(vec3 n, uint links) {
    n /= abs(n.x) + abs(n.y) + abs(n.z);
    vec2 o = n.z >= 0.0 ? n.xy : (1.0 - abs(n.yx)) * vec2(n.x >= 0.0 ? 1.0 : -1.0, n.y >= 0.0 ? 1.0 : -1.0);
    return (packSnorm4x8(vec4(o, 0.0, 0.0)) << 16u) | links;
}
vec3 bentNormal(uint packed) {
    vec2 o = unpackSnorm4x8(packed >> 16u).xy;
    vec3 n = vec3(o, 1.0 - abs(o.x) - abs(o.y));
    if (n.z < 0.0) n.xy = (1.0 - abs(n.yx)) * vec2(n.x >= 0.0 ? 1.0 : -1.0, n.y >= 0.0 ? 1.0 : -1.0);
    return normalize(n);
}
// Every neighbour's share of what the node gives way by, which is that often what a share is: who
// bends has all of them. Halfs, shortened to 11, 11 and 10 bits: all see the same.
uint packShare(vec3 share) {
    uvec3 h = uvec3(packHalf2x16(share.xy), 0u, packHalf2x16(vec2(share.z, 0.0)) & 0xFFFFu);
    h = uvec3(h.x & 0xFFFFu, h.x >> 16u, h.z) + uvec3(16u, 16u, 32u);
    return h.x >> 5u | (h.y >> 5u) << 11u | (h.z >> 6u) << 22u;
}
vec3 shareOf(uint packed) {
    return vec3(unpackHalf2x16((packed & 0x7FFu) << 5u | (packed & 0x3FF800u) << 10u),
                unpackHalf2x16(packed >> 22u << 6u).x);
}
float nearCount(uint links) { return float(bitCount(links & 0xFFu)); }
#endif

layout(push_constant) uniform DeformPushBlock { DeformPush push; };

// One thread's object and items, every 64th: nodes or vertices. Several, as what is an object's is
// read once for all of them. Loops over them ask at their end: where software runs several threads
// as one, a loop that asks at its start goes through its text once more with nobody in it.
struct DeformItem {
    uint object;  // quad of its DeformObject
    uint number;
    uint end;     // of the group; there may be fewer
    uint parity;  // of the places that are read
    bool reset;
    bool crosses;
};
DeformItem deformItem() {
    uvec2 group = deformGroups[push.first + gl_WorkGroupID.x];
    DeformItem item;
    item.object = group.x * kDeformObjectQuads;
    item.number = (group.y & kDeformItem) + gl_LocalInvocationID.x;
    item.end = (group.y & kDeformItem) + kDeformGroup;
    item.parity = ((group.y & kDeformOdd) != 0u ? 1u : 0u) ^ (push.parity & 1u);
    item.reset = (group.y & kDeformReset) != 0u;
    item.crosses = (group.y & kDeformCrosses) != 0u;
    return item;
}

#ifdef FW_USE_OBJECT_QUADS
// The world in object axes. `facts`: the third quad of the DeformObject, which says whose rows.
vec3 rowOf(uvec4 facts, uint row) { return uintBitsToFloat(objectQuads[facts.y * 10u + 5u + row].xyz); }
vec3 toObject(uvec4 facts, vec3 v) {  // a direction, its length kept
    return (rowOf(facts, 0u) * v.x + rowOf(facts, 1u) * v.y + rowOf(facts, 2u) * v.z) /
           uintBitsToFloat(facts.z);
}
vec3 upHere(uvec4 facts) { return toObject(facts, push.up.xyz); }
vec4 heightHere(uvec4 facts) {  // m, world, along up: of (place, 1)
    vec4 h = vec4(0.0);
    FW_UNROLL for (uint row = 0u; row < 3u; ++row)
        h += push.up[row] * uintBitsToFloat(objectQuads[facts.y * 10u + 5u + row]);
    return h;
}
#endif
#endif
