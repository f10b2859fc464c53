// Deformation of burning meshes: records of its buffers, and arithmetic for C++ and shaders.
// Cosmetic floats, derived from the authoritative burn state. A particle stands for all drawn
// vertices at one position; one of these vertices stores its state.
// clang-format off
#ifndef FW_SHARED_DEFORM_H
#define FW_SHARED_DEFORM_H
#include "shared/burn.h"
#include "shared/types.h"

#ifdef __cplusplus
#include <glm/gtc/packing.hpp>
#endif

FW_SHARED_BEGIN

FW_CONST uint kDeformTexels = 16u;     // texels sampled in a particle's ring: k of eq. (9)
FW_CONST uint kDeformRing = 8u;        // neighbours of a particle
FW_CONST uint kLinksPerPass = 2u;       // links read at a time
FW_CONST uint kDeformLinkPasses = 4u;       // passes over the links: kDeformRing in all
// Bending sets: two directions, long and short; each step uses one.
FW_CONST uint kBendSets = 4u;
FW_CONST uint kDeformRun = 64u;        // particles that need the same number of link passes
// Quads of a DeviceParticle; offsets of its parts:
FW_CONST uint kDeformParticleQuads = 16u;
FW_CONST uint kParticleLinks = 1u;          // neighbours, one quad per pass
FW_CONST uint kParticleBends = 5u;          // bending constraints, one quad per set
FW_CONST uint kParticleRest = 9u;
FW_CONST uint kParticleTexels = 10u;
FW_CONST uint kParticleRecession = 14u;
FW_CONST uint kDeformEmbeddingQuads = 4u;
// Quads of a DeformObject: materials from 4, pins from 20.
FW_CONST uint kDeformObjectQuads = 36u;
FW_CONST uint kShownQuads = 3u;        // of a ShownVertex
FW_CONST uint kMaxPins = 8u;
FW_CONST uint kDeformGroup = 512u;     // particles or vertices of a workgroup: 8 per thread
// Flags in the second word of a group, above the first particle or vertex.
FW_CONST uint kDeformReset = 0x80000000u;  // start from the rest pose
FW_CONST uint kDeformOdd = 0x40000000u;    // reads the second positions
FW_CONST uint kDeformCrosses = 0x20000000u; // walls may cross and open
FW_CONST uint kDeformWoke = 0x10000000u;   // it did not move in the frame before
FW_CONST uint kDeformItem = 0x0FFFFFFFu;
FW_CONST uint kDeformLinkIndex = 0xFFFFFFu; // particle index of a link
FW_CONST uint kSoftQuads = 5u;         // quads per particle: see lib/deform.glsl
FW_CONST uint kSoftTicks = 32u;        // ticks of a step: 1/128 s
FW_CONST uint kMaxSoftSteps = 6u;     // steps of a frame; a longer frame drops the rest

// DeformObject::flags
FW_CONST uint kDeformRecede = 1u;      // tier A: recedes along its offset, no forces
FW_CONST uint kDeformShell = 2u;       // tier B: a thin sheet
FW_CONST uint kDeformExtended = 4u;    // an extension's pass moves its particles

// DeformParticle::flags, above the material (bits 0..7)
FW_CONST uint kParticleClosed = 0x100u;    // its ring of neighbours closes
// At rest it lies in the middle of its neighbours, seen along the normal.
FW_CONST uint kParticleEven = 0x200u;
// And of its first bending set; << 1: of its second ...
FW_CONST uint kParticleBendsEven = 0x400u;
// It, or another particle of its run, has bending constraints.
FW_CONST uint kParticleHasBends = 0x4000u;
FW_CONST uint kParticleRingShift = 16u;    // number of neighbours: bits 16..19
FW_CONST uint kParticlePassesShift = 20u;   // link passes of its run: bits 20..22

