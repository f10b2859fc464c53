// Copies the positions, and normals if given, of an object's vertices from the host's vertex
// buffer; otherwise skin-to-mesh makes normals. 64 vertices per group.
#version 450
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "shared/deform.h"
layout(std430, set = 0, binding = FW_BIND_SKIN_SOURCES) readonly buffer SourcesBuffer {
    uint sources[];
};
layout(std430, set = 0, binding = FW_BIND_SKIN_GIVEN) readonly buffer GivenBuffer { uint given[]; };
layout(std430, set = 0, binding = FW_BIND_SHOWN) buffer ShownBuffer { uint shownWords[]; };
layout(push_constant) uniform SkinPushBlock { SkinPush push; };

vec3 vectorAt(uint word) { return uintBitsToFloat(uvec3(given[word], given[word + 1u], given[word + 2u])); }

void main() {
    for (uint i = gl_GlobalInvocationID.x; i < push.count; i += gl_NumWorkGroups.x * 64u) {
        uint at = push.given + sources[push.sourceBase + i] * push.stride;
        vec3 shape = uintBitsToFloat(uvec3(push.scaleX, push.scaleY, push.scaleZ));
        vec3 place = vectorAt(at) * shape;
        uint to = (push.shownBase + i) * kShownQuads * 4u;
        uvec3 words = floatBitsToUint(place);
        shownWords[to] = words.x;
        shownWords[to + 1u] = words.y;
        shownWords[to + 2u] = words.z;
        if (push.normal != kNoneTexel) {
            vec3 n = vectorAt(at + push.normal) / shape;
            float size = dot(n, n);
            if (size > 1e-20) shownWords[to + 3u] = packDirection(n * inversesqrt(size));
        }
    }
}
