// Deformation of burning meshes: records of its planes, and the maths that C++ and shaders share.
// Cosmetic floats, derived from the authoritative burn state. A *node* is a point of the drawn
// mesh with all vertices that lie on it; its state is kept with one of them.
// GLSL too, and laid out by hand.
// clang-format off
#ifndef FW_SHARED_DEFORM_H
#define FW_SHARED_DEFORM_H
#include "shared/burn.h"

#ifdef __cplusplus
#include <cmath>
#include <glm/gtc/packing.hpp>
#endif

FW_SHARED_BEGIN

FW_SHARED_CONST uint kDeformTexels = 16u;     // of a node's ring that it samples, as eq. (9)'s k
FW_SHARED_CONST uint kDeformRing = 8u;        // neighbours of a node
FW_SHARED_CONST uint kDeformLinks = 2u;       // of a node that are read at a time
FW_SHARED_CONST uint kDeformTurns = 4u;       // so often: kDeformRing of them
FW_SHARED_CONST uint kArmWays = 4u;           // two directions, far and less far; a step minds one
FW_SHARED_CONST uint kDeformRun = 64u;        // nodes that take as many turns as each other
FW_SHARED_CONST uint kDeformNodeQuads = 20u;  // of a DeviceNode; in it, from the first:
FW_SHARED_CONST uint kNodeNear = 1u;          // neighbours, a quad a turn
FW_SHARED_CONST uint kNodeArms = 5u;          // its arms, a quad for each of kArmWays
FW_SHARED_CONST uint kNodeRest = 9u;
FW_SHARED_CONST uint kNodeFar = 10u;          // those two steps straight on, a quad a turn: springs have them
FW_SHARED_CONST uint kNodeTexels = 14u;
FW_SHARED_CONST uint kNodeOut = 18u;
FW_SHARED_CONST uint kDeformCoatQuads = 4u;
FW_SHARED_CONST uint kDeformObjectQuads = 36u; // of a DeformObject: materials from 4, pins from 20
FW_SHARED_CONST uint kShownQuads = 3u;        // of a ShownVertex
FW_SHARED_CONST uint kMaxPins = 8u;
FW_SHARED_CONST uint kDeformGroup = 512u;     // nodes or vertices of a workgroup: 8 a thread
// In the second word of a group, above the first node or vertex.
FW_SHARED_CONST uint kDeformReset = 0x80000000u;  // start from rest
FW_SHARED_CONST uint kDeformOdd = 0x40000000u;    // its places are the second ones
FW_SHARED_CONST uint kDeformCrosses = 0x20000000u; // walls may cross and open by themselves
FW_SHARED_CONST uint kDeformWoke = 0x10000000u;   // it did not move in the frame before
FW_SHARED_CONST uint kDeformItem = 0x0FFFFFFFu;
FW_SHARED_CONST uint kDeformNode = 0xFFFFFFu; // of a link: which node
FW_SHARED_CONST uint kSoftQuads = 5u;         // of a vertex of what moves: see lib/deform_buffers.glsl
FW_SHARED_CONST uint kSoftTicks = 32u;        // of one of its steps: 1/128 s
FW_SHARED_CONST uint kMostSoftSteps = 6u;     // of a frame; a hitch drops the rest

// DeformObject::flags
FW_SHARED_CONST uint kDeformRecede = 1u;      // tier A: along the offset, no forces
FW_SHARED_CONST uint kDeformShell = 2u;       // tier B: a thin sheet
FW_SHARED_CONST uint kDeformSprings = 4u;     // tier C: the published mass-spring model