struct DeformParticle {       // constant, per mesh
    uint vertex;                 // vertex that stores its state, from the mesh's first
    uint flags;                  // material, kParticle...
    float rise;                  // m from it to the mean of its neighbours, along the rest normal
    uint opposite;               // texel on the opposite wall, or kNoneTexel
    uint ring[8];                // vertices around it, in order
    uint ringLength[4];          // m, half floats
    float x; float y; float z;   // m, rest
    float area;                  // m^2, a third of its triangles
    uint texels[16];             // in its ring, in the burn map; padded with kNoneTexel
    // Direction of recession: -1 along every face's normal where possible.
    float outX; float outY; float outZ;
    float limit;                 // m, largest recession
    uint bendEnds[8];            // bending partners behind and ahead, per set; or kNoneTexel
    float bendLength[8];          // m
    float bendRise[4];            // m, as `rise`, of each pair
};
FW_SIZE(DeformParticle, 240)

struct DeviceLinks {      // one link pass
    uint first; uint second;     // particles; the link's odds (linkOdds) above bit 23
    uint lengths;                // m, half floats; 0: no link
    float rise;                  // m, of bending constraints
};
// A DeformParticle on the device: quad by quad, each for all particles of the mesh.
struct DeviceParticle {
    uint vertex; uint flags; float rise; uint opposite;
    DeviceLinks near_[4];
    DeviceLinks bends[4];
    float x; float y; float z; float area;
    uint texels[16];
    float outX; float outY; float outZ; float limit;
    uint reserved[4];
};
FW_SIZE(DeviceParticle, 256)

// Constant, per drawn vertex: how its normal follows; device: quad by quad.
struct DeformEmbedding {
    uint particle;            // vertex that stores its particle's state
    uint normal;          // at rest, signed 11:11:10
    uint reserved0; uint reserved1;
    // Chain of vertices around it, padded with the last: triangles that share the normal.
    uint ring[8];
    float faceX; float faceY; float faceZ;  // unit, their area-weighted normal at rest
    float longest;        // m^2 at rest, longest distance to a ring vertex
};
FW_SIZE(DeformEmbedding, 64)

struct ShownVertex {      // drawn instead of mesh::RenderVertex's position and normal
    float x; float y; float z;   // m, object space
    uint normal;                 // signed 11:11:10
    float burnt;                 // [0, 1], mean over the particle's texels; never falls
    // m, spring model: lost per step, and for later steps; kept of a solid: recession.
    float lost; float kept;
    float behind;                // s of appearance time for which the opposite wall has burnt
    float reserved[3];
    float burnThrough;  // s of appearance time: burn-through offset, holes come earlier by it
};
FW_SIZE(ShownVertex, 48)

struct DeformMaterial {   // one material on one object
    uint charTicks;       // from ignition to consumed (recession) or charred (sheets)
    float depth;          // m, recession when consumed
    float shrink;         // [0, 0.5] of lengths, when charred
    float curl;           // 1/m, when charred
    uint holeTicks;       // from ignition to a hole; kNoneTexel: never
    float holeSeconds;    // the same in appearance time
    float bend;           // [0, 1] stiffness against bending, before it chars
    float drag;           // 1/s, of the air across it
};
FW_SIZE(DeformMaterial, 32)

struct DeformObject {     // per object slot
    uint nodeBase;        // into the nodes
    uint particleCount;
    uint embeddingBase;        // into the embeddings
    uint vertexCount;
    uint shownBase;       // into the shown vertices
    uint stateBase;       // as BurnObject
    uint flags;           // kDeform...
    uint pinCount;
    float ground;         // m, world, along up: nothing falls below it; -1e9: no ground
    uint slot;            // of its BurnObject
    float scale;          // m in the world of 1 m
    uint extensionBase;   // quads, into the words of an extension
    uint softBase;        // into the state of the particles
    uint innerFirst;      // first of its vertices on the inner skin, in the vertices; see `wall`
    float wall;           // m, depth of the inner skin below the surface; 0: none
    float reserved0;
    DeformMaterial materials[8];
    vec4 pins[16];        // from xyz, radius; to xyz, 0: object space, m
};
FW_SIZE(DeformObject, 576)

struct DeformPush {       // push constants of the deformation passes
    uint now;             // tick of the displayed state
    uint first;           // group in the list
    uint parity;  // of the substep; above bit 0: bending set of the step; recede: number of steps
    float step;           // s
    vec4 wind;            // m/s, world; w: s, cosmetic time
    vec4 up;              // world; w: ticks since the step's start
};
FW_SIZE(DeformPush, 48)

