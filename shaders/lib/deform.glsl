// Buffers and items of the deformation passes. With FW_TEXELS per-particle data is read through
// texel buffers: a software device reads a texel faster than four words of a storage buffer, and
// writes words faster than texels. Particles, embeddings and soft state lie quad by quad: first
// quad of all, then the second. So neighbouring reads are close, and unread quads cost nothing.
#include "lib/compute.glsl"
#include "shared/deform.h"

#ifdef FW_TEXELS
#define FW_QUADS(number, access, name) FW_TEXEL_BUFFER(number, readonly, name)
#define FW_OUT_QUADS(number, name) FW_BUFFER(number, writeonly, uvec4, name)
#define FW_QUAD(name, at) imageLoad(name, int(at))
// Orders a read and a write of the same quad, which are two resources.
void readBeforeWritten() { memoryBarrier(); }
#else
#define FW_QUADS(number, access, name) FW_BUFFER(number, access, uvec4, name)
#define FW_OUT_QUADS(number, name)
#define FW_QUAD(name, at) name[at]
#define shownOut shownQuads
#define softOut softQuads
void readBeforeWritten() {}
#endif
#define FW_BUFFER_DEFORM_PARTICLES(access) FW_QUADS(DEFORM_PARTICLES, access, particleQuads) \
    uvec4 deformParticle(uint quad) { return FW_QUAD(particleQuads, quad); }
#define FW_BUFFER_DEFORM_EMBEDDINGS(access) FW_QUADS(DEFORM_EMBEDDINGS, access, embeddingQuads) \
    uvec4 deformEmbedding(uint quad) { return FW_QUAD(embeddingQuads, quad); }
#define FW_BUFFER_SHOWN(access) FW_QUADS(SHOWN, access, shownQuads) FW_OUT_QUADS(SHOWN, shownOut) \
    vec4 shown(uint quad) { return uintBitsToFloat(FW_QUAD(shownQuads, quad)); }
// Per particle: two positions, each with the path length to a pin and a bend share (packBendShare);
// the link cache; facts for neighbours (packParticleFacts) and two bend shares for constraint ends;
// nearest pin point with its radius.
#define FW_BUFFER_SOFT(access) FW_QUADS(SOFT, access, softQuads) FW_OUT_QUADS(SOFT, softOut) \
    uvec4 soft(uint quad) { return FW_QUAD(softQuads, quad); }
const uint kSoftLinkCache = 2u, kSoftFacts = 3u, kSoftAnchor = 4u;

FW_BUFFER(DEFORM_OBJECTS, readonly, uvec4, deformObjects)
FW_BUFFER(DEFORM_GROUPS, readonly, uvec2, deformGroups)
FW_PUSH(DeformPush)

// Loops over links test at their end. All particles of a run have the same number of passes, so no
// lane leaves early.
uint linkPasses(uint flags) { return flags >> kParticlePassesShift & 7u; }
uint bendPasses(uint flags) { return (flags & kParticleHasBends) != 0u ? 1u : 0u; }

uvec3 softPlace(vec3 place, uint path) {
    uvec3 p = floatBitsToUint(place);
    return uvec3(packPathBits(p.x, path, kPathLowMask), packPathBits(p.y, path >> 5u, kPathLowMask),
                 packPathBits(p.z, path >> 10u, kPathHighMask));
}
vec3 placeOf(uvec4 quad) {
    return uintBitsToFloat(quad.xyz & ~uvec3(kPathLowMask, kPathLowMask, kPathHighMask));
}
uint pathBits(uvec4 quad) {
    return (quad.x & kPathLowMask) | (quad.y & kPathLowMask) << 5u |
           (quad.z & kPathHighMask) << 10u;
}
// First word of the link cache: holding links, below bit 8; pinned neighbours, below 16; holding
// bending constraints, two per set, below 24. Then charred shares of neighbours and of constraint
// ends; own facts.
const uint kLinkCachePinned = 8u, kLinkCacheBends = 16u;
const uint kLinkCacheWhole = 0x1000000u;  // no neighbour has parted

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