// DeformNode::flags, above the material (bits 0..7)
FW_SHARED_CONST uint kNodeClosed = 0x100u;    // its ring of neighbours closes
FW_SHARED_CONST uint kNodeEven = 0x200u;      // it rests in the middle of its neighbours, seen from above
FW_SHARED_CONST uint kNodeArmsEven = 0x400u;  // and of its first arms; << 1: of its second ...
FW_SHARED_CONST uint kNodeHasArms = 0x4000u;    // it has arms, or another of its run has
FW_SHARED_CONST uint kNodeRingShift = 16u;    // how many neighbours: bits 16..19
FW_SHARED_CONST uint kNodeTurnsShift = 20u;   // how many turns its run takes to read them: bits 20..22

struct DeformNode {       // static, per mesh
    uint vertex;                 // that keeps what is shown of it, from the mesh's first
    uint flags;                  // material, kNode...
    float rise;                  // m that its neighbours' mean lies above it along the rest normal
    uint opposite;               // texel on the wall behind, kNoneTexel: none
    uint ring[8];                // vertices around it, in order
    uint ringLength[4];          // m, halfs
    float x; float y; float z;   // m, rest
    float area;                  // m^2, a third of its triangles
    uint cross_[8];              // as ring, two steps straight on; no length or kNoneTexel: none
    uint crossLength[4];         // m, halfs
    uint texels[16];             // of its ring, in the burn map; kNoneTexel after the last
    float outX; float outY; float outZ; // which way it recedes: -1 along every face's normal, if it can
    float limit;                 // m, most it may recede
    uint arms[8];                // vertices some way off, behind and ahead in each way; or kNoneTexel
    float armLength[8];          // m
    float armRise[4];            // m, as `rise`, of each two
};
FW_SHARED_SIZE(DeformNode, 288)

struct DeviceLinks {      // what one turn reads
    uint first; uint second;     // nodes; the link's odds (linkOdds) above bit 23
    uint lengths;                // m, halfs; 0: no link
    float rise;                  // m, of arms
};
struct DeviceNode {       // a DeformNode as devices have it: quad by quad, each of all nodes of the mesh
    uint vertex; uint flags; float rise; uint opposite;
    DeviceLinks near_[4];
    DeviceLinks arms[4];
    float x; float y; float z; float area;
    DeviceLinks far_[4];
    uint texels[16];
    float outX; float outY; float outZ; float limit;
    uint reserved[4];
};
FW_SHARED_SIZE(DeviceNode, 320)

struct DeformCoat {       // static, per drawn vertex: what its normal follows; devices: quad by quad
    uint node;            // vertex that keeps its node's state
    uint normal;          // at rest, signed 11:11:10
    uint reserved0; uint reserved1;
    uint ring[8];         // chain of vertices around it, the last repeated: of triangles that share the normal
    float faceX; float faceY; float faceZ;  // unit, their area-weighted normal at rest
    float longest;        // m^2, at rest, of the way to one of the ring
};
FW_SHARED_SIZE(DeformCoat, 64)

struct ShownVertex {      // what is drawn instead of a mesh::RenderVertex's position and normal
    float x; float y; float z;   // m, object space
    uint normal;                 // signed 11:11:10
    float burnt;                 // [0, 1] mean over the node's texels; never falls
    float lost; float kept;      // m, of a spring node: in each step, and for later ones; kept: of
                                 // a solid, that it has receded
    float behind;                // s of look time that the wall behind has burnt for
    float reserved[3];
    float lead;                  // s of look time that holes come earlier here
};
FW_SHARED_SIZE(ShownVertex, 48)

struct DeformMaterial {   // one material on one object
    uint charTicks;       // from ignition to consumed (recession) or charred (sheets)
    float depth;          // m, recession when consumed
    float shrink;         // [0, 0.5] of lengths, when charred
    float curl;           // 1/m, when charred
    uint holeTicks;       // from ignition to a hole; kNoneTexel: it never opens
    float holeSeconds;    // the same in look time
    float bend;           // [0, 1] stiffness against bending, before it chars
    float drag;           // 1/s, of the air across it
};
FW_SHARED_SIZE(DeformMaterial, 32)