struct SkinPush {         // push constants of the skin pass
    uint count;           // drawn vertices
    uint sourceBase;      // into the sources
    uint shownBase;       // into the shown vertices
    uint given;           // word of the host's first position
    uint stride;          // words
    uint normal;          // words from a position to its normal; kNoneTexel: none
    uint scaleX; uint scaleY; uint scaleZ; // float bits: the mesh's shape
    uint reserved0; uint reserved1; uint reserved2;
};
FW_SIZE(SkinPush, 48)

#ifdef __cplusplus
using glm::packHalf2x16;
using glm::unpackHalf2x16;
inline float inversesqrt(float x) { return 1.0f / std::sqrt(x); }
#endif

// Eq. (9) with areas: mip of a burn map in which about k texels cover a ring of `texels`.
FW_FN uint mipOfRing(uint texels, uint k) {
    uint mip = 0u;
    while (texels >= k * 4u) {
        texels /= 4u;
        ++mip;
    }
    return mip;
}

// Burnt share of a texel's fuel at tick `now` + `more`, if it caught at t.
FW_FN float burntShare(uint t, uint now, float more, uint charTicks) {
    if (!isSource(t) || now < t) return 0.0f;
    if (charTicks == kNoneTexel || charTicks == 0u) return 0.0f;
    return min((float(now - t) + more) / float(charTicks), 1.0f);
}

// Recession in m, limited so that neither walls nor neighbouring triangles cross.
FW_FN float recession(float burnt, float depth, float limit) { return min(burnt * depth, limit); }

// Least wall thickness, as a share, that a fully receded wall keeps above the inner skin.
FW_CONST float kThinnestWall = 0.15f;

// Rotates the rest normal `n` as its faces rotated from `a` to `b`; all unit.
FW_FN vec3 rotateNormal(vec3 n, vec3 a, vec3 b) {
    float c = dot(a, b);
    if (c > 0.9999995f) return n;
    if (c < -0.99f) return b;  // inverted: the shortest rotation is not defined
    vec3 sum = a + b;
    vec3 turned = n - sum * (dot(sum, n) / (1.0f + c)) + b * (2.0f * dot(a, n));
    return turned * inversesqrt(max(dot(turned, turned), 1e-20f));
}

// ---- sheets: position-based dynamics, Jacobi: each particle corrects itself by its neighbours'
// last state

FW_CONST float kNoPath = 60000.0f;  // m along unburnt links to a pin: no path known
// A known path to a pin that grew has either been replaced by another one, which the next steps
// find, or is gone and neighbours report it to each other in circles. It grows faster than such
// circles, so a falling piece is not held back and a held piece yields little.
FW_CONST float kPathGrowth = 1.03f;
FW_FN bool isPathKnown(float path, float before) { return path <= before * 1.004f; }
FW_FN float nextPath(float path, float before, bool known) {
    return min(known && !isPathKnown(path, before) ? path * kPathGrowth : path, kNoPath);
}
FW_CONST float kPathSlack = 1.001f;   // tolerance of half-float storage
FW_CONST float kBendUnit = 4096.0f;    // packed bends, per m
FW_CONST float kCharredSteps = 15.0f;  // resolution of the charred share that neighbours see
// The link cache is updated every kLinkCacheSteps steps: fire takes seconds.
FW_CONST uint kLinkCacheSteps = 4u;
FW_FN bool updatesLinkCache(uint step) { return step % kLinkCacheSteps == 0u; }
// Jacobi corrections: an alternating pattern is corrected by up to 4 times the first and twice 3.4
// times the second factor. With velocities this is stable below 4/3.
FW_CONST float kLinkRelax = 0.2f;
FW_CONST float kBendRelax = 0.08f;
FW_CONST float kSheetDamping = 0.01f;  // of the velocity, per 1/128 s
FW_CONST float kFastest = 12.0f;       // m/s
FW_CONST float kPinBurns = 0.6f;       // burnt share at which a pin lets go

