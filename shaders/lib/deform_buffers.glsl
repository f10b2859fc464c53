// Buffers of the deformation passes, as quads of words. As in lib/buffers.glsl a shader defines
// FW_USE_<NAME>. With FW_TEXELS per-particle data is read through texel buffers: a software device
// reads a texel faster than four words of a storage buffer, and writes words faster than texels.
// Particles, embeddings and soft state lie quad by quad: first quad of all, then the second. So
// neighbouring reads are close, and unread quads cost nothing.
#ifndef FW_LIB_DEFORM_BUFFERS_GLSL
#define FW_LIB_DEFORM_BUFFERS_GLSL
#include "lib/buffers.glsl"
#include "shared/deform.h"

#ifdef FW_TEXELS
#define FW_QUADS(number, access, block, name) \
    layout(rgba32ui, set = 0, binding = FW_BIND_COUNT + number) readonly uniform uimageBuffer name
#define FW_QUAD(name, at) imageLoad(name, int(at))
// Orders a read and a write of the same quad, which are two resources.
void readBeforeWritten() { memoryBarrier(); }
#else
#define FW_QUADS(number, access, block, name) FW_BUFFER(number, access, block, uvec4, name)
#define FW_QUAD(name, at) name[at]
#define shownOut shownQuads
#define softOut softQuads
void readBeforeWritten() {}
#endif

FW_BUFFER(FW_BIND_DEFORM_OBJECTS, readonly, DeformObjectsBuffer, uvec4, deformObjects);
FW_BUFFER(FW_BIND_DEFORM_GROUPS, readonly, DeformGroupsBuffer, uvec2, deformGroups);
#ifdef FW_USE_DEFORM_PARTICLES
FW_QUADS(FW_BIND_DEFORM_PARTICLES, readonly, DeformParticlesBuffer, nodeQuads);
uvec4 deformNode(uint quad) { return FW_QUAD(nodeQuads, quad); }
// Loops over links test at their end. All particles of a run have the same number of passes, so no
// lane leaves early.
uint nodeTurns(uint flags) { return flags >> kParticlePassesShift & 7u; }
uint nodeArms(uint flags) { return (flags & kParticleHasBends) != 0u ? 1u : 0u; }  // 0 or 1 additional passes
#endif
#ifdef FW_USE_DEFORM_EMBEDDINGS
FW_QUADS(FW_BIND_DEFORM_EMBEDDINGS, readonly, DeformEmbeddingsBuffer, coatQuads);
uvec4 deformCoat(uint quad) { return FW_QUAD(coatQuads, quad); }
#endif
#ifdef FW_USE_SHOWN
FW_QUADS(FW_BIND_SHOWN, FW_READ_WRITE, ShownBuffer, shownQuads);
#ifdef FW_TEXELS
FW_BUFFER(FW_BIND_SHOWN, writeonly, ShownOutBuffer, uvec4, shownOut);
#endif
vec4 shown(uint quad) { return uintBitsToFloat(FW_QUAD(shownQuads, quad)); }
#endif
#ifdef FW_USE_SHOWN_WORDS
FW_BUFFER(FW_BIND_SHOWN, writeonly, ShownWordsBuffer, uint, shownWords);
#endif

#ifdef FW_USE_SOFT
// Per particle: two positions, each with the path length to a pin and a bend share (packBendShare); the
// link cache; facts for neighbours (packParticleFacts) and two bend shares for constraint ends; nearest pin
// point with its radius.
FW_QUADS(FW_BIND_SOFT, FW_READ_WRITE, SoftBuffer, softQuads);
#ifdef FW_TEXELS
FW_BUFFER(FW_BIND_SOFT, writeonly, SoftOutBuffer, uvec4, softOut);
#endif
uvec4 soft(uint quad) { return FW_QUAD(softQuads, quad); }
const uint kSoftLinkCache = 2u, kSoftFacts = 3u, kSoftAnchor = 4u;
uvec3 softPlace(vec3 place, uint way) {
    uvec3 p = floatBitsToUint(place);
    return uvec3(packPathBits(p.x, way, kPathLowMask), packPathBits(p.y, way >> 5u, kPathLowMask),
                 packPathBits(p.z, way >> 10u, kPathHighMask));
}
vec3 placeOf(uvec4 quad) { return uintBitsToFloat(quad.xyz & ~uvec3(kPathLowMask, kPathLowMask, kPathHighMask)); }
uint wayBits(uvec4 quad) {
    return (quad.x & kPathLowMask) | (quad.y & kPathLowMask) << 5u | (quad.z & kPathHighMask) << 10u;
}
// First word of the link cache: holding links, below bit 8; pinned neighbours, below 16; holding
// bending constraints, two per set, below 24. Then charred shares of neighbours and of constraint
// ends; own facts.
const uint kLinkCachePinned = 8u, kLinkCacheBends = 16u, kLinkCacheWhole = 0x1000000u;  // no neighbour has parted
#endif

layout(push_constant) uniform DeformPushBlock { DeformPush push; };

// Object and items of a thread, every 64th particle or vertex: object data is loaded once for
// several. Loops over items test at their end, since a software device runs a loop's body once more
// with no active lane.
struct DeformItem {
    uint object;  // quad of its DeformObject
    uint number;
    uint end;     // of the group; may be fewer
    uint parity;  // of the positions that are read
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
// World directions in object axes. facts: third quad of the DeformObject, which holds the object
// slot.
vec3 rowOf(uvec4 facts, uint row) { return uintBitsToFloat(objectQuads[facts.y * 10u + 5u + row].xyz); }
vec3 toObject(uvec4 facts, vec3 v) {  // a direction, its length kept
    return (rowOf(facts, 0u) * v.x + rowOf(facts, 1u) * v.y + rowOf(facts, 2u) * v.z) / uintBitsToFloat(facts.z);
}
vec3 upHere(uvec4 facts) { return toObject(facts, push.up.xyz); }
vec4 heightHere(uvec4 facts) {  // m, world, along up: dot with (position, 1)
    vec4 h = vec4(0.0);
    FW_UNROLL for (uint row = 0u; row < 3u; ++row)
        h += push.up[row] * uintBitsToFloat(objectQuads[facts.y * 10u + 5u + row]);
    return h;
}
#endif
#endif