struct DeformObject {     // per object slot
    uint nodeBase;        // into the nodes
    uint nodeCount;
    uint coatBase;        // into the coats
    uint vertexCount;
    uint shownBase;       // into the shown vertices
    uint stateBase;       // as BurnObject
    uint flags;           // kDeform...
    uint pinCount;
    float ground;         // m, world, along up: nothing falls below; -1e9: no ground
    uint slot;            // of its BurnObject
    float scale;          // m in the world of 1 m
    float springs;        // 1/s^2, stiffness over mass of the published model
    uint softBase;        // into the soft nodes
    uint innerFirst;      // of its vertices on the inner skin, into the vertices; see `wall`
    float wall;           // m, how far that is under the surface; 0: it has none
    float reserved0;
    DeformMaterial materials[8];
    vec4 pins[16];        // from xyz, radius; to xyz, 0: object space, m
};
FW_SHARED_SIZE(DeformObject, 576)

struct DeformPush {       // push constants of the deformation passes
    uint now;             // tick of the state that is shown
    uint first;           // group in the list
    uint parity;          // of the substep; above bit 0 which arms it minds; recede: steps there are
    float step;           // s
    vec4 wind;            // m/s, world; w: s, cosmetic time
    vec4 up;              // world; w: ticks into the running step
};
FW_SHARED_SIZE(DeformPush, 48)

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
FW_SHARED_SIZE(SkinPush, 48)

#ifdef __cplusplus
using glm::cross;
using std::sin;
using glm::dot;
using glm::length;
using glm::packHalf2x16;
using glm::unpackHalf2x16;
inline float inversesqrt(float x) { return 1.0f / std::sqrt(x); }
inline float deformFloor(float x) { return std::floor(x); }
#else
float deformFloor(float x) { return floor(x); }
#endif
FW_SHARED_FN float leastF(float a, float b) { return a < b ? a : b; }
FW_SHARED_FN float mostF(float a, float b) { return a > b ? a : b; }
FW_SHARED_FN float mixF(float a, float b, float t) { return a + (b - a) * t; }
FW_SHARED_FN float unitF(float x) { return x < 0.0f ? 0.0f : (x > 1.0f ? 1.0f : x); }

// Eq. (9) with areas: the mip of a burn map of which about k texels cover a ring of `texels`.
FW_SHARED_FN uint mipOfRing(uint texels, uint k) {
    uint mip = 0u;
    while (texels >= k * 4u) {
        texels /= 4u;
        ++mip;
    }
    return mip;
}

// Share of a texel's fuel that is gone at tick `now` and `more`, if it caught at t.
FW_SHARED_FN float burntShare(uint t, uint now, float more, uint charTicks) {
    if (!isSource(t) || now < t) return 0.0f;
    if (charTicks == kNoneTexel || charTicks == 0u) return 0.0f;
    return leastF((float(now - t) + more) / float(charTicks), 1.0f);
}

// m that a node recedes: never so far that walls or the triangles around would cross.
FW_SHARED_FN float recession(float burnt, float depth, float limit) {
    return leastF(burnt * depth, limit);
}

// How near the inner skin comes to the surface when all of a wall has receded.
FW_SHARED_CONST float kThinnestWall = 0.15f;  // of it

// The rest normal `n`, turned as its faces turned from `a` to `b`; all unit.
FW_SHARED_FN vec3 turnedNormal(vec3 n, vec3 a, vec3 b) {
    float c = dot(a, b);
    if (c > 0.9999995f) return n;
    if (c < -0.99f) return b;  // turned over: the least turn says nothing
    vec3 sum = a + b;
    vec3 turned = n - sum * (dot(sum, n) / (1.0f + c)) + b * (2.0f * dot(a, n));
    return turned * inversesqrt(mostF(dot(turned, turned), 1e-20f));
}

// ---- sheets: position based, every node corrects itself from what its neighbours were --------------

