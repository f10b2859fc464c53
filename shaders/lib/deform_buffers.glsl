// Storage buffers of the deformation passes, by words of four. As lib/buffers.glsl: a shader defines
// FW_USE_<NAME> as the access it needs.
#ifndef FW_LIB_DEFORM_BUFFERS_GLSL
#define FW_LIB_DEFORM_BUFFERS_GLSL
#include "lib/buffers.glsl"
#include "shared/deform.h"

FW_BUFFER(FW_BIND_DEFORM_OBJECTS, readonly, DeformObjectsBuffer, uvec4, deformObjects);
FW_BUFFER(FW_BIND_DEFORM_GROUPS, readonly, DeformGroupsBuffer, uvec2, deformGroups);
#ifdef FW_USE_DEFORM_NODES
FW_BUFFER(FW_BIND_DEFORM_NODES, readonly, DeformNodesBuffer, uvec4, deformNodes);
#endif
#ifdef FW_USE_DEFORM_COATS
FW_BUFFER(FW_BIND_DEFORM_COATS, readonly, DeformCoatsBuffer, uvec4, deformCoats);
#endif
#ifdef FW_USE_SHOWN
FW_BUFFER(FW_BIND_SHOWN, FW_USE_SHOWN, ShownBuffer, vec4, shown);
#endif
#ifdef FW_USE_SHOWN_WORDS
FW_BUFFER(FW_BIND_SHOWN, FW_USE_SHOWN_WORDS, ShownWordsBuffer, uint, shownWords);
#endif

#ifdef FW_USE_SOFT
// Per shown vertex two places (xyz, packed reach to a pin and burnt share) and bend.comp's result.
FW_BUFFER(FW_BIND_SOFT, FW_USE_SOFT, SoftBuffer, uvec4, soft);
// The third quad: the normal, coarsely, and which links hold (near, far << 8); near and far bends.
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
vec3 nearBend(uvec4 bent) {
    return vec3(unpackHalf2x16(bent.y), unpackHalf2x16(bent.z).x);
}
vec3 farBend(uvec4 bent) {
    return vec3(unpackHalf2x16(bent.z).y, unpackHalf2x16(bent.w));
}
// Of each neighbour: who bends has all of them.
float bendShare(uvec4 bent) { return 1.0 / float(max(bitCount(bent.x & 0xFFu), 1)); }
#endif

layout(push_constant) uniform DeformPushBlock { DeformPush push; };

// One thread's object and item: a node or a vertex, which may be beyond the last.
struct DeformItem {
    uint object;  // quad of its DeformObject
    uint number;
    uint parity;  // of the places that are read
    bool reset;
};
DeformItem deformItem() {
    uvec2 group = deformGroups[push.first + gl_WorkGroupID.x];
    DeformItem item;
    item.object = group.x * kDeformObjectQuads;
    item.number = (group.y & kDeformItem) + gl_LocalInvocationID.x;
    item.parity = ((group.y & kDeformOdd) != 0u ? 1u : 0u) ^ (push.parity & 1u);
    item.reset = (group.y & kDeformReset) != 0u;
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
float heightHere(uvec4 facts, vec3 place) {  // m, world, along up
    float h = 0.0;
    FW_UNROLL for (uint row = 0u; row < 3u; ++row) {
        vec4 r = uintBitsToFloat(objectQuads[facts.y * 10u + 5u + row]);
        h += push.up[row] * (dot(r.xyz, place) + r.w);
    }
    return h;
}
#endif
#endif
