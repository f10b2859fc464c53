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
// Per node: two places, each with a way to a pin and the share that neighbours have of how it bends
// (packShare); its ties; facts that neighbours see (packFacts), and two shares that the ends of its
// arms have; the nearest point of a pin, with its radius.
FW_QUADS(FW_BIND_SOFT, SoftBuffer, softQuads);
#ifdef FW_TEXELS
FW_BUFFER(FW_BIND_SOFT, writeonly, SoftOutBuffer, uvec4, softOut);
#endif
uvec4 soft(uint quad) { return FW_QUAD(softQuads, quad); }
const uint kSoftTies = 2u, kSoftSeen = 3u, kSoftAnchor = 4u;
uvec3 softPlace(vec3 place, uint way) {
    uvec3 p = floatBitsToUint(place);
    return uvec3(packPlace(p.x, way, kWayLow), packPlace(p.y, way >> 5u, kWayLow),
                 packPlace(p.z, way >> 10u, kWayHigh));
}
vec3 placeOf(uvec4 quad) { return uintBitsToFloat(quad.xyz & ~uvec3(kWayLow, kWayLow, kWayHigh)); }
uint wayBits(uvec4 quad) {
    return (quad.x & kWayLow) | (quad.y & kWayLow) << 5u | (quad.z & kWayHigh) << 10u;
}
// The ties' first word: links that hold, below bit 8; neighbours that are pinned, below 16; arms that
// hold, two for each way, below 24. Then charred shares, of neighbours and of arms' ends; own facts.
const uint kTiesPinned = 8u, kTiesArms = 16u, kTiesWhole = 0x1000000u;  // no neighbour has parted
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
    bool woke;
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
    item.woke = (group.y & kDeformWoke) != 0u;
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