// Threshold of 256 at which a link parts while both ends are consumed.
FW_FN uint linkOdds(uint a, uint b) {
    uint h = ((a ^ b) * 0x9E3779B1u) ^ ((a + b) * 0x85EBCA6Bu);
    return ((h ^ (h >> 15u)) * 0x2C1B3C6Du) >> 24u;
}
FW_FN bool linkHolds(float burntA, float burntB, uint odds) {
    return min(burntA, burntB) < 0.80f + 0.15f / 256.0f * float(odds);
}

// Shrink and curl progress. It reaches 1 before links part.
FW_FN float charredShare(float burnt) {
    float x = saturate(burnt * 1.8f);
    return x * x * (3.0f - 2.0f * x);
}

// State that neighbours read: burnt share (8 bits), charred share (4 bits), pinned (1 bit).
FW_FN uint packParticleFacts(float burnt, bool pinned) {
    return uint(burnt * 255.0f) | uint(charredShare(burnt) * kCharredSteps + 0.5f) << 8u |
           (pinned && burnt <= kPinBurns ? 1u << 12u : 0u);
}
FW_FN float burntOf(uint facts) { return float(facts & 255u) * (1.0f / 255.0f); }
FW_FN uint charredOf(uint facts) { return (facts >> 8u) & 15u; }
FW_FN uint pinnedOf(uint facts) { return (facts >> 12u) & 1u; }

// The path length to a pin is stored in the low bits of the position: an error of a millionth.
FW_CONST uint kPathKnown = 0x8000u;  // the path once had this length
FW_FN uint packPathLength(float path, bool known) {
    return (packHalf2x16(vec2(path, 0.0f)) & 0x7FFFu) | (known ? kPathKnown : 0u);
}
FW_FN float unpackPathLength(uint bits) { return unpackHalf2x16(bits & 0x7FFFu).x; }
FW_CONST uint kPathLowMask = 31u;   // mask of the bits in x and y
FW_CONST uint kPathHighMask = 63u;  // mask of the bits in z
FW_FN uint packPathBits(uint word, uint bits, uint mask) {
    return ((word + (mask + 1u) / 2u) & ~mask) | (bits & mask);
}

// Share of a bend correction for each neighbour, stored once per particle. Half floats, shortened
// to 11, 11 and 10 bits, so that all neighbours see the same value.
FW_FN uint packBendShare(vec3 share) {
    uint xy = packHalf2x16(vec2(share.x, share.y)), z = packHalf2x16(vec2(share.z, 0.0f));
    return (((xy & 0xFFFFu) + 16u) >> 5u) | (((xy >> 16u) + 16u) >> 5u) << 11u |
           (((z & 0xFFFFu) + 32u) >> 6u) << 22u;
}
FW_FN vec3 unpackBendShare(uint bits) {
    vec2 xy = unpackHalf2x16((bits & 0x7FFu) << 5u | (bits & 0x3FF800u) << 10u);
    return vec3(xy.x, xy.y, unpackHalf2x16((bits >> 22u) << 6u).x);
}

// Relaxation factor that gives the same stiffness for any step length.
FW_FN float relaxAt(float relax, float dt) {
    float steps = dt * 128.0f;
    return steps < 1.0f ? relax * steps * steps : relax;
}

// Velocity factor of one step; charred sheets are damped strongly.
FW_FN float sheetDamping(float charred, float dt) {
    return 1.0f - kSheetDamping * (1.0f + 5.0f * charred) * (dt * 128.0f);
}

// A burnt ring stretched beyond this square ratio has torn: no skin is left between its ends.
FW_CONST float kTornSquare = 2.6f;  // of squared rest lengths
FW_CONST float kTornOffset = 1000.0f; // s of appearance time
FW_FN float tornOffset(float square, float longest, float burnt) {
    return burnt > 0.5f && square > kTornSquare * longest ? kTornOffset : 0.0f;
}