FW_SHARED_CONST float kReachNone = 60000.0f;  // m along unburnt links to a pin: none known
// A way to a pin that was known and grew: either there is another, which the next steps find, or there
// is none and neighbours tell each other of it in circles. It grows by more than they make it, so that
// in the one case nothing is held back that falls, and in the other little is let go for a moment.
FW_SHARED_CONST float kReachGrows = 1.03f;
FW_SHARED_FN bool reachKnown(float way, float before) { return way <= before * 1.004f; }
FW_SHARED_FN float reachNext(float way, float before, bool known) {
    return leastF(known && !reachKnown(way, before) ? way * kReachGrows : way, kReachNone);
}
FW_SHARED_CONST float kReachSlack = 1.001f;   // it is kept as a half
FW_SHARED_CONST float kBendUnit = 4096.0f;    // of packed bends, per m
FW_SHARED_CONST float kCharredSteps = 15.0f;  // in which nodes know of others'
// Which links hold is looked at once in so many steps: fire takes seconds.
FW_SHARED_CONST uint kTieSteps = 4u;
FW_SHARED_FN bool tiesAt(uint way) { return way % kTieSteps == 0u; }
// Neighbours correct at the same time: a pattern of alternating nodes is corrected by up to 4 times
// the one and twice 3.4 times the other, and with speeds that is stable while it is below 4/3.
FW_SHARED_CONST float kLinkRelax = 0.2f;
FW_SHARED_CONST float kBendRelax = 0.08f;
FW_SHARED_CONST float kSheetDamping = 0.01f;  // of the velocity, in 1/128 s
FW_SHARED_CONST float kFastest = 12.0f;       // m/s
FW_SHARED_CONST float kPinBurns = 0.6f;       // a pin lets go of what has burnt so far

// Links part one by one as both ends are consumed: when, of 256.
FW_SHARED_FN uint linkOdds(uint a, uint b) {
    uint h = ((a ^ b) * 0x9E3779B1u) ^ ((a + b) * 0x85EBCA6Bu);
    return ((h ^ (h >> 15u)) * 0x2C1B3C6Du) >> 24u;
}
FW_SHARED_FN bool linkHolds(float burntA, float burntB, uint odds) {
    return leastF(burntA, burntB) < 0.80f + 0.15f / 256.0f * float(odds);
}

// How far shrinking and curling have come: all of it before links part.
FW_SHARED_FN float charredShare(float burnt) {
    float x = unitF(burnt * 1.8f);
    return x * x * (3.0f - 2.0f * x);
}

// What neighbours know of a node's fire: burnt share (8 bits), charred share (4 bits) and whether it
// is pinned.
FW_SHARED_FN uint packFacts(float burnt, bool pinned) {
    return uint(burnt * 255.0f) | uint(charredShare(burnt) * kCharredSteps + 0.5f) << 8u |
           (pinned && burnt <= kPinBurns ? 1u << 12u : 0u);
}
FW_SHARED_FN float burntOf(uint facts) { return float(facts & 255u) * (1.0f / 255.0f); }
FW_SHARED_FN uint charredOf(uint facts) { return (facts >> 8u) & 15u; }
FW_SHARED_FN uint pinnedOf(uint facts) { return (facts >> 12u) & 1u; }

// Neighbours know its way to a pin as well: with its place, in the last bits of that, a millionth of it.
FW_SHARED_CONST uint kWayKnown = 0x8000u;  // beside the way: it once was what it had been
FW_SHARED_FN uint packWay(float way, bool known) {
    return (packHalf2x16(vec2(way, 0.0f)) & 0x7FFFu) | (known ? kWayKnown : 0u);
}
FW_SHARED_FN float wayOf(uint bits) { return unpackHalf2x16(bits & 0x7FFFu).x; }
FW_SHARED_CONST uint kWayLow = 31u;   // of the bits of x and y
FW_SHARED_CONST uint kWayHigh = 63u;  // of those of z
FW_SHARED_FN uint packPlace(uint word, uint bits, uint mask) {
    return ((word + (mask + 1u) / 2u) & ~mask) | (bits & mask);
}