// Air at a particle, in object units: wind with gusts, and updraft where it burns.
FW_CONST float kUpdraft = 1.2f;  // m/s
FW_FN float gustAt(vec3 x, float scale, float time) {
    float phase = dot(x, vec3(3.1f, 2.3f, 2.7f)) * scale;
    return 0.7f + 0.3f * sin(2.3f * time + phase) + 0.25f * sin(5.9f * time - 1.7f * phase);
}
FW_FN float updraftAt(float burnt) {
    float a = saturate((burnt - 0.02f) / 0.18f), b = saturate((burnt - 0.7f) / 0.3f);
    return kUpdraft * a * a * (3.0f - 2.0f * a) * (1.0f - b * b * (3.0f - 2.0f * b));
}

// Correction of x towards rest length from y. share: 1/2, or 1 if y is pinned.
FW_FN vec3 linkCorrection(vec3 x, vec3 y, float rest, float share) {
    vec3 d = y - x;
    float l = length(d);
    return d * (share * (l - rest) / max(l, 1e-9f));
}

// Curl direction along the normal: towards the side that flames lick, from below.
FW_FN float curlSide(vec3 normal, vec3 up) {
    return clamp(0.7f - 2.0f * dot(normal, up), -1.0f, 1.0f);
}

// ---- bending constraints Constraints between neighbours barely resist wide bends, so a fine mesh
// would hang like a rag. Each particle therefore has a partner at a fixed distance behind and one
// ahead, in two directions, whose middle is its target. Partners are mutual. Short sets damp the
// waves that long sets cannot see. A step uses one set. A particle whose constraints have parted
// has none.
FW_CONST float kBendSetRelax = 0.17f;
FW_CONST float kBendTears = 1.1f;  // stretch at which a constraint parts
FW_CONST float kBendCurl = 1.4f;  // relative to a ring of the same reach
// Curl acts across a burning edge, not along it, since a sheet cannot do both. Its strength follows
// from the charred shares behind and ahead. Material charred on both sides has no shape to keep.
FW_FN float bendCurl(float behind, float ahead) {
    float d = ahead - behind;
    return min(4.0f * d * d, 1.0f);
}
FW_FN float bendStiffness(float stiff, float charred, float across) {
    return kBendSetRelax * stiff * (1.0f - charred * (1.0f - across));
}

// Correction for the neighbours' mean to lie `rise` above the particle. An even particle takes all
// of it (the gradient of an energy); others take the part along the normal.
FW_FN vec3 bendOf(vec3 toMean, vec3 normal, float rise, float neighbours, float relax, bool even) {
    vec3 off = even ? toMean - normal * rise : normal * (dot(toMean, normal) - rise);
    off *= relax * neighbours / (neighbours + 1.0f);
    float square = dot(off, off);
    return square > 1e-4f ? off * (1e-2f * inversesqrt(square)) : off;
}

// Rise of the neighbours' mean caused by a curl, in m; `square`: mean of the squared distances.
// Limited so that neighbours do not fold onto each other.
FW_FN float curlRise(float curl, float square) {
    float rise = 0.25f * curl * square, most = 0.3f * square * inversesqrt(max(square, 1e-20f));
    return clamp(rise, -most, most);
}

FW_FN vec3 limitSpeed(vec3 v, float most) {
    float square = dot(v, v);
    return square > most * most ? v * (most * inversesqrt(square)) : v;
}

// Nearest point on a pin's segment.
FW_FN vec3 pinPoint(vec3 x, vec3 from, vec3 to) {
    vec3 d = to - from;
    return from + d * saturate(dot(x - from, d) / max(dot(d, d), 1e-12f));
}

FW_FN uint packDirection(vec3 n) {  // signed 11:11:10
    int x = int(floor(n.x * 1023.0f + 0.5f)), y = int(floor(n.y * 1023.0f + 0.5f));
    int z = int(floor(n.z * 511.0f + 0.5f));
    return (uint(x) & 0x7FFu) | ((uint(y) & 0x7FFu) << 11u) | ((uint(z) & 0x3FFu) << 22u);
}
FW_FN vec3 unpackDirection(uint packed) {
    int n = int(packed);
    vec3 v = vec3(float((n << 21) >> 21), float((n << 10) >> 21), float(n >> 22) * 2.0f);
    return v * inversesqrt(max(dot(v, v), 1e-20f));
}

FW_SHARED_END
#endif