// Every neighbour's share of what a node gives way by, which is that often what a share is: who
// bends has all of them. Halfs, shortened to 11, 11 and 10 bits: all see the same.
FW_SHARED_FN uint packShare(vec3 share) {
    uint xy = packHalf2x16(vec2(share.x, share.y)), z = packHalf2x16(vec2(share.z, 0.0f));
    return (((xy & 0xFFFFu) + 16u) >> 5u) | (((xy >> 16u) + 16u) >> 5u) << 11u |
           (((z & 0xFFFFu) + 32u) >> 6u) << 22u;
}
FW_SHARED_FN vec3 shareOf(uint bits) {
    vec2 xy = unpackHalf2x16((bits & 0x7FFu) << 5u | (bits & 0x3FF800u) << 10u);
    return vec3(xy.x, xy.y, unpackHalf2x16((bits >> 22u) << 6u).x);
}

// A relaxation that stands for the same stiffness whatever the step.
FW_SHARED_FN float relaxAt(float relax, float dt) {
    float steps = dt * 128.0f;
    return steps < 1.0f ? relax * steps * steps : relax;
}

// Of a velocity, after one step; charred sheets move as through honey.
FW_SHARED_FN float sheetDamping(float charred, float dt) {
    return 1.0f - kSheetDamping * (1.0f + 5.0f * charred) * (dt * 128.0f);
}

// What has burnt and been drawn out to several lengths has torn: no skin is left between its ends.
FW_SHARED_CONST float kTornSquare = 2.6f;  // of rest lengths' squares
FW_SHARED_CONST float kTornLead = 1000.0f; // s of look time
FW_SHARED_FN float tornLead(float square, float longest, float burnt) {
    return burnt > 0.5f && square > kTornSquare * longest ? kTornLead : 0.0f;
}

// The air at a node, in its object's units: it goes with the wind, in gusts, and rises where it burns.
FW_SHARED_CONST float kUpdraft = 1.2f;  // m/s
FW_SHARED_FN float gustAt(vec3 x, float scale, float time) {
    float phase = dot(x, vec3(3.1f, 2.3f, 2.7f)) * scale;
    return 0.7f + 0.3f * sin(2.3f * time + phase) + 0.25f * sin(5.9f * time - 1.7f * phase);
}
FW_SHARED_FN float updraftAt(float burnt) {
    float a = unitF((burnt - 0.02f) / 0.18f), b = unitF((burnt - 0.7f) / 0.3f);
    return kUpdraft * a * a * (3.0f - 2.0f * a) * (1.0f - b * b * (3.0f - 2.0f * b));
}

// What moves x towards the rest length from y; share: 1/2, or 1 if y is pinned.
FW_SHARED_FN vec3 linkPush(vec3 x, vec3 y, float rest, float share) {
    vec3 d = y - x;
    float l = length(d);
    return d * (share * (l - rest) / mostF(l, 1e-9f));
}

// Which way it curls, seen along its normal: towards the side that flames lick, from below.
FW_SHARED_FN float curlSide(vec3 normal, vec3 up) {
    float s = 0.7f - 2.0f * dot(normal, up);
    return s < -1.0f ? -1.0f : (s > 1.0f ? 1.0f : s);
}

// ---- stiffness beyond neighbours
// What neighbours feel of a wide bend is next to nothing, so a fine mesh that bends by them alone hangs
// like a rag. A sheet's nodes have arms as well: in each of two directions a node some fixed way behind
// and one as far ahead, in whose middle it belongs; who is somebody's node ahead has that one behind.
// Waves as long as an arm would pass unnoticed, so there are shorter ones too. A step minds one kind.
// Where a node's arms do not hold it has none.
FW_SHARED_CONST float kArmRelax = 0.17f;
FW_SHARED_CONST float kArmTears = 1.1f;  // of its length: what lies between has parted
FW_SHARED_CONST float kArmCurls = 1.4f;  // more than a ring of the same reach does
// They curl across a burning edge and not along it, as a sheet cannot do both: how much, by the charred
// shares behind and ahead. What is charred on both sides has no shape of its own to keep.
FW_SHARED_FN float armCurl(float behind, float ahead) {
    float d = ahead - behind;
    return leastF(4.0f * d * d, 1.0f);
}
FW_SHARED_FN float armFirm(float stiff, float charred, float across) {
    return kArmRelax * stiff * (1.0f - charred * (1.0f - across));
}

// What a node's place must give for its neighbours' mean to lie `rise` above it. Of an even node all
// of the way there: that is the slope of an energy, which a part of it along a normal is not.
FW_SHARED_FN vec3 bendOf(vec3 toMean, vec3 normal, float rise, float neighbours, float relax, bool even) {
    vec3 off = even ? toMean - normal * rise : normal * (dot(toMean, normal) - rise);
    off *= relax * neighbours / (neighbours + 1.0f);
    float square = dot(off, off);
    return square > 1e-4f ? off * (1e-2f * inversesqrt(square)) : off;
}

// m that a curl lifts the mean of neighbours whose squared distances have this mean; no more than
// they can be lifted without lying on top of each other.
FW_SHARED_FN float curlRise(float curl, float square) {
    float rise = 0.25f * curl * square, most = 0.3f * square * inversesqrt(mostF(square, 1e-20f));
    return rise > most ? most : (rise < -most ? -most : rise);
}

FW_SHARED_FN vec3 noFasterThan(vec3 v, float most) {
    float square = dot(v, v);
    return square > most * most ? v * (most * inversesqrt(square)) : v;
}

// Nearest point of a pin's segment.
FW_SHARED_FN vec3 pinPoint(vec3 x, vec3 from, vec3 to) {
    vec3 d = to - from;
    return from + d * unitF(dot(x - from, d) / mostF(dot(d, d), 1e-12f));
}

// ---- springs, as published ------------------------------------------------------------------------

FW_SHARED_CONST float kSpringShare = 0.2f;   // alpha of eq. (3)
FW_SHARED_CONST float kDecayShare = 1.0f;    // beta
FW_SHARED_CONST float kSpringDamping = 0.08f;  // of the velocity, per step

// Eq. (4): of one spring, per unit mass.
FW_SHARED_FN vec3 springPull(vec3 x, vec3 y, float rest, float stiffness) {
    return linkPush(x, y, rest, stiffness);
}
// Eqs. (5) to (8): what a recession by `depth` within a step of dt is as an acceleration.
FW_SHARED_FN vec3 decayPull(vec3 normal, float depth, float dt) {
    return normal * (-2.0f * depth / (dt * dt));
}
// Semi-implicit Euler is stable below 2 / w, w^2 <= 2 * springs * stiffness (Gershgorin): the
// stiffness at `share` of that bound.
FW_SHARED_FN float springsAt(float share, float dt, float springs) {
    float w = 2.0f * share / dt;
    return w * w / (2.0f * springs);
}

FW_SHARED_FN uint packDirection(vec3 n) {  // signed 11:11:10
    int x = int(deformFloor(n.x * 1023.0f + 0.5f)), y = int(deformFloor(n.y * 1023.0f + 0.5f));
    int z = int(deformFloor(n.z * 511.0f + 0.5f));
    return (uint(x) & 0x7FFu) | ((uint(y) & 0x7FFu) << 11u) | ((uint(z) & 0x3FFu) << 22u);
}
FW_SHARED_FN vec3 unpackDirection(uint packed) {
    int n = int(packed);
    vec3 v = vec3(float((n << 21) >> 21), float((n << 10) >> 21), float(n >> 22) * 2.0f);
    return v * inversesqrt(mostF(dot(v, v), 1e-20f));
}

FW_SHARED_END
#endif
